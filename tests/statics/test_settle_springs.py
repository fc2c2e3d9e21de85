"""Suspensions with springs and stops: forces by hand, droop, collapse."""

import math

import numpy as np
import pytest
import yaml
from little_rover import FIXTURES, fixture

import rover_pin as rp

FLAT = rp.Terrain.flat()
K = 4000.0
BODY = 40 * 9.81


def posts(**heights):
    """Level ground of another height in each quadrant, steps far from every wheel."""
    fl, fr, bl, br = (heights.get(name, 0.0) for name in ("fl", "fr", "bl", "br"))
    at = np.arange(-2.0, 2.05, 0.1)
    front, left = at[None, :] > 0.15, at[:, None] > 0.15
    nodes = np.where(front, np.where(left, fl, fr), np.where(left, bl, br))
    return rp.Terrain.from_grid(nodes, 0.1, (-2.0, -2.0), "linear")


def unsprung(tmp_path, **keys):
    """sprung4 without its springs."""
    sidecar = yaml.safe_load((FIXTURES / "sprung4" / "rover.yaml").read_text())
    sidecar.pop("springs")
    path = tmp_path / "rover.yaml"
    path.write_text(yaml.safe_dump({**sidecar, **keys}))
    return rp.load(FIXTURES / "sprung4" / "sprung4.urdf", sidecar=path)


def test_springs_carry_the_body():
    stance = rp.settle(fixture("sprung4"), FLAT)
    assert stance.settled
    for name, force in stance.springs.items():
        slide = stance.joints[name.replace("spring", "slide")]
        assert force == pytest.approx(-K * slide, abs=1e-9)
        assert slide == pytest.approx(BODY / 4 / K, abs=1e-9)
    for load in stance.loads.values():
        assert load == pytest.approx(50 * 9.81 / 4, abs=1e-7)
    assert not stance.stops
    assert stance.redundant == 0


@pytest.mark.parametrize("h", [0.005, 0.02, -0.015])
def test_twist_is_taken_by_springs_alone(h):
    """Diagonal posts +-h: the body stays level, every slide moves by its post's height."""
    stance = rp.settle(fixture("sprung4"), posts(fl=h, br=h, fr=-h, bl=-h))
    assert stance.settled, stance.reason
    np.testing.assert_allclose(stance.rpy, 0.0, atol=1e-8)
    for wheel, sign in (("fl", 1), ("fr", -1), ("bl", -1), ("br", 1)):
        assert stance.loads[wheel] == pytest.approx(50 * 9.81 / 4 + sign * K * h, abs=1e-4)
        assert stance.joints[f"slide_{wheel}"] == pytest.approx(BODY / 4 / K + sign * h, abs=1e-7)


def test_one_post_lifts_by_a_quarter():
    """To first order the least-squares plane of the posts; the loads' twist is k h / 4."""
    h = 0.004
    stance = rp.settle(fixture("sprung4"), posts(fl=h))
    assert stance.settled, stance.reason
    twist = stance.loads["fl"] - stance.loads["fr"] - stance.loads["bl"] + stance.loads["br"]
    assert twist / 4 == pytest.approx(K * h / 4, abs=0.01)
    level = rp.settle(fixture("sprung4"), FLAT)
    assert stance.position[2] - level.position[2] == pytest.approx(h / 4, abs=2e-5)


PIT = [(10.0, (-0.2, -0.15, 0.1))]
"""A payload away from the pit, so that three wheels hold the rover."""


def test_a_wheel_over_a_pit_hangs_on_its_spring():
    stance = rp.settle(fixture("sprung4").with_payload(PIT), posts(fl=-0.6))
    assert stance.settled, stance.reason
    assert stance.loads["fl"] == 0.0
    assert stance.gaps["fl"] > 0.05
    assert min(stance.loads[wheel] for wheel in ("fr", "bl", "br")) > 0
    up = math.cos(stance.rpy[0]) * math.cos(stance.rpy[1])
    assert stance.joints["slide_fl"] == pytest.approx(-2.5 * 9.81 * up / K, abs=1e-9)
    assert not stance.stops
    assert sum(stance.loads.values()) == pytest.approx(stance.weight, rel=1e-9)


def test_a_wheel_over_a_pit_droops_to_its_stop(tmp_path):
    """Without springs the slide's lower stop, -0.15 m, carries leg and wheel."""
    stance = rp.settle(unsprung(tmp_path).with_payload(PIT), posts(fl=-0.6))
    assert stance.settled, stance.reason
    assert stance.loads["fl"] == 0.0
    assert stance.joints["slide_fl"] == pytest.approx(-0.15, abs=1e-8)
    up = math.cos(stance.rpy[0]) * math.cos(stance.rpy[1])
    assert stance.stops["slide_fl"] == pytest.approx(2.5 * 9.81 * up, rel=1e-8)
    for slide in ("slide_fr", "slide_bl", "slide_br"):
        assert stance.joints[slide] == pytest.approx(0.15, abs=1e-8)


