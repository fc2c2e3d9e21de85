"""Size, weight, place and the choice of axes do not matter; extremes are no failure."""

import numpy as np
import pinocchio as pin
import pytest
import yaml
from little_rover import FIXTURES, Builder, fixture, four_wheels

import rover_pin as rp

ROUGH = rp.Terrain.rough(1, 0.05, 0.8)
AT = np.arange(-5.0, 5.05, 0.1)
NODES = np.array(ROUGH.height(AT[None, :], AT[:, None]))


def box(scale=1.0, mass=40.0):
    made = four_wheels(
        0.5 * scale,
        0.4 * scale,
        (0.1 * scale, 0.05 * scale, 0.0),
        mass,
        0.2 * scale,
        radius=0.1 * scale,
        width=0.06 * scale,
        tread=0.03 * scale,
    )
    made.parts = [part.replace("1e-06", repr(1e-8 * mass)) for part in made.parts]
    return made


@pytest.mark.parametrize("scale", [0.01, 0.1, 30.0])
def test_a_rover_and_its_ground_in_another_size(tmp_path, scale):
    ground = rp.Terrain.from_grid(NODES, 0.1, (-5, -5))
    scaled = rp.Terrain.from_grid(scale * NODES, 0.1 * scale, (-5 * scale, -5 * scale))
    one = rp.settle(box().load(tmp_path / "one"), ground, x=0.3, y=0.2, yaw=0.5)
    other = rp.settle(box(scale).load(tmp_path / "other"), scaled, x=0.3 * scale, y=0.2 * scale, yaw=0.5)
    assert one.settled, one
    assert other.settled, other
    np.testing.assert_allclose(other.rpy, one.rpy, atol=1e-9)
    assert other.position[2] == pytest.approx(scale * one.position[2], rel=1e-9)
    for wheel, load in one.loads.items():
        assert other.loads[wheel] == pytest.approx(load, abs=1e-5)


@pytest.mark.parametrize("mass", [1e-5, 1e7])
def test_a_rover_of_another_weight(tmp_path, mass):
    one = rp.settle(box().load(tmp_path / "one"), ROUGH, x=0.3)
    other = rp.settle(box(mass=mass).load(tmp_path / "other"), ROUGH, x=0.3)
    assert other.settled, other
    for wheel, load in one.loads.items():
        assert other.loads[wheel] / other.weight == pytest.approx(load / one.weight, abs=1e-9)


@pytest.mark.parametrize("gravity", [1e-3, 1e3])
def test_a_world_of_another_gravity(gravity):
    one = rp.settle(fixture("thirds"), ROUGH, x=0.3)
    other = rp.settle(fixture("thirds"), ROUGH, x=0.3, gravity=gravity)
    assert other.settled, other
    for wheel, load in one.loads.items():
        assert other.loads[wheel] / gravity == pytest.approx(load / 9.81, rel=1e-8)


@pytest.mark.parametrize("name", ["rigid4", "thirds", "four_bar", "trailing4", "turnbuckle"])
def test_a_map_in_national_coordinates(name):
    """Half a million east, four million north, at 3000 m: as at the origin."""
    east, north = 500_000.0, 4_000_000.0
    here = rp.Terrain.from_grid(NODES, 0.1, (-5, -5))
    there = rp.Terrain.from_grid(NODES + 3000.0, 0.1, (east - 5, north - 5))
    one = rp.settle(fixture(name), here, x=1.25, y=0.75, yaw=0.4)
    other = rp.settle(fixture(name), there, x=east + 1.25, y=north + 0.75, yaw=0.4)
    assert one.settled, one
    assert other.settled, other
    assert other.position[2] - 3000 == pytest.approx(one.position[2], abs=1e-8)
    np.testing.assert_allclose(other.rpy, one.rpy, atol=1e-8)
    for wheel, load in one.loads.items():
        assert other.loads[wheel] == pytest.approx(load, abs=1e-4)
    assert other.residuals["equilibrium"] < 1e-6
    assert other.residuals["gap_m"] < 1e-6


@pytest.mark.parametrize(("width", "tread"), [(0.0, 0.0), (0.002, 0.001), (0.2, 0.1)])
def test_blades_and_balls_for_wheels(tmp_path, width, tread):
    rover = four_wheels(radius=0.1, width=width, tread=tread).load(tmp_path)
    for ground in (ROUGH, rp.Terrain.slope(20), rp.Terrain.slope(20, 70)):
        stance = rp.settle(rover, ground, x=0.3, y=1.0, yaw=0.8)
        assert stance.settled, stance
        assert stance.residuals["gap_m"] < 1e-6
        assert sum(stance.loads.values()) == pytest.approx(stance.weight, rel=1e-9)


def turned(tmp_path, up):
    """A box on wheels whose drawing stands on its side: its own `up` says which."""
    toward = np.array(up, float) / np.linalg.norm(up)
    R = np.array(pin.Quaternion.FromTwoVectors(toward, np.array([0.0, 0.0, 1.0])).matrix()).T
    made = Builder("turned").link("base_link", 40, (R @ [0.1, 0.05, 0.1]).tolist())
    for end, x in (("f", 0.5), ("b", -0.5)):
        for side, y in (("l", 0.4), ("r", -0.4)):
            made.wheel(end + side, "base_link", (R @ [x, y, -0.2]).tolist())
    axis = " ".join(map(repr, (R @ [0.0, 1.0, 0.0]).tolist()))
    made.parts = [part.replace('<axis xyz="0.0 1.0 0.0"/>', f'<axis xyz="{axis}"/>') for part in made.parts]
    return made.say(up=[float(v) for v in up]).load(tmp_path)


