"""settle on plateaus of random heights against a minimum of energy by SLSQP, springs included."""

from pathlib import Path

import numpy as np
import pytest
import yaml
from energy import energy_minimum
from tree_walk import machine

import rover_pin as rp

FIXTURES = Path(__file__).parents[1] / "fixtures"
PITCH = 0.025


def plateaus(rng, places, spread):
    """A bilinear map that is level around every place (x, y) of a wheel; heights by name."""
    heights = {name: float(rng.uniform(-spread, spread)) for name in places}
    nodes = np.arange(-2.0, 2.0 + PITCH / 2, PITCH)
    x, y = np.meshgrid(nodes, nodes)
    away = np.array([np.hypot(x - px, y - py) for px, py in places.values()])
    z = np.array(list(heights.values()))[np.argmin(away, axis=0)]
    return rp.Terrain.from_grid(z, PITCH, (-2.0, -2.0), "linear"), heights


def wheel_places(rover, joints):
    """x, y of every wheel on level ground."""
    stance = rp.settle(rover, rp.Terrain.flat(), joints=joints)
    assert stance.settled
    return {contact.wheel: contact.point[:2] for contact in stance.contacts}


def compare(rover, rng, spread, joints=None):
    """One stance both ways; False where it does not settle or leaves its plateaus."""
    terrain, heights = plateaus(rng, wheel_places(rover, joints), spread)
    stance = rp.settle(rover, terrain, joints=joints)
    if not stance.settled or any(contact.normal[2] < 1.0 - 1e-12 for contact in stance.contacts):
        return False
    least = energy_minimum(machine(rover), heights, (0.0, 0.0, 0.0), {**rover.home, **(joints or {})})
    base = {"base_z": stance.position[2], "base_pitch": stance.rpy[1], "base_roll": stance.rpy[0]}
    ours = {**stance.joints, **base}
    for name, value in least.items():
        assert ours[name] == pytest.approx(value, abs=1e-6), name
    return True


def with_springs(tmp_path, rng):
    """rocker_bogie with springs on every passive joint, as one would write them by hand."""
    rover = rp.load("rocker_bogie")
    sidecar = yaml.safe_load(rover.sidecar_path.read_text())
    sidecar.pop("parameters")
    sidecar["springs"] = [
        {
            "name": f"spring_{joint}",
            "joint": joint,
            "stiffness": float(rng.uniform(20, 400)),
            "rest": float(rng.uniform(-0.2, 0.2)),
            "preload": float(rng.uniform(-20, 20)),
        }
        for joint in ("rocker_l", "bogie_l", "bogie_r")
    ]
    (tmp_path / "plain.urdf").write_text(rover.urdf)
    (tmp_path / "rover.yaml").write_text(yaml.safe_dump(sidecar))
    return rp.load(tmp_path / "plain.urdf")


def enough(attempt, wanted):
    """Repeat until that many stances were compared."""
    compared = sum(attempt() for _ in range(wanted))
    for _ in range(wanted):
        if compared == wanted:
            break
        compared += attempt()
    assert compared == wanted


def test_fifteen_stances_without_springs():
    rng = np.random.default_rng(0)
    rover = rp.load("rocker_bogie")
    enough(lambda: compare(rover, rng, 0.06), 15)


def test_fifteen_stances_of_a_rocker_bogie_with_springs(tmp_path):
    """A wheel may hang from its spring; stiffness, rest and preload differ from joint to joint."""
    rng = np.random.default_rng(1)
    rovers = []
    for i in range(3):
        (tmp_path / str(i)).mkdir()
        rovers.append(with_springs(tmp_path / str(i), rng))
    enough(lambda: compare(rovers[int(rng.integers(3))], rng, 0.06), 15)


def test_ten_stances_of_four_sprung_wheels():
    rng = np.random.default_rng(2)
    rover = rp.load(FIXTURES / "sprung4" / "sprung4.urdf")
    enough(lambda: compare(rover, rng, 0.06), 10)


def test_ten_stances_of_trailing_arms():
    """Torsion springs in front, struts between frames behind."""
    rng = np.random.default_rng(3)
    rover = rp.load(FIXTURES / "trailing4" / "trailing4.urdf")
    enough(lambda: compare(rover, rng, 0.02), 10)


def test_raised_and_steered_hit_mrii():
    rng = np.random.default_rng(4)
    rover = rp.load("hit_mrii")
    joints = {"L_act": 0.2, "R_act": 0.2, "LF_st": 0.3, "RB_st": -0.2}
    enough(lambda: compare(rover, rng, 0.05, joints), 5)
