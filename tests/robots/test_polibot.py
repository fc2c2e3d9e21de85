"""Polibot's half model against its paper and the 21 equations; the whole robot against its half."""

import math

import numpy as np
import pytest
from polibot_equations import IDENTIFIED, Setup, belt_around, follow, places
from shelves import shelves

import rover_pin as rp

FLAT = rp.Terrain.flat()
ROAD = ("w3", "w4", "w5", "w6")
ARMS = ("bogie_rear", "bogie_front", "rear_arm", "front_arm")
EDGES = (0.21, 0.0, -0.23)
"""m from the sprocket: between wheels 3 and 4, 4 and 5, 5 and 6."""


@pytest.fixture(scope="module")
def half():
    return rp.load("polibot_half")


@pytest.fixture(scope="module")
def whole():
    return rp.load("polibot")


def steps(heights):
    """Terrain under wheels 3 to 6, mm."""
    return shelves(EDGES, np.array(heights) / 1e3)


def stand(rover, terrain=FLAT, **more):
    stance = rp.settle(rover, terrain, posture="home", **more)
    assert stance.settled, stance.reason
    return stance


def loads(stance, end=""):
    return np.array([stance.loads[w + end] for w in ROAD])


def pose(stance):
    """X_A, Z_A [mm], theta, theta1..4 [deg], as the paper counts them: X from wheel 3."""
    contact = next(c for c in stance.contacts if c.wheel == "w3")
    place = (contact.point[0] - stance.position[0], stance.position[2])
    pitch = stance.rpy[1]
    return np.array(
        [*np.multiply(1e3, place), *np.degrees([pitch, *(pitch + stance.joints[a] for a in ARMS)])]
    )


def agrees(stance, answer):
    """Poses to 1e-6 mm and deg, forces to 1e-5 N."""
    np.testing.assert_allclose(pose(stance)[:2], answer.pose[:2], atol=1e-6)
    np.testing.assert_allclose(pose(stance)[2:], np.degrees(answer.pose[2:]), atol=1e-6)
    np.testing.assert_allclose(loads(stance), answer.loads, atol=1e-5)
    assert stance.tensions["track"] == pytest.approx(min(answer.t1, answer.t2), abs=1e-5)
    assert stance.tight["track"] == pytest.approx(max(answer.t1, answer.t2), abs=1e-5)


def test_table_6_models_column(half):
    expected = [311.0, 303.3, 4.41, 61.6, 38.3, 71.6, 52.2]
    difference = np.abs(pose(stand(half)) - expected)
    assert np.all(difference[:2] < 0.15)
    assert np.all(difference[2:] < 0.05)


@pytest.mark.parametrize(
    ("heights", "more", "z", "pitch"),
    [
        ((0, 0, 0, 0), 80.0, 291.2, 2.61),
        ((55, 0, 0, 0), 0.0, 307.9, -2.69),
        ((0, 0, 0, 55), 0.0, 307.8, 7.31),
    ],
    ids=["table_7", "table_8_w3", "table_8_w6"],
)
def test_tables_7_and_8_models_columns(heights, more, z, pitch):
    stance = stand(rp.load("polibot_half", mass=(96.2 + more) / 2), steps(heights))
    assert pose(stance)[1] == pytest.approx(z, abs=0.2)
    assert pose(stance)[2] == pytest.approx(pitch, abs=0.05)


def test_baseline_forces(half):
    stance = stand(half)
    np.testing.assert_allclose(loads(stance), [95.5, 180.3, 180.1, 16.0], atol=0.1)
    assert stance.tensions["track"] == pytest.approx(299.9, abs=0.1)
    assert pose(stance)[1] == pytest.approx(303.31, abs=0.01)
    assert pose(stance)[2] == pytest.approx(4.410, abs=0.01)
    assert np.std(loads(stance)) / np.mean(loads(stance)) == pytest.approx(0.579, abs=1e-3)


def test_forces_with_55_mm_under_the_front_wheel(half):
    stance = stand(half, steps((55, 0, 0, 0)))
    np.testing.assert_allclose(loads(stance), [167.0, 81.2, 138.5, 85.1], atol=0.1)
    assert stance.tensions["track"] == pytest.approx(237.3, abs=0.1)
    assert pose(stance)[1] == pytest.approx(308.05, abs=0.01)
    assert pose(stance)[2] == pytest.approx(-2.687, abs=0.01)


