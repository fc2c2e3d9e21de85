"""Robots of example-robot-data by name: feet, wheels, reference postures."""

import re

import pinocchio as pin
import pytest

import rover_pin as rp
from rover_pin.description import examples


def total(stance):
    return sum(stance.loads.values())


@pytest.mark.parametrize("name", [each.name for each in examples.EXAMPLES])
def test_it_stands_on_flat_ground_and_carries_its_weight(name):
    rover = rp.load(f"example:{name}")
    assert rover.name == f"example:{name}"
    free = pin.buildModelFromUrdf(str(rover.source), pin.JointModelFreeFlyer())
    assert rover.mass == pytest.approx(pin.computeTotalMass(free), rel=1e-12)
    stance = rp.settle(rover, rp.Terrain.flat())
    assert str(stance.status) == "settled"
    assert total(stance) == pytest.approx(9.81 * rover.mass, rel=1e-9)
    assert min(stance.loads.values()) > 0
    assert stance.residuals["equilibrium"] < 1e-9
    margins = rp.stability(stance)
    assert margins["polygon"].value > 0.04
    assert not any("missing" in note for note in rover.notes)


@pytest.mark.parametrize(
    ("name", "state"), [("anymal_b", "standing"), ("hyq", "standing"), ("solo12", "straight_standing")]
)
def test_home_is_the_srdfs_posture(name, state):
    rover = rp.load(f"example:{name}")
    assert dict(rover.postures["home"]) == dict(rover.postures[state])


def test_an_example_that_is_not_there(monkeypatch):
    with pytest.raises(rp.errors.DescriptionError) as caught:
        rp.load("example:anymal")
    assert str(caught.value).startswith(
        "no example of that name (got 'example:anymal'); did you mean 'example:anymal_b'"
    )
    monkeypatch.setattr(examples, "_places", lambda: iter([examples.Path("/nowhere")]))
    with pytest.raises(rp.errors.DescriptionError) as caught:
        rp.load("example:anymal_b")
    assert re.fullmatch(
        r"example-robot-data has no anymal_b_simple_description/robots/anymal.urdf, or is not installed "
        r"\(got 'example:anymal_b'\); pip install example-robot-data; tried /nowhere",
        str(caught.value),
    )


def test_every_example_has_its_sidecar():
    folder = examples.sidecar_of("example:talos").parent
    assert {path.stem for path in folder.glob("*.yaml")} == {each.name for each in examples.EXAMPLES}
