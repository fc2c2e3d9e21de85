"""Going straight to a stance by Newton lands where following the terrain in 80 small steps lands."""

import math

import numpy as np
import pytest

import rover_pin as rp
from rover_pin.statics.follow import follow, straight
from rover_pin.statics.level import on_level
from rover_pin.statics.stance import Status

STEPS = 80


def both_ways(rover, terrain, x, y, yaw):
    """The footing gone straight to (or None) and the one followed."""
    values = dict.fromkeys(rover.joints, 0.0) | dict(rover.home)
    problem, footing = on_level(rover, values, (), 9.81)
    problem = problem.moved(x, y, yaw)
    level = float(terrain.height(x, y))
    z = footing.z.copy()
    z[0] += level
    return straight(problem, footing, z, terrain), follow(problem, footing, z, terrain, level, steps=STEPS)


def cases(count, rms, seed):
    """Seeded robots, maps and places."""
    rng = np.random.default_rng(seed)
    rovers = [rp.load("rocker_bogie"), rp.load("hit_mrii")]
    for i in range(count):
        if i % 20 == 0:
            terrain = rp.Terrain.rough(int(rng.integers(10_000)), rms, float(rng.uniform(0.5, 1.0)))
        yield rovers[i % 2], terrain, *rng.uniform(-8, 8, 2), rng.uniform(-math.pi, math.pi)


def agree(count, rms, seed):
    """Compare; how many went straight."""
    went = 0
    for rover, terrain, x, y, yaw in cases(count, rms, seed):
        told = f"{rover.name} on {terrain.label} at {x!r}, {y!r}, {yaw!r}"
        short, long = both_ways(rover, terrain, x, y, yaw)
        if short is not None:
            went += 1
            assert long.status is Status.SETTLED, f"{told}: {long.reason}"
            np.testing.assert_allclose(short.z, long.z, rtol=0.0, atol=1e-7, err_msg=told)
        stance = rp.settle(rover, terrain, x=x, y=y, yaw=yaw)
        assert stance.settled == (long.status is Status.SETTLED) or stance.status is Status.GROUNDED, told
        if stance.settled:
            assert stance.position[2] == pytest.approx(long.z[0], abs=1e-7), told
            np.testing.assert_allclose(stance.rpy[1::-1], long.z[1:3], rtol=0.0, atol=1e-7, err_msg=told)
    return went


@pytest.mark.slow  # 200 stances, each followed in 80 steps
def test_straight_is_as_good_as_eighty_steps_on_moderate_ground():
    assert agree(200, 0.05, 0) > 180


@pytest.mark.slow  # 100 stances, each followed in 80 steps
def test_straight_is_as_good_as_eighty_steps_on_rough_ground():
    assert agree(100, 0.15, 1) > 50
