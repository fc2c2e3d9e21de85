"""The kinematic model both ways, against closed forms of a rover with driven rockers."""

import math

import numpy as np
import pytest
from hit_mrii_closed_form import Machine
from places import ground, resting, rover

import rover_pin as rp
from rover_pin.errors import InputError, MechanismError
from rover_pin.kinematics.instant import Bodies
from rover_pin.kinematics.model import complete, forward, structure
from rover_pin.kinematics.rolling import ground_rows, rim_rows
from rover_pin.kinematics.wheelbase import wheelbase, wheelbase_row

WHEELS = ("LF", "LM", "LB", "RF", "RM", "RB")
STILL = dict.fromkeys([*(f"{w}_st" for w in WHEELS), *(f"{w}_dr" for w in WHEELS if w[1] != "F")], 0.0)
MACHINE = Machine()


def raised(clearance):
    stance = rp.settle(rover("hit_mrii"), ground("flat"), posture={"clearance": clearance})
    return Bodies(rover("hit_mrii"), ground("flat")).at(np.array(stance.configuration))


@pytest.mark.parametrize("clearance", [0.15, 0.25, 0.33, 0.4, 0.48, 0.55])
def test_reshaping_closed_form(clearance):
    """dh/dt = (1 + z) du/dt / (1/F' + 1/R'), d(d_fm)/dt = -dh/dt [(F sin a + P cos a)/F' + tan b]."""
    at = raised(clearance)
    u = float(at.q[at.rover.column["L_act"]])
    a, b, p = MACHINE.angles(u)
    arm, rear, pillar = MACHINE.front_arm, MACHINE.rear_arm, MACHINE.pillar
    ahead, behind = arm * math.cos(a) - pillar * math.sin(a), rear * math.cos(b)
    rise = 0.0036
    shrink = -rise * ((arm * math.sin(a) + pillar * math.cos(a)) / ahead + math.tan(b))
    motion = complete(at, {**STILL, "up": rise})
    v = motion.velocity
    assert motion.sliding < 1e-12
    assert motion.undetermined == ()
    assert v[at.rover.column["L_act"]] == pytest.approx(
        rise * (1 / ahead + 1 / behind) / (1 + MACHINE.gear), rel=1e-9
    )
    assert wheelbase_row(at, "LF", "LM") @ v == pytest.approx(shrink, rel=1e-9)
    assert wheelbase(at, "LF", "LM") == pytest.approx(ahead + behind - 0.3875, abs=1e-9)
    assert float(at.q[4]) == pytest.approx(p, abs=1e-9)


def test_front_wheels_over_the_ground_at_480_mm():
    at = raised(0.48)
    motion = complete(at, {**STILL, "clearance": 0.0036})
    for wheel in ("LF", "RF"):
        place = at.index([wheel])
        speed = 1e3 * float(ground_rows(at, place)[0] @ motion.velocity)
        assert speed == pytest.approx(-6.677, rel=0.005)
        turning = motion.velocity[[at.rover.column[f"{wheel[0]}_fr"], at.rover.column["base_pitch"]]].sum()
        turning += motion.velocity[at.rover.column[f"{wheel[0]}_diff"]]
        rim = 1e3 * float(rim_rows(at, place)[0] @ motion.velocity)
        assert rim == pytest.approx(speed - 1e3 * 0.15 * turning, abs=1e-6)  # the carrier turns with the arm


@pytest.mark.parametrize("word", ["flat", "slope:8", "rough:3,0.04,0.8"])
@pytest.mark.parametrize("name", ["hit_mrii", "rocker_bogie"])
def test_forward_undoes_inverse(name, word):
    at = resting(name, word)
    known = dict.fromkeys([n for n in at.rover.actuated if not n.endswith(("dr", "drive")) and n not in
                           {w.drive for w in at.rover.wheels}], 0.0)  # fmt: skip
    there = complete(at, {**known, "forward": 0.03})
    back = forward(at, {n: float(there.velocity[at.rover.column[n]]) for n in at.rover.actuated})
    assert back.undetermined == ()
    assert back.velocity == pytest.approx(there.velocity, abs=1e-9 if there.sliding < 1e-9 else 2e-2)


def test_rates_that_do_not_agree_slide():
    at = resting("hit_mrii", "flat")
    found = forward(at, {"LF_dr": 0.1})  # one wheel against five that are braked
    assert found.sliding > 1e-3
    assert found.where.split(" of ")[0] in ("rolling", "side slip")


def test_wheels_stay_on_the_ground_before_none_slides():
    """Drives that disagree on rough ground: wheels slide, but none is pressed into the ground or lifted."""
    at = resting("rocker_bogie", "rough:3,0.04,0.8")
    drives = [wheel.drive for wheel in at.rover.wheels]
    found = forward(at, dict.fromkeys(drives, 0.5) | {drives[0]: 0.9})
    assert found.sliding > 1e-3
    names, rows = structure(at)
    rates = dict(zip(names, rows @ found.velocity, strict=True))
    kept = [rate for name, rate in rates.items() if name.startswith(("contact of", "coupling"))]
    assert len(kept) == 7
    assert kept == pytest.approx(np.zeros(7), abs=1e-12)
    for nudge in np.eye(len(at.q))[:6]:  # nothing slides less that keeps what is known and those
        v = found.velocity + 1e-3 * nudge
        other = complete(
            at, {name: float(v[at.rover.column[name]]) for name in (*at.rover.actuated, "base_x")}
        )
        assert np.linalg.norm(rows[7:] @ other.velocity) >= np.linalg.norm(rows[7:] @ found.velocity) - 1e-12


def test_what_is_left_open_is_named():
    at = resting("hit_mrii", "flat")
    found = complete(at, {"forward": 0.1, "L_act": 0.0, "R_act": 0.0}, lifted=["RF"])
    assert "RF_dr" in found.undetermined
    assert "LF_dr" not in found.undetermined


def test_refusals():
    at = resting("hit_mrii", "flat")
    with pytest.raises(InputError, match="forwards: no rate of that name; did you mean 'forward'"):
        complete(at, {"forwards": 1.0})
    with pytest.raises(InputError, match=r"forward: must be a finite number \(got nan\)"):
        complete(at, {"forward": np.nan})
    with pytest.raises(InputError, match="L_bogie: is no driven joint"):
        forward(at, {"L_bogie": 1.0})
    with pytest.raises(MechanismError, match="known rates contradict one another; leave some of them out"):
        complete(at, {"up": 0.1, "base_z": 0.2})
