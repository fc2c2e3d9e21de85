"""Tracks in a stance: tension, slack, what the joints cannot reach, supports that change, tractions."""

import numpy as np
import pytest
from little_rover import fixture, four_wheels
from tracked_rover import tracked

import rover_pin as rp
from rover_pin.errors import InputError, MechanismError
from rover_pin.statics.asked import held_values
from rover_pin.statics.differences import stiffness_by_differences
from rover_pin.statics.follow import follow, straight
from rover_pin.statics.level import on_level
from rover_pin.statics.report import report

FLAT = rp.Terrain.flat()
FIXTURES = ("sprung4", "trailing4", "four_bar", "turnbuckle", "caster3", "thirds", "bogie_min")


def rovers(*names):
    made = {
        "tracked": tracked,
        "polibot_half": lambda: rp.load("polibot_half"),
        "polibot": lambda: rp.load("polibot"),
    }
    return [(made[name]() if name in made else fixture(name)) for name in names]


def problem_of(rover):
    values, locked = held_values(rover, None, {}, (), 9.81)
    return on_level(rover, values, locked, 9.81)


@pytest.mark.parametrize("name", ["tracked", "polibot_half", "polibot", *FIXTURES])
@pytest.mark.parametrize("ground", ["flat", "slope:7", "rough:1,0.05,0.8"])
def test_stiffness_is_the_derivative_of_the_imbalance(name, ground):
    """In closed form for every element, against central differences of the equations themselves."""
    (rover,) = rovers(name)
    terrain = rp.Terrain.parse(ground)
    problem, footing = problem_of(rover)
    generator = np.random.default_rng(6)
    for _ in range(3):
        here = problem.moved(*generator.uniform(-4, 4, 2), generator.uniform(0, 6))
        state = here.state(footing.z + generator.uniform(-0.05, 0.05, here.n), terrain)
        loads, pulls = (
            generator.uniform(0, 100, len(state.slack)),
            generator.uniform(-90, 90, len(state.closure)),
        )
        exact = here.stiffness(state, terrain, loads, pulls, 0.0)
        rough = stiffness_by_differences(here, state, terrain, loads, pulls, 0.0)
        np.testing.assert_allclose(exact, rough, atol=3e-7 * np.abs(rough).max())


def test_a_taut_track_pulls_as_hard_as_its_wheels_let_it():
    """A virtual motion: what the weight and springs do, the tension does against the slack's change."""
    rover = tracked()
    stance = rp.settle(rover, FLAT)
    assert stance.settled
    tension = stance.tensions["t"]
    assert tension > 1.0
    shorter = rp.settle(tracked(track={"length": 2.58}), FLAT)
    assert shorter.tensions["t"] > tension


def test_a_slack_track_has_no_tension_and_is_as_none():
    loose = rp.settle(tracked(track={"length": 2.7}), FLAT)
    assert loose.settled
    assert loose.tensions == {"t": 0.0}
    outer = rp.settle(tracked(track={"length": 3.5}), FLAT)
    assert loose.position[2] == pytest.approx(outer.position[2], abs=1e-10)
    for wheel, load in loose.loads.items():
        assert load == pytest.approx(outer.loads[wheel], abs=1e-7)


@pytest.mark.parametrize("length", [2.55, 2.58, 2.6, 2.62, 2.7])
def test_tension_and_slack_are_complementary(length):
    stance = rp.settle(tracked(track={"length": length}), FLAT)
    assert stance.tensions["t"] >= 0.0
    assert stance.residuals["complementarity"] < 1e-9
    assert sum(stance.loads.values()) == pytest.approx(stance.weight, rel=1e-9)


def test_a_track_too_short_for_its_wheels_is_named():
    with pytest.raises(MechanismError) as found:
        rp.settle(tracked(track={"length": 2.2}), FLAT)
    said = str(found.value)
    assert "tracks.t: the track is shorter than its way around its wheels wherever the joints go" in said
    missing = float(said.split("go: ")[1].split(" m")[0])
    assert 0.15 < missing < 0.3
    assert "give a longer track, or smaller or nearer wheels" in said


def test_a_spring_longer_than_its_stop_is_named(tmp_path):
    bed = four_wheels()
    bed.link("arm", 1.0).joint("hinge", "base_link", "arm", (0, 0, 0.1), limits=(-0.1, 0.1))
    bed.say(
        springs=[
            {
                "name": "strut",
                "frames": [{"link": "base_link", "xyz": [0.3, 0, 0]}, {"link": "arm", "xyz": [0.3, 0, 0.2]}],
                "stiffness": 1000.0,
                "length_max": 0.1,
            }
        ]
    )
    with pytest.raises(MechanismError) as found:
        rp.settle(bed.load(tmp_path), FLAT)
    assert "springs.strut: the spring is longer than its length_max wherever the joints go" in str(
        found.value
    )


