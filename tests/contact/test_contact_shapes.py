import math
import subprocess
import sys

import numpy as np
import pytest
from contact_oracle import unit

from rover_pin.contact import Capsule, Foot, Wheel, half_extents, pack
from rover_pin.contact.point import point_foot
from rover_pin.errors import InputError


def wheel(**changes):
    values = {
        "name": "fl", "link": "wheel_fl", "joint": 3, "center": [0.1, 0.2, 0.0], "axis": [0, 2, 0],
        "radius": 0.1, "width": 0.06,
    }  # fmt: skip
    return Wheel(**{**values, **changes})


def test_tread_defaults_to_half_the_width_and_at_most_the_radius():
    assert wheel().tread == pytest.approx(0.03)
    assert wheel(width=0.5).tread == pytest.approx(0.1)
    assert wheel(width=0.5).ring == 0.0
    assert wheel(tread=0.05).ring == pytest.approx(0.05)
    assert wheel().axis.tolist() == [0, 1, 0]
    assert not wheel().center.flags.writeable


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"tread": 0.2}, "fl: tread is more than the radius 0.1 m (got 0.2); give at most the radius"),
        (
            {"tread": -0.1},
            "fl: tread is not a finite number of zero or more (got -0.1); give tread in metres",
        ),
        ({"radius": 0.0}, "fl: radius is not a finite number above zero (got 0.0); give radius in metres"),
        ({"radius": math.nan}, "fl: radius is not a finite number above zero (got nan)"),
        ({"radius": "x"}, "fl: radius is not a finite number above zero (got 'x')"),
        ({"axis": [0, 0, 0]}, "fl: axis has no direction"),
        ({"center": [0, 1]}, "fl: center is not three finite numbers (got [0, 1]); give center: [x, y, z]"),
        ({"center": "abc"}, "fl: center is not three finite numbers"),
        ({"friction": -1}, "fl: friction is not a finite number of zero or more (got -1); give friction"),
    ],
)
def test_a_wheel_that_is_none(changes, message):
    with pytest.raises(InputError) as caught:
        wheel(**changes)
    assert message in str(caught.value)


def test_feet_and_capsules():
    foot = Foot("lf", "LF_FOOT", 2, [0, 0, 0.1], 0.02, 0.7)
    assert (foot.form, foot.ring, foot.tread) == (0, 0.0, 0.02)
    bare = point_foot("rf", "RF_FOOT", 4, [0, 0, 0])
    assert (bare.radius, bare.tread) == (0.0, 0.0)
    rod = Capsule("skid", "base", 1, [0, 0, 0], [1, 0, 0], 0.3, 0.05)
    assert (rod.form, rod.ring, rod.tread) == (1, 0.3, 0.05)
    with pytest.raises(InputError, match="lf: radius is not a finite number of zero or more"):
        Foot("lf", "LF_FOOT", 2, [0, 0, 0], -1.0)
    with pytest.raises(InputError, match="skid: half_length is not"):
        Capsule("skid", "base", 1, [0, 0, 0], [1, 0, 0], math.inf, 0.05)


def test_packing():
    packed = pack([wheel(), Foot("lf", "LF_FOOT", 2, [0, 0, 0.1], 0.02)])
    assert packed.forms.tolist() == [0, 0]
    assert packed.joints.tolist() == [3, 2]
    assert packed.rings == pytest.approx([0.07, 0.0])
    assert packed.treads == pytest.approx([0.03, 0.02])
    assert packed.centers.shape == packed.axes.shape == (2, 3)
    assert pack([]).centers.shape == (0, 3)


def test_half_extents_hold_every_point():
    rng = np.random.default_rng(0)
    t = np.linspace(0, 2 * math.pi, 2001)
    for _ in range(20):
        axis = unit(rng.normal(size=3))
        u = unit(np.cross(axis, rng.normal(size=3)))
        v = np.cross(axis, u)
        circle = 0.2 * (np.cos(t)[:, None] * u + np.sin(t)[:, None] * v)
        ring, rod = half_extents([0, 1], [axis, axis], [0.2, 0.2], [0.05, 0.0])
        assert ring == pytest.approx(np.abs(circle[:, :2]).max(0) + 0.05, abs=1e-6)
        assert rod == pytest.approx(0.2 * np.abs(axis[:2]))


def test_importing_the_room_is_light():
    heavy = "{'matplotlib', 'xarray', 'meshcat', 'yourdfpy', 'rover_pin.contact.search'}"
    code = f"import rover_pin.contact, sys; print(sorted({heavy} & set(sys.modules)))"
    got = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert got.stdout.strip() == "[]"
