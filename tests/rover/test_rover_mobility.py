"""Rank, redundancy and mobility; what info tells; loops that cannot close."""

import json

import numpy as np
import pytest

import rover_pin as rp
from rover_pin.mobility import close_loops


def four_bar(make, coupler=2.0, kind="ball", more=""):
    """A crank and a rocker of 1 m standing 2 m apart, and a coupler on the crank; axes along y."""
    parts = [
        make.link("base"),
        make.link("crank"),
        make.link("coupler"),
        make.link("rocker"),
        make.link("end"),
        make.link("top"),
        make.joint("a", "base", "crank", "continuous"),
        make.joint("b", "crank", "coupler", "continuous", xyz="0 0 1"),
        make.joint("c", "base", "rocker", "continuous", xyz="2 0 0"),
        make.joint("e", "coupler", "end", "fixed", xyz=f"{coupler} 0 0"),
        make.joint("t", "rocker", "top", "fixed", xyz="0 0 1"),
    ]
    sidecar = f"loops: [{{name: bar, frames: [end, top], type: {kind}{more}}}]"
    return make.load(*parts, sidecar=sidecar)


@pytest.mark.parametrize(
    ("kind", "more", "rows", "rank"),
    [
        ("ball", "", 3, 2),
        ("planar", ", axis: [0, 1, 0]", 2, 2),
        ("hinge", ", axis: [0, 1, 0]", 5, 2),
        ("weld", "", 6, 3),
        ("distance", ", length: 0.1", 1, 1),
    ],
)
def test_a_four_bar_counts(make, kind, more, rows, rank):
    counts = four_bar(make, 2.2 if kind == "distance" else 2.0, kind, more).mobility
    assert (counts.joints, counts.rows, counts.rank) == (3, rows, rank)
    assert (counts.mobility, counts.redundancy) == (3 - rank, rows - rank)


def test_loops_are_closed_before_they_are_counted(make):
    rover = four_bar(make, coupler=2.3)
    at = close_loops(rover.model, rover.couplings, rover.loops, rover.neutral, 6)
    assert np.abs(rover.loops[0].residual(at)).max() < 1e-10
    assert np.abs(at.q[6:]).max() > 0.01
    assert np.all(at.q[:6] == 0)
    assert rover.mobility.mobility == 1


def test_a_loop_that_cannot_close(make):
    rover = four_bar(make, coupler=5.0)
    with pytest.raises(rp.errors.MechanismError) as caught:
        rover.info()
    assert str(caught.value).startswith(
        f"{rover.sidecar_path}: loops.bar: it cannot close from the home posture: "
    )
    assert "m or rad remain; check its frames and lengths" in str(caught.value)


def test_info_is_plain_json(make):
    rover = make.load(
        *make.pair(limits="-1 1e300"),
        make.link("wheel"),
        make.joint("d", "arm", "wheel", "continuous"),
        sidecar="""
        wheels: [{frame: wheel, radius: 0.2, width: 0.1}]
        contacts: [{name: toe, frame: arm}]
        couplings: [{name: gear, joints: {j: 1, d: 2}}]
        springs:
          - {name: s, joint: j, stiffness: 3, preload: 1}
          - {name: t, frames: [base, wheel], stiffness: 4, length_max: 1}
        """,
    )
    told = json.loads(json.dumps(rover.info(), allow_nan=False))
    assert told["robot"] == "bot"
    assert told["mass_kg"] == 3.0
    assert told["joints"] == {
        "j": {"actuated": False, "lower": -1.0, "upper": None},
        "d": {"actuated": True, "lower": None, "upper": None},
    }
    assert told["wheels"]["wheel"]["drive"] == "d"
    assert told["couplings"] == {"gear": {"joints": {"j": 1.0, "d": 2.0}, "offset": 0.0}}
    assert told["springs"]["s"] == {"on": "j", "stiffness": 3.0, "preload": 1.0}
    assert told["springs"]["t"]["on"] == ["base", "wheel"]
    assert list(told["contacts"]) == ["toe"]
    assert (told["mobility"], told["rank"], told["redundancy"]) == (1, 1, 0)
    assert told["notes"] == list(rover.notes)
