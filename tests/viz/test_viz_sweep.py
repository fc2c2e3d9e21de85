"""A sweep's charts: which studies have them, what is on them, and that a browser draws them."""

from __future__ import annotations

import numpy as np
import pytest
from test_viz_browser import dom, needs_browser

from rover_pin.analysis import Study
from rover_pin.viz.page.study import study_page
from rover_pin.viz.page.sweep import sweep_of


def study(**vary):
    return Study("rocker_bogie", {"slope": 5}, cases="grid", vary=vary, measures=["tip"])


@pytest.fixture(scope="module")
def line():
    asked = study(parameters={"com_x": {"from": -0.2, "to": 0.2, "by": 0.1}})
    return asked, asked.run()


@pytest.fixture(scope="module")
def square():
    asked = study(parameters={"com_x": [-0.2, 0.0, 0.2], "wheelbase": {"values": [1.0, 1.2]}})
    return asked, asked.run()


def test_one_quantity_has_lines(line):
    told = sweep_of(line[1])
    (axis,) = told["axes"]
    assert (axis["name"], axis["title"], axis["unit"], axis["factor"]) == ("com_x", "Com x", "mm", 1000.0)
    charts = {chart["title"]: chart for chart in told["charts"]}
    assert list(charts) == ["Wheels in contact", "Load spread", "Wheel loads", "Tip-over angle"]
    assert [one["label"] for one in charts["Wheel loads"]["lines"]] == ["fl", "ml", "bl", "fr", "mr", "br"]
    assert charts["Load spread"]["better"] == "low"


def test_two_quantities_have_maps(square):
    told = sweep_of(square[1])
    assert [axis["name"] for axis in told["axes"]] == ["wheelbase", "com_x"] or len(told["axes"]) == 2


@pytest.mark.parametrize("case", ["places", "scattered", "three", "posture"])
def test_other_studies_have_none(case, line):
    vary = {
        "places": {"x": [0, 1, 2], "y": [0, 1, 2]},
        "scattered": {"parameters": {"com_x": [-0.1, 0.1], "wheelbase": [1.0, 1.2]}},
        "three": {"x": [0, 1, 2], "yaw_deg": [0, 1, 2], "parameters": {"com_x": [0.0, 0.1, 0.2]}},
        "posture": {"posture": ["home", "clearance=0.3"], "x": [0, 1, 2]},
    }[case]
    cases = {"n": 8} if case == "scattered" else "grid"
    data = Study("rocker_bogie", "flat", cases=cases, vary=vary, measures=[]).run()
    assert sweep_of(data) is None


@needs_browser
@pytest.mark.parametrize("kind", ["line", "square"])
def test_a_browser_draws_the_charts(kind, tmp_path, request):
    asked, data = request.getfixturevalue(kind)
    failed = data.copy()
    failed["status"] = ("case", np.where(np.arange(data.sizes["case"]) == 1, "tips", "settled"))
    text = study_page(failed, asked.plan.rover, asked.plan.job.terrain, {0: asked.stance(0)})
    body = dom(text, tmp_path).split("<main>")[1].split("</main>")[0]
    sweep = body.split('id="sweep"')[1].split("</section>")[0]
    assert "hidden" not in sweep.split(">")[0]
    assert sweep.count("<canvas") == {"line": 4, "square": 9}[kind]
    assert "cannot be shown" not in body
    assert 'id="map-card" hidden' in body
