"""Robots of example-robot-data serve every static measure, on flat ground and on a slope, as by hand."""

import math
import re

import numpy as np
import pytest
import yaml
from urdf_by_hand import Shape, Standing

import rover_pin as rp
from rover_pin.description import examples
from rover_pin.stability.registry import MEASURES
from rover_pin.stability.report import inapplicable
from rover_pin.viz.traverse_motion import traverse_run

NAMES = [each.name for each in examples.EXAMPLES]
WHEELED = {"tiago"}
EDGES = 48
"""Of the pyramids in the linear programs."""


def declared(name):
    """The sidecar's feet and wheels, and its home."""
    said = yaml.safe_load(examples.sidecar_of(name).read_text())
    touching = [*said.get("wheels", ()), *said["contacts"]]
    shapes = [
        Shape(
            one.get("name", one["frame"]), one["frame"], tuple(one.get("center", (0, 0, 0))),
            one.get("radius", 0.0), one["friction"], (0.0, 0.0, 1.0) if "width" in one else None,
        )
        for one in touching
    ]  # fmt: skip
    return shapes, said.get("postures", {}).get("home", {})


@pytest.fixture(scope="module", params=[(0.0, 0.0), (8.0, 0.5)], ids=["flat", "slope"])
def ground(request):
    return request.param


@pytest.fixture(scope="module", params=NAMES)
def case(request, ground):
    """Name, stance, its margins, and the same by hand."""
    degrees, yaw = ground
    rover = rp.load(f"example:{request.param}")
    shapes, home = declared(request.param)
    hand = Standing(rover.source, home, shapes, math.radians(degrees), yaw)
    stance = rp.settle(rover, rp.Terrain.slope(degrees), yaw=yaw)
    return request.param, stance, rp.stability(stance), hand


def test_it_stands_and_carries_as_by_hand(case):
    _, stance, _, hand = case
    assert str(stance.status) == "settled"
    by_hand = {shape.name: load for shape, load in zip(hand.shapes, hand.loads, strict=True)}
    assert stance.loads == pytest.approx(by_hand, abs=1e-8 * hand.weight)
    assert min(stance.loads.values()) >= 0.0
    assert sum(stance.loads.values()) == pytest.approx(hand.weight, rel=1e-11)
    np.testing.assert_allclose(stance.com, hand.com, atol=1e-10)
    np.testing.assert_allclose(stance.rpy, hand.rpy, atol=1e-9)
    assert stance.redundant == len(hand.points) - 3
    assert max(stance.residuals[key] for key in ("equilibrium", "gap_m", "complementarity")) < 1e-10
    assert stance.residuals["loop_m"] == 0.0


def test_every_measure_answers_or_says_why_not(case):
    name, stance, margins, _ = case
    reasons = inapplicable(stance.rover)
    assert set(margins) | set(reasons) == set(MEASURES)
    assert not set(margins) & set(reasons)
    expected = {"clearance": f"example:{name} declares no belly points"}
    if name not in WHEELED:
        expected["torque"] = f"no wheel of example:{name} is driven"
    assert reasons == expected
    for margin in margins.values():
        assert margin.answered, margin
        assert margin.edges[margin.limiting] == margin.value


def test_measures_agree_with_each_other(case):
    """The centre of mass is inside; region within polygon, feasible region within that."""
    _, _, margins, _ = case
    value = {name: margin.value for name, margin in margins.items()}
    assert all(value[name] > 0.0 for name in ("polygon", "tip", "force_angle", "energy", "zmp", "region"))
    assert value["zmp"] == pytest.approx(value["polygon"], abs=1e-10)
    assert value["region"] <= value["polygon"] + 1e-8
    assert value["feasible"] <= value["region"] + 1e-8
    assert margins["feasible"].details["area_m2"] <= margins["region"].details["area_at_most_m2"] * (1 + 1e-9)