def test_a_suspension_without_springs_collapses_to_its_stops(tmp_path):
    stance = rp.settle(unsprung(tmp_path), FLAT)
    assert stance.settled, stance.reason
    for joint, value in stance.joints.items():
        if joint.startswith("slide"):
            assert value == pytest.approx(0.15, abs=1e-8)
            assert stance.stops[joint] == pytest.approx(BODY / 4, abs=1e-6)
    assert stance.position[2] == pytest.approx(0.25 - 0.15, abs=1e-8)
    for load in stance.loads.values():
        assert load == pytest.approx(50 * 9.81 / 4, abs=1e-6)
    assert stance.redundant == 1


def test_a_stop_stands_on_uneven_ground_too(tmp_path):
    """Without springs two slides at least are on their stops; what hangs, hangs on the ground."""
    stance = rp.settle(unsprung(tmp_path), rp.Terrain.rough(3, 0.02, 0.9), x=0.2)
    assert stance.settled, stance.reason
    assert min(stance.stops.values()) > 0
    assert len(stance.stops) >= 3
    for joint in stance.stops:
        assert stance.joints[joint] == pytest.approx(0.15, abs=1e-8)
    assert sum(stance.loads.values()) == pytest.approx(stance.weight, rel=1e-9)
    assert stance.residuals["equilibrium"] < 1e-9


def test_a_locked_slide_is_held_where_the_posture_says(tmp_path):
    slides = [f"slide_{end}{side}" for end in "fb" for side in "lr"]
    rover = unsprung(tmp_path, locks=slides)
    stance = rp.settle(rover, FLAT, locks=slides, posture=dict.fromkeys(slides, -0.05))
    assert stance.settled, stance.reason
    assert stance.locked == tuple(sorted(slides))
    assert stance.position[2] == pytest.approx(0.25 + 0.05, abs=1e-10)
    assert not stance.stops


def test_a_given_slide_is_locked_and_the_spring_still_reports():
    slides = {f"slide_{end}{side}": -0.05 for end in "fb" for side in "lr"}
    stance = rp.settle(fixture("sprung4"), FLAT, joints=slides)
    assert stance.settled, stance.reason
    assert stance.position[2] == pytest.approx(0.30, abs=1e-10)
    for force in stance.springs.values():
        assert force == pytest.approx(K * 0.05)


def test_struts_stand_on_their_stops_where_little_weighs_on_them():
    """On the moon the struts' preload of 60 N holds them at full length, and the stop carries the rest."""
    stance = rp.settle(fixture("trailing4"), FLAT, gravity=0.3)
    assert stance.settled, stance.reason
    assert {"strut_l", "strut_r"} <= set(stance.stops)
    for strut in ("strut_l", "strut_r"):
        assert stance.springs[strut] == pytest.approx(60.0, abs=1e-4)
        assert 0 < stance.stops[strut] < 60.0
    heavy = rp.settle(fixture("trailing4"), FLAT, gravity=20.0)
    assert heavy.settled, heavy.reason
    assert not heavy.stops
    assert min(heavy.springs["strut_l"], heavy.springs["strut_r"]) > 60.0


def test_struts_balance_their_arms():
    """About the arm's joint, in the plane: strut's push against the wheel's load and the weights."""
    stance = rp.settle(fixture("trailing4"), FLAT)
    assert stance.settled, stance.reason
    pitch = stance.rpy[1]
    for side in "lr":
        q = stance.joints[f"arm_b{side}"]

        def turned(x, z, q=q):
            return np.array([x * math.cos(q) + z * math.sin(q), -x * math.sin(q) + z * math.cos(q)])

        pivot = np.array([-0.2, 0.0])
        end = pivot + turned(-0.25, -0.125)
        top = np.array([-0.4, 0.2])
        push = stance.springs[f"strut_{side}"]
        away = end - top
        assert push == pytest.approx(60 + 6000 * (0.36 - np.linalg.norm(away)), abs=1e-6)
        force = push * away / np.linalg.norm(away)
        lever = end - pivot
        moment = lever[1] * force[0] - lever[0] * force[1]
        up = np.array([-math.sin(pitch), math.cos(pitch)])
        for place, size in (
            (turned(-0.3, -0.15), stance.loads[f"b{side}"] - 2 * 9.81),
            (turned(-0.15, -0.075), -9.81),
        ):
            moment += place[1] * size * up[0] - place[0] * size * up[1]
        assert moment == pytest.approx(0.0, abs=1e-6)
