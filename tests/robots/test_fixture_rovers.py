"""The small rovers of tests/fixtures do what their heads say: numbers by hand."""

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import linprog

import rover_pin as rp

FIXTURES = Path(__file__).parents[1] / "fixtures"
FLAT = rp.Terrain.flat()


def load(name, sidecar="rover.yaml"):
    return rp.load(FIXTURES / name / f"{name}.urdf", sidecar=FIXTURES / name / sidecar)


def bumps(x, y):
    """Uneven ground without symmetry."""
    x, y = np.asarray(x), np.asarray(y)
    return 0.05 * np.sin(2.3 * x + 0.5) * np.cos(1.9 * y - 0.4) + 0.03 * x


def alike(one, other, tolerance=1e-8, newton=1e-5):
    """Same pose and loads."""
    assert one.settled, one.reason
    assert other.settled, other.reason
    np.testing.assert_allclose(one.position, other.position, atol=tolerance)
    np.testing.assert_allclose(one.rpy, other.rpy, atol=tolerance)
    for wheel, load_n in one.loads.items():
        assert other.loads[wheel] == pytest.approx(load_n, abs=newton)


def test_thirds():
    stance = rp.settle(load("thirds"), FLAT)
    third = 60 * 9.81 / 6
    for wheel, load_n in stance.loads.items():
        assert load_n == pytest.approx(third, rel=1e-5), wheel


@pytest.mark.parametrize("sidecar", ["planar.yaml", "coupling.yaml"])
@pytest.mark.parametrize("terrain", [rp.Terrain.slope(12), rp.Terrain.from_function(bumps)])
def test_four_bar_stands_alike_however_its_legs_are_said(sidecar, terrain):
    loops = rp.settle(load("four_bar"), terrain, x=0.3, y=0.2, yaw=0.8)
    alike(loops, rp.settle(load("four_bar", sidecar), terrain, x=0.3, y=0.2, yaw=0.8))


def test_four_bar_legs_are_parallelograms():
    stance = rp.settle(load("four_bar"), rp.Terrain.from_function(bumps), x=0.3, y=0.2, yaw=0.8)
    assert stance.settled, stance.reason
    assert abs(stance.joints["upper_l"]) > 0.01
    for side in "lr":
        assert stance.joints[f"lower_{side}"] == pytest.approx(stance.joints[f"upper_{side}"], abs=1e-8)
        assert stance.joints[f"knuckle_{side}"] == pytest.approx(-stance.joints[f"upper_{side}"], abs=1e-8)


@pytest.mark.parametrize(
    ("name", "sidecar", "rank", "redundancy", "mobility"),
    [
        ("four_bar", "rover.yaml", 5, 2, 5),
        ("four_bar", "planar.yaml", 5, 0, 5),
        ("four_bar", "coupling.yaml", 5, 0, 5),
        ("turnbuckle", "rover.yaml", 6, 0, 5),
        ("turnbuckle", "coupling.yaml", 1, 0, 10),
    ],
)
def test_rank_redundancy_and_mobility_of_loops(name, sidecar, rank, redundancy, mobility):
    """Joints less rank: four drives and one swing; the turnbuckle's twin keeps its held bar and rods."""
    info = load(name, sidecar).info()
    assert (info["rank"], info["redundancy"], info["mobility"]) == (rank, redundancy, mobility)


@pytest.mark.parametrize("yaw", [0.0, 0.8, math.pi / 2])
def test_turnbuckle_is_the_coupling_on_a_plane(yaw):
    terrain = rp.Terrain.slope(10)
    built = rp.settle(load("turnbuckle"), terrain, yaw=yaw)
    alike(built, rp.settle(load("turnbuckle", "coupling.yaml"), terrain, yaw=yaw), newton=1e-4)
    assert built.joints["bar"] == pytest.approx(0.0, abs=1e-8)


def test_turnbuckle_departs_from_the_coupling_as_its_geometry_says():
    """Bar angle to rocker angle: a rod of 0.3 m from the bar (lever 0.4) to the rocker (lever 0.3)."""
    stance = rp.settle(load("turnbuckle"), rp.Terrain.from_function(bumps), x=0.3, y=0.2, yaw=0.8)
    assert stance.settled, stance.reason
    bar = stance.joints["bar"]
    assert abs(bar) > 5e-3
    for side, sign in (("l", 1), ("r", -1)):
        rocker = stance.joints[f"rocker_{side}"]
        end = np.array([-0.3 - sign * 0.4 * math.sin(bar), sign * 0.4 * math.cos(bar), 0.3])
        top = np.array([0.3 * math.sin(rocker), sign * 0.4, 0.3 * math.cos(rocker)])
        assert np.linalg.norm(top - end) == pytest.approx(0.3, abs=1e-8)


