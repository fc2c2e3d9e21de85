"""Figures of a run."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from motion_runs import settled_run

import rover_pin as rp


@pytest.fixture(scope="module")
def run():
    return settled_run(rp.load("hit_mrii"), rp.Terrain.flat())


def triangles(axes):
    return [float(line.get_xdata()[0]) for line in axes.lines if line.get_marker() == "v"]


def test_every_log_has_its_panel_and_its_lines(run, tmp_path):
    figure = rp.viz.plot_run(run)
    index, loads, clearance, attitude, drift = figure.axes
    assert [axes.get_ylabel() for axes in figure.axes] == [
        "index [–]", "load [N]", "clearance [mm]", "attitude [°]", "drift [mm]",
    ]  # fmt: skip
    lines = {line.get_label(): line for line in index.lines}
    np.testing.assert_allclose(lines["wheelbase"].get_ydata(), run.indices["wheelbase"][:, 0])
    assert np.flatnonzero(np.isnan(lines["load deviation"].get_ydata().filled(np.nan))).tolist() == [
        4
    ]  # silent
    assert any(
        (np.asarray(line.get_ydata()) == 1.0).all() and line.get_linestyle() == "--" for line in index.lines
    )
    for wheel in run.rover.wheels:
        line = next(line for line in loads.lines if line.get_label() == wheel.name)
        np.testing.assert_allclose(line.get_ydata(), run.loads[wheel.name])
        assert line.get_linestyle() == ("-" if wheel.name[0] == "L" else "--")
    np.testing.assert_allclose(clearance.lines[0].get_ydata()[0], 250.0, atol=0.05)
    assert {line.get_label() for line in attitude.lines} >= {"roll", "pitch"}
    assert drift.get_xlabel() == "time [s]"
    figure.savefig(tmp_path / "run.svg")
    assert "chassis_raise" in (tmp_path / "run.svg").read_text()


def test_changes_of_action_are_marked_and_named(run):
    axes = rp.viz.plot_run(run).axes[0]
    assert triangles(axes) == [0.0, 12.0]
    assert [text.get_text() for text in axes.texts] == ["chassis_raise", "chassis_lower"]


def test_many_changes_are_named_by_letters_with_a_key(run):
    words = ("creep_raise", "creep_lower", "rolling") * 4
    figure = rp.viz.plot_run(dataclasses.replace(run, time=np.r_[0:11, 40.0], actions=words))
    assert [text.get_text() for text in figure.axes[0].texts] == list("abcabcabcabc")
    assert figure.get_supxlabel() == "a  creep_raise    b  creep_lower    c  rolling"


def test_changes_at_almost_the_same_time_stand_together(run):
    words = ("engage L_bogie", *("lift LF",) * 11)
    axes = rp.viz.plot_run(dataclasses.replace(run, time=np.r_[0.0, 0.01, 1:11], actions=words)).axes[0]
    assert triangles(axes) == [0.0, 0.01]
    assert [text.get_text() for text in axes.texts] == ["engage L_bogie, lift LF"]


def test_an_index_far_above_its_limit_is_cut_and_said(run):
    spiked = {"height": np.full((12, 1), 0.5)}
    spiked["height"][3] = 25.0
    axes = rp.viz.plot_run(dataclasses.replace(run, indices=spiked)).axes[0]
    assert axes.get_ylim() == (0.0, 2.0)
    assert "cut at 2; highest 25" in [text.get_text() for text in axes.texts]


def test_one_sample_is_dots_and_an_empty_run_is_refused(run):
    first = {name: getattr(run, name)[:1] for name in ("time", "configuration", "rates", "actions", "lifted")}
    one = dataclasses.replace(run, **first, indices={}, loads={}, drift=None)
    figure = rp.viz.plot_run(one)
    assert len(figure.axes) == 2
    assert figure.axes[-1].lines[0].get_marker() == "o"
    with pytest.raises(rp.errors.InputError, match="run: has no sample; log at least where it started"):
        rp.viz.plot_run(dataclasses.replace(one, time=np.empty(0)))
