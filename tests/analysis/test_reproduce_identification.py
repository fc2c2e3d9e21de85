"""Polibot's geometry from the paper's tables: the planar model, derivatives, fits, how far they reach."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import rover_pin as rp
from rover_pin.analysis.papers import polibot_identification as identification
from rover_pin.analysis.papers.polibot import certainty, search, targets
from rover_pin.analysis.papers.polibot.ground import on_obstacle
from rover_pin.analysis.papers.polibot.planar import LENGTHS, STATE, arcs, belt, solve
from rover_pin.analysis.papers.polibot.reading import read

ALL = len(targets.TARGETS)
ARRIVES = 11
"""Index of a start of seed 1 from which the search arrives."""


@pytest.fixture(scope="module")
def half() -> rp.Rover:
    return rp.load("polibot_half")


@pytest.fixture(scope="module")
def bundled() -> np.ndarray:
    return identification.bundled_lengths()


@pytest.fixture(scope="module")
def fit() -> search.Fit:
    return search.search(search.starts(ARRIVES + 1, 1)[ARRIVES])


def shaken(bundled: np.ndarray, seed: int) -> np.ndarray:
    """Lengths by up to 1 mm or deg elsewhere, none below 0; wheels as they are."""
    moved = bundled + np.random.default_rng(seed).uniform(-1.0, 1.0, len(bundled))
    moved[-6:] = bundled[-6:]
    return np.maximum(moved, 0.0)


@pytest.mark.parametrize("seed", [None, 0, 1, 2])
def test_the_planar_model_is_settle(half: rp.Rover, bundled: np.ndarray, seed: int | None) -> None:
    lengths = bundled if seed is None else shaken(bundled, seed)
    rover = half.with_parameters(**identification.as_parameters(lengths))
    rest = rp.settle(rover, rp.Terrain.flat())
    heavy = rover.with_parameters(mass=targets.inputs().mass[targets.PAYLOADED])
    stances = {
        targets.BASELINE: rest,
        targets.PAYLOADED: rp.settle(heavy, rp.Terrain.flat()),
        targets.FRONT: on_obstacle(rover, "w3", 0.055, rest),
        targets.REAR: on_obstacle(rover, "w6", 0.055, rest),
    }
    found = solve(lengths, targets.inputs(), targets.first_guess())
    for case, stance in stances.items():
        assert found.good[case]
        assert stance.settled
        if min(found.state[7:11, case]) < 0.0:
            continue  # the planar model keeps its wheels down
        seen = read(stance)
        state = dict(zip(STATE, found.state[:, case], strict=True))
        pose = np.array([seen.x_a, seen.z_a, *np.radians([seen.theta, *seen.arms])])
        assert found.state[:7, case] == pytest.approx(pose, abs=1e-6)
        assert found.state[7:11, case] == pytest.approx(list(seen.loads.values()), abs=1e-4)
        assert state["T"] == pytest.approx(seen.tension, abs=1e-3)
        springs = [seen.springs[name] for name in ("s1", "s2", "s3")]
        assert found.state[12:, case] == pytest.approx(springs, abs=1e-3)


def test_derivatives_are_finite_differences(bundled: np.ndarray) -> None:
    cases = targets.inputs()
    found = solve(bundled, cases, targets.first_guess())
    assert bool(np.all(found.good))
    step = 1e-4
    for k in range(len(LENGTHS)):
        ends = []
        for sign in (1.0, -1.0):
            moved = bundled.copy()
            moved[k] += sign * step
            ends.append(solve(moved, cases, found.state).state)
        slope = (ends[0] - ends[1]) / (2.0 * step)
        assert found.by_length[:, k] == pytest.approx(slope, rel=1e-5, abs=1e-5 * np.max(np.abs(slope)))


def test_misses_and_their_derivatives(bundled: np.ndarray) -> None:
    here = search.evaluated(bundled)
    step = 1e-4
    for k in (0, 8, 17, 23):
        ends = []
        for sign in (1.0, -1.0):
            moved = bundled.copy()
            moved[k] += sign * step
            ends.append(search.evaluated(moved, guess=here.state).misses)
        assert here.slopes[:, k] == pytest.approx((ends[0] - ends[1]) / (2.0 * step), rel=1e-4, abs=1e-3)


def test_a_belt_of_equal_circles() -> None:
    corners = [np.array(c, dtype=float) for c in ((0.0, 0.0), (100.0, 0.0), (100.0, 50.0), (0.0, 50.0))]
    length, pulls, turns = belt(corners, [10.0] * 4)
    assert length == pytest.approx(2.0 * np.pi * 10.0 + 300.0, rel=1e-14)
    assert np.sum(pulls, axis=0) == pytest.approx(np.zeros(2), abs=1e-14)
    assert turns == pytest.approx([np.pi / 2.0] * 4)


def test_the_tables_values_are_recovered_from_far(fit: search.Fit, bundled: np.ndarray) -> None:
    assert np.max(np.abs(fit.start - fit.lengths)) > 50.0  # mm: it began far from where it ended
    assert fit.within
    pose = fit.state[:7, targets.BASELINE]
    assert pose[:2] == pytest.approx(targets.TABLE_6_STATE[:2], abs=0.05)
    assert np.degrees(pose[2:]) == pytest.approx(targets.TABLE_6_STATE[2:], abs=0.05)
    assert np.degrees(pose[2]) == pytest.approx(4.41, abs=0.005)
    for target, missed in zip(targets.TARGETS, fit.misses, strict=True):
        assert abs(missed) <= 1.0, target.name
    assert np.all(fit.lengths >= search.LOWER)
    assert np.all(fit.lengths <= search.UPPER)
    assert np.all(arcs(fit.lengths, fit.state, targets.inputs()) > -search.SLIGHT)


def test_the_geometry_is_not_unique(fit: search.Fit, bundled: np.ndarray) -> None:
    there = search.evaluated(bundled)
    assert there.good
    assert search.worst(there, ALL) < 4.0
    assert np.max(np.abs(fit.lengths - bundled)) > 20.0


def test_a_length_goes_as_far_as_the_targets_are_met(fit: search.Fit) -> None:
    k = LENGTHS.index("d6")
    low, high = certainty.interval(fit, k)
    for end in (low, high):
        assert end.within
        again = search.evaluated(end.lengths)  # solved from Table 6 on, not from its neighbour
        assert again.misses == pytest.approx(end.misses, abs=1e-3)
    assert low.lengths[k] + 1.0 < fit.lengths[k] < high.lengths[k] - 1.0


def test_directions_that_nothing_fixes(bundled: np.ndarray) -> None:
    there = search.evaluated(bundled)
    found = certainty.directions(there, targets.TABLES)
    count = len(search.FREE)
    assert found.rank == targets.TABLES
    assert found.vectors.shape == (count, count)
    for row in found.vectors[found.rank :]:
        step = np.zeros(len(LENGTHS))
        step[search.FREE] = row
        assert there.slopes[: targets.TABLES] @ step == pytest.approx(np.zeros(targets.TABLES), abs=1e-6)
    assert certainty.directions(there).rank > found.rank


def test_a_geometry_without_a_stance_is_told(bundled: np.ndarray) -> None:
    lengths = bundled.copy()
    lengths[LENGTHS.index("d9")] = 20.0  # the rear wheel cannot reach the ground
    there = search.evaluated(lengths)
    assert not there.good
    assert not there.within


def test_the_report_compares_with_the_bundled_geometry(fit: search.Fit, bundled: np.ndarray) -> None:
    there = search.evaluated(bundled)
    found = identification.Identification(
        1, (fit,), there, fit, certainty.directions(there, targets.TABLES), certainty.directions(there),
        {"d7": (98.0, 104.0)},
    )  # fmt: skip
    text = identification.report(found)
    assert "1 starts, 1 geometries that meet all 21 targets" in text
    assert "98.00 to 104.00" in text
    assert "fixed to better than 1 mm (or deg)" in text
    assert "-0.00" not in identification.report(replace(found, fits=()))


def test_starts_are_seeded() -> None:
    assert np.array_equal(search.starts(3, 7), search.starts(3, 7))
    assert not np.array_equal(search.starts(3, 7), search.starts(3, 8))


def test_the_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert identification.main(["--starts", "1", "--no-intervals"]) == 0
    told = capsys.readouterr()
    assert "start 1 of 1" in told.err
    assert "1 starts, 0 geometries" in told.out
    with pytest.raises(SystemExit):
        identification.main(["--starts", "0"])
    assert "--starts must be at least 1" in capsys.readouterr().err
