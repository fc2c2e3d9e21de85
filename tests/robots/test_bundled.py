"""What every bundled robot owes: data that ship, parameters that agree, masses that can exist."""

import re
from importlib import resources
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
import yaml

import rover_pin as rp

ROBOTS = ["hit_mrii", "polibot", "polibot_half", "rocker_bogie", "x_suspension"]
SYMMETRIC = ["hit_mrii", "polibot", "rocker_bogie"]
MASSLESS = ["polibot", "polibot_half", "x_suspension"]
"""Robots whose papers leave arms and wheels without weight."""


def folder(name):
    return Path(str(resources.files("rover_pin.urdf"))) / name


def sidecar(name):
    return yaml.safe_load((folder(name) / "rover.yaml").read_text())


BOUNDS = [
    (name, parameter, bound)
    for name in ROBOTS
    for parameter, spec in sidecar(name)["parameters"].items()
    for bound in spec["bounds"]
    if name != "polibot" or parameter not in sidecar("polibot_half")["parameters"]
]
"""A parameter of the whole Polibot that its half has too is tried there."""


@pytest.mark.parametrize("name", ROBOTS)
def test_ships_description_sidecar_and_sources(name):
    for file in (f"{name}.urdf.xacro", "rover.yaml", "README.md"):
        assert (folder(name) / file).is_file()
    assert (folder(name).parent / "solids.xacro").is_file()


def test_catalogue_lists_them():
    assert {entry.name for entry in rp.robots()} >= set(ROBOTS)


@pytest.mark.parametrize("name", ROBOTS)
def test_nothing_had_to_be_guessed(name):
    notes = rp.load(name).notes
    assert len(notes) == (1 if name in MASSLESS else 0)
    assert all("no mass" in note for note in notes)


@pytest.mark.parametrize("name", ROBOTS)
def test_parameters_are_the_arguments_of_the_xacro_and_the_formulas_of_the_sidecar(name):
    main = folder(name) / f"{name}.urdf.xacro"
    included = re.findall(r'<xacro:include filename="([^"]+)"/>', main.read_text())
    text = "".join(path.read_text() for path in (main, *(main.parent / file for file in included)))
    arguments = {n: float(v) for n, v in re.findall(r'<xacro:arg name="(\w+)" default="([^"]+)"/>', text)}
    declared = {n: spec["default"] for n, spec in sidecar(name)["parameters"].items()}
    assert arguments.items() <= declared.items()
    formulas = re.findall(r"\$\{([^}]*)\}", (folder(name) / "rover.yaml").read_text())
    used = {word for formula in formulas for word in re.findall(r"\w+", formula)}
    assert declared.keys() - arguments.keys() <= used


@pytest.mark.parametrize("name", ROBOTS)
def test_every_parameter_is_in_the_readme(name):
    text = (folder(name) / "README.md").read_text()
    assert not [n for n in sidecar(name)["parameters"] if f"`{n}`" not in text]


@pytest.mark.parametrize("name", ROBOTS)
def test_wheel_sizes_agree_with_the_drawn_ones(name):
    rover = rp.load(name)
    for wheel in rover.wheels:
        drawn = {v.size for v in rover.visuals if v.link == wheel.link and v.kind == "cylinder"}
        assert (wheel.radius, wheel.width) in drawn


@pytest.mark.parametrize("name", ROBOTS)
def test_inertias_can_exist(name):
    """Principal moments are positive and none exceeds the sum of the others."""
    model = rp.load(name).model
    for body, inertia in zip(model.names, model.inertias, strict=True):
        if inertia.mass == 0.0:
            continue
        moments = np.linalg.eigvalsh(inertia.inertia)
        assert moments[0] > 0, body
        assert moments[2] <= moments[0] + moments[1] + 1e-12, body


@pytest.mark.parametrize("name", SYMMETRIC)
def test_left_mirrors_right_at_home(name):
    rover = rp.load(name)
    places = wheel_places(rover, np.zeros(rover.model.nv))
    half = len(places) // 2
    mirrored = np.array(places[:half]) * [1, -1, 1]
    np.testing.assert_allclose(mirrored, places[half:], atol=1e-12)


@pytest.mark.parametrize("name", ROBOTS)
def test_stands_in_every_named_posture(name):
    rover = rp.load(name)
    for posture in rover.postures:
        stance = rp.settle(rover, rp.Terrain.flat(), posture=posture)
        assert stance.settled, (posture, stance.reason)
        assert sum(stance.loads.values()) == pytest.approx(rover.mass * 9.81, rel=1e-9)


@pytest.mark.parametrize(("name", "parameter", "bound"), BOUNDS)
def test_stands_at_the_bounds_of_each_parameter(name, parameter, bound):
    rover = rp.load(name, **{parameter: bound})
    assert rover.parameters[parameter] == bound
    stance = rp.settle(rover, rp.Terrain.flat(), posture="home")
    assert stance.settled, stance.reason


def wheel_places(rover, q):
    """World positions of the wheels' centres, in the rover's order."""
    data = rover.model.createData()
    pin.forwardKinematics(rover.model, data, q)
    return [data.oMi[wheel.joint].act(np.array(wheel.center)) for wheel in rover.wheels]
