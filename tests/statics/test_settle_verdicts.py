"""Statuses: off the map, grounded, cliffs, steps and notches; and none where the rover simply stands."""

import math

import numpy as np
import pytest
from little_rover import Builder, fixture, four_wheels

import rover_pin as rp
from rover_pin.errors import OffMapError

FLAT = rp.Terrain.flat()
S = rp.Status


def grid(size=4.0, tilt_deg=0.0, spacing=0.1, interpolation="smooth"):
    """A square map about the origin, rising along x."""
    at = np.arange(-size / 2, size / 2 + spacing / 2, spacing)
    heights = np.tile(at * math.tan(math.radians(tilt_deg)), (len(at), 1))
    return rp.Terrain.from_grid(heights, spacing, (-size / 2, -size / 2), interpolation)


def test_every_point_of_a_wheel_must_be_over_the_map():
    """Front wheels reach 0.5 + 0.15 m ahead; sideways a disc of tread 0.03 m reaches 0.4 + 0.03 m."""
    rover, ground = fixture("rigid4"), grid()
    assert rp.settle(rover, ground, x=2 - 0.65 - 1e-6).settled
    off = rp.settle(rover, ground, x=2 - 0.65 + 1e-4)
    assert off.status is S.OFF_MAP
    assert off.limiting in ("fl", "fr")
    assert off.reason == f"{off.limiting} reaches beyond the map"
    assert rp.settle(rover, ground, y=2 - 0.43 - 1e-6).settled
    off = rp.settle(rover, ground, y=2 - 0.43 + 1e-4)
    assert off.status is S.OFF_MAP
    assert off.limiting in ("fl", "bl")
    off = rp.settle(rover, ground, x=-1.9)
    assert off.limiting in ("bl", "br")


@pytest.mark.parametrize("interpolation", ["linear", "smooth"])
def test_off_the_map_counts_where_it_stands_not_where_it_starts(interpolation):
    """Level, the front wheels reach 0.65 m ahead; pitched by 40 deg only 0.6 m."""
    rover, ground = fixture("rigid4"), grid(tilt_deg=40, interpolation=interpolation)
    reach = 0.5 * math.cos(math.radians(40)) + 0.1 * math.sin(math.radians(40)) + 0.15
    inside = rp.settle(rover, ground, x=2 - reach - 0.005)
    assert inside.settled, inside
    assert rp.settle(rover, ground, x=2 - reach + 0.005).status is S.OFF_MAP


def test_a_place_off_the_map_is_an_error():
    with pytest.raises(OffMapError) as caught:
        rp.settle(fixture("rigid4"), grid(), x=2.5, y=-1)
    assert str(caught.value) == (
        "grid: the place is not on the map (got '2.5, -1'); the map spans x -2 to 2 m, y -2 to 2 m"
    )


def test_a_map_smaller_than_the_rover_is_an_error():
    with pytest.raises(OffMapError, match=r"smaller than the rover, whose wheels are 1\.\d+ m apart"):
        rp.settle(fixture("rigid4"), grid(size=1.0), x=0.0)


def hill(height, radius=0.12, x0=0.0, y0=0.0):
    """A steep bump."""

    def h(x, y):
        away = (np.asarray(x) - x0) ** 2 + (np.asarray(y) - y0) ** 2
        return height * np.exp(-away / (2 * radius**2))

    return rp.Terrain.from_function(h, spacing=0.05)


def test_a_belly_on_a_bump_is_grounded():
    """rigid4's box ends 0.2 m over level ground."""
    rover = fixture("rigid4")
    assert rp.settle(rover, hill(0.19)).settled
    stance = rp.settle(rover, hill(0.25))
    assert stance.status is S.GROUNDED
    assert stance.limiting == "base_link"
    assert stance.reason.startswith("base_link is 0.0")
    assert stance.reason.endswith(" m in the ground")
    assert not stance.loads


def test_a_belly_point_without_collision_shapes_is_grounded(tmp_path):
    made = four_wheels(mass=40).say(belly=[{"frame": "base_link", "point": [0, 0, -0.1]}])
    rover = made.load(tmp_path)
    assert rp.settle(rover, hill(0.19, 0.08)).settled
    stance = rp.settle(rover, hill(0.21, 0.08))
    assert stance.status is S.GROUNDED
    assert stance.reason == "base_link is 0.01 m in the ground"