def test_slack_and_friction_on_a_slope_of_known_need(case, ground):
    """One coefficient everywhere: the weight needs tan(slope) of it; the slack is above 0."""
    _, stance, _, _ = case
    margins = rp.stability(stance, ["friction", "slack"], friction=0.6)
    assert margins["friction"].value == pytest.approx(0.6 - math.tan(math.radians(ground[0])), abs=1e-6)
    assert margins["friction"].note == f"needs friction {margins['friction'].details['least']:.6g}"
    assert 0.0 < margins["slack"].value < stance.weight / len(stance.contacts)


def test_the_friction_needed_is_that_of_the_slope_whatever_the_casters_have(case, ground):
    name, _, margins, _ = case
    least = margins["friction"].details["least"]
    assert least == pytest.approx(math.tan(math.radians(ground[0])), abs=1e-6)
    words = "one friction of {:.6g} at every contact would do" if name in WHEELED else "needs friction {:.6g}"
    assert margins["friction"].note == words.format(least)


@pytest.mark.parametrize("measure", ["region", "feasible"])
def test_regions_lie_between_pyramids_within_and_around_the_cones(case, measure):
    _, stance, margins, hand = case
    bracket(margins[measure], hand, stance, measure == "feasible")


def bracket(margin, hand, stance, torques):
    """The margin and the outline's reach against linear programs (HiGHS)."""
    corners = np.array(margin.outline) - stance.com[:2]
    toward = margin.details["toward_rad"] + stance.rpy[2]
    for angle in (toward, toward + 2.2, toward - 1.9):
        a = np.array([math.cos(angle), math.sin(angle)])
        least, most = (hand.reach(a, EDGES, torques, inside) for inside in (True, False))
        assert margin.value <= most + 1e-7
        assert least * (1 - 2e-3) - 1e-7 <= np.max(corners @ a) <= most + 1e-6
        if angle == toward:
            assert least - 1e-7 <= margin.value


@pytest.mark.parametrize(
    ("name", "share"), [("anymal_b", 0.25), ("hyq", 0.5), ("solo12", 0.0015), ("talos", 0.35)]
)
def test_efforts_of_the_urdf_bound_the_feasible_region(tmp_path, name, share):
    """Every effort of the URDF times `share`: the region shrinks, as by linear programs.

    TIAGo's wheels are at their efforts on the slope above; less would not hold up its arm.
    """
    rover = rp.load(f"example:{name}")
    weaker = tmp_path / rover.source.name
    text = re.sub(
        r'effort="([^"]+)"', lambda m: f'effort="{float(m[1]) * share!r}"', rover.source.read_text("utf-8")
    )
    weaker.write_text(text, "utf-8")
    packages = {"example-robot-data": rover.source.parents[3]}
    weak = rp.load(weaker, sidecar=examples.sidecar_of(name), packages=packages)
    stance = rp.settle(weak, rp.Terrain.slope(4.0), yaw=0.5)
    margins = rp.stability(stance, ["region", "feasible"])
    shapes, home = declared(name)
    hand = Standing(weaker, home, shapes, math.radians(4.0), 0.5)
    assert margins["feasible"].details["area_at_most_m2"] < 0.9 * margins["region"].details["area_m2"]
    bracket(margins["feasible"], hand, stance, torques=True)


def test_a_path_tells_the_friction_that_it_needs_and_no_share_of_frictions_that_differ():
    rover, slope = rp.load("example:tiago"), rp.Terrain.slope(6.0)
    path = rp.analysis.traverse(rover, slope, [(0.0, 0.0), (0.05, 0.0)])
    np.testing.assert_allclose(path.friction_needed, math.tan(math.radians(6.0)), atol=1e-6)
    assert list(traverse_run(path, rover, slope).indices) == ["torque needed of effort"]
    alike = rp.analysis.traverse(rover, slope, [(0.0, 0.0), (0.05, 0.0)], friction=0.5)
    share = traverse_run(alike, rover, slope).indices["friction needed of given"]
    np.testing.assert_allclose(share, math.tan(math.radians(6.0)) / 0.5, atol=1e-6)
