"""Road wheels on upright springs in a track, against Appendix F of the Polibot paper."""

import numpy as np
import pytest
from polibot_equations import Setup as Polibot
from polibot_equations import follow as follow_polibot
from shelves import shelves
from x_suspension_equations import Setup, follow

import rover_pin as rp

ROAD = ("w2", "w3", "w4", "w5")
RADIUS = 65.0


@pytest.fixture(scope="module")
def rover():
    return rp.load("x_suspension")


def stand(rover, heights=(0, 0, 0, 0), **more):
    terrain = shelves((0.21, 0.0, -0.21), np.array(heights) / 1e3)
    stance = rp.settle(rover, terrain, posture="home", **more)
    assert stance.settled, stance.reason
    return stance


def loads(stance):
    return np.array([stance.loads[w] for w in ROAD])


def agrees(stance, answer):
    assert 1e3 * stance.position[2] == pytest.approx(answer.pose[0], abs=1e-6)
    assert np.degrees(stance.rpy[1]) == pytest.approx(np.degrees(answer.pose[1]), abs=1e-6)
    np.testing.assert_allclose(
        [1e3 * stance.joints[f"slide_{i}"] for i in range(2, 6)], answer.lengths, atol=1e-6
    )
    np.testing.assert_allclose(loads(stance), answer.loads, atol=1e-5)
    assert stance.tensions["track"] == pytest.approx(answer.tension, abs=1e-5)


def test_its_track_pulls_like_polibots(rover):
    assert stand(rover).tensions["track"] == pytest.approx(follow_polibot(Polibot()).t1, abs=0.1)


@pytest.mark.parametrize(
    "heights",
    [(0, 0, 0, 0), (10, 0, 0, 0), (20, 0, 0, 0), (40, 0, 0, 0), (65, 0, 0, 0), (0, 10, 0, 0), (0, 0, 0, 15),
     (12, 3, 8, 5)],
)  # fmt: skip
def test_appendix_f(rover, heights):
    agrees(stand(rover, heights), follow(Setup(heights=heights)))


@pytest.mark.parametrize("seed", range(6))
def test_appendix_f_of_random_setups(seed):
    rng = np.random.default_rng(seed)
    mass, stiffness, rest = rng.uniform(40, 70), rng.uniform(8, 16), rng.uniform(152, 158)
    heights = tuple(rng.uniform(0.0, 12.0, 4))
    setup = Setup(mass=mass, stiffness=stiffness, rest=rest, heights=heights)
    one = rp.load("x_suspension", mass=mass, stiffness=1e3 * stiffness, rest=rest / 1e3)
    agrees(stand(one, heights), follow(setup))


def test_its_track_goes_slack_over_a_third_of_the_wheels_radius(rover):
    """The paper's curves end at about 35% of the radius, where the tension is gone."""
    tensions = {share: stand(rover, (share * RADIUS, 0, 0, 0)).tensions["track"] for share in (0.34, 0.37)}
    assert tensions[0.34] > 1.0
    assert tensions[0.37] == 0.0


def test_symmetric_on_level_ground(rover):
    stance = stand(rover)
    assert stance.rpy[1] == pytest.approx(0.0, abs=1e-9)
    np.testing.assert_allclose(loads(stance), loads(stance)[::-1], atol=1e-6)


def test_mirrored_steps_mirror_the_loads(rover):
    front, rear = stand(rover, (15, 0, 0, 0)), stand(rover, (0, 0, 0, 15))
    np.testing.assert_allclose(loads(front), loads(rear)[::-1], atol=1e-6)


def test_tensions_differ_by_the_resistance(rover):
    stance = stand(rover, resistance=50.0)
    assert stance.tight["track"] - stance.tensions["track"] == pytest.approx(50.0, abs=1e-6)
