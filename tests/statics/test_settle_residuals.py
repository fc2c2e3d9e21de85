"""Residuals see what is wrong: a pose or a load that is off shows up by its size."""

import dataclasses
import math

import numpy as np
import pytest
import recheck
from little_rover import fixture

import rover_pin as rp
from rover_pin.mechanism import Kinematics
from rover_pin.statics import residuals
from rover_pin.statics.held import free_coordinates, held_joints

ROUGH = rp.Terrain.rough(2, 0.03, 0.8)


@pytest.fixture(scope="module")
def stance():
    found = rp.settle(fixture("thirds"), ROUGH, x=0.5, y=0.2, yaw=0.4)
    assert found.settled, found.reason
    assert not found.stops
    return found


def free_motions(stance):
    held = held_joints(stance.rover, stance.locked)
    x, y, _ = stance.position
    return free_coordinates(stance.rover, held, stance.joints, x, y, stance.rpy[2]).basis


def at(rover, q):
    return Kinematics(rover.model, rover.model.createData(), np.array(q))


def gap_at(stance, q, contacts):
    return residuals.gap(stance.rover, at(stance.rover, q), ROUGH, contacts)


def closure(rover, q):
    return residuals.closure(rover, at(rover, q))


def equilibrium(stance, contacts=None):
    rover = stance.rover
    return residuals.equilibrium(
        rover,
        at(rover, stance.configuration),
        free_motions(stance),
        stance.contacts if contacts is None else contacts,
        np.zeros(rover.model.nv),
        stance.gravity,
    )


def moved(stance, column, by):
    q = np.array(stance.configuration)
    q[stance.rover.column[column]] += by
    return q


def test_recomputed_here_they_are_what_the_stance_says(stance):
    assert equilibrium(stance) == pytest.approx(stance.residuals["equilibrium"], abs=1e-12)
    assert equilibrium(stance) < 1e-9
    gap = gap_at(stance, stance.configuration, stance.contacts)
    assert gap == pytest.approx(stance.residuals["gap_m"], abs=1e-12)
    assert gap < 1e-9


def test_a_load_that_is_off_unbalances(stance):
    for i, contact in enumerate(stance.contacts):
        contacts = list(stance.contacts)
        contacts[i] = dataclasses.replace(contact, load=contact.load + 0.01 * stance.weight)
        assert equilibrium(stance, contacts) == pytest.approx(0.01, rel=0.2)


def test_a_load_shifted_between_wheels_unbalances_a_moment(stance):
    """Fore and aft of a bogie: no net force, but its joint's row."""
    by = {c.wheel: i for i, c in enumerate(stance.contacts)}
    contacts = list(stance.contacts)
    for wheel, sign in (("ml", 1), ("bl", -1)):
        old = contacts[by[wheel]]
        contacts[by[wheel]] = dataclasses.replace(old, load=old.load + sign * 0.01 * stance.weight)
    assert equilibrium(stance, contacts) > 0.01 * 0.5 / stance.rover.wheel_span


def test_a_point_that_is_off_unbalances(stance):
    contacts = list(stance.contacts)
    contacts[0] = dataclasses.replace(contacts[0], point=contacts[0].point + np.array([0.05, 0, 0]))
    share = contacts[0].load / stance.weight * 0.05 / stance.rover.wheel_span
    assert equilibrium(stance, contacts) > 0.3 * share


@pytest.mark.parametrize("column", ["base_z", "base_pitch", "base_roll", "bogie_l"])
@pytest.mark.parametrize("by", [1e-4, -1e-4])
def test_a_pose_that_is_off_opens_or_closes_gaps(stance, column, by):
    gap = gap_at(stance, moved(stance, column, by), stance.contacts)
    assert gap > 2e-5


def test_a_wheel_that_sinks_without_a_contact_is_seen(stance):
    """The contacts are left out: only the dense look at the rings is left."""
    sunk = moved(stance, "base_z", -1e-3)
    assert gap_at(stance, sunk, ()) > 5e-4
    assert gap_at(stance, stance.configuration, ()) < 1e-9


def test_a_contact_off_the_surface_is_seen(stance):
    contact = stance.contacts[0]
    for shift in ([0, 0, 1e-3], [1e-2, 0, 0]):
        wrong = (dataclasses.replace(contact, point=contact.point + shift),)
        assert gap_at(stance, stance.configuration, wrong) > 2e-4


def test_an_open_coupling_and_an_open_loop_are_seen(stance):
    assert closure(stance.rover, stance.configuration) < 1e-12
    open_coupling = moved(stance, "rocker_l", 1e-3)
    assert closure(stance.rover, open_coupling) == pytest.approx(1e-3, rel=1e-6)
    built = rp.settle(fixture("turnbuckle"), ROUGH, x=0.5, y=0.2)
    assert built.settled, built.reason
    assert closure(built.rover, built.configuration) < 1e-9
    assert closure(built.rover, moved(built, "bar", 1e-3)) > 1e-4


NONE = np.zeros(0)


def test_complementarity_is_seen(stance):
    contact = stance.contacts[0]
    weight = stance.weight
    hovering = dataclasses.replace(contact, gap=1e-3)
    found = residuals.complementarity([hovering], stance.gaps, NONE, NONE, weight)
    assert found == pytest.approx(contact.load * 1e-3 / weight, rel=1e-9)
    pulling = dataclasses.replace(contact, load=-0.02 * weight, gap=0.0)
    assert residuals.complementarity([pulling], stance.gaps, NONE, NONE, weight) == pytest.approx(0.02)
    assert residuals.complementarity([], {"fl": -1e-3}, NONE, NONE, weight) == pytest.approx(1e-3)
    stopped = np.array([2.0 * weight]), np.array([1e-3])
    assert residuals.complementarity([], {}, *stopped, weight) == pytest.approx(2e-3)
    assert residuals.complementarity(stance.contacts, stance.gaps, NONE, NONE, weight) < 1e-9


