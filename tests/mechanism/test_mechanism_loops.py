"""Loops: rows against finite differences, what each type closes, `at: zero`, and what the sidecar may say."""

import numpy as np
import pinocchio as pin
import pytest
from little_rover import fixture
from pydantic import ValidationError

import rover_pin as rp
from rover_pin.errors import SidecarError
from rover_pin.mechanism import FrameSpec, Kinematics, LoopSpec

TYPES = ("ball", "hinge", "planar", "weld", "distance")
BUNDLED = ("rocker_bogie", "hit_mrii")
ROVERS = ("turnbuckle", "four_bar", "sprung4", "trailing4", *BUNDLED)


def named(name):
    return rp.load(name) if name in BUNDLED else fixture(name)


def random_q(rover, generator, size=1.0):
    """Any configuration: pitch away from the ZYX singularity, joints beyond their limits too."""
    return generator.uniform(-size, size, rover.model.nv)


def random_loop(rover, kind, generator, **more):
    """Two frames at random places of two random bodies that move against each other."""
    links = [f.name for f in rover.model.frames if f.type == pin.FrameType.BODY]
    while True:
        first, second = generator.choice(links, 2, replace=False)
        frames = [
            FrameSpec(
                link=str(link), xyz=tuple(generator.normal(0, 0.3, 3)), rpy=tuple(generator.normal(0, 1, 3))
            )
            for link in (first, second)
        ]
        axis = tuple(generator.normal(0, 1, 3)) if kind in ("hinge", "planar") else None
        if kind == "distance":
            more = {"length": 0.37, **more}
        spec = LoopSpec(name="loop", frames=tuple(frames), type=kind, axis=axis, **more)
        try:
            return spec.resolve(rover.model)
        except SidecarError:  # both frames on one body
            continue


def at(rover, q):
    return Kinematics(rover.model, rover.model.createData(), q)


def differences(function, q, step=1e-6):
    """(rows, nv) central differences."""
    columns = []
    for j in range(len(q)):
        up, down = q.copy(), q.copy()
        up[j] += step
        down[j] -= step
        columns.append((np.atleast_1d(function(up)) - np.atleast_1d(function(down))) / (2 * step))
    return np.column_stack(columns)


@pytest.mark.parametrize("kind", TYPES)
@pytest.mark.parametrize("name", ROVERS)
def test_jacobian_is_the_derivative_of_the_residual(name, kind):
    rover = named(name)
    generator = np.random.default_rng(TYPES.index(kind) + 10 * ROVERS.index(name))
    for _ in range(4):
        loop = random_loop(rover, kind, generator)
        q = random_q(rover, generator)
        expected = differences(lambda p, loop=loop: loop.residual(at(rover, p)), q)
        np.testing.assert_allclose(
            loop.jacobian(at(rover, q)), expected, atol=1e-6 * max(1, np.abs(expected).max())
        )
        assert loop.residual(at(rover, q)).shape == (loop.size,)


@pytest.mark.parametrize("kind", TYPES)
def test_jacobian_at_zero_offset(kind):
    rover = fixture("turnbuckle")
    generator = np.random.default_rng(TYPES.index(kind))
    loop = random_loop(rover, kind, generator, **({"length": None} if kind == "distance" else {}), at="zero")
    q = random_q(rover, generator)
    expected = differences(lambda p: loop.residual(at(rover, p)), q)
    np.testing.assert_allclose(loop.jacobian(at(rover, q)), expected, atol=1e-6)


@pytest.mark.parametrize("kind", TYPES)
def test_at_zero_is_closed_at_zero_wherever_the_base_stands(kind):
    rover = fixture("four_bar")
    generator = np.random.default_rng(5)
    loop = random_loop(rover, kind, generator, **({"length": None} if kind == "distance" else {}), at="zero")
    q = np.zeros(rover.model.nv)
    np.testing.assert_allclose(loop.residual(at(rover, q)), 0.0, atol=1e-12)
    q[:6] = generator.normal(0, 1, 6)
    np.testing.assert_allclose(loop.residual(at(rover, q)), 0.0, atol=1e-12)
    q[6:] = 0.3 * generator.normal(0, 1, len(q) - 6)
    assert np.max(np.abs(loop.residual(at(rover, q)))) > 1e-3


