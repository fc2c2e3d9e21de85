"""settle against an independent complementarity solve: other kinematics, contact search and solver."""

import math
from pathlib import Path

import numpy as np
import pytest
from complementarity import Oracle
from tree_walk import machine

import rover_pin as rp

ROBOTS = ("rocker_bogie", "hit_mrii")
# rms [m], Hurst exponent, spacing [m]
MAPS = ((0.05, 0.8, 0.05), (0.1, 0.8, 0.05), (0.15, 0.5, 0.05), (0.2, 0.7, 0.1), (0.25, 0.8, 0.05))
PLACES = 5
FIXTURES = Path(__file__).parents[1] / "fixtures"
POSITION_M, ANGLE_RAD, LOAD_N = 1e-6, 1e-6, 1e-4


def compare(stance, rest):
    """Differences that are too large; lengths and angles share a number."""
    base = {"base_z": stance.position[2], "base_pitch": stance.rpy[1], "base_roll": stance.rpy[0]}
    ours = {**stance.joints, **base}
    assert rest.residual < 1e-10
    for name, value in rest.q.items():
        assert ours[name] == pytest.approx(value, abs=min(POSITION_M, ANGLE_RAD)), name
    for wheel, load in rest.loads.items():
        assert stance.loads[wheel] == pytest.approx(load, abs=LOAD_N), wheel
        assert stance.gaps[wheel] == pytest.approx(rest.gaps[wheel], abs=POSITION_M), wheel
    assert min(rest.gaps.values()) > -POSITION_M


@pytest.mark.slow  # an oracle solve takes half a second: scipy, and whole footprints looked at in numpy
@pytest.mark.parametrize(("rms", "hurst", "spacing"), MAPS)
@pytest.mark.parametrize("robot", ROBOTS)
def test_fifty_stances_on_rough_maps(robot, rms, hurst, spacing):
    rover = rp.load(robot)
    read = machine(rover)
    rng = np.random.default_rng([ROBOTS.index(robot), round(1000 * rms)])
    compared = 0
    for _ in range(3 * PLACES):
        terrain = rp.Terrain.rough(int(rng.integers(1000)), rms, hurst, spacing=spacing)
        x, y, yaw = *rng.uniform(-7, 7, 2), rng.uniform(-math.pi, math.pi)
        stance = rp.settle(rover, terrain, x=x, y=y, yaw=yaw)
        if not stance.settled:
            continue
        compare(stance, Oracle(read, terrain, (x, y, yaw), stance.rover.home).settle())
        compared += 1
        if compared == PLACES:
            break
    assert compared == PLACES


def swells():
    """A map of smooth swells and a slant."""
    x, y = np.meshgrid(np.arange(-4.0, 4.01, 0.05), np.arange(-4.0, 4.01, 0.05))
    return rp.Terrain.from_grid(0.05 * np.sin(1.3 * x + 0.4) * np.cos(1.7 * y) + 0.03 * x, 0.05, (-4.0, -4.0))


@pytest.mark.parametrize(
    "fixture", ["bogie_min", "four_bar", "rigid4", "sprung4", "thirds", "trailing4", "turnbuckle"]
)
def test_small_rovers_with_loops_springs_and_spare_freedoms(fixture):
    """Loops' multipliers, springs on joints and between frames, lifted wheels."""
    rover = rp.load(FIXTURES / fixture / f"{fixture}.urdf")
    terrain = swells()
    settled = 0
    for x, y, yaw in ((0.1, 0.2, 0.3), (1.1, -0.7, 2.0), (-2.0, 0.4, -1.0)):
        stance = rp.settle(rover, terrain, x=x, y=y, yaw=yaw)
        if stance.settled:
            settled += 1
            compare(stance, Oracle(machine(rover), terrain, (x, y, yaw), rover.home).settle())
    assert settled


@pytest.mark.parametrize(("x", "y", "yaw"), [(1.1, -0.7, 2.0), (-2.0, 0.4, -1.0), (0.7, 0.9, 0.1)])
def test_a_caster_solves_the_same_equations(x, y, yaw):
    """Its fork has several equilibria, of which the oracle knows no steady one: it starts from settle's."""
    rover = rp.load(FIXTURES / "caster3" / "caster3.urdf")
    stance = rp.settle(rover, swells(), x=x, y=y, yaw=yaw)
    assert stance.settled
    base = {"base_z": stance.position[2], "base_pitch": stance.rpy[1], "base_roll": stance.rpy[0]}
    compare(stance, Oracle(machine(rover), swells(), (x, y, yaw)).settle(start={**stance.joints, **base}))


def test_turned_joints_and_locks():
    """Steered wheels, a raised posture, a clutch engaged."""
    rover = rp.load("hit_mrii")
    terrain = rp.Terrain.rough(5, 0.1, 0.7)
    joints = {"LF_st": 0.4, "RF_st": 0.3, "LB_st": -0.5, "L_act": 0.3, "R_act": 0.1, "L_bogie": 0.1}
    stance = rp.settle(rover, terrain, x=0.5, y=-0.4, yaw=0.7, joints=joints)
    assert stance.settled
    held = ("L_bogie",)
    compare(stance, Oracle(machine(rover), terrain, (0.5, -0.4, 0.7), joints, held).settle())


def test_weaker_gravity():
    rover = rp.load("rocker_bogie")
    terrain = rp.Terrain.rough(2, 0.1, 0.7)
    stance = rp.settle(rover, terrain, x=1.0, y=2.0, yaw=-0.4, gravity=3.71)
    compare(stance, Oracle(machine(rover), terrain, (1.0, 2.0, -0.4), rover.home, gravity=3.71).settle())
