"""Motion constraints on loads."""

import numpy as np
import pytest
from hit_mrii_closed_form import Machine
from sides import HIT

import rover_pin as rp
from rover_pin.control.motion_constraints import motion_constraints
from rover_pin.control.now import Now
from rover_pin.control.settled_loads import settled_loads
from rover_pin.errors import InputError

MACHINE = Machine()
TASK_6 = {"LF": 351.0, "LM": 376.0, "LB": 376.0, "RF": 0.0, "RM": 977.0, "RB": 126.0}


@pytest.fixture
def at(level, raised):
    return level.at(raised.configuration)


def test_task_6(at, constraints, still):
    """The right front wheel hangs: it is not among the wheels in contact."""
    now = Now(at, still, still, ("RF",), TASK_6)
    assert constraints["load_difference"].value(now).tolist() == [851.0]
    mean = (351 + 376 + 376 + 977 + 126) / 5
    assert constraints["load_deviation"].value(now) == pytest.approx([977 - mean])


def test_a_wheel_that_ought_to_stand_counts(at, constraints, still):
    now = Now(at, still, still, (), TASK_6)
    assert constraints["load_difference"].value(now).tolist() == [977.0]


def test_deviation_below_the_mean(at, constraints, still):
    loads = dict.fromkeys(HIT.wheels, 400.0) | {"LB": 100.0}
    assert constraints["load_deviation"].value(Now(at, still, still, (), loads)) == pytest.approx([250.0])


def test_gradient_of_the_closed_form(hit, at, constraints, raised, still):
    """Both rockers together, as the closed form has them."""
    u, step = raised.joints["L_act"], 1e-5

    def difference(angle):
        front, behind = MACHINE.loads(angle)
        return behind - front

    slope = (difference(u + step) - difference(u - step)) / (2 * step)
    rows = constraints["load_difference"].gradient(Now(at, still, still, (), raised.loads))
    rockers = [hit.column["L_act"], hit.column["R_act"]]
    assert rows.shape == (1, hit.model.nv)
    assert rows[0, rockers].sum() == pytest.approx(slope, rel=5e-4)
    assert np.flatnonzero(rows[0]).tolist() == sorted(rockers)
    deviation = constraints["load_deviation"].gradient(Now(at, still, still, (), raised.loads))
    assert deviation[0, rockers].sum() == pytest.approx(2 / 3 * slope, rel=5e-4)  # mean - front, 4 : 2 wheels


@pytest.mark.parametrize(
    ("loads", "lifted", "message"),
    [
        (None, (), "load_difference: needs the wheels' loads; give `loads`, or leave it out of this cycle"),
        ({"LF": 1.0}, (), "LM: has no load; load_difference needs every standing wheel's"),
        (TASK_6, ("RX",), "RX: no wheel of that name; did you mean 'RM' or 'RF' or 'RB'?"),
        (TASK_6, HIT.wheels, "load_difference: no wheel stands (got 'LF, LM, LB, RF, RM, RB')"),
    ],
)
def test_refusals(at, constraints, still, loads, lifted, message):
    with pytest.raises(InputError) as caught:
        constraints["load_difference"].value(Now(at, still, still, lifted, loads))
    assert str(caught.value) == message


def test_gradient_needs_the_statics(hit, at, still):
    plain = motion_constraints(hit, HIT, ["load_deviation"])["load_deviation"]
    with pytest.raises(InputError, match=r"load_deviation: has no gradient without the statics; give `Opt"):
        plain.gradient(Now(at, still, still, (), TASK_6))


def test_settled_loads(hit, raised):
    loads_at = settled_loads(hit, rp.Terrain.flat())
    assert loads_at(np.array(raised.configuration)) == pytest.approx(dict(raised.loads), abs=1e-6)
    front, _ = MACHINE.loads(0.0)
    home = loads_at(np.array(hit.neutral))
    assert home == pytest.approx(dict.fromkeys(HIT.wheels, front), abs=1e-2)


def test_settled_loads_with_a_clutch(hit, raised):
    """Unfolding the right side with its clutch engaged takes load off its front wheel."""
    q = np.array(raised.configuration)
    q[hit.column["R_act"]] -= 0.05
    loads = settled_loads(hit, rp.Terrain.flat(), locked=["R_bogie"])(q)
    assert loads["RF"] == 0.0
    assert sum(loads.values()) == pytest.approx(225 * 9.81)


def test_loads_where_it_does_not_stand(hit, raised):
    heavy = hit.with_payload([(400.0, (2.0, 0.0, 0.0))])
    with pytest.raises(InputError, match="has no loads there: tips, "):
        settled_loads(heavy, rp.Terrain.flat())(np.array(raised.configuration))


def test_unknown_clutch(hit):
    with pytest.raises(InputError, match="locked: no joint that can be locked"):
        settled_loads(hit, rp.Terrain.flat(), locked=["R_boggie"])
