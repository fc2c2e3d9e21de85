"""Motion constraints of another rover: two wheels a side, a driven rear arm, no gear, no clutch, no bogie."""

import math

import numpy as np
import pytest
from sides import slope

import rover_pin as rp
from rover_pin.control.layout import Layout, Side
from rover_pin.control.motion_constraints import Options, motion_constraints
from rover_pin.control.now import Now
from rover_pin.kinematics.instant import Bodies

ROUGH = rp.Terrain.rough(seed=8, rms=0.02, hurst=0.8, size=8.0, spacing=0.1)
SIDES = Layout(Side("left", ("LF", "LB"), "L_h", "L_r"), Side("right", ("RF", "RB"), "R_h", "R_r"))


@pytest.fixture
def rover(make):
    """Per side an arm on a shaft, its wheel 0.5 m ahead and 0.2 m down, and its mirror image."""
    parts = [make.link("base", 20.0)]
    for s, y in (("L", 0.4), ("R", -0.4)):
        parts += [
            make.joint(f"{s}_h", "base", f"{s}_arm", xyz=f"0 {y} 0"),
            make.link(f"{s}_arm", 2.0),
            make.joint(f"{s}_r", f"{s}_arm", f"{s}_rear"),
            make.link(f"{s}_rear", 2.0),
            make.joint(f"{s}F_dr", f"{s}_arm", f"{s}F", "continuous", xyz="0.5 0 -0.2"),
            make.link(f"{s}F", 1.0),
            make.joint(f"{s}B_dr", f"{s}_rear", f"{s}B", "continuous", xyz="-0.5 0 -0.2"),
            make.link(f"{s}B", 1.0),
        ]
    wheels = "\n".join(
        f"  - {{name: {w}, frame: {w}, radius: 0.1, width: 0.05}}" for w in ("LF", "LB", "RF", "RB")
    )
    drives = ", ".join(f"{w}_dr" for w in ("LF", "LB", "RF", "RB"))
    coupled = "couplings:\n  - {name: differential, joints: {L_h: 1, R_h: 1}}"
    return make.load(*parts, sidecar=f"actuated: [L_r, R_r, {drives}]\n{coupled}\nwheels:\n{wheels}\n")


@pytest.fixture
def constraints(rover):
    return motion_constraints(rover, SIDES, options=Options(speed_floor=0.01))


def test_rear_arms_folded(rover, constraints):
    """Rear arms turned by u, bodies as they are: 0.5 cos u + 0.2 sin u from hinge back to wheel."""
    still = np.zeros(rover.model.nv)
    q = rover.configuration({"L_r": 0.4, "R_r": -0.3})
    now = Now(Bodies(rover, rp.Terrain.flat()).at(q), still, still)
    behind = [0.5 * math.cos(u) + 0.2 * math.sin(u) for u in (0.4, -0.3)]
    np.testing.assert_allclose(constraints["wheelbase"].value(now), [0.5 - b for b in behind], atol=1e-12)
    np.testing.assert_allclose(constraints["length"].value(now), (behind[0] - behind[1]) / 0.8, atol=1e-12)


@pytest.mark.parametrize("name", ["wheelbase", "height", "length"])
def test_gradients(rover, constraints, name):
    q = np.random.default_rng(2).uniform(-0.4, 0.4, rover.model.nv)
    bodies, still = Bodies(rover, ROUGH), np.zeros(rover.model.nv)
    constraint = constraints[name]
    wanted = slope(lambda p: constraint.value(Now(bodies.at(p), still, still)), q)
    np.testing.assert_allclose(constraint.gradient(Now(bodies.at(q), still, still)), wanted, atol=1e-6)


def test_rocker_speed_by_statics(rover, constraints):
    """How the distance of the wheels follows a rear arm, from stances on uneven ground."""
    bodies, still = Bodies(rover, ROUGH), np.zeros(rover.model.nv)
    stations = constraints["rocker_speed"].stations

    def stand(left, right):
        stance = rp.settle(rover, ROUGH, x=0.2, y=0.1, yaw=0.5, joints={"L_r": left, "R_r": right})
        assert stance.settled
        return bodies.at(stance.configuration)

    def apart(*rockers):
        return stations.at(stand(*rockers)).apart

    step = 1e-5
    left = (apart(0.3 + step, 0.1) - apart(0.3 - step, 0.1))[0] / (2 * step)
    right = (apart(0.3, 0.1 + step) - apart(0.3, 0.1 - step))[1] / (2 * step)
    rates = still.copy()
    rates[[rover.column["L_r"], rover.column["R_r"]]] = 1.0
    value = constraints["rocker_speed"].value(Now(stand(0.3, 0.1), rates, still))
    np.testing.assert_allclose(value, np.abs([left, right]) / 0.01, rtol=1e-4)
