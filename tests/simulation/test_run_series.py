"""Clearance of a run and spans of its words."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import rover_pin as rp
from rover_pin.simulation.run import Run
from rover_pin.simulation.series import Span, clearance, spans


def test_spans_cover_every_sample_once():
    assert spans("aabccca") == (Span("a", 0, 1), Span("b", 2, 2), Span("c", 3, 5), Span("a", 6, 6))
    assert spans(()) == ()
    assert spans(((), (), ("LF",))) == (Span((), 0, 1), Span(("LF",), 2, 2))


@pytest.fixture(scope="module")
def stances():
    rover, step = rp.load("hit_mrii"), rp.Terrain.step(0.1, 0.3)
    angles = np.radians([0.0, 20.0, 39.108])
    return [rp.settle(rover, step, x=x, joints={"L_act": u, "R_act": u})
            for x, u in ((-2.0, angles[0]), (-2.0, angles[2]), (0.0, angles[1]))]  # fmt: skip


def run_of(stances):
    q = np.array([stance.configuration for stance in stances])
    words = ("",) * len(q)
    return Run(stances[0].rover, stances[0].terrain, np.arange(len(q)) * 1.0, q, 0 * q, words, ((),) * len(q))


def test_clearance_is_the_papers_on_level_ground_and_the_measures_anywhere(stances):
    found = clearance(run_of(stances))
    np.testing.assert_allclose(found[:2], [0.250, 0.480], atol=5e-5)  # notes: u = 0 and 39.108 deg
    measured = [rp.stability(stance)["clearance"].value for stance in stances]
    np.testing.assert_allclose(found, measured, atol=1e-12)


def test_a_rover_without_belly_points_has_none(stances):
    run = run_of(stances)
    assert clearance(dataclasses.replace(run, rover=dataclasses.replace(run.rover, belly=()))) is None
