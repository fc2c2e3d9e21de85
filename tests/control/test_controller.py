"""One control cycle after the other: projection, refusals, faults, and what the supervisor makes of them."""

import numpy as np
import pytest
from sides import HIT as SIDES

import rover_pin as rp
from rover_pin.control.actions import Drive, Engage, Grip, Release, Reshape
from rover_pin.control.controller import Controller
from rover_pin.control.modes import (
    CHASSIS_LIFTING,
    MODES,
    Mode,
    Speeds,
    chassis_lifting,
    crabbing,
    rolling,
    wheel_lifting,
)
from rover_pin.control.motion_constraints import motion_constraints
from rover_pin.control.now import Now
from rover_pin.control.projection import Projection
from rover_pin.control.supervisor import State, Supervisor
from rover_pin.control.threshold import Threshold
from rover_pin.errors import InputError
from rover_pin.kinematics.advance import advance
from rover_pin.kinematics.steering import Twist
from rover_pin.kinematics.tasks.clearance import clearance

FLAT = rp.Terrain.flat()
SPEEDS = Speeds()


class Rig:
    """A controller, a clock, and a rover that does what it is told."""

    def __init__(self, rover, thresholds=None, at=0.25, terrain=FLAT, **options):
        self.now, self.answers = 0.0, False
        supervisor = Supervisor(lambda: self.now, lambda _: self.answers, 1.0)
        allowed = {mode: {} for mode in MODES} if thresholds is None else thresholds
        self.controller = Controller(
            rover, terrain, SIDES, motion_constraints(rover, SIDES), allowed, supervisor, **options
        )
        self.at = self.controller.inverse.at(rp.settle(rover, terrain, posture={"clearance": at}))
        self.cycles = []

    def run(self, mode, most=100000, **given):
        self.controller.begin(mode, self.at.q)
        return self.go_on(most, **given)

    def go_on(self, most, **given):
        for _ in range(most):
            cycle = self.controller.cycle(self.at, **given)
            self.cycles.append(cycle)
            if np.any(cycle.velocity):
                self.at = advance(self.at, cycle.velocity, self.controller.dt)
            self.now += self.controller.dt
            if cycle.order.state not in (State.RUNNING, State.ROLLING_BACK, State.HALTED):
                break
        return cycle.order


@pytest.fixture(scope="module")
def hit():
    return rp.load("hit_mrii")


def thresholds(**limits):
    given = {name: Threshold(limit) for name, limit in limits.items()}
    return dict.fromkeys(MODES, given)


def test_the_wheelbase_stops_the_chassis(hit):
    """Motion constraint 3 at 0.25 halts the raise at a clearance of 447.1 mm, both sides alike."""
    rig = Rig(hit, thresholds(wheelbase=0.25), at=0.42)
    order = rig.run(chassis_lifting(SIDES, SPEEDS, 0.48), most=1500)
    halted = [event for event in rig.controller.supervisor.trace if event.state is State.HALTED]
    assert [event.reason for event in halted] == ["wheelbase"]
    assert order.state is State.ROLLING_BACK
    highest = max(
        cycle.solution.velocity is not None and cycle.look.value.max() for cycle in rig.cycles if cycle.look
    )
    assert highest == pytest.approx(0.25, abs=1e-4)
    first = next(i for i, cycle in enumerate(rig.cycles) if cycle.order.state is State.HALTED)
    again = Rig(hit, thresholds(wheelbase=0.25), at=0.42)
    again.controller.begin(chassis_lifting(SIDES, SPEEDS, 0.48), again.at.q)
    again.go_on(first + 1)
    assert 1e3 * clearance(again.at) == pytest.approx(447.1, abs=0.5)
    left, right = (again.at.q[hit.column[f"{side}_act"]] for side in "LR")
    assert left == pytest.approx(right, abs=1e-9)


