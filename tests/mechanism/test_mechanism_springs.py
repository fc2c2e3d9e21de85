"""Springs: force against energy, stops, and what the sidecar may say."""

import numpy as np
import pytest
from little_rover import fixture
from pydantic import ValidationError
from scipy.spatial.transform import Rotation

from rover_pin.errors import MechanismError, SidecarError
from rover_pin.mechanism import FrameSpec, FrameSpringSpec, JointSpring, JointSpringSpec, Kinematics


def at(rover, q):
    return Kinematics(rover.model, rover.model.createData(), q)


def gradient(function, q, step=1e-6):
    slopes = np.zeros(len(q))
    for j in range(len(q)):
        up, down = q.copy(), q.copy()
        up[j] += step
        down[j] -= step
        slopes[j] = (function(up) - function(down)) / (2 * step)
    return slopes


def springs_of(name):
    return [(name, spring.name) for spring in fixture(name).springs]


@pytest.mark.parametrize(("name", "spring"), springs_of("trailing4") + springs_of("sprung4"))
def test_force_is_minus_the_slope_of_the_energy(name, spring):
    rover = fixture(name)
    element = next(s for s in rover.springs if s.name == spring)
    generator = np.random.default_rng(3)
    for _ in range(5):
        q = generator.uniform(-0.8, 0.8, rover.model.nv)
        expected = -gradient(lambda p: element.energy(at(rover, p)), q)
        np.testing.assert_allclose(
            element.force(at(rover, q)), expected, atol=1e-6 * max(1, np.abs(expected).max())
        )


def test_joint_spring_is_preload_less_stiffness_times_travel():
    rover = fixture("trailing4")
    spec = JointSpringSpec(name="s", joint="arm_fl", stiffness=40, rest=0.1, preload=2)
    spring = spec.resolve(rover.column)
    q = np.zeros(rover.model.nv)
    q[rover.column["arm_fl"]] = 0.35
    here = at(rover, q)
    assert spring.effort(here) == pytest.approx(2 - 40 * 0.25)
    force = spring.force(here)
    assert force[rover.column["arm_fl"]] == pytest.approx(-8.0)
    assert np.count_nonzero(force) == 1
    assert isinstance(spring, JointSpring)
    assert not hasattr(spring, "slack")


def test_frame_spring_pushes_its_ends_apart():
    """Generalised force against the two end forces, moved to the joints by finite differences of the ends."""
    rover = fixture("trailing4")
    spring = next(s for s in rover.springs if s.name == "strut_l")
    q = np.random.default_rng(4).uniform(-0.5, 0.5, rover.model.nv)
    here = at(rover, q)
    one, other = spring.first.origin(here).copy(), spring.second.origin(here).copy()
    length = np.linalg.norm(other - one)
    push = 60 + 6000 * (0.36 - length)
    assert spring.effort(here) == pytest.approx(push, rel=1e-12)
    assert spring.length(here) == pytest.approx(length, rel=1e-14)
    along = (other - one) / length
    work = gradient(lambda p: push * along @ spring.second.origin(at(rover, p)), q)
    work -= gradient(lambda p: push * along @ spring.first.origin(at(rover, p)), q)
    np.testing.assert_allclose(spring.force(here), work, atol=1e-5)


def test_frame_spring_has_its_stop_at_length_max():
    rover = fixture("trailing4")
    spring = next(s for s in rover.springs if s.name == "strut_r")
    generator = np.random.default_rng(6)
    for _ in range(3):
        q = generator.uniform(-0.5, 0.5, rover.model.nv)
        here = at(rover, q)
        assert spring.slack(here) == pytest.approx(0.36 - spring.length(here), abs=1e-15)
        expected = gradient(lambda p: spring.slack(at(rover, p)), q)
        np.testing.assert_allclose(spring.slack_gradient(here), expected, atol=1e-7)
    # at its full length it pushes with its preload
    q = np.zeros(rover.model.nv)
    column = rover.column["arm_br"]
    low, high = -0.5, 0.9
    for _ in range(100):
        q[column] = (low + high) / 2
        slack = spring.slack(at(rover, q))
        if (spring.slack(at(rover, np.where(np.arange(len(q)) == column, high, q))) > 0) == (slack > 0):
            high = q[column]
        else:
            low = q[column]
    assert spring.slack(at(rover, q)) == pytest.approx(0.0, abs=1e-9)
    assert spring.effort(at(rover, q)) == pytest.approx(60.0, abs=1e-5)