def test_gravity_of_another_world_unbalances(stance):
    rover = stance.rover
    off = residuals.equilibrium(
        rover,
        at(rover, stance.configuration),
        free_motions(stance),
        stance.contacts,
        np.zeros(rover.model.nv),
        1.62,
    )
    assert off > 1.0


def test_a_spring_left_out_is_seen():
    stance = rp.settle(fixture("sprung4"), rp.Terrain.flat())
    assert equilibrium(stance) < 1e-9
    soft = dataclasses.replace(stance.rover, springs=stance.rover.springs[1:])
    off = residuals.equilibrium(
        soft,
        at(soft, stance.configuration),
        free_motions(stance),
        stance.contacts,
        np.zeros(soft.model.nv),
        9.81,
    )
    assert off == pytest.approx(40 / 4 / 50, rel=1e-6)


def test_the_equilibrium_rows_are_those_of_virtual_work(stance):
    """Power of weight and loads along any free motion vanishes: finite differences of heights."""
    rover, q = stance.rover, np.array(stance.configuration)
    import pinocchio as pin

    data = rover.model.createData()
    basis = free_motions(stance)
    generator = np.random.default_rng(0)
    for _ in range(5):
        way = basis @ generator.normal(0, 1, basis.shape[1])

        def height(t, contact=None, way=way):
            p = q + t * way
            if contact is None:
                return pin.centerOfMass(rover.model, data, p)[2]
            pin.forwardKinematics(rover.model, data, q)
            local = data.oMi[contact.joint].actInv(np.array(contact.point))
            pin.forwardKinematics(rover.model, data, p)
            return data.oMi[contact.joint].act(local)[2]

        step = 1e-6
        power = -stance.weight * (height(step) - height(-step)) / (2 * step)
        for contact in stance.contacts:
            power += contact.load * (height(step, contact) - height(-step, contact)) / (2 * step)
        assert power == pytest.approx(0.0, abs=1e-5 * stance.weight)


def test_no_settled_stance_hides_a_residual():
    """What residuals refute is not settled: slopes, steps, bumps, any rover."""
    grounds = [rp.Terrain.rough(3, 0.06, 0.6), rp.Terrain.step(0.08, 0.5), rp.Terrain.slope(20, 30)]
    generator = np.random.default_rng(4)
    for name in ("thirds", "rigid4", "four_bar", "caster3", "bogie_min"):
        for ground in grounds:
            for _ in range(2):
                x, y = generator.uniform(-0.5, 0.5, 2)
                found = rp.settle(fixture(name), ground, x=x, y=y, yaw=generator.uniform(-math.pi, math.pi))
                if found.settled:
                    assert found.residuals["gap_m"] < 1e-6, (name, ground, x, y)
                    assert found.residuals["equilibrium"] < 1e-6, (name, ground, x, y)
                    assert found.residuals["loop_m"] < 1e-6
                    assert found.residuals["complementarity"] < 1e-6


def test_a_node_in_a_tread_shows():
    """On a bilinear map a node that stands 0.1 mm inside a tread is seen, wherever under it."""
    rover = fixture("thirds")
    nodes = rp.Terrain.rough(5, 0.02, 0.8, size=6.0, spacing=0.01, interpolation="linear")
    found = rp.settle(rover, nodes, x=0.1, y=0.2, yaw=0.3)
    assert found.settled, found.reason
    here = at(rover, found.configuration)
    assert residuals.gap(rover, here, nodes, found.contacts) < 1e-6
    wheel = rover.shapes[0]
    center = here.point(wheel.joint, wheel.center)
    axis = here.rotation(wheel.joint) @ wheel.axis
    (x0, y0), pitch = nodes.params[2:4], nodes.spacing
    rows, columns = nodes.table.shape
    x, y = x0 + pitch * np.arange(columns), y0 + pitch * np.arange(rows)
    heights = nodes.height(x, y[:, None])
    i, j = round((center[1] - y0) / pitch), round((center[0] - x0) / pitch)
    tried = 0
    for row, column in [(i + a, j + b) for a in range(-6, 7, 3) for b in range(-6, 7, 3)]:
        level = np.linspace(heights[row, column], center[2], 20000)
        away = np.stack([np.full(20000, x[column]), np.full(20000, y[row]), level], axis=1) - center
        along = away @ axis
        across = np.linalg.norm(away - along[:, None] * axis, axis=1)
        inside = np.flatnonzero(wheel.tread - np.hypot(along, across - wheel.ring) > 1e-4)
        if inside.size == 0:
            continue
        tried += 1
        spiked = heights.copy()
        spiked[row, column] = level[inside[0]]
        with_node = rp.Terrain.from_grid(spiked, pitch, origin=(x0, y0), interpolation="linear")
        assert residuals.gap(rover, here, with_node, []) >= 1e-4
    assert tried >= 8


def test_a_stance_on_jagged_ground_holds_for_an_independent_look():
    """A node between the coarse look's samples once left a wheel 0.16 mm in the ground."""
    rough = rp.Terrain.rough(2, 0.1113632324418493, 0.43620415281284786, interpolation="linear")
    place = {"x": 0.8955527539839441, "y": -2.079048147249564, "yaw": -0.8445661862581462}
    found = rp.settle(fixture("rigid4"), rough, **place)
    assert found.settled
    assert max(recheck.residuals(found)) < 1e-8
