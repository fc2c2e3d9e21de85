"""bench: every method on the same places, its rows, its answers beside the plain path's, its peers."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from little_rover import fixture

from rover_pin import Terrain, load, settle
from rover_pin.analysis.benchmarks import Report, bench
from rover_pin.analysis.benchmarks.agreement import Agreement
from rover_pin.analysis.benchmarks.clock import Spent, least, spent
from rover_pin.analysis.benchmarks.growth import over_cases, over_nodes, over_wheels
from rover_pin.analysis.benchmarks.mujoco_model import cannot, mjcf, wheel_hull
from rover_pin.analysis.benchmarks.row import Row, rates
from rover_pin.analysis.benchmarks.scene import moderate, rough
from rover_pin.analysis.benchmarks.size import QUICK
from rover_pin.analysis.benchmarks.two_processes import together
from rover_pin.analysis.benchmarks.wheeled import wheeled_rover
from rover_pin.errors import InputError

SMALL = replace(
    QUICK, cases=300, turns=2, times=1, plain=6, alone=5, open_alone=3, resting=1, processes=(),
    grow_wheels=(4,), grow_nodes=(64,), grow_cases=(40,),
)  # fmt: skip
ALWAYS = {
    "work", "robot", "terrain", "ground", "method", "processes", "per_second", "per_cpu_second", "cases",
    "to_plain_path", "agreement",
}  # fmt: skip


@pytest.fixture(scope="module")
def bogie() -> Any:
    return load("rocker_bogie")


@pytest.fixture(scope="module")
def report(bogie: Any) -> Report:
    return bench([bogie], size=SMALL, quick=True)


def rows_of(report: Report, **wanted: object) -> list[Row]:
    return [row for row in report.rows if all(getattr(row, key) == value for key, value in wanted.items())]


def test_every_method_answers_every_work_on_both_grounds(report: Report) -> None:
    for terrain in ("moderate", "rough"):
        for method in ("compiled", "plain"):
            for work in ("settle", "row"):
                (row,) = rows_of(report, terrain=terrain, method=method, work=work)
                assert row.per_second is not None
                assert row.per_second > 0
                assert row.per_cpu_second is not None
                assert row.cases > 0
        (slowest,) = rows_of(report, terrain=terrain, work="slowest case")
        assert slowest.slowest_ms is not None
        assert 0 < slowest.slowest_ms < 1e4


def test_rows_have_the_keys_that_machines_read(report: Report) -> None:
    for row in report.rows:
        said = row.as_object()
        assert set(said) >= ALWAYS
        assert said["robot"] == "rocker_bogie"
    compiled = rows_of(report, method="compiled", work="row", terrain="moderate")[0].as_object()
    assert set(compiled["agreement"]) >= {"m", "rad", "N"}
    assert 0 <= compiled["to_plain_path"] <= 1
    assert compiled["ground"] == "rough:1,0.05,0.8"
    assert rows_of(report, terrain="rough")[0].ground == "rough:1,0.065,0.5"


def test_the_compiled_path_agrees_with_the_plain_one(report: Report) -> None:
    for row in rows_of(report, method="compiled"):
        if row.agreement is not None:
            assert row.compared
            assert row.other_status == 0
            assert row.agreement["m"] < 1e-8
            assert row.agreement["rad"] < 1e-8
            assert row.agreement["N"] < 1e-5


def test_mujoco_stands_where_the_plain_path_stands(report: Report) -> None:
    pytest.importorskip("mujoco")
    for row in rows_of(report, method="mujoco"):
        assert row.agreement is not None
        assert row.cases == 1
        assert row.agreement["m"] < 2e-3
        assert row.agreement["rad"] < math.radians(0.3)


def test_what_is_left_out_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[str] = []
    monkeypatch.setattr("rover_pin.analysis.benchmarks.run.mujoco_version", lambda: None)
    found = bench([], quick=True, progress=told.append)
    assert found.left_out == [
        "mujoco: it is not installed (pip install mujoco)",
        "growth with cases, wheels and maps, and memory: only without --quick",
    ]
    assert (found.rows, told) == ([], [])
    assert found.machine["numpy"] == np.__version__


def test_two_processes_share_no_work(bogie: Any) -> None:
    one, two = together(moderate(bogie, size=6.0), (1, 2), 50, 2)
    assert (one.processes, one.cases, two.processes, two.cases) == (1, 100, 2, 200)
    for row in (one, two):
        assert row.method == "compiled"
        assert row.per_second is not None
        assert row.per_cpu_second is not None


def test_growth_has_a_row_for_each_size() -> None:
    wheels, _ = over_wheels(SMALL, lambda _: None)
    nodes, _ = over_nodes(SMALL, lambda _: None)
    assert [row.wheels for row in wheels] == [4]
    assert [row.nodes for row in nodes] == [64]
    for row in (*wheels, *nodes):
        assert row.agreement is not None
        assert row.agreement["m"] < 1e-8


def test_a_study_says_its_memory() -> None:
    (row,), left_out = over_cases(SMALL, lambda _: None)
    assert (row.work, row.cases, left_out) == ("study", 40, [])
    assert row.peak_mb is not None
    assert 50 < row.peak_mb < 4000
    assert row.disk_mb is not None


@pytest.mark.parametrize("wheels", [4, 6, 8, 12])
def test_rovers_of_any_number_of_wheels_are_determinate(wheels: int, tmp_path: Path) -> None:
    """As many free coordinates as wheels; on level ground loads are symmetric and sum to the weight."""
    rover = wheeled_rover(wheels, tmp_path)
    assert 3 + len(rover.passive) - 1 == wheels == len(rover.wheels)
    stance = settle(rover, Terrain.flat())
    assert (str(stance.status), stance.redundant) == ("settled", 0)
    assert sum(stance.loads.values()) == pytest.approx(rover.mass * 9.81)
    left = [load for name, load in stance.loads.items() if name.startswith("top_l")]
    right = [load for name, load in stance.loads.items() if name.startswith("top_r")]
    assert left == pytest.approx(right)
    assert min(left) > 0.5 * rover.mass * 9.81 / wheels


def test_an_odd_number_of_wheels(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"wheels: must be an even number, at least 4 \(got 5\)"):
        wheeled_rover(5, tmp_path)


@pytest.mark.parametrize("robot", ["rocker_bogie", "hit_mrii"])
def test_the_peer_weighs_what_the_rover_weighs(robot: str) -> None:
    rover = load(robot)
    assert cannot(rover) == ""
    text = mjcf(rover, rover.home, (3, 3), (1.0, 1.0, 0.1, 0.5), np.zeros(3))
    masses = [float(e.get("mass", "nan")) for e in ET.fromstring(text).iter("inertial")]
    assert sum(masses) == pytest.approx(rover.mass, rel=1e-4)


def test_the_peers_wheel_lies_inside_the_swept_circle(bogie: Any) -> None:
    wheel = bogie.wheels[0]
    points = wheel_hull(wheel) - np.asarray(wheel.center)
    along = points @ np.asarray(wheel.axis)
    across = np.linalg.norm(points - np.outer(along, wheel.axis), axis=1)
    np.testing.assert_allclose(np.hypot(across - wheel.ring, along), wheel.tread, atol=1e-12)
    assert across.max() == pytest.approx(wheel.radius)


def test_what_the_peer_cannot_say() -> None:
    assert cannot(fixture("trailing4")) == "springs between frames"
    assert cannot(fixture("four_bar", "planar.yaml")) == "loops other than ball"
    assert cannot(fixture("four_bar")) == ""


def test_places_are_the_same_however_many_are_asked(bogie: Any) -> None:
    scene = rough(bogie)
    few, many = scene.places(5), scene.places(50)
    assert np.array_equal(few.x, many.first(5).x)
    assert np.array_equal(few.yaw, many.first(5).yaw)
    assert bool(np.all(scene.terrain.covers(many.x, many.y)))


def test_agreement_counts_missing_numbers_as_endless() -> None:
    found = Agreement()
    found.add("m", 1.0, 1.5)
    found.add("m", 1.0, 1.25)
    found.add("N", -math.inf, -math.inf)
    found.add("rad", math.nan, 0.0)
    assert dict(found.largest) == {"m": 0.5, "N": 0.0, "rad": math.inf}


def test_the_clock_takes_the_least() -> None:
    turns = iter([30_000, 10])
    result, time = least(lambda: sum(range(next(turns))), 2)
    with spent() as timer:
        sum(range(30_000))
    assert result == 45
    assert time.wall < timer.spent.wall
    assert rates(10, Spent(2.0, 4.0)) == {"cases": 10, "per_second": 5.0, "per_cpu_second": 2.5}