def test_a_step_under_the_rear_wheel_is_a_step_seen_backwards(half):
    """The step of the command line, met with the tail."""
    terrain = rp.Terrain.step(0.055, 0.24, spacing=0.01)
    turned = stand(half, terrain, yaw=math.pi)
    np.testing.assert_allclose(loads(turned), loads(stand(half, steps((0, 0, 0, 55)))), atol=1e-6)


@pytest.mark.parametrize(
    "changed",
    [
        {"mass": 40.0}, {"mass": 65.0}, {"mass": 88.1}, {"track_length": 2023.0}, {"track_length": 2030.0},
        {"track_length": 2020.0}, {"d11": 196.5}, {"d11": 199.5}, {"stiffness": 20.0},
        {"com": (-20.0, -60.0)}, {"preload": (0.0, 50.0, 0.0)},
        {"terrain": (20, 0, 0, 0)}, {"terrain": (0, 30, 0, 0)},
        {"terrain": (0, 0, 30, 0)}, {"terrain": (0, 0, 0, 40)}, {"terrain": (40, 10, 0, 20)},
    ],
    ids=str,
)  # fmt: skip
def test_the_21_equations(changed):
    if "d11" in changed:
        changed = {"geometry": dict(IDENTIFIED) | changed}
    compare(Setup(**changed))


@pytest.mark.parametrize("seed", range(12))
def test_the_21_equations_of_random_setups(seed):
    rng = np.random.default_rng(seed)
    geometry = {k: v * rng.uniform(0.99, 1.01) for k, v in IDENTIFIED.items()}
    geometry |= {k: rng.uniform(0.0, 3.0) for k in ("d2", "d14")}
    setup = Setup(
        geometry=geometry,
        mass=rng.uniform(40.0, 70.0),
        com=(rng.uniform(-60.0, -20.0), rng.uniform(-120.0, -60.0)),
        stiffness=rng.uniform(10.0, 20.0),
        preload=tuple(rng.uniform(0.0, 100.0, 3)),
        terrain=tuple(rng.uniform(0.0, 15.0, 4)),
    )
    # As long as these wheels need, so that the track is neither far too long nor too short.
    at_rest = follow(Setup()).pose
    length = belt_length(setup, at_rest)
    compare(Setup(**(vars(setup) | {"track_length": length + rng.uniform(-1.0, 4.0)})))


def belt_length(setup, at):
    return belt_around(setup, places(setup.geometry, at), None).length


def compare(setup, resistance=0.0):
    """The half model of a setup against its equations."""
    answer = follow(setup)
    rover = rp.load("polibot_half", **parameters(setup))
    agrees(stand(rover, steps(setup.terrain), resistance=resistance), answer)
    return answer


def parameters(setup):
    """The half model's parameters of a setup."""
    found = {k: v / 1e3 for k, v in setup.geometry.items() if k[0] in "dr" and k != "d11"}
    found |= {f"{k}_deg": math.degrees(v) for k, v in setup.geometry.items() if k.startswith("alpha")}
    found |= {f"preload_{k}": v for k, v in enumerate(setup.preload, 1)}
    found |= {f"length_max_{k}": v / 1e3 for k, v in enumerate(setup.length_max, 1)}
    return found | {
        "front_arm_length": setup.geometry["d11"] / 1e3,
        "track_length": setup.track_length / 1e3,
        "stiffness": setup.stiffness * 1e3,
        "mass": setup.mass,
        "com_x": -setup.com[0] / 1e3,
        "com_z": setup.com[1] / 1e3,
    }


@pytest.mark.parametrize("length", [2.034, 2.05, 2.1])
def test_a_slack_track_has_no_tension(length):
    stance = stand(rp.load("polibot_half", track_length=length))
    assert stance.tensions["track"] == 0.0
    free = stand(rp.load("polibot_half", track_length=2.09))
    np.testing.assert_allclose(loads(stance), loads(free), atol=1e-9)


@pytest.mark.parametrize("resistance", [100.0, -60.0])
@pytest.mark.parametrize("heights", [(0, 0, 0, 0), (40, 0, 0, 0), (0, 0, 0, 40), (20, 5, 0, 10)])
def test_the_21_equations_with_motion_resistance(half, resistance, heights):
    setup = Setup(resistance=resistance, terrain=heights)
    answer = follow(setup)
    stance = stand(half, steps(heights), resistance=resistance)
    agrees(stance, answer)
    assert stance.traction_ratio == pytest.approx(answer.ratio, abs=1e-9)
    np.testing.assert_allclose([stance.tractions[w] for w in ROAD], answer.traction, atol=1e-5)