@pytest.mark.parametrize("up", [(1, 0, 0), (0, 1, 0), (0, -1, 0.2), (1, 1, 1), (2, 0, 0.5)])
def test_up_of_the_root_link_is_turned_to_z_by_the_shortest_way(tmp_path, up):
    plain = rp.settle(turned(tmp_path / "plain", (0, 0, 1)), rp.Terrain.slope(12), yaw=0.4)
    other = rp.settle(turned(tmp_path / "other", up), rp.Terrain.slope(12), yaw=0.4)
    assert other.settled, other
    np.testing.assert_allclose(other.rpy, plain.rpy, atol=1e-9)
    np.testing.assert_allclose(other.position, plain.position, atol=1e-9)
    for wheel, load in plain.loads.items():
        assert other.loads[wheel] == pytest.approx(load, abs=1e-6)


def test_up_that_points_down_stands_on_its_wheels(tmp_path):
    """z down: any half turn does; it must stand, level, with the same sum."""
    stance = rp.settle(turned(tmp_path, (0, 0, -1)), rp.Terrain.flat())
    assert stance.settled, stance
    np.testing.assert_allclose(stance.rpy, 0.0, atol=1e-9)
    assert stance.com[2] > 0.2
    assert sorted(stance.loads.values())[0] > 0


def stiff(tmp_path, stiffness):
    sidecar = yaml.safe_load((FIXTURES / "sprung4" / "rover.yaml").read_text())
    for spring in sidecar["springs"]:
        spring["stiffness"] = stiffness
    path = tmp_path / "rover.yaml"
    path.write_text(yaml.safe_dump(sidecar))
    return rp.load(FIXTURES / "sprung4" / "sprung4.urdf", sidecar=path)


@pytest.mark.parametrize("stiffness", [0.0, 1.0, 100.0, 1e4, 1e6, 1e8])
def test_springs_from_none_to_rigid(tmp_path, stiffness):
    stance = rp.settle(stiff(tmp_path, stiffness), ROUGH, x=0.3, y=0.4, yaw=0.3)
    assert stance.settled, stance
    assert sum(stance.loads.values()) == pytest.approx(stance.weight, rel=1e-9)
    assert stance.residuals["equilibrium"] < 1e-9


def test_the_stiffest_springs_are_a_rigid_rover(tmp_path):
    held = {f"slide_{end}{side}": 0.0 for end in "fb" for side in "lr"}
    rigid = rp.settle(fixture("sprung4"), ROUGH, x=0.3, y=0.4, yaw=0.3, joints=held)
    stance = rp.settle(stiff(tmp_path, 1e9), ROUGH, x=0.3, y=0.4, yaw=0.3)
    assert rigid.settled, rigid
    assert stance.settled, stance
    np.testing.assert_allclose(stance.rpy, rigid.rpy, atol=1e-5)
    for wheel, load in rigid.loads.items():
        assert stance.loads[wheel] == pytest.approx(load, abs=0.05)


def test_everything_locked_is_a_rigid_rover():
    locked = {"rocker_l": 0.0, "bogie_l": 0.0, "bogie_r": 0.0}
    stance = rp.settle(fixture("thirds"), ROUGH, x=0.3, joints=locked)
    assert stance.settled, stance
    assert stance.joints["rocker_r"] == 0.0
    assert sum(load > 0 for load in stance.loads.values()) == 3


def test_a_braked_wheel_carries_alike_however_it_is_turned():
    plain = rp.settle(fixture("thirds"), ROUGH, x=0.3)
    turned_wheel = rp.settle(fixture("thirds"), ROUGH, x=0.3, joints={"drive_fl": 1.3})
    assert turned_wheel.joints["drive_fl"] == 1.3
    assert turned_wheel.locked == ()
    for wheel, load in plain.loads.items():
        assert turned_wheel.loads[wheel] == pytest.approx(load, abs=1e-6)


@pytest.mark.parametrize("radius", [0.0, 0.03])
def test_feet_on_rough_ground(tmp_path, radius):
    """Points and balls: contact where the ground is, a radius off along its normal."""
    made = Builder("table").link("base_link", 12, (0.05, 0, 0.1))
    places = {"lf": (0.4, 0.3, -0.4), "rf": (0.4, -0.3, -0.4), "h": (-0.4, 0.02, -0.4)}
    for name, place in places.items():
        made.link(name, 1e-6).joint(f"to_{name}", "base_link", name, place, kind="fixed")
    made.say(contacts=[{"name": n, "frame": n, "radius": radius, "friction": 0.7} for n in places])
    stance = rp.settle(made.load(tmp_path), ROUGH, x=0.4, y=-0.2, yaw=0.9)
    assert stance.settled, stance
    assert stance.redundant == 0
    data = stance.rover.model.createData()
    pin.forwardKinematics(stance.rover.model, data, np.array(stance.configuration))
    for contact in stance.contacts:
        foot = next(f for f in stance.rover.feet if f.name == contact.wheel)
        center = data.oMi[foot.joint].act(np.array(foot.center))
        np.testing.assert_allclose(center - radius * contact.normal, contact.point, atol=1e-8)
        np.testing.assert_allclose(contact.normal, ROUGH.normal(*contact.point[:2]), atol=1e-7)
        assert not contact.rolling.any()
    assert sum(stance.loads.values()) == pytest.approx(stance.weight, rel=1e-9)
