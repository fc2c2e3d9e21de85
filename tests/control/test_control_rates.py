"""Motion constraints on velocities: no sliding, closed forms, hand numbers, finite differences."""

import numpy as np
import pinocchio as pin
import pytest
from hit_mrii_closed_form import Machine
from sides import HIT, motion, slope

import rover_pin as rp
from rover_pin.control.motion_constraints import Options, motion_constraints
from rover_pin.control.now import Now
from rover_pin.kinematics.instant import Bodies

MACHINE = Machine()
BRAKES = ("LM_dr", "LB_dr", "RM_dr", "RB_dr")
STRAIGHT = tuple(f"{wheel}_st" for wheel in HIT.wheels)
RATES = ("coordination", "rocker_speed", "forward_change", "yaw_change", "roll_rate")
ROUGH = rp.Terrain.rough(seed=3, rms=0.03, hurst=0.8, size=8.0, spacing=0.1)


def uneven(hit, **more):
    stance = rp.settle(hit, ROUGH, x=0.3, y=-0.2, yaw=0.4, joints={"L_act": 0.3, "R_act": 0.1} | more)
    assert stance.settled
    return Bodies(hit, ROUGH).at(stance.configuration)


@pytest.mark.parametrize("name", RATES)
@pytest.mark.parametrize("lifted", [(), ("RF",)])
def test_value_is_linear(hit, constraints, name, lifted):
    """The gradient is d value / dv, by differences; value = gradient v + offset."""
    rng = np.random.default_rng(5)
    at, (v, nominal) = uneven(hit), 0.02 * rng.standard_normal((2, hit.model.nv))
    constraint = constraints[name]
    now = Now(at, v, nominal, lifted)
    gradient, value = constraint.gradient(now), constraint.value(now)
    wanted = slope(lambda w: constraint.value(Now(at, w, nominal, lifted)), v, 1e-3)
    applies = np.isfinite(value)
    np.testing.assert_allclose(gradient[applies], wanted[applies], rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose((gradient @ v + constraint.offset(now))[applies], value[applies], atol=1e-12)
    assert not gradient[~applies].any()


def turning(hit, level, q, v, wheel, step=1e-5):
    """Angular velocity of a wheel's body from two orientations."""
    places = []
    for sign in (1, -1):
        data = hit.model.createData()
        pin.forwardKinematics(hit.model, data, q + sign * step * v)
        places.append(data.oMi[hit.model.getJointId(f"{wheel}_dr")].rotation)
    return pin.log3(places[0] @ places[1].T) / (2 * step)


@pytest.mark.parametrize("seed", range(3))
def test_coordination_by_its_words(hit, level, constraints, raised, still, seed):
    """v_F - v_M - d(d_fm)/dt, turnings and distances from two configurations, level ground, no yaw rate."""
    rng = np.random.default_rng(seed)
    q, v = np.array(raised.configuration), 0.1 * rng.standard_normal(hit.model.nv)
    v[3] = 0.0
    now = Now(level.at(q), v, still)

    def distance(p):
        at = level.at(p)
        return (at.centers[at.index(["LF", "RF"])] - at.centers[at.index(["LM", "RM"])])[:, 0]

    apart = (distance(q + 1e-6 * v) - distance(q - 1e-6 * v)) / 2e-6
    rim = {w: MACHINE.wheel_radius * turning(hit, level, q, v, w)[1] for w in ("LF", "LM", "RF", "RM")}
    wanted = [rim["LF"] - rim["LM"] - apart[0], rim["RF"] - rim["RM"] - apart[1]]
    np.testing.assert_allclose(constraints["coordination"].value(now), wanted, atol=1e-8)


def test_raising_without_sliding(hit, level, constraints, raised, still):
    """The note's case: 3.6 mm/s at 480 mm, middle and rear braked; the front wheels go at -6.677 mm/s."""
    at = level.at(raised.configuration)
    rate = 0.0036 / MACHINE.lift_rate(raised.joints["L_act"], 1.0)
    v = motion(at, {"L_act": rate, "R_act": rate}, held=(*BRAKES, *STRAIGHT))
    now = Now(at, v, still)
    apart = constraints["wheelbase"].stations.at(at).apart_rows @ v
    np.testing.assert_allclose(1e3 * apart, -6.677, atol=5e-4)
    np.testing.assert_allclose(constraints["coordination"].value(now), 0.0, atol=1e-12)
    rim = MACHINE.wheel_radius * v[hit.column["LF_dr"]]
    assert rim == pytest.approx(MACHINE.rim_rate(raised.joints["L_act"], 0.0036), abs=1e-9)


def test_a_wheel_that_turns_too_fast(hit, level, constraints, raised, still):
    at = level.at(raised.configuration)
    still[hit.column["LF_dr"]] = 0.02
    still[hit.column["RM_dr"]] = 0.04
    value = constraints["coordination"].value(Now(at, still, still))
    np.testing.assert_allclose(value, [0.15 * 0.02, -0.15 * 0.04], atol=1e-12)


@pytest.mark.parametrize("wanted", [{"L_act": 0.01}, {"R_act": -0.02}, {"L_act": 0.01, "R_act": 0.01}])
def test_nothing_to_coordinate_where_nothing_slides(hit, constraints, still, wanted):
    """Uneven ground, rockers unlike, pitch and roll rates."""
    at = uneven(hit)
    v = motion(at, wanted)
    assert np.abs(constraints["wheelbase"].stations.at(at).apart_rows @ v).max() > 1e-3
    np.testing.assert_allclose(constraints["coordination"].value(Now(at, v, still)), 0.0, atol=1e-12)


def test_turning_on_steered_wheels_slides_nowhere(hit, level, constraints, still):
    """About a centre 3 m to the left, at home, where steering axes are upright."""
    q = hit.configuration(position=(0.0, 0.0, 0.45))
    at = level.at(q)
    middle = at.centers[at.index(["LM"])[0]]
    for wheel, center in zip(at.bodies.names, at.centers, strict=True):
        x, y = center[:2] - middle[:2] * [1.0, 0.0]
        q[hit.column[f"{wheel}_st"]] = np.arctan2(x, 3.0 - y)
    at = level.at(q)
    v = motion(at, {"base_yaw": 0.02}, held=(*STRAIGHT, "L_act", "R_act"))
    assert 0.05 < v[0] < 0.07
    np.testing.assert_allclose(constraints["coordination"].value(Now(at, v, still)), 0.0, atol=1e-12)


@pytest.mark.parametrize(("lifted", "gone"), [((), ()), (("LF",), (0,)), (("RM",), (1,)), (("LB",), ())])
def test_lifted_wheels_are_not_coordinated(level, constraints, raised, still, lifted, gone):
    now = Now(level.at(raised.configuration), still + 0.01, still, lifted)
    constraint = constraints["coordination"]
    assert tuple(np.flatnonzero(np.isnan(constraint.value(now)))) == gone
    assert tuple(np.flatnonzero(~constraint.gradient(now).any(axis=1))) == gone
    assert tuple(np.flatnonzero(~constraint.applies(now))) == gone


@pytest.mark.parametrize("clearance", [0.15, 0.25, 0.33, 0.48, 0.55])
def test_rocker_speed_of_the_closed_form(hit, level, constraints, still, clearance):
    """At w_max the distance front to middle changes as fast as the side drives."""
    stance = rp.settle(hit, rp.Terrain.flat(), posture={"clearance": clearance})
    u, speed = stance.joints["L_act"], 0.015
    per_rate = MACHINE.wheelbase_rate(u, MACHINE.lift_rate(u, 1.0))
    nominal, v = still.copy(), still.copy()
    nominal[0] = speed
    v[hit.column["L_act"]], v[hit.column["R_act"]] = speed / abs(per_rate), -0.5 * speed / abs(per_rate)
    value = constraints["rocker_speed"].value(Now(level.at(stance.configuration), v, nominal))
    np.testing.assert_allclose(value, [1.0, -0.5], atol=1e-8)


def test_rocker_speed_of_a_turning_body(hit, level, constraints, raised, still):
    """Sides drive at 15 mm/s -+ 0.02 rad/s times 652 mm."""
    nominal, v = still.copy(), still.copy()
    nominal[0], nominal[3] = 0.015, 0.02
    v[hit.column["L_act"]] = v[hit.column["R_act"]] = 0.001
    left, right = constraints["rocker_speed"].value(Now(level.at(raised.configuration), v, nominal))
    assert left / right == pytest.approx((0.015 + 0.02 * 0.652) / (0.015 - 0.02 * 0.652), rel=1e-6)


def test_rocker_speed_at_a_standstill(hit, level, raised, still):
    """The floor is the speed then."""
    watched = motion_constraints(hit, HIT, ["rocker_speed"], Options(speed_floor=0.01))["rocker_speed"]
    v = still.copy()
    v[hit.column["L_act"]] = 0.01
    left, right = watched.value(Now(level.at(raised.configuration), v, still))
    assert left == pytest.approx(0.516, abs=1e-3)
    assert right == 0.0


@pytest.mark.parametrize(("lifted", "locked"), [((), ()), (("RF",), ("R_bogie",)), (("LM",), ("L_bogie",))])
def test_reshaping_by_statics(hit, constraints, still, lifted, locked):
    """d(d_fm)/dw from stances with one rocker a little on, uneven ground: no Jacobian in it."""
    stations, bodies = constraints["rocker_speed"].stations, Bodies(hit, ROUGH)
    start = rp.settle(hit, ROUGH, x=0.3, y=-0.2, yaw=0.4, joints={"L_act": 0.35, "R_act": 0.3})
    passive = {name: start.joints[name] for name in locked}
    away = {"RF": {"R_act": 0.25}, "LM": {"L_act": 0.45}}
    rockers = {"L_act": 0.35, "R_act": 0.3} | {k: v for w in lifted for k, v in away[w].items()}

    def stand(side, more):
        joints = rockers | passive
        joints[("L_act", "R_act")[side]] += more
        stance = rp.settle(hit, ROUGH, x=0.3, y=-0.2, yaw=0.4, joints=joints)
        assert stance.settled
        return stance

    stance = stand(0, 0.0)
    gone = tuple(wheel for wheel in HIT.wheels if stance.loads[wheel] == 0.0)
    assert gone == lifted
    at = bodies.at(stance.configuration)
    found = stations.reshaping.rates(Now(at, still, still, gone, None, locked))
    for side in range(2):
        far = [stations.at(bodies.at(stand(side, s * 1e-5).configuration)).apart[side] for s in (1, -1)]
        assert found[side] == pytest.approx((far[0] - far[1]) / 2e-5, abs=2e-4), (side, gone)


def test_a_rocker_that_cannot_turn(hit, level, constraints, raised, still):
    """All wheels down and one clutch engaged: that side is stiff, the other is not."""
    now = Now(level.at(raised.configuration), still, still, locked=("L_bogie",))
    left, right = constraints["rocker_speed"].stations.reshaping.rates(now)
    assert left == 0.0
    assert right == pytest.approx(-0.516, abs=1e-3)


def test_forward_change(level, constraints, raised, still):
    heading = np.array(raised.configuration)
    heading[3] = 0.5 * np.pi
    v, nominal = still.copy(), still.copy()
    v[:2], nominal[:2] = [0.3, 0.018], [0.0, 0.015]
    value = constraints["forward_change"].value(Now(level.at(heading), v, nominal))
    assert value == pytest.approx([0.003 / 0.015])
    assert constraints["forward_change"].value(Now(level.at(heading), v, still)) == pytest.approx([18.0])


def test_yaw_change(level, constraints, raised, still):
    """Task 15 has 0.02 rad/s and changes of about 0.4 of it."""
    v, nominal = still.copy(), still.copy()
    v[3], nominal[3] = 0.012, 0.02
    at = level.at(raised.configuration)
    assert constraints["yaw_change"].value(Now(at, v, nominal)) == pytest.approx([-0.4])
    assert constraints["yaw_change"].value(Now(at, v, still)) == pytest.approx([12.0])


def test_roll_rate(level, constraints, raised, still):
    """Rolling at 0.01 rad/s hinges 830 mm apart part at 8.3 mm/s."""
    v, nominal = still.copy(), still.copy()
    v[5], nominal[:2] = 0.01, [0.012, 0.016]
    value = constraints["roll_rate"].value(Now(level.at(raised.configuration), v, nominal))
    assert value == pytest.approx([0.0083 / 0.02], rel=1e-3)  # the body is pitched by 0.7 deg