@pytest.mark.parametrize(("name", "rms"), [("tracked", 0.02), ("polibot_half", 0.06), ("polibot", 0.05)])
def test_supports_changed_at_the_place_are_those_reached_by_following(name, rms):
    """Wheels that lift, tracks that slacken, springs that meet their stops: in one go as step by step."""
    (rover,) = rovers(name)
    problem, footing = problem_of(rover)
    generator = np.random.default_rng(9)
    changed = 0
    for seed in range(5):
        terrain = rp.Terrain.rough(seed, rms, 0.8)
        for _ in range(12):
            here = problem.moved(*generator.uniform(-8, 8, 2), generator.uniform(0, 6))
            level = float(terrain.height(*here.reduction.offset[:2]))
            z = footing.z.copy()
            z[0] += level
            found = straight(here, footing, z, terrain)
            if found is None or np.array_equal(found.active, footing.active):
                continue
            changed += 1
            short = report(here, found, terrain, ())
            long = report(here, follow(here, footing, z, terrain, level), terrain, ())
            assert short.status is long.status
            if short.settled:
                np.testing.assert_allclose(short.configuration, long.configuration, atol=1e-7)
    assert changed >= 5


def balance_of(stance):
    """Forces (3,) and moments (3,) about the origin of all that acts on the rover from outside."""
    heading = np.array([np.cos(stance.rpy[2]), np.sin(stance.rpy[2]), 0.0])
    drag = -stance.resistance * heading - np.array([0.0, 0.0, stance.weight])
    force, moment = drag.copy(), np.cross(stance.com, drag)
    for contact in stance.contacts:
        along = np.array(contact.rolling)
        along = along if along @ heading >= 0 else -along
        share = stance.traction_ratio * contact.load if stance.tractions[contact.wheel] else 0.0
        pull = np.array([0.0, 0.0, contact.load]) + share * along
        force += pull
        moment += np.cross(contact.point, pull)
    return force, moment, heading


@pytest.mark.parametrize("name", ["tracked", "polibot_half", "polibot"])
@pytest.mark.parametrize("force", [60.0, -40.0])
def test_a_resistance_is_the_difference_of_the_tensions(name, force):
    (rover,) = rovers(name)
    if name == "tracked":
        rover = tracked(driven=True)
    stance = rp.settle(rover, FLAT, resistance=force)
    assert stance.settled
    between = sum(stance.tight[t] - stance.tensions[t] for t in stance.tensions)
    assert between == pytest.approx(abs(force), abs=1e-6)
    assert stance.traction_ratio == pytest.approx(force / stance.weight, rel=1e-9)
    for wheel, traction in stance.tractions.items():
        assert traction == pytest.approx(stance.traction_ratio * stance.loads[wheel], abs=1e-9)
    total, moment, heading = balance_of(stance)
    np.testing.assert_allclose(total, 0.0, atol=1e-6)
    np.testing.assert_allclose(moment @ [-heading[1], heading[0], 0.0], 0.0, atol=1e-6)
    assert stance.residuals["equilibrium"] < 1e-9


@pytest.mark.parametrize("ground", ["slope:5", "rough:3,0.02,0.8"])
@pytest.mark.parametrize("name", ["rocker_bogie", "polibot_half"])
def test_external_forces_balance_against_a_resistance_on_uneven_ground(name, ground):
    """Along the heading, upwards, and about the axis across: by the whole rover's free body."""
    rover = rp.load(name)
    yaw = 0.0 if ground == "slope:5" else 0.4
    stance = rp.settle(rover, rp.Terrain.parse(ground), x=0.3, y=-0.2, yaw=yaw, resistance=50.0)
    assert stance.settled, stance.reason
    total, moment, heading = balance_of(stance)
    assert total @ heading == pytest.approx(0.0, abs=1e-5)
    assert total[2] == pytest.approx(0.0, abs=1e-5)
    if name == "rocker_bogie" or yaw:
        return  # the base's place is held sideways; a belt's contact lies beside its wheel's middle
    across = np.array([-heading[1], heading[0], 0.0])
    about = moment - np.cross(stance.position, total)
    assert about @ across == pytest.approx(0.0, abs=1e-4)


def test_a_resistance_that_no_wheel_of_a_track_can_overcome_is_refused():
    with pytest.raises(InputError) as found:
        rp.settle(tracked(), FLAT, resistance=10.0)
    assert "tracks.t: a track overcomes a resistance by one driven wheel; this one has 0" in str(found.value)


@pytest.mark.parametrize("force", [float("nan"), float("inf")])
def test_a_resistance_is_a_number(force):
    with pytest.raises(InputError, match="resistance: must be a finite number"):
        rp.settle(rp.load("polibot_half"), FLAT, resistance=force)


def test_a_half_model_leans_neither_way_on_a_side_slope():
    stance = rp.settle(rp.load("polibot_half"), rp.Terrain.slope(6, 90))
    assert stance.settled
    assert stance.rpy[0] == pytest.approx(0.0, abs=1e-12)