def test_springs_do_no_work_on_the_rover_as_a_whole():
    """No net force, no net moment: the rows of the base vanish."""
    rover = fixture("trailing4")
    q = np.random.default_rng(9).uniform(-0.5, 0.5, rover.model.nv)
    for spring in rover.springs:
        np.testing.assert_allclose(spring.force(at(rover, q))[:6], 0.0, atol=1e-9)


def test_springs_do_not_feel_where_the_base_is():
    rover = fixture("trailing4")
    q = np.random.default_rng(10).uniform(-0.5, 0.5, rover.model.nv)
    moved = q.copy()
    moved[:3] = [3, -2, 1]
    yaw, pitch, roll = Rotation.random(random_state=3).as_euler("ZYX")
    moved[3:6] = yaw, pitch, roll
    for spring in rover.springs:
        assert spring.energy(at(rover, q)) == pytest.approx(spring.energy(at(rover, moved)), rel=1e-10)
        assert spring.effort(at(rover, q)) == pytest.approx(spring.effort(at(rover, moved)), rel=1e-10)


def test_a_spring_whose_ends_coincide_has_no_direction():
    rover = fixture("turnbuckle")
    frames = (FrameSpec(link="base_link", xyz=(0, 0.4, 0)), FrameSpec(link="rocker_link_l"))
    spring = FrameSpringSpec(name="s", frames=frames, stiffness=10, length_max=0.2).resolve(rover.model)
    with pytest.raises(MechanismError, match=r"springs\.s: the spring's ends coincide.*move one of"):
        spring.force(at(rover, np.zeros(rover.model.nv)))


@pytest.mark.parametrize(
    ("spec", "fields", "message"),
    [
        (JointSpringSpec, {"stiffness": -1}, "greater than or equal to 0"),
        (JointSpringSpec, {"stiffness": float("inf")}, "finite"),
        (JointSpringSpec, {"preload": float("nan")}, "finite"),
        (JointSpringSpec, {"rest": float("nan")}, "finite"),
        (JointSpringSpec, {"length_max": 0.2}, "Extra inputs"),
        (FrameSpringSpec, {"length_max": 0}, "greater than 0"),
        (FrameSpringSpec, {"rest": 0.1}, "Extra inputs"),
    ],
)
def test_a_spring_that_says_nothing_sensible_is_refused(spec, fields, message):
    whole = {"name": "s", "stiffness": 10}
    whole |= {"joint": "a"} if spec is JointSpringSpec else {"frames": ("a", "b"), "length_max": 0.2}
    with pytest.raises(ValidationError, match=message):
        spec(**{**whole, **fields})


def test_unknown_joint_and_frame_name_the_nearest():
    rover = fixture("trailing4")
    with pytest.raises(SidecarError) as caught:
        JointSpringSpec(name="s", joint="arm_f", stiffness=1).resolve(rover.column, file="a.yaml")
    assert "a.yaml: springs.s: no moving joint of this name (got 'arm_f'); did you mean" in str(caught.value)
    assert "'arm_fl'" in str(caught.value)
    spec = FrameSpringSpec(name="s", frames=("base_lnk", "arm_link_bl"), stiffness=1, length_max=1)
    with pytest.raises(SidecarError, match=r"springs\.s: no link or joint of this name.*'base_link'"):
        spec.resolve(rover.model)


def test_both_ends_on_one_body_is_refused():
    spec = FrameSpringSpec(name="s", frames=("arm_bl", "arm_link_bl"), stiffness=1, length_max=1)
    with pytest.raises(SidecarError, match=r"springs\.s: both ends sit on one body.*name frames on"):
        spec.resolve(fixture("trailing4").model)