def test_rigid_four_wheeler_shares_its_load_without_twist():
    """Least squares of four loads is the one affine in x and y: m g (1/4 + ...)."""
    rover = load("rigid4")
    stance = rp.settle(rover, FLAT)
    assert stance.redundant == 1
    weight = stance.weight
    cx, cy, _ = stance.com
    for wheel, load_n in stance.loads.items():
        x = 0.5 if wheel[0] == "f" else -0.5
        y = 0.4 if wheel[1] == "l" else -0.4
        expected = weight / 4 * (1 + cx * x / 0.25 + cy * y / 0.16)
        assert load_n == pytest.approx(expected, abs=1e-6)


def test_slides_sink_by_what_they_carry():
    stance = rp.settle(load("sprung4"), FLAT)
    sink = 40 * 9.81 / (4 * 4000)
    for joint, value in stance.joints.items():
        if joint.startswith("slide"):
            assert value == pytest.approx(sink, abs=1e-9)
    assert stance.position[2] == pytest.approx(0.1 + 0.15 - sink, abs=1e-9)
    for load_n in stance.loads.values():
        assert load_n == pytest.approx(50 * 9.81 / 4, abs=1e-6)


def test_trailing_arms_balance_their_springs():
    """Front arm about its joint: wheel's load and weights against preload - k q; masses 1 kg and 2 kg."""
    stance = rp.settle(load("trailing4"), FLAT)
    assert stance.settled, stance.reason
    pitch = stance.rpy[1]
    for side in "lr":
        turned = stance.joints[f"arm_f{side}"]
        angle = turned + pitch
        reach = 0.3 * math.cos(angle) + 0.15 * math.sin(angle)
        moment = stance.loads[f"f{side}"] * reach - 9.81 * (2 * reach + 1 * reach / 2)
        assert moment == pytest.approx(30 + 120 * turned, abs=1e-6)


def test_caster_keeps_its_angle_on_the_level():
    stance = rp.settle(load("caster3"), FLAT, posture={"fork": 0.4})
    assert stance.settled, stance.reason
    assert stance.undetermined == ("fork",)
    assert stance.joints["fork"] == pytest.approx(0.4)


def test_caster_rests_with_its_wheel_uphill():
    """The slope rises along +x; facing down it the wheel behind the fork's axis is uphill."""
    stance = rp.settle(load("caster3"), rp.Terrain.slope(8), yaw=math.pi)
    assert stance.settled, stance.reason
    assert stance.undetermined == ()
    assert stance.joints["fork"] == pytest.approx(0.0, abs=1e-8)
    other = rp.settle(load("caster3"), rp.Terrain.slope(8), yaw=0.0)
    assert not other.settled
    assert other.limiting == "fork"


@pytest.mark.parametrize(
    ("slope", "by_body", "by_bogies"),
    [(6.0, True, True), (7.5, True, False), (14.0, True, False), (21.0, True, False)],
)
def test_bogies_forbid_what_the_body_allows(slope, by_body, by_bogies):
    """Free front wheel, friction 0.8: limits 26.57 deg by the body's rows, 6.58 deg with the bogies'."""
    from rover_pin.statics.balance import balance

    stance = rp.settle(load("bogie_min"), rp.Terrain.slope(slope))
    assert stance.settled, stance.reason
    rows = balance(stance)
    body = [k for k, name in enumerate(rows.rows) if name.startswith("base")]
    assert len(body) == 6
    assert feasible(stance, rows, body) is by_body
    assert feasible(stance, rows, range(len(rows.rows))) is by_bogies


def feasible(stance, rows, kept):
    """Whether forces in the slope's plane of symmetry balance the kept rows: a linear program.

    Per contact a normal and a rolling force, |rolling| <= friction * normal, none where the wheel is free.
    """
    kept = list(kept)
    columns, bounds, cones = [], [], []
    count = len(stance.contacts)
    for k, contact in enumerate(stance.contacts):
        block = rows.contact[kept, 3 * k : 3 * k + 3]
        columns += [block @ contact.normal, block @ contact.rolling]
        grip = 0.0 if contact.free else contact.friction
        bounds += [(0, None), (None, None)]
        for sign in (1, -1):
            cone = np.zeros(2 * count)
            cone[2 * k], cone[2 * k + 1] = -grip, sign
            cones.append(cone)
    matrix = (
        np.column_stack([*columns, *rows.internal[kept].T])
        if rows.internal.size
        else np.column_stack(columns)
    )
    extra = matrix.shape[1] - 2 * count
    bounds += [(low, None) if np.isfinite(low) else (None, None) for low in rows.internal_lower]
    scale = stance.weight
    answer = linprog(
        np.zeros(matrix.shape[1]),
        A_ub=np.hstack([np.array(cones), np.zeros((len(cones), extra))]),
        b_ub=np.zeros(len(cones)),
        A_eq=matrix,
        b_eq=rows.gravity[kept] / scale,
        bounds=bounds,
    )
    return bool(answer.status == 0)