@pytest.mark.parametrize("kind", TYPES)
def test_the_base_moves_no_loop(kind):
    """Loops are internal: their forces do no work on the rover as a whole."""
    rover = fixture("turnbuckle")
    generator = np.random.default_rng(17)
    loop = random_loop(rover, kind, generator)
    q = random_q(rover, generator)
    if kind == "ball":  # its rows stand along world axes: they turn with the base unless closed
        q = _closed(loop, rover, q)
    np.testing.assert_allclose(loop.jacobian(at(rover, q))[:, :3], 0.0, atol=1e-12)
    if kind in ("planar", "distance"):
        np.testing.assert_allclose(loop.jacobian(at(rover, q))[:, 3:6], 0.0, atol=1e-9)


def _closed(loop, rover, q):
    for _ in range(60):
        step = np.linalg.lstsq(loop.jacobian(at(rover, q)), -loop.residual(at(rover, q)), rcond=1e-8)[0]
        q = q + step * min(1.0, 0.3 / max(np.abs(step).max(), 1e-12))
    return q


def test_what_each_type_leaves_free():
    """Second frame placed by hand against the first: which displacements leave the residual at zero."""
    rover = fixture("turnbuckle")
    zero = at(rover, np.zeros(rover.model.nv))
    moves = {
        "none": (np.zeros(3), np.zeros(3)),
        "along": (np.array([0, 0.1, 0]), np.zeros(3)),
        "across": (np.array([0.1, 0, 0]), np.zeros(3)),
        "turn_about": (np.zeros(3), np.array([0, 0.2, 0])),
        "turn_off": (np.zeros(3), np.array([0.2, 0, 0])),
    }
    allowed = {
        "ball": {"none", "turn_about", "turn_off"},
        "hinge": {"none", "turn_about"},
        "planar": {"none", "along", "turn_about", "turn_off"},
        "weld": {"none"},
    }
    first = FrameSpec(link="rocker_link_l").resolve(rover.model)
    for kind, free in allowed.items():
        for move, (shift, turn) in moves.items():
            origin = first.origin(zero) + first.axes(zero) @ shift
            axes = first.axes(zero) @ pin.exp3(turn)
            body = FrameSpec(link="rocker_link_r").resolve(rover.model)
            local = body.axes(zero).T @ (origin - body.origin(zero))
            rpy = pin.rpy.matrixToRpy(body.axes(zero).T @ axes)
            frames = ("rocker_link_l", FrameSpec(link="rocker_link_r", xyz=tuple(local), rpy=tuple(rpy)))
            axis = (0.0, 1.0, 0.0) if kind in ("hinge", "planar") else None
            loop = LoopSpec(name="l", frames=frames, type=kind, axis=axis).resolve(rover.model)
            closed = bool(np.max(np.abs(loop.residual(zero))) < 1e-9)
            assert closed is (move in free), (kind, move)


def test_a_weld_turned_half_round_is_open():
    """The skew part of a half turn is zero, and yet the frames do not meet."""
    rover = fixture("turnbuckle")
    zero = at(rover, np.zeros(rover.model.nv))
    frames = (
        FrameSpec(link="rocker_link_l", xyz=(0, -0.4, 0)),
        FrameSpec(link="rocker_link_r", xyz=(0, 0.4, 0), rpy=(np.pi, 0, 0)),
    )
    loop = LoopSpec(name="w", frames=frames, type="weld").resolve(rover.model)
    assert np.max(np.abs(loop.residual(zero))) > 0.1


def test_distance_is_a_distance():
    rover = fixture("four_bar")
    generator = np.random.default_rng(2)
    loop = random_loop(rover, "distance", generator)
    q = random_q(rover, generator)
    here = at(rover, q)
    apart = np.linalg.norm(loop.first.origin(here) - loop.second.origin(here))
    assert loop.residual(here)[0] == pytest.approx(apart - 0.37, abs=1e-14)


