"""Tracks and springs in the picture: where the model has them."""

import numpy as np
import pytest
from tracked_rover import tracked

import rover_pin as rp
from rover_pin.mechanism import Kinematics
from rover_pin.viz.colours import GRIP, STRONG, WEAK
from rover_pin.viz.inside import COIL, GRIPS, PROUD, THICK, WIRE, belt_points, belt_width, struts, tracks


def kinematics(stance):
    rover = stance.rover
    return Kinematics(rover.model, rover.model.createData(), np.array(stance.configuration))


def test_a_drawn_belt_lies_on_its_taut_way():
    rover = tracked()
    stance = rp.settle(rover, rp.Terrain.flat())
    at, track = kinematics(stance), rover.tracks[0]
    path = track.path(at)
    drawn = tracks(rover, stance.configuration, 1.0)
    axis = at.rotation(track.joint) @ track.axes[:, 2]
    across = (drawn.vertices - path[0]) @ axis
    assert np.ptp(across) == pytest.approx(belt_width(rover, track, 1.0))
    flat = drawn.vertices - across[:, None] * axis
    way = belt_points(track, at, 1e-3)
    away = np.linalg.norm(flat[:, None] - way[None], axis=2).min(axis=1)
    assert away.max() <= max(PROUD, THICK - PROUD) + 1e-3
    assert np.linalg.norm(np.diff(way, axis=0), axis=1).sum() == pytest.approx(
        track.wrap(at).length, rel=2e-3
    )


def test_a_belt_is_marked_where_it_lies_on_the_ground():
    rover = tracked()
    stance = rp.settle(rover, rp.Terrain.flat())
    drawn = tracks(rover, stance.configuration, 1.0, stance.terrain)
    marked = np.all(drawn.colours == GRIP, axis=1)
    assert 0 < marked.sum() < len(marked)
    assert drawn.vertices[marked, 2].max() < GRIPS + THICK
    bearing = [contact.point[0] for contact in stance.contacts if contact.load > 0]
    assert drawn.vertices[marked, 0].min() <= min(bearing) + 1e-9
    assert drawn.vertices[marked, 0].max() >= max(bearing) - 1e-9


def test_springs_go_from_end_to_end_and_tell_their_force_by_colour():
    rover = rp.load("polibot_half")
    stance = rp.settle(rover, rp.Terrain.flat())
    drawn = struts(rover, stance.configuration, 1.0)
    at = kinematics(stance)
    per = len(drawn.vertices) // len(rover.springs)
    forces = np.array([stance.springs[spring.name] for spring in rover.springs])
    for k, spring in enumerate(rover.springs):
        own = slice(k * per, (k + 1) * per)
        a, b = spring.first.origin(at), spring.second.origin(at)
        rings = drawn.vertices[own].reshape(-1, 7, 3)[:, :6].mean(axis=1)
        np.testing.assert_allclose(rings[[0, -1]], [a, b], atol=1e-9)
        along = (b - a) / np.linalg.norm(b - a)
        off = (drawn.vertices[own] - a) - np.outer((drawn.vertices[own] - a) @ along, along)
        assert np.linalg.norm(off, axis=1).max() == pytest.approx(COIL + WIRE, rel=0.02)
        share = forces[k] / forces.max()
        expected = np.array(WEAK) + share * (np.array(STRONG) - np.array(WEAK))
        np.testing.assert_allclose(drawn.colours[own][0], expected, atol=1e-6)
    assert not len(struts(rp.load("rocker_bogie"), rp.load("rocker_bogie").neutral, 1.0).faces)


def test_a_sliding_joints_coil_ends_at_its_body_and_shortens_with_it():
    rover = rp.load("x_suspension")
    lengths = []
    q = np.array(rover.neutral)
    for value in (0.0, 0.02):
        q[rover.column["slide_3"]] = value
        at = Kinematics(rover.model, rover.model.createData(), q.copy())
        joint = rover.model.getJointId("slide_3")
        drawn = struts(rover, q, 1.0)
        per = len(drawn.vertices) // len(rover.springs)
        place = [spring.joint for spring in rover.springs].index("slide_3")
        rings = drawn.vertices[place * per : (place + 1) * per].reshape(-1, 7, 3)[:, :6].mean(axis=1)
        np.testing.assert_allclose(rings[-1], at.origin(joint), atol=1e-9)
        lengths.append(np.linalg.norm(rings[0] - rings[-1]))
    assert abs(lengths[1] - lengths[0]) == pytest.approx(0.02, abs=1e-9)
