"""A rover's control.yaml."""

import dataclasses

import pytest
from hit_mrii_closed_form import Machine
from sides import HIT

from rover_pin.control.modes import MODES, Speeds
from rover_pin.control.motion_constraints import CONSTRAINTS
from rover_pin.control.plan import load_plan
from rover_pin.control.threshold import Threshold
from rover_pin.errors import InputError, SidecarError

MACHINE = Machine()

GOOD = """schema: 1
sides:
  left: {wheels: [LF, LM, LB], hinge: L_diff, rocker: L_act, clutch: L_bogie}
  right: {wheels: [RF, RM, RB], hinge: R_diff, rocker: R_act}
speeds: {lift: 0.005}
modes:
  rolling: {height: {limit: 0.2}}
  chassis_lifting: {margin: 0.9, wheelbase: {limit: 0.33}, height: {limit: 0.05, margin: 0.8}}
"""


@pytest.fixture
def read(hit, tmp_path):
    def reading(text):
        path = tmp_path / "control.yaml"
        path.write_text(text)
        return load_plan(hit, path)

    return reading


@pytest.fixture
def refused(read, tmp_path):
    def reading(old, new):
        assert old in GOOD
        with pytest.raises(SidecarError) as caught:
            read(GOOD.replace(old, new))
        return str(caught.value).replace(f"{tmp_path}/", "")

    return reading


def test_read(read):
    plan = read(GOOD)
    assert plan.layout == dataclasses.replace(HIT, right=dataclasses.replace(HIT.right, clutch=None))
    assert plan.speeds == Speeds(lift=0.005)
    assert dict(plan.thresholds_of("rolling")) == {"height": Threshold(0.2, 1.0)}
    assert dict(plan.thresholds_of("chassis_lifting")) == {
        "wheelbase": Threshold(0.33, 0.9), "height": Threshold(0.05, 0.8)
    }  # fmt: skip


def test_missing_mode(read, tmp_path):
    with pytest.raises(InputError) as caught:
        read(GOOD).thresholds_of("creeping")
    assert str(caught.value).replace(f"{tmp_path}/", "") == (
        "control.yaml: modes.creeping: no thresholds for this mode; state them; "
        "there are rolling, chassis_lifting"
    )


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("schema: 1\n", "", "control.yaml: schema: missing; start with `schema: 1`"),
        ("schema: 1", "schema: 2",
         "control.yaml: schema: another schema (got 2); this version reads schema 1"),
        ("speeds: {lift", "speed: {lift", "control.yaml:5: speed: unknown key; did you mean 'speeds'?"),
        ("lift: 0.005", "lift: 0", "control.yaml:5: speeds.lift: not above 0 (got 0); give a number above 0"),
        ("lift: 0.005", "lift: .nan", "control.yaml:5: speeds.lift: not a finite number (got nan); "
         "give a finite number"),
        ("wheelbase: {", "weelbase: {", "control.yaml:8: modes.chassis_lifting.weelbase: unknown key; "
         "did you mean 'wheelbase'?"),
        ("limit: 0.33", "limt: 0.33", "control.yaml:8: modes.chassis_lifting.wheelbase.limt: unknown key; "
         "did you mean 'limit'?"),
        ("limit: 0.33", "limit: -1", "control.yaml:8: modes.chassis_lifting.wheelbase.limit: not above 0 "
         "(got -1); give a number above 0"),
        ("margin: 0.9", "margin: 1.5", "control.yaml:8: modes.chassis_lifting.margin: above 1 (got 1.5); "
         "give a number of at most 1"),
        ("margin: 0.9", "lifted_set: {limit: 1}",
         "control.yaml:8: modes.chassis_lifting.lifted_set: unknown key; known: coordination, "
         "forward_change, height, length, load_deviation, load_difference, margin, "
         "rocker_speed, roll_rate, wheelbase, yaw_change"),
        ("hinge: L_diff", "hinge: L_dif", "control.yaml:2: sides: left: hinge: no joint of that name "
         "(got 'L_dif'); did you mean 'L_diff' or 'R_diff' or 'L_fr'?"),
        ("[LF, LM, LB]", "[LF, LM]", "control.yaml:2: sides: sides need as many wheels as each other, "
         "at least two (got '2 and 3'); list the wheels of each side front to rear"),
        (", rocker: R_act", "", "control.yaml:4: sides.right.rocker: missing; state it"),
        ("  rolling: {", "  chassis_lifting: {", "control.yaml:8: modes.chassis_lifting: stated twice, "
         "first in line 7; keep one"),
        ("speeds: {lift: 0.005}", "speeds: {lift: 0.005", "control.yaml:6: not YAML: did not find expected "
         "',' or '}'; check indentation, colons and brackets"),
    ],
)  # fmt: skip
def test_refused(refused, old, new, message):
    assert refused(old, new) == message


def test_no_modes(read, tmp_path):
    with pytest.raises(SidecarError) as caught:
        read(GOOD[: GOOD.index("modes:")] + "modes: {}\n")
    assert str(caught.value).replace(f"{tmp_path}/", "") == (
        "control.yaml:6: modes: names no mode; state the thresholds of at least one"
    )


def test_no_file(hit, tmp_path):
    with pytest.raises(SidecarError, match=r"none.yaml: no such file; write a control.yaml with its sides"):
        load_plan(hit, tmp_path / "none.yaml")


def test_hit_mrii(hit):
    """The bundled file: every mode, the paper's limits of loads, room for the paper's clearances."""
    plan = load_plan(hit)
    assert plan.layout == HIT
    assert plan.speeds == Speeds(0.025, 0.0036, 0.1)
    assert set(plan.thresholds) == set(MODES)
    assert plan.thresholds_of("single_lift")["load_difference"].limit == 1100.0
    assert plan.thresholds_of("double_lift")["load_difference"].limit == 1300.0
    for mode in ("single_lift", "double_lift"):
        assert plan.thresholds_of(mode)["load_deviation"].limit == 700.0
    for mode in MODES:
        assert set(plan.thresholds_of(mode)) <= set(CONSTRAINTS)
        assert {"coordination", "wheelbase", "height", "load_difference"} <= set(plan.thresholds_of(mode))
        for clearance in (0.15, 0.25, 0.39) if mode == "creeping" else (0.15, 0.25, 0.45, 0.48, 0.55):
            taken = MACHINE.shortening(MACHINE.motor_angle(clearance))
            assert abs(taken) < plan.thresholds_of(mode)["wheelbase"].allowed
