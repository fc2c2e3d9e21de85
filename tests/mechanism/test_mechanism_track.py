"""Tracks: a taut cable around circles, its derivatives, what leaves it, and what the sidecar may say."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize
from scipy.spatial import ConvexHull
from tracked_rover import tracked

from rover_pin.errors import SidecarError
from rover_pin.mechanism import Kinematics
from rover_pin.mechanism.cable import OFF, pulls, taut


def wrap(places, rho):
    count = len(rho)
    following, spans, turns = np.empty(count, dtype=np.int64), np.zeros((count, 3)), np.zeros(count)
    length = taut(np.array(places, dtype=float), np.array(rho, dtype=float), following, spans, turns)
    return length, following, spans, turns


def around(angles, radii):
    order = np.argsort(angles)
    return np.column_stack([np.cos(angles), np.sin(angles)])[order] * np.asarray(radii)[order, None]


circles = st.integers(3, 9).flatmap(
    lambda k: st.tuples(
        st.lists(st.floats(0.0, 6.28), min_size=k, max_size=k, unique=True),
        st.lists(st.floats(0.2, 1.0), min_size=k, max_size=k),
        st.floats(0.01, 0.4),
    )
)


@settings(max_examples=200, deadline=None, derandomize=True)
@given(circles)
def test_equal_circles_take_their_hulls_perimeter_and_one_circumference(drawn):
    angles, radii, r = drawn
    places = around(np.array(angles), radii)
    sorted_angles = np.sort(angles)
    gaps = np.diff(np.append(sorted_angles, sorted_angles[0] + 2 * np.pi))
    apart = min(np.linalg.norm(a - b) for i, a in enumerate(places) for b in places[:i])
    if gaps.max() > 3.0 or gaps.min() < 1e-3 or apart < 1e-3:
        return  # no loop around the middle
    length, following, *_ = wrap(places, [r] * len(places))
    hull = ConvexHull(places)
    assert length == pytest.approx(2 * np.pi * r + hull.area, abs=1e-12)
    outside = {i for i in range(len(places)) if following[i] == OFF}
    assert not outside & set(hull.vertices)


def test_circles_of_all_sizes_take_the_hull_of_their_points():
    generator = np.random.default_rng(4)
    turn = np.linspace(0.0, 2 * np.pi, 20_000, endpoint=False)
    ring = np.column_stack([np.cos(turn), np.sin(turn)])
    for _ in range(12):
        k = int(generator.integers(3, 7))
        places = around(np.arange(k) * 2 * np.pi / k, generator.uniform(0.8, 1.0, k))
        rho = generator.uniform(0.02, 0.35, k)
        hull = ConvexHull(np.concatenate([p + r * ring for p, r in zip(places, rho, strict=True)]))
        assert wrap(places, rho)[0] == pytest.approx(hull.area, abs=2e-7)


def test_an_outside_roller_pushes_the_cable_in():
    """Length by the closed form of crossed tangents: a roller of r between two of R on one line."""
    big, small, half, deep = 0.1, 0.05, 0.5, 0.08
    places = [(-half, 0.0), (0.0, -big + deep - small), (half, 0.0)]
    length, following, _, turns = wrap(places, [big, -small, big])
    down = big - deep + small  # from the line of centres to the roller's centre
    apart = np.hypot(half, down)
    tangent = np.sqrt(apart**2 - (big + small) ** 2)
    lean = np.arcsin((big + small) / apart) - np.arctan2(down, half)
    expected = 2 * tangent + 2 * half + 2 * small * lean + 2 * big * (np.pi + lean)
    assert list(following) == [1, 2, 0]
    assert length == pytest.approx(expected, abs=1e-12)
    assert turns[1] < 0.0
    assert wrap([(-half, 0.0), (0.0, -0.4), (half, 0.0)], [big, -small, big])[1][1] == OFF


def test_an_inside_and_an_outside_circle_that_overlap_leave_no_cable():
    assert np.isnan(wrap([(0, 0), (0.1, 0), (1, 0), (0.5, 1)], [0.1, -0.1, 0.1, 0.1])[0])


def test_two_circles_are_an_open_belt():
    """2 sqrt(C^2 - (R - r)^2) + R (pi + 2 a) + r (pi - 2 a), sin a = (R - r) / C."""
    length, _, _, turns = wrap([(0, 0), (1, 0)], [0.5, 0.1])
    a = np.arcsin(0.4)
    assert length == pytest.approx(
        2 * np.sqrt(1 - 0.16) + 0.5 * (np.pi + 2 * a) + 0.1 * (np.pi - 2 * a), abs=1e-12
    )
    assert turns[0] == pytest.approx(np.pi + 2 * a)


def test_pulls_are_minus_the_slope_of_the_length():
    generator = np.random.default_rng(8)
    places = around(np.arange(6) * 1.05, generator.uniform(0.7, 1.0, 6))
    rho = generator.uniform(0.02, 0.2, 6)
    _, following, spans, _ = wrap(places, rho)
    forces = np.empty((6, 2))
    pulls(following, spans, forces)
    for i in range(6):
        for k in range(2):
            sides = []
            for step in (1e-6, -1e-6):
                moved = places.copy()
                moved[i, k] += step
                sides.append(wrap(moved, rho)[0])
            assert forces[i, k] == pytest.approx(-(sides[0] - sides[1]) / 2e-6, abs=1e-6)
    np.testing.assert_allclose(forces.sum(axis=0), 0.0, atol=1e-14)


def poses(rover, count, seed):
    generator = np.random.default_rng(seed)
    for _ in range(count):
        yield generator.uniform(-0.15, 0.15, rover.model.nv)


def at(rover, q):
    return Kinematics(rover.model, rover.model.createData(), q)


def test_slack_gradient_and_curvature_against_differences():
    """Also that the base feels nothing of a cable, though its plane turns with it."""
    rover = tracked()
    (track,) = rover.tracks
    for q in poses(rover, 6, 2):
        here = at(rover, q)
        gradient, curvature = track.slack_gradient(here), np.zeros((rover.model.nv,) * 2)
        track.bend_slack(here, 1.0, curvature)
        for j in range(rover.model.nv):
            step = np.zeros(rover.model.nv)
            step[j] = 1e-6
            up, down = at(rover, q + step), at(rover, q - step)
            assert gradient[j] == pytest.approx((track.slack(up) - track.slack(down)) / 2e-6, abs=1e-6)
            slope = (track.slack_gradient(up) - track.slack_gradient(down)) / 2e-6
            np.testing.assert_allclose(-curvature[:, j], slope, atol=2e-6)
        np.testing.assert_allclose(gradient[:6], 0.0, atol=1e-14)


def test_a_track_is_the_shortest_closed_polygon_around_its_wheels():
    """Its drawn path, against points moved by another solver: no shorter way around all circles."""
    rover = tracked()
    (track,) = rover.tracks
    here = at(rover, np.array(rover.neutral))
    path = track.path(here)
    drawn = np.linalg.norm(np.diff(path, axis=0), axis=1).sum()
    length = track.length - track.slack(here)
    assert drawn == pytest.approx(length, rel=2e-3)
    assert drawn < length
    wrapped = track.wrap(here)
    flat = wrapped.centers @ wrapped.plane[:, :2]
    rho = wrapped.rho

    def perimeter(heights):
        """Length of the hull's support polygon in 720 directions: any loop around the circles is as long."""
        turn = np.linspace(0, 2 * np.pi, 720, endpoint=False)
        support = np.max(flat @ np.array([np.cos(turn), np.sin(turn)]) + rho[:, None], axis=0)
        return float(np.mean(support + heights) * 2 * np.pi)

    best = minimize(lambda h: perimeter(h[0] ** 2), [0.1])
    assert best.fun == pytest.approx(length, rel=1e-4)


