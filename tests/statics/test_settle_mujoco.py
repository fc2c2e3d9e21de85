"""settle against the same robots dropped in MuJoCo on the same surface, where they come to rest."""

import math
from pathlib import Path

import numpy as np
import pytest
from tree_walk import machine

import rover_pin as rp

mujoco = pytest.importorskip("mujoco")
oracle = pytest.importorskip("mujoco_rest")

FIXTURES = Path(__file__).parents[1] / "fixtures"
HEIGHT_M, TILT_DEG = 5e-3, 0.5


def upward(rpy):
    """The base's z axis in the world."""
    (a, b, c), (d, e, f) = np.cos(rpy), np.sin(rpy)
    return np.array([c * e * a + f * d, f * e * a - c * d, b * a])


def drop(rover, terrain, place):
    """Height difference [m] and tilt between the two [deg], or None where MuJoCo did not come to rest."""
    rest = oracle.come_to_rest(machine(rover), rover.urdf, terrain, place, rover.home)
    if not rest.resting:
        return None
    stance = rp.settle(rover, terrain, x=rest.position[0], y=rest.position[1], yaw=rest.yaw)
    assert stance.settled
    apart = min(1.0, float(upward(stance.rpy) @ rest.rotation[:, 2]))
    return rest.position[2] - stance.position[2], math.degrees(math.acos(apart))


@pytest.mark.slow  # ten drops of a robot, each a thousand time steps
@pytest.mark.parametrize("robot", ["rocker_bogie", "hit_mrii"])
def test_twenty_stances(robot):
    rover = rp.load(robot)
    rng = np.random.default_rng(len(robot))
    found, restless = [], 0
    while len(found) < 10:
        rms = rng.uniform(0.03, 0.15)
        terrain = rp.Terrain.rough(int(rng.integers(1000)), rms, 0.8)
        got = drop(rover, terrain, (*rng.uniform(-7, 7, 2), rng.uniform(-math.pi, math.pi)))
        if got is None:
            restless += 1
            assert restless <= 10
        else:
            found.append(got)
    heights, tilts = np.array(found).T
    told = f"{restless} did not come to rest; heights {heights}, tilts {tilts}"
    assert np.max(np.abs(heights)) < HEIGHT_M, told
    assert np.max(tilts) < TILT_DEG, told


@pytest.mark.parametrize("fixture", ["sprung4", "four_bar"])
def test_springs_and_loops(fixture):
    rover = rp.load(FIXTURES / fixture / f"{fixture}.urdf")
    got = drop(rover, rp.Terrain.rough(3, 0.05, 0.9), (0.3, -0.2, 0.5))
    assert got is not None
    assert abs(got[0]) < HEIGHT_M
    assert got[1] < TILT_DEG


def test_the_height_field_lies_where_the_surface_lies():
    """Rays from above meet MuJoCo's ground within a millimetre of ours: rows along +y, not flipped."""
    terrain = rp.Terrain.rough(4, 0.2, 0.7)
    rover = rp.load("rocker_bogie")
    place = (1.0, -2.0, 0.0)
    heights, low = oracle.sampled(terrain, place, 3.0)
    rise = float(np.ptp(heights))
    text = oracle.mjcf(machine(rover), rover.urdf, {}, len(heights), 3.0, rise, (*place[:2], low))
    model = mujoco.MjModel.from_xml_string(text)
    model.hfield_data[:] = ((heights - low) / rise).ravel()
    data = mujoco.MjData(model)
    data.qpos[:3] = 50.0
    mujoco.mj_forward(model, data)
    for dx, dy in np.random.default_rng(0).uniform(-1.4, 1.4, (20, 2)):
        start = np.array([place[0] + dx, place[1] + dy, 5.0])
        down = mujoco.mj_ray(
            model, data, start, np.array([0.0, 0.0, -1.0]), None, 1, -1, np.zeros(1, np.int32)
        )
        assert 5.0 - down == pytest.approx(float(terrain.height(*start[:2])), abs=1e-3)


def test_mass_is_the_same():
    rover = rp.load("hit_mrii")
    text = oracle.mjcf(machine(rover), rover.urdf, {}, 11, 1.0, 0.1, (0.0, 0.0, 0.0))
    model = mujoco.MjModel.from_xml_string(text)
    assert float(np.sum(model.body_mass)) == pytest.approx(rover.mass, rel=1e-9)