def test_a_link_that_hits_the_ground_is_named(tmp_path):
    made = four_wheels(mass=40).link("skid", 1.0, box=(0.1, 0.1, 0.1))
    made.joint("fix", "base_link", "skid", (0.2, 0.2, -0.15), kind="fixed")
    rover = made.load(tmp_path)
    assert rp.settle(rover, hill(0.08, 0.05, 0.2, 0.2)).settled
    stance = rp.settle(rover, hill(0.15, 0.12, 0.2, 0.2))
    assert stance.status is S.GROUNDED
    assert stance.limiting == "skid"


def test_a_bundled_rover_on_a_boulder_is_grounded():
    rover = rp.load("rocker_bogie")
    stance = rp.settle(rover, hill(0.5, 0.12))
    assert stance.status is S.GROUNDED, stance
    assert stance.limiting == "base_link"


def cliff(depth, edge, width=0.02):
    """Level ground that falls off ahead of x = edge."""

    def h(x, y):
        return -depth / (1 + np.exp(-(np.asarray(x) - edge) / width)) + 0.0 * np.asarray(y)

    return rp.Terrain.from_function(h, spacing=0.05)


def test_a_rigid_rover_leans_over_a_cliff_and_falls():
    """Front wheels beyond the edge: it pitches until its belly, or everything, is over."""
    stance = rp.settle(fixture("rigid4"), cliff(2.0, 0.3))
    assert stance.status in (S.TIPS, S.GROUNDED), stance
    assert stance.limiting


def test_a_bogie_rover_at_a_cliff_says_what_gave_way():
    """The front wheels find no ground; the bogies cannot hold a centre of mass ahead of their pivots."""
    rover = fixture("thirds")
    stance = rp.settle(rover, cliff(3.0, 0.2))
    assert stance.status in (S.TIPS, S.GROUNDED), stance
    assert stance.limiting
    assert stance.limiting in stance.reason


@pytest.mark.parametrize("slope", [4.0, 8.0, 15.0])
def test_where_the_followed_branch_ends_the_joint_is_named(slope):
    """A caster downhill of its fork flips round as the ground rises: not the next branch, but `tips`."""
    rover = fixture("caster3")
    stance = rp.settle(rover, rp.Terrain.slope(slope), yaw=0.0)
    assert stance.status is S.TIPS, stance
    assert stance.limiting == "fork"
    assert "fork" in stance.reason
    assert rp.settle(rover, rp.Terrain.slope(slope), yaw=0.0, posture={"fork": 3.0}).settled


def test_one_wheel_over_an_edge_is_caught_by_the_suspension():
    """A drop the rocker can follow: it stands, the wheel on the lower ground."""
    stance = rp.settle(fixture("thirds"), cliff(0.25, 0.5))
    assert stance.settled, stance
    lower = [c.point[2] for c in stance.contacts if c.wheel in ("fl", "fr")]
    assert max(lower) < -0.2
    assert sum(stance.loads.values()) == pytest.approx(stance.weight, rel=1e-9)


def ramp_contact(radius, height, run):
    """How far ahead of a wheel's lowest point a ramp's foot lies where the wheel touches both."""
    return radius * math.tan(math.atan2(height, run) / 2)


@pytest.mark.parametrize(("height", "spacing"), [(0.1, 0.05), (0.2, 0.1), (0.2, 0.04), (0.3, 0.05)])
def test_a_wheel_against_a_step_has_two_contacts(height, spacing):
    rover = fixture("rigid4")
    foot = 0.5 + ramp_contact(0.15, height, spacing)
    ground = rp.Terrain.step(height, foot + spacing, spacing)
    stance = rp.settle(rover, ground)
    assert stance.settled, stance
    np.testing.assert_allclose(stance.rpy, 0.0, atol=1e-6)
    for wheel in ("fl", "fr"):
        places = sorted((c for c in stance.contacts if c.wheel == wheel), key=lambda c: c.point[0])
        assert len(places) == 2
        slope = math.atan2(height, spacing)
        np.testing.assert_allclose(places[0].point[[0, 2]], [0.5, 0.0], atol=1e-5)
        beyond = [0.5 + 0.15 * math.sin(slope), 0.15 * (1 - math.cos(slope))]
        np.testing.assert_allclose(places[1].point[[0, 2]], beyond, atol=1e-5)
        np.testing.assert_allclose(places[1].normal, [-math.sin(slope), 0, math.cos(slope)], atol=1e-5)
    assert stance.redundant == 3  # six contacts, three equations of a rigid body
    assert sum(stance.loads.values()) == pytest.approx(stance.weight, rel=1e-9)