def test_both_sides_of_a_limit_bind(hit):
    """A value below minus its limit is as far beyond it: the rows keep |eta| <= kappa limit."""
    constraints = motion_constraints(hit, SIDES, ["wheelbase", "roll_rate"])
    rig = Rig(hit)
    at = rig.at
    still = np.zeros(hit.model.nv)
    projection = Projection(constraints, {"wheelbase": Threshold(0.2, 0.5), "roll_rate": Threshold(3.0)}, 2.0)
    rows = projection.watch(Now(at, still, still)).rows(at, 0.01)
    assert rows.names == ("roll_rate", "wheelbase left", "wheelbase right")
    assert rows.low == pytest.approx([-3.0, -0.2, -0.2], abs=1e-9)
    assert rows.high == pytest.approx([3.0, 0.2, 0.2], abs=1e-9)
    assert not rows.equation


def test_readings_are_the_constraints_own(hit):
    velocity = ("rocker_speed", "forward_change", "yaw_change", "roll_rate")
    limits = {"coordination": 0.01, "wheelbase": 0.4, "height": 0.1, "length": 0.1}
    limits |= dict.fromkeys(velocity, 9.0) | {"load_difference": 900.0, "load_deviation": 600.0}
    rig = Rig(hit, thresholds(**limits), at=0.3)
    loads = dict(rp.settle(hit, FLAT, posture={"clearance": 0.3}).loads)
    rig.run(chassis_lifting(SIDES, SPEEDS, 0.4), most=5, loads=loads)
    before = rig.at
    cycle = rig.controller.cycle(before, loads=loads)
    assert set(cycle.readings) == {"lifted_set", *limits}
    still = np.zeros(hit.model.nv)
    now = Now(before, cycle.velocity, still, (), loads)
    for name, reading in cycle.readings.items():
        constraint = rig.controller.constraints[name]
        assert reading.value == pytest.approx(constraint.value(now), abs=1e-12), name
        if name in limits:
            assert reading.index == pytest.approx(np.abs(reading.value) / limits[name], abs=1e-12)


def test_a_load_constraint_halts(hit):
    rig = Rig(hit, thresholds(load_difference=100.0), at=0.3)
    loads = {"LF": 500.0, "LM": 300.0, "LB": 300.0, "RF": 370.0, "RM": 370.0, "RB": 370.0}
    rig.controller.begin(chassis_lifting(SIDES, SPEEDS, 0.4), rig.at.q)
    assert rig.controller.cycle(rig.at, loads=loads).order == rig.controller.supervisor.order
    assert rig.controller.supervisor.order.state is State.HALTED
    assert rig.controller.supervisor.order.reason == "load_difference"


def test_a_second_reminder_turns_the_way_without_one_more_step_forward(hit):
    rig = Rig(hit, thresholds(load_difference=100.0), at=0.3)
    loads = {"LF": 500.0, "LM": 300.0, "LB": 300.0, "RF": 370.0, "RM": 370.0, "RB": 370.0}
    rig.answers = True
    goals = [chassis_lifting(SIDES, SPEEDS, goal).actions for goal in (0.4, 0.45)]
    rig.controller.begin(Mode(CHASSIS_LIFTING, goals[0] + goals[1]), rig.at.q)
    while rig.controller.supervisor.order.state is not State.ROLLING_BACK:
        cycle = rig.controller.cycle(rig.at, loads=loads)
    assert cycle.order.reason == "reminder 2 within one mode: load_difference"
    assert np.any(cycle.solution.velocity)
    assert not np.any(cycle.velocity)