def test_tensions_differ_by_the_resistance(half):
    stance = stand(half, resistance=100.0)
    assert stance.tight["track"] - stance.tensions["track"] == pytest.approx(100.0, abs=1e-6)
    shares = [stance.tractions[w] / stance.loads[w] for w in ROAD]
    np.testing.assert_allclose(shares, shares[0], atol=1e-9)
    assert sum(stance.tractions.values()) == pytest.approx(100.0, abs=1e-6)


def test_sprocket_and_idler_are_auxiliary(half, whole):
    assert [w.name for w in half.wheels if w.auxiliary] == ["w1", "w2"]
    assert sum(w.auxiliary for w in whole.wheels) == 4
    stance = stand(half)
    assert stance.loads["w1"] == stance.loads["w2"] == 0.0


@pytest.mark.parametrize("heights", [(0, 0, 0, 0), (55, 0, 0, 0), (0, 0, 0, 40)])
@pytest.mark.parametrize("resistance", [0.0, 100.0])
def test_the_whole_robot_is_two_halves(half, whole, heights, resistance):
    one = stand(half, steps(heights), resistance=resistance)
    two = stand(whole, steps(heights), resistance=2.0 * resistance)
    np.testing.assert_allclose(two.position, one.position, atol=1e-9)
    np.testing.assert_allclose(two.rpy, one.rpy, atol=1e-9)
    for end in ("_l", "_r"):
        np.testing.assert_allclose(loads(two, end), loads(one), atol=1e-6)
        assert two.tensions["track" + end] == pytest.approx(one.tensions["track"], abs=1e-6)
        assert two.tight["track" + end] == pytest.approx(one.tight["track"], abs=1e-6)


def one_sided(height, side):
    """A shelf under the front wheel of one side: 1 left, -1 right."""
    x, y = np.arange(-100, 101) * 0.01, np.arange(-100, 101) * 0.01
    z = np.where((x[None, :] > 0.21) & (side * y[:, None] > 0.1), height, 0.0)
    return rp.Terrain.from_grid(z, 0.01, (-1.0, -1.0), "linear")


def test_mirrored_terrain_mirrors_the_whole_robot(whole):
    left, right = (stand(whole, one_sided(0.04, side)) for side in (1, -1))
    assert left.rpy[0] == pytest.approx(-right.rpy[0], abs=1e-9)
    assert abs(left.rpy[0]) > math.radians(0.5)
    assert left.rpy[1] == pytest.approx(right.rpy[1], abs=1e-9)
    np.testing.assert_allclose(loads(left, "_l"), loads(right, "_r"), atol=1e-6)
    np.testing.assert_allclose(loads(left, "_r"), loads(right, "_l"), atol=1e-6)
    assert left.loads["w3_l"] > left.loads["w3_r"]


@pytest.mark.parametrize(("yaw", "low", "high"), [(90.0, "_l", "_r"), (-90.0, "_r", "_l")])
def test_side_slope(whole, yaw, low, high):
    """Loads balance about the mass centre.

    Four contacts and a track a side leave five rolling freedoms (roll, and each arm left against right)
    nothing: with all wheels down and both tracks taut it does not roll on its springs, the tracks carry it.
    """
    stance = stand(whole, rp.Terrain.parse("slope:12"), yaw=math.radians(yaw))
    points = np.array([c.point for c in stance.contacts])
    forces = np.array([c.load for c in stance.contacts])
    assert forces.sum() == pytest.approx(96.2 * 9.81, rel=1e-9)
    np.testing.assert_allclose(forces @ points[:, :2] / forces.sum(), stance.com[:2], atol=1e-9)
    assert loads(stance, low).sum() > 1.3 * loads(stance, high).sum()
    for arm in ARMS:
        assert stance.joints[arm + low] == pytest.approx(stance.joints[arm + high], abs=1e-9)
    assert stance.tensions["track" + high] > stance.tensions["track" + low] + 400.0


def test_steeper_side_slope_lifts_the_upper_front_wheel_and_rolls(whole):
    stance = stand(whole, rp.Terrain.parse("slope:20"), yaw=math.radians(90.0))
    assert stance.loads["w3_r"] == 0.0
    assert 20.1 < -math.degrees(math.asin(math.sin(stance.rpy[0]) * math.cos(stance.rpy[1]))) < 20.5


@pytest.mark.parametrize("name", ["polibot", "polibot_half"])
def test_arms_weigh_nothing(name):
    rover = rp.load(name)
    assert rover.model.inertias[1].mass == rover.mass
    assert rover.mass == {"polibot": 96.2, "polibot_half": 48.1}[name]