@pytest.mark.parametrize("height", [0.05, 0.1, 0.14])
@pytest.mark.parametrize("x", [0.52, 0.55, 0.58, 0.62, 0.66])
def test_a_rover_stands_at_a_step_wherever_it_is(height, x):
    """Lower than the wheel's centre a step is climbed or cleared, never a failure of the solver."""
    stance = rp.settle(fixture("rigid4"), rp.Terrain.step(height, x, 0.05))
    assert stance.settled, stance
    assert stance.residuals["gap_m"] < 1e-6
    assert stance.residuals["equilibrium"] < 1e-9


@pytest.mark.parametrize("spacing", [0.001, 0.005, 0.05])
@pytest.mark.parametrize("height", [0.1, 0.2])
def test_no_stance_penetrates_a_wall(height, spacing):
    """A steep face 0.1 m ahead of an axle of radius 0.15 m: whatever the verdict, a stance clears it."""
    stance = rp.settle(fixture("rigid4"), rp.Terrain.step(height, 0.6, spacing))
    assert stance.status in (S.SETTLED, S.TIPS, S.GROUNDED), stance
    if stance.settled:
        assert stance.residuals["gap_m"] < 1e-6


def notch(angle_deg, depth, x0):
    """A V across the way at x0, its flanks at an angle."""
    rise = math.tan(math.radians(angle_deg))

    def h(x, y):
        return np.minimum(0.0, rise * np.abs(np.asarray(x) - x0) - depth) + 0.0 * np.asarray(y)

    return rp.Terrain.from_function(h, spacing=0.02)


@pytest.mark.parametrize(("angle", "depth"), [(20.0, 0.12), (35.0, 0.12), (50.0, 0.2)])
def test_a_wheel_in_a_notch_has_two_contacts(angle, depth):
    """Both front wheels; the notch lies where the pitch of the rover has put their centres."""
    tilt = math.radians(angle)
    sunk = depth - 0.15 / math.cos(tilt) + 0.15
    pitch = math.asin(sunk)  # axles 1 m apart
    x0 = 0.5 * math.cos(pitch) - 0.1 * math.sin(pitch)
    stance = rp.settle(fixture("rigid4"), notch(angle, depth, x0))
    assert stance.settled, stance
    assert stance.rpy[1] == pytest.approx(pitch, abs=1e-6)
    for wheel in ("fl", "fr"):
        places = sorted((c for c in stance.contacts if c.wheel == wheel), key=lambda c: c.point[0])
        assert len(places) == 2
        for place, side in zip(places, (-1, 1), strict=True):
            assert place.point[0] - x0 == pytest.approx(side * 0.15 * math.sin(tilt), abs=1e-5)
            np.testing.assert_allclose(place.normal, [-side * math.sin(tilt), 0, math.cos(tilt)], atol=1e-5)
    assert stance.redundant == 3
    loads = np.array([c.load for c in stance.contacts])
    points = np.array([c.point for c in stance.contacts])
    rows = np.vstack([np.ones(len(loads)), points[:, 0], points[:, 1]])
    right = stance.weight * np.array([1, stance.com[0], stance.com[1]])
    least = rows.T @ np.linalg.solve(rows @ rows.T, right)
    assert least.min() > 0
    np.testing.assert_allclose(loads, least, atol=1e-6 * stance.weight)


def test_nothing_is_wrong_where_nothing_is_wrong():
    """Gentle ground: every place is a stance."""
    rover, ground = rp.load("rocker_bogie"), rp.Terrain.rough(11, 0.02, 0.9)
    generator = np.random.default_rng(11)
    for _ in range(30):
        x, y, yaw = *generator.uniform(-8, 8, 2), generator.uniform(-math.pi, math.pi)
        stance = rp.settle(rover, ground, x=x, y=y, yaw=yaw)
        assert stance.settled, stance


