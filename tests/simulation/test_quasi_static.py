"""Simulated modes: contacts do not slide, and every posture is one that the statics find by themselves."""

import math

import numpy as np
import pytest

import rover_pin as rp
from rover_pin.control.modes import Mode, Speeds, chassis_lifting, crabbing, creeping, rolling, wheel_lifting
from rover_pin.control.plan import load_plan
from rover_pin.control.supervisor import State
from rover_pin.errors import InputError
from rover_pin.simulation.quasi_static import Setting, simulate

FLAT = rp.Terrain.flat()
STEADY = 0.75
"""deg: the paper's robot keeps its pitch within this while its chassis moves."""


@pytest.fixture(scope="module")
def hit():
    return rp.load("hit_mrii")


@pytest.fixture(scope="module")
def plan(hit):
    return load_plan(hit)


def run(rover, plan, modes, clearance=0.25, terrain=FLAT, **options):
    start = rp.settle(rover, terrain, posture={"clearance": clearance})
    options = {"dt": 0.02, "every": 0.5} | options
    return simulate(rover, terrain, start, modes, Setting(plan.layout, plan.thresholds, **options))


def stands_as_the_statics_say(found):
    assert np.nanmax(found.residual) < 1e-6
    assert np.nanmax(found.apart) < 1e-5
    assert not np.isnan(found.apart).any()
    total = sum(found.loads.values())
    assert total == pytest.approx(225.0 * 9.81, rel=1e-9)
    assert min(float(np.min(load)) for load in found.loads.values()) >= 0.0


def test_raising_and_lowering(hit, plan):
    """No wheel slides 0.1 mm on the whole way from 150 to 550 mm; the body pitches by 0.75 deg at most."""
    speeds = Speeds(lift=0.0072)
    modes = [chassis_lifting(plan.layout, speeds, goal) for goal in (0.15, 0.55)]
    found, _ = run(hit, plan, modes)
    assert found.status == "done"
    stands_as_the_statics_say(found)
    assert np.max(found.drift) < 1e-4
    pitch = np.degrees(found.configuration[:, hit.column["base_pitch"]])
    assert np.max(np.abs(pitch)) < STEADY
    assert np.nanmax(found.values["wheelbase"]) == pytest.approx(0.534, abs=0.001)


@pytest.mark.parametrize(("hold", "advance"), [("drive", 0.210), ("wheel", 0.166)])
def test_creeping(hit, plan, hold, advance):
    """It goes forward, without sliding; by how much depends on what a brake holds."""
    found, _ = run(hit, plan, [creeping(plan.layout, Speeds(lift=0.0072), 0.25, 0.36, 2, hold)])
    assert found.status == "done"
    stands_as_the_statics_say(found)
    assert np.max(found.drift) < 1e-4
    assert found.configuration[-1, 0] == pytest.approx(advance, abs=0.001)


def test_creeping_up_a_slope(hit, plan):
    found, _ = run(
        hit, plan, [creeping(plan.layout, Speeds(lift=0.0072), 0.25, 0.3, 1)], terrain=rp.Terrain.slope(10.0)
    )
    assert found.status == "done"
    stands_as_the_statics_say(found)
    assert np.max(found.drift) < 1e-4


def test_rolling_and_crabbing_do_not_slide(hit, plan):
    fast = Speeds(roll=0.1, steer=0.5)
    modes = [rolling(plan.layout, fast, 1.0, 0.4), crabbing(plan.layout, fast, 0.5, -math.pi / 2)]
    found, _ = run(hit, plan, modes, clearance=0.25)
    assert found.status == "done"
    stands_as_the_statics_say(found)
    assert np.max(found.drift) < 1e-4
    assert found.configuration[-1, 3] == pytest.approx(0.4, abs=1e-4)


def test_a_front_wheel_lifted_from_485_mm(hit, plan):
    found, _ = run(hit, plan, [wheel_lifting(plan.layout, plan.speeds, ["RF"], 0.18, 0.1)], clearance=0.485)
    assert found.status == "done"
    stands_as_the_statics_say(found)
    top = [i for i, action in enumerate(found.actions) if action == "roll with lifted wheels"][-1]
    loads = {name: float(load[top]) for name, load in found.loads.items()}
    assert loads == pytest.approx({"LF": 351, "LM": 376, "LB": 376, "RF": 0, "RM": 977, "RB": 126}, abs=10)
    assert found.lifted[top] == ("RF",)
    assert found.lifted[-1] == ()
    assert found.values["load_difference"][top, 0] == pytest.approx(851.0, abs=1.0)


def test_a_lift_that_is_refused_stays_put(hit, plan):
    found, supervisor = run(
        hit, plan, [wheel_lifting(plan.layout, plan.speeds, ["RF"], 0.18, 0.1)], clearance=0.2
    )
    assert found.status == "held"
    assert found.reason.startswith(
        "RF: is not lifted: with RF just off the ground RB would have to carry -5.2"
    )
    assert supervisor.order.state is State.HELD
    assert np.ptp(found.configuration, axis=0).max() < 1e-9


def test_a_mode_that_cannot_begin(hit, plan):
    start = rp.settle(hit, FLAT, joints={"L_act": 0.1, "R_act": 0.3})
    found, _ = simulate(hit, FLAT, start, [chassis_lifting(plan.layout, plan.speeds, 0.4)],
                        Setting(plan.layout, plan.thresholds))  # fmt: skip
    assert found.status == "refused"
    assert found.reason.startswith("L_act, R_act: chassis_lifting moves both sides together")


def test_an_obstacle_in_the_way(hit, plan):
    """A wheel before a step that is as high as itself: the action makes no way, and goes back."""
    terrain = rp.Terrain.step(0.3, 1.2)
    found, supervisor = run(
        hit, plan, [rolling(plan.layout, Speeds(roll=0.1), 1.0)], terrain=terrain, every=5.0
    )
    assert found.status in ("returned", "held")
    assert any(
        "makes no way any more" in e.reason or "cannot hold together" in e.reason for e in supervisor.trace
    )


def test_refusals(hit, plan):
    with pytest.raises(InputError, match="modes: none are given; give at least one mode"):
        run(hit, plan, [])
    over = rp.settle(hit, FLAT, joints={"L_act": 0.9, "R_act": -0.7})
    if not over.settled:
        with pytest.raises(InputError, match="start: must be settled"):
            simulate(hit, FLAT, over, [Mode("rolling", ())], Setting(plan.layout, plan.thresholds))
    found, _ = run(hit, plan, [Mode("rolling", ())])
    assert (found.status, found.reason) == ("refused", "rolling: has no actions")


def test_too_long(hit, plan):
    found, _ = run(hit, plan, [rolling(plan.layout, plan.speeds, 10.0)], longest=1.0)
    assert (found.status, found.reason) == ("too long", "longer than 1 s")
