"""What stays the same when map, heading, side, or units change; and what loads always obey."""

import math
import re

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

import rover_pin as rp

ROVERS = {name: rp.load(name) for name in ("rocker_bogie", "hit_mrii")}
quick = settings(max_examples=12, deadline=None, derandomize=True)
robots = st.sampled_from(sorted(ROVERS))
seeds = st.integers(0, 500)
angles = st.floats(-math.pi, math.pi)
places = st.floats(-5.0, 5.0)
sizes = st.floats(0.02, 0.2)


def grid(seed, rms, nodes=241, spacing=0.1):
    """Heights of a rough map."""
    terrain = rp.Terrain.rough(seed, rms, 0.7, size=(nodes - 1) * spacing, spacing=spacing)
    nodes = np.arange(-(nodes // 2), nodes // 2 + 1) * spacing
    x, y = np.meshgrid(nodes, nodes)
    return terrain.height(x, y)


def swells(seed, height):
    """A smooth function and its gradient."""
    rng = np.random.default_rng(seed)
    waves, phases = rng.uniform(-2.0, 2.0, (6, 2)), rng.uniform(0.0, 2 * math.pi, 6)
    tall = height * rng.uniform(0.2, 0.6, 6)

    def f(x, y):
        return sum(a * np.sin(k[0] * x + k[1] * y + p) for a, k, p in zip(tall, waves, phases, strict=True))

    def df(x, y):
        slopes = [a * np.cos(k[0] * x + k[1] * y + p) for a, k, p in zip(tall, waves, phases, strict=True)]
        return tuple(sum(s * k[i] for s, k in zip(slopes, waves, strict=True)) for i in (0, 1))

    return f, df


def alike(a, b, *, roll=1.0, length=1.0, force=1.0, swap=None, tolerance=1e-8):
    """Two stances, b's numbers scaled or mirrored to a's."""
    assert a.status is b.status
    assert b.position[2] / length == pytest.approx(a.position[2], abs=tolerance)
    assert roll * b.rpy[0] == pytest.approx(a.rpy[0], abs=tolerance)
    assert b.rpy[1] == pytest.approx(a.rpy[1], abs=tolerance)
    swap = swap or (lambda name: name)
    for wheel, load in a.loads.items():
        assert b.loads[swap(wheel)] / force == pytest.approx(load, abs=1e-4), wheel
    for joint, value in a.joints.items():
        assert b.joints[swap(joint)] == pytest.approx(value, abs=tolerance), joint


@quick
@given(robots, seeds, sizes, places, places, angles)
def test_loads_carry_the_weight_and_never_pull(robot, seed, rms, x, y, yaw):
    stance = rp.settle(ROVERS[robot], rp.Terrain.rough(seed, rms, 0.7), x=x, y=y, yaw=yaw)
    if not stance.settled:
        assert not stance.loads
        return
    assert sum(stance.loads.values()) == pytest.approx(stance.weight, rel=1e-9)
    assert min(contact.load for contact in stance.contacts) >= 0.0
    assert min(stance.gaps.values()) > -1e-6
    for wheel, gap in stance.gaps.items():
        assert stance.loads[wheel] * gap < 1e-6 * stance.weight
    assert stance.residuals["equilibrium"] < 1e-9


@quick
@given(robots, seeds, sizes, angles, st.integers(-40, 40), st.integers(-40, 40))
def test_a_map_moved_by_whole_nodes(robot, seed, rms, yaw, i, j):
    z, spacing = grid(seed, rms), 0.125
    rover = ROVERS[robot]
    first = rp.Terrain.from_grid(z, spacing)
    moved = rp.Terrain.from_grid(z, spacing, (i * spacing, j * spacing))
    a = rp.settle(rover, first, x=15.0, y=15.0, yaw=yaw)
    b = rp.settle(rover, moved, x=15.0 + i * spacing, y=15.0 + j * spacing, yaw=yaw)
    alike(a, b)


@quick
@given(robots, seeds, sizes, places, places, angles, angles)
def test_ground_and_heading_turned_together(robot, seed, height, x, y, yaw, turn):
    f, df = swells(seed, height)
    c, s = math.cos(turn), math.sin(turn)

    def g(x, y):
        return f(c * x + s * y, -s * x + c * y)

    def dg(x, y):
        gx, gy = df(c * x + s * y, -s * x + c * y)
        return c * gx - s * gy, s * gx + c * gy

    a = rp.settle(ROVERS[robot], rp.Terrain.from_function(f, df), x=x, y=y, yaw=yaw)
    turned = rp.Terrain.from_function(g, dg)
    b = rp.settle(ROVERS[robot], turned, x=c * x - s * y, y=s * x + c * y, yaw=yaw + turn)
    alike(a, b)


def other_side(name):
    """Left for right: rocker_l, fl, drive_ml, L_bogie, LF."""
    if name[0] in "LR":
        return "RL"["LR".index(name[0])] + name[1:]
    return re.sub("[lr]$", lambda found: "rl"["lr".index(found[0])], name)


@quick
@given(robots, seeds, sizes, places, places, angles)
def test_left_and_right_are_mirror_images(robot, seed, height, x, y, yaw):
    f, df = swells(seed, height)

    def g(x, y):
        return f(x, -y)

    def dg(x, y):
        gx, gy = df(x, -y)
        return gx, -gy

    a = rp.settle(ROVERS[robot], rp.Terrain.from_function(f, df), x=x, y=y, yaw=yaw)
    b = rp.settle(ROVERS[robot], rp.Terrain.from_function(g, dg), x=x, y=-y, yaw=-yaw)
    alike(a, b, roll=-1.0, swap=other_side)


@quick
@given(seeds, sizes, angles, st.floats(0.5, 20.0))
def test_gravity_scales_loads_alone(seed, rms, yaw, gravity):
    terrain = rp.Terrain.rough(seed, rms, 0.7)
    a = rp.settle(ROVERS["hit_mrii"], terrain, yaw=yaw)
    b = rp.settle(ROVERS["hit_mrii"], terrain, yaw=yaw, gravity=gravity)
    alike(a, b, force=gravity / 9.81)


def scaled(rover, folder, k):
    """The rover k times as large, its masses as they were."""
    text = re.sub(
        r'xyz="([^"]*)"(?=[^>]*/>)',
        lambda m: 'xyz="' + " ".join(repr(k * float(v)) for v in m[1].split()) + '"',
        rover.urdf,
    )
    text = re.sub(
        r'<axis xyz="([^"]*)"',
        lambda m: '<axis xyz="' + " ".join(repr(float(v) / k) for v in m[1].split()) + '"',
        text,
    )
    sidecar = yaml.safe_load(rover.sidecar_path.read_text())
    sidecar.pop("parameters")
    for wheel in sidecar["wheels"]:
        for key in ("radius", "width", "tread"):
            wheel[key] *= k
    for spot in sidecar["belly"]:
        spot["point"] = [k * v for v in spot["point"]]
    (folder / "large.urdf").write_text(text)
    (folder / "rover.yaml").write_text(yaml.safe_dump(sidecar))
    return rp.load(folder / "large.urdf")


@pytest.mark.parametrize("k", [0.1, 0.5, 3.0, 10.0])
def test_a_robot_and_its_map_in_other_units(tmp_path, k):
    """k times as large, gravity k times as strong: angles and loads over gravity stay."""
    rover = ROVERS["rocker_bogie"]
    large = scaled(rover, tmp_path, k)
    for seed in range(6):
        z = grid(seed, 0.12)
        small = rp.Terrain.from_grid(z, 0.1)
        wide = rp.Terrain.from_grid(k * z, k * 0.1)
        a = rp.settle(rover, small, x=12.0, y=11.0, yaw=0.4 * seed)
        b = rp.settle(large, wide, x=12.0 * k, y=11.0 * k, yaw=0.4 * seed, gravity=9.81 * k)
        alike(a, b, length=k, force=k, tolerance=1e-7)
