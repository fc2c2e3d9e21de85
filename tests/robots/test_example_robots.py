"""Robots of example-robot-data by name: feet, wheels, reference postures."""

import math
import re

import numpy as np
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


def test_anymal_against_a_computation_by_hand():
    """Its feet and CoM by Pinocchio on the URDF itself; margins by plain geometry."""
    rover = rp.load("example:anymal_b")
    stance = rp.settle(rover, rp.Terrain.flat())
    model = pin.buildModelFromUrdf(str(rover.source), pin.JointModelFreeFlyer())
    q = pin.neutral(model)
    standing = {"LF": (-0.1, 0.7, -1), "RF": (0.1, 0.7, -1), "LH": (-0.1, -0.7, 1), "RH": (0.1, -0.7, 1)}
    for leg, angles in standing.items():
        for joint, value in zip(("HAA", "HFE", "KFE"), angles, strict=True):
            q[model.joints[model.getJointId(f"{leg}_{joint}")].idx_q] = value
    data = model.createData()
    com = pin.centerOfMass(model, data, q)
    pin.updateFramePlacements(model, data)
    legs = ("LF", "LH", "RH", "RF")  # round the polygon, to the left of the heading first
    balls = [data.oMf[model.getFrameId(f"{leg}_FOOT")].act(np.array([0, 0, 0.02325])) for leg in legs]
    heights = [ball[2] for ball in balls]
    assert max(heights) - min(heights) < 1e-9  # so the base stands level, and the hand has it easy
    feet = [ball[:2] for ball in balls]
    distances = []
    for a, b in zip(feet, feet[1:] + feet[:1], strict=True):
        along = (b - a) / math.dist(a, b)
        distances.append(along[0] * (com[1] - a[1]) - along[1] * (com[0] - a[0]))
    margin = rp.stability(stance)["polygon"]
    assert len(margin.edges) == 4
    assert margin.value == pytest.approx(min(distances), abs=1e-9)
    height = com[2] - heights[0] + 0.031
    tip = rp.stability(stance)["tip"].value
    assert tip == pytest.approx(math.atan(min(distances) / height), abs=1e-9)
    weight = 9.81 * pin.computeTotalMass(model)
    rows = np.array([[1.0] * 4, [f[0] for f in feet], [f[1] for f in feet]])
    least = rows.T @ np.linalg.solve(rows @ rows.T, weight * np.array([1.0, com[0], com[1]]))  # all above 0
    for leg, load in zip(legs, least, strict=True):
        assert stance.loads[f"{leg}_FOOT"] == pytest.approx(load, abs=1e-7)
    assert stance.redundant == 1


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