@pytest.mark.parametrize(
    ("track", "said"),
    [
        ({"wheels": ["w1", "w9"]}, "no wheel of that name"),
        ({"wheels": ["w1", "w2", "w1"]}, "the wheel stands twice"),
        ({"wheels": ["w1", "w3", "w2", "w4"]}, "its wheels are not in order around the loop"),
        (
            {"wheels": ["w1", "w2", {"frame": "arm_f_link", "center": [0.2, 0, 0.02], "radius": 0.01}]},
            "arm_f_link is swallowed by w2: it lies inside its circle",
        ),
        (
            {"wheels": ["w1", "w2", {"frame": "arm_m_link", "axis": [1, 0, 0], "radius": 0.05}]},
            "does not lie in the plane",
        ),
        ({"wheels": ["w1", {"frame": "base_link", "axis": [0, 0, 0], "radius": 0.05}]}, "`axis` is zero"),
        ({"wheels": ["w1", "w2", {"wheel": "w3", "side": "left"}]}, "not one of its words (got 'left')"),
        (
            {"wheels": ["w1", "w2", {"wheel": "w2b", "side": "outside", "radius": 0.13}]},
            "overlap, with the cable between them",
        ),
    ],
)
def test_a_track_that_says_nothing_sensible_is_refused(track, said):
    with pytest.raises(SidecarError) as found:
        tracked(track={"name": "t", "length": 3.0, **track})
    assert said in str(found.value)
    assert "tracks" in str(found.value)


def test_a_joint_that_moves_a_wheel_out_of_the_plane_is_named():
    with pytest.raises(SidecarError, match=r"a joint moves w2 out of the plane of w1.*arm_f"):
        tracked(arm_axis=(1.0, 0.0, 0.0))


def test_wheels_beside_the_plane_are_moved_into_it():
    """A wheel farther out along its axis wraps alike."""
    here, there = tracked(), tracked(beside=0.03)
    for q in poses(here, 3, 5):
        assert here.tracks[0].slack(at(here, q)) == pytest.approx(
            there.tracks[0].slack(at(there, q)), abs=1e-14
        )