def test_rough_ground_gives_a_verdict_everywhere():
    """Rough as the default study: settled, tips or grounded, and what is not settled is named."""
    rover, ground = rp.load("rocker_bogie"), rp.Terrain.rough(1, 0.05, 0.8)
    generator = np.random.default_rng(12)
    for _ in range(60):
        x, y, yaw = *generator.uniform(-8.5, 8.5, 2), generator.uniform(-math.pi, math.pi)
        stance = rp.settle(rover, ground, x=x, y=y, yaw=yaw)
        assert stance.status in (S.SETTLED, S.TIPS, S.GROUNDED), (x, y, yaw, stance)
        assert stance.settled or stance.limiting


@pytest.mark.parametrize("name", ["caster3", "trailing4", "four_bar", "bogie_min"])
def test_every_small_rover_gets_a_verdict_on_rough_ground(name):
    generator = np.random.default_rng(13)
    for i in range(12):
        ground = rp.Terrain.rough(i % 3, (0.03, 0.06)[i % 2], 0.7)
        x, y, yaw = *generator.uniform(-8, 8, 2), generator.uniform(-3, 3)
        stance = rp.settle(fixture(name), ground, x=x, y=y, yaw=yaw)
        assert stance.status in (S.SETTLED, S.TIPS, S.GROUNDED), (i, x, y, yaw, stance)


@pytest.mark.parametrize("height", [0.005, 0.02])
def test_two_high_wheels_are_joined_by_a_third(tmp_path, height):
    """Diagonal posts under a centre of mass on the diagonal: it leans to either side, and is caught there."""
    at = np.arange(-2.0, 2.05, 0.1)
    nodes = np.where((at[None, :] > 0.15) == (at[:, None] > 0.15), height, 0.0)
    ground = rp.Terrain.from_grid(nodes, 0.1, (-2.0, -2.0), "linear")
    for y in (1e-3, -1e-3):
        rover = four_wheels(com=(0.0, y, 0.0)).load(tmp_path / str(y))
        stance = rp.settle(rover, ground)
        assert stance.settled, stance
        caught = "bl" if y > 0 else "fr"
        carrying = {wheel for wheel, load in stance.loads.items() if load > 1e-9 * stance.weight}
        assert carrying in ({"fl", "br", "bl"}, {"fl", "br", "fr"})
        assert stance.loads[caught] > 0


def test_a_symmetric_box_stands_on_three_of_its_wheels(tmp_path):
    """Its mass is over both diagonals: on two wheels it balances, and a third is millimetres away."""
    rover, ground = four_wheels().load(tmp_path), rp.Terrain.rough(1, 0.05, 0.8)
    generator = np.random.default_rng(5)
    for _ in range(40):
        x, y, yaw = *generator.uniform(-8, 8, 2), generator.uniform(-3, 3)
        stance = rp.settle(rover, ground, x=x, y=y, yaw=yaw)
        assert stance.settled, (x, y, yaw, stance)
        assert sum(load > 0 for load in stance.loads.values()) == 3


def test_two_wheels_alone_fall_over(tmp_path):
    made = Builder("bicycle").link("base_link", 10, (0, 0, 0.2))
    for name, x in (("f", 0.4), ("b", -0.4)):
        made.wheel(name, "base_link", (x, 0, -0.1))
    stance = rp.settle(made.load(tmp_path), FLAT)
    assert stance.status is S.TIPS, stance


def test_two_wheels_with_a_low_mass_stand(tmp_path):
    """Wheels braked, the body rolls with them, and its mass is below their centres."""
    made = Builder("trailer").link("base_link", 10, (0, 0, -0.19))
    for name, y in (("l", 0.4), ("r", -0.4)):
        made.wheel(name, "base_link", (0, y, 0), radius=0.2, tread=0.02)
    stance = rp.settle(made.load(tmp_path), FLAT)
    assert stance.settled, stance
    assert stance.rpy[1] == pytest.approx(0.0, abs=1e-8)
    for load in stance.loads.values():
        assert load == pytest.approx(stance.weight / 2, rel=1e-9)