def test_modes_run_and_undo(hit):
    rig = Rig(hit, at=0.3, dt=0.05)
    start = np.array(rig.at.q)
    assert rig.run(chassis_lifting(SIDES, SPEEDS, 0.31)).state is State.DONE
    assert clearance(rig.at) == pytest.approx(0.31, abs=1e-5)
    tight = Rig(
        hit, {**{mode: {} for mode in MODES}, CHASSIS_LIFTING: {"wheelbase": Threshold(0.1)}}, at=0.3, dt=0.05
    )
    roll = Drive(SIDES, Twist(forward=0.1), 0.05)
    up = Reshape(SIDES, 0.48, 0.02, ("LM", "RM"), label="raise")
    assert tight.run(Mode(CHASSIS_LIFTING, (roll, up))).state is State.RETURNED
    drives = [hit.column[wheel.drive] for wheel in hit.wheels]
    same = [i for i in range(hit.model.nv) if i not in drives]
    assert tight.at.q[same] == pytest.approx(start[same], abs=2e-5)
    told = [(str(e.state), e.action) for e in tight.controller.supervisor.trace if "reached" not in e.reason]
    assert told == [("running", "roll"), ("running", "raise"), ("halted", "raise"), ("rolling back", "raise"),
                    ("rolling back", "roll"), ("returned", "")]  # fmt: skip


def test_infeasible_halts_with_the_rows_that_fight(hit):
    """A place that no rows can be kept from: the rover was moved by hand."""
    rig = Rig(hit, at=0.3)
    rig.controller.begin(rolling(SIDES, SPEEDS, 1.0), rig.at.q)
    rig.controller.cycle(rig.at)
    q = rig.at.q.copy()
    q[hit.column["L_act"]] += 0.2  # a motor was moved by hand: couplings and contacts are torn
    cycle = rig.controller.cycle(q)
    assert cycle.order.state is State.HALTED
    assert cycle.order.reason.startswith("these cannot hold together: ")
    assert not np.any(cycle.velocity)


def test_sensors(hit):
    for spoil, words in (
        (lambda q: q * np.nan, "the sensor of base_x tells nan for its place"),
        (lambda q: q[:-1], "25 numbers for the places of 26 coordinates"),
    ):
        rig = Rig(hit)
        rig.controller.begin(rolling(SIDES, SPEEDS, 1.0), rig.at.q)
        cycle = rig.controller.cycle(spoil(rig.at.q))
        assert (cycle.order.state, cycle.order.reason) == (State.HELD, words)
        assert not np.any(cycle.velocity)
    rig = Rig(hit)
    rig.controller.begin(rolling(SIDES, SPEEDS, 1.0), rig.at.q)
    cycle = rig.controller.cycle(rig.at, loads={"LF": np.inf})
    assert cycle.order.reason == "the load sensor of LF tells inf"
    rates = np.zeros(hit.model.nv)
    rates[hit.column["LF_dr"]] = np.nan
    rig = Rig(hit)
    rig.controller.begin(rolling(SIDES, SPEEDS, 1.0), rig.at.q)
    assert (
        rig.controller.cycle(rig.at, rates=rates).order.reason == "the sensor of LF_dr tells nan for its rate"
    )


def test_too_fast(hit):
    rig = Rig(hit)
    order = rig.run(rolling(SIDES, Speeds(roll=0.2), 1.0), most=3)
    assert order.state is State.HELD
    assert "_dr: roll asks for more speed than the joint has (got '1.33'); its limit is 1" in order.reason


def test_a_clutch_on_a_moving_joint(hit):
    rig = Rig(hit)
    rig.controller.begin(wheel_lifting(SIDES, SPEEDS, ["RM"], 0.05, 0.0), rig.at.q)
    rates = np.zeros(hit.model.nv)
    rates[hit.column["R_bogie"]] = 0.01
    order = rig.controller.cycle(rig.at, rates=rates).order
    assert order.state is State.HELD
    assert order.reason == (
        "R_bogie: the clutch cannot be engaged on a joint that moves faster than 0.001 rad/s"
        " (got '0.01 rad/s'); stop the rockers and wheels first"
    )
    assert rig.controller.grip == Grip()


def test_a_lift_that_would_need_a_negative_load(hit):
    rig = Rig(hit, at=0.2)
    order = rig.run(wheel_lifting(SIDES, SPEEDS, ["RF"], 0.18, 0.3), most=5)
    assert order.state is State.HELD
    assert order.reason.startswith(
        "RF: is not lifted: with RF just off the ground RB would have to carry -5.2"
    )