def test_frames_by_link_by_joint_and_by_place():
    rover = fixture("turnbuckle")
    here = at(rover, np.zeros(rover.model.nv))
    link = FrameSpec(link="rocker_link_l").resolve(rover.model)
    joint = FrameSpec(link="rocker_l").resolve(rover.model)
    np.testing.assert_allclose(link.origin(here), [0, 0.4, 0], atol=1e-12)
    np.testing.assert_allclose(joint.origin(here), [0, 0.4, 0], atol=1e-12)
    place = FrameSpec(link="rocker_link_l", xyz=(0.1, 0.2, 0.3), rpy=(0, 0, np.pi / 2)).resolve(rover.model)
    np.testing.assert_allclose(place.origin(here), [0.1, 0.6, 0.3], atol=1e-12)
    np.testing.assert_allclose(place.axes(here)[:, 0], [0, 1, 0], atol=1e-12)


def test_a_frames_jacobian_is_the_derivative_of_its_origin():
    rover = rp.load("hit_mrii")
    generator = np.random.default_rng(8)
    frame = FrameSpec(link="LB_wheel", xyz=(0.1, -0.2, 0.3)).resolve(rover.model)
    q = random_q(rover, generator)
    expected = differences(lambda p: frame.origin(at(rover, p)), q)
    np.testing.assert_allclose(frame.jacobian(at(rover, q))[:3], expected, atol=1e-7)


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"type": "hinge"}, "a hinge loop needs `axis`"),
        ({"type": "planar"}, "a planar loop needs `axis`"),
        ({"type": "ball", "axis": (0, 1, 0)}, "a ball loop has no `axis`"),
        ({"type": "hinge", "axis": (0, 0, 0)}, "`axis` is zero"),
        ({"type": "distance"}, "a distance loop needs `length`"),
        ({"type": "weld", "length": 0.3}, "a weld loop has no `length`"),
        ({"type": "distance", "length": 0.0}, "greater than 0"),
        ({"type": "distance", "length": float("nan")}, "finite"),
        ({"type": "rope"}, "'ball', 'hinge', 'planar', 'weld', 'distance' or 'level'"),
        ({"at": "home"}, "'zero'"),
        ({"tolerance": 0.0}, "greater than 0"),
        ({"frames": ("a",)}, "frames"),
        (
            {"frames": (FrameSpec(link="a"), {"link": "b", "xyz": (0, 0, float("inf"))})},
            "must be finite",
        ),
        ({"colour": 1}, "Extra inputs"),
    ],
)
def test_a_loop_that_says_nothing_sensible_is_refused(fields, message):
    with pytest.raises(ValidationError, match=message):
        LoopSpec(**{"name": "l", "frames": ("a", "b"), **fields})


def test_a_distance_at_zero_with_a_length_is_refused():
    """Either the distance found at zero or the one stated."""
    with pytest.raises(ValidationError):
        LoopSpec(name="l", frames=("a", "b"), type="distance", length=0.4, at="zero")


def test_unknown_frame_names_the_nearest():
    spec = LoopSpec(name="left", frames=("rocker_lnk_l", "bar_link"), type="ball")
    with pytest.raises(SidecarError) as caught:
        spec.resolve(fixture("turnbuckle").model, file="rover.yaml")
    text = str(caught.value)
    assert text.startswith(
        "rover.yaml: loops.left: no link or joint of this name (got 'rocker_lnk_l'); did you mean"
    )
    assert "'rocker_link_l'" in text


def test_a_loop_within_one_body_is_refused():
    frames = ("bar_link", FrameSpec(link="bar", xyz=(0, 0.4, 0)))
    with pytest.raises(SidecarError, match=r"loops\.l: both frames .*'bar_link, bar'\); name frames"):
        LoopSpec(name="l", frames=frames, type="ball").resolve(fixture("turnbuckle").model)