def test_postures_a_mode_cannot_start_in(hit):
    rig = Rig(hit)
    q = rig.at.q.copy()
    q[hit.column["L_act"]], q[hit.column["R_act"]] = 0.1, 0.2
    with pytest.raises(InputError) as caught:
        rig.controller.begin(chassis_lifting(SIDES, SPEEDS, 0.4), q)
    assert str(caught.value) == (
        "L_act, R_act: chassis_lifting moves both sides together and starts with their rockers alike"
        " (got '5.73 and 11.46 deg'); bring them to the same angle first"
    )
    q = rig.at.q.copy()
    q[hit.column["LF_st"]] = 0.5
    with pytest.raises(
        InputError, match=r"LF_st: single_lift starts with the wheels straight \(got '28.65 deg'\)"
    ):
        rig.controller.begin(wheel_lifting(SIDES, SPEEDS, ["RM"], 0.1, 0.0), q)
    rig.controller.grip = Grip({"R_bogie": 0.0}, ("RM",))
    with pytest.raises(
        InputError, match="RM: rolling starts with every wheel on the ground; let it down first"
    ):
        rig.controller.begin(rolling(SIDES, SPEEDS, 1.0), rig.at.q)
    rig.controller.grip = Grip({"R_bogie": 0.0})
    with pytest.raises(
        InputError, match="R_bogie: rolling starts with the clutches released; release it first"
    ):
        rig.controller.begin(rolling(SIDES, SPEEDS, 1.0), rig.at.q)


def test_a_mode_without_thresholds(hit):
    rig = Rig(hit, {"rolling": {}})
    with pytest.raises(InputError, match="mode crabbing: has no thresholds; did you mean 'rolling'"):
        rig.controller.begin(crabbing(SIDES, SPEEDS, 1.0), rig.at.q)
    with pytest.raises(
        InputError, match="wheelbass: no motion constraint of that name; did you mean 'wheelbase'"
    ):
        Rig(hit, {"rolling": {"wheelbass": Threshold(1.0)}}).controller.begin(
            rolling(SIDES, SPEEDS, 1.0), rig.at.q
        )


def test_a_hanging_wheel_is_not_let_fall(hit):
    rig = Rig(hit)
    rig.controller.grip = Grip({"R_bogie": 0.0}, ("RM",))
    rig.controller._mode = Mode("rolling", (Release(("R_bogie",)),))
    rig.controller.supervisor.begin("rolling", ["release"])
    order = rig.controller.cycle(rig.at).order
    assert order.reason == "RM: hangs and would fall; let it down before the clutch is released"


def test_an_action_that_makes_no_way(hit):
    """A joint limit in the way: programs are solved, but nothing comes nearer."""
    rig = Rig(hit, at=0.5, dt=0.05)
    order = rig.run(chassis_lifting(SIDES, Speeds(lift=0.02), 0.9), most=3000)
    assert order.state in (State.RETURNED, State.ROLLING_BACK)
    reasons = [event.reason for event in rig.controller.supervisor.trace if event.state is State.HALTED]
    assert reasons[0].startswith("raise or lower makes no way any more, ")


def test_the_edge_of_the_map_holds_the_rover(hit):
    rig = Rig(hit, terrain=rp.Terrain.from_function(lambda x, y: 0.0 * x, extent=(-2.0, 1.25, -2.0, 2.0)))
    order = rig.run(rolling(SIDES, SPEEDS, 1.0), most=2000)
    assert order.state is State.HELD
    assert order.reason == "LF: is not over the map; the map spans x -2 to 1.25 m, y -2 to 2 m"
    assert 0.1 < rig.at.q[0] < 0.5
    assert not np.any(rig.cycles[-1].velocity)


def test_names_of_clutches():
    assert Engage(("a", "b")).name == "engage a and b"
    assert Release(("a",)).name == "release a"
