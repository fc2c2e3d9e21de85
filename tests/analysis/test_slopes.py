"""Slopes at tip and at slip: closed forms of a rigid rover, suspensions, what cannot be asked."""

import dataclasses
import math

import numpy as np
import pytest
from little_rover import fixture

import rover_pin as rp
from rover_pin.analysis import slopes
from rover_pin.analysis.slopes.tilt_table import TiltTable
from rover_pin.errors import InputError

EDGES = {
    ("fl", "fr"): (1.0, 0.0),
    ("bl", "br"): (-1.0, 0.0),
    ("fl", "bl"): (0.0, 1.0),
    ("fr", "br"): (0.0, -1.0),
}
HALF = np.array([0.5, 0.4])


def by_hand(com, heading):
    """Slope at which a rigid four-wheeler tips, and the wheels of the edge it tips over."""
    downhill = np.array([math.cos(math.pi - heading), math.sin(math.pi - heading)])
    found = {}
    for wheels, normal in EDGES.items():
        distance = HALF @ np.abs(normal) - com[:2] @ normal
        if downhill @ normal > 1e-9:
            found[wheels] = math.atan(distance / (com[2] * (downhill @ normal)))
    return min(found.items(), key=lambda each: each[1])


def test_a_rigid_rover_tips_and_slips_in_closed_form():
    rover = fixture("rigid4")
    # body 60 kg at (0.1, 0.05, 0.1), four wheels of 2.5 kg at z = -0.1, the ground 0.15 below them
    com = np.array([60 * 0.1, 60 * 0.05, 60 * 0.1 - 10 * 0.1]) / 70.0 + (0.0, 0.0, 0.25)
    data = slopes(rover, 7, friction=0.4)
    for heading, tip, limiting, status in zip(
        data.heading_rad.values,
        data.tip_rad.values,
        data.tip_limiting.values,
        data.tip_status.values,
        strict=True,
    ):
        edge, expected = by_hand(com, heading)
        assert tip == pytest.approx(expected, abs=1e-6)
        assert status == "tips"
        assert str(limiting) not in edge  # a wheel on the other side has no load left
    np.testing.assert_allclose(data.slip_rad, math.atan(0.4), atol=1e-6)
    np.testing.assert_allclose(data.stands_to_rad, data.slip_rad)
    assert (data.attrs["friction"], data.attrs["robot"]) == (0.4, "rigid4")


def test_half_track_and_height_across_the_slope(make):
    # mass at (0, 0, h), wheels at half tracks t: tip at atan(t / h), slip at atan(mu) from mu < t / h only
    t, h, radius = 0.3, 0.5, 0.1
    parts, wheels = [make.link("base", 50.0, com=f"0 0 {h - radius!r}")], []
    for name, x, y in (("fl", 0.5, t), ("fr", 0.5, -t), ("rl", -0.5, t), ("rr", -0.5, -t)):
        parts += [
            make.link(f"w_{name}", 1e-6),
            make.joint(f"d_{name}", "base", f"w_{name}", "continuous", xyz=f"{x} {y} 0"),
        ]
        wheels.append(f"{{name: {name}, frame: w_{name}, radius: {radius}, width: 0.05, friction: 0.55}}")
    rover = make.load(*parts, sidecar=f"actuated: [d_fl, d_fr, d_rl, d_rr]\nwheels: [{', '.join(wheels)}]\n")
    data = slopes(rover, 4)
    across = [1, 3]
    np.testing.assert_allclose(data.tip_rad.values[across], math.atan(t / h), atol=1e-6)
    np.testing.assert_allclose(data.tip_rad.values[[0, 2]], math.atan(0.5 / h), atol=1e-6)
    np.testing.assert_allclose(data.slip_rad, math.atan(0.55), atol=1e-6)
    assert data.attrs["friction"] == "as declared"
    rough = slopes(rover, 4, friction=0.8)
    assert np.isnan(rough.slip_rad.values[across]).all()
    np.testing.assert_allclose(rough.stands_to_rad.values[across], math.atan(t / h), atol=1e-6)
    np.testing.assert_allclose(rough.slip_rad.values[[0, 2]], math.atan(0.8), atol=1e-6)
    assert list(rough.slip_limiting.values[across]) == ["", ""]


def test_wheels_that_turn_freely_slip_sooner_uphill(make):
    # two of four wheels free, the mass amid them: uphill the others carry all that goes along the slope
    parts, wheels = [make.link("base", 50.0, com="0 0 0")], []
    for name, x, y in (("fl", 0.5, 0.4), ("fr", 0.5, -0.4), ("rl", -0.5, 0.4), ("rr", -0.5, -0.4)):
        parts += [
            make.link(f"w_{name}", 1e-6),
            make.joint(f"d_{name}", "base", f"w_{name}", "continuous", xyz=f"{x} {y} 0"),
        ]
        free = "true" if name[0] == "f" else "false"
        wheels.append(
            f"{{name: {name}, frame: w_{name}, radius: 0.1, width: 0.05, friction: 0.6, free: {free}}}"
        )
    rover = make.load(*parts, sidecar=f"actuated: [d_rl, d_rr]\nwheels: [{', '.join(wheels)}]\n")
    data = slopes(rover, 4)
    # up: rear normals W cos / 2 + W sin h, with the height h = 0.1 of the mass over a wheelbase of 1
    up, down = (math.atan(0.3 / (1.0 - sign * 0.6 * 0.1)) for sign in (1, -1))
    assert data.slip_rad.values[0] == pytest.approx(up, abs=1e-6)
    assert data.slip_rad.values[2] == pytest.approx(down, abs=1e-6)
    np.testing.assert_allclose(data.slip_rad.values[[1, 3]], math.atan(0.6), atol=1e-6)
    assert str(data.slip_limiting.values[0]) in ("rl", "rr")


def test_a_suspension_tips_where_its_stance_ends():
    rover = fixture("thirds")
    limits = TiltTable(rover, 0.0, None, {}).limits()
    assert limits.tip_status == "tips"
    table = TiltTable(rover, 0.0, None, {})
    assert table.stance(limits.tip).settled
    assert not table.stance(limits.tip + limits.tip_open + 1e-6).settled
    # the load of a wheel goes to nothing there
    assert min(table.stance(limits.tip).loads.values()) < 1e-4 * rover.mass * 9.81


def test_stances_that_are_not_found_leave_the_slope_open(monkeypatch):
    table = TiltTable(fixture("rigid4"), 0.0, 0.3, {})
    tip = table.limits().tip
    plain = TiltTable.stance

    def stance(self, slope):
        found = plain(self, slope)
        if tip - 0.02 < slope < tip + 0.01:
            self._standing.pop(slope, None)
            return dataclasses.replace(found, status=rp.Status.NO_CONVERGENCE)
        return found

    monkeypatch.setattr(TiltTable, "stance", stance)
    limits = TiltTable(fixture("rigid4"), 0.0, 0.3, {}).limits()
    assert limits.tip == pytest.approx(tip - 0.02, abs=1e-6)
    assert limits.tip_open == pytest.approx(0.03, abs=3e-6)
    assert limits.tip_status == "tips"
    assert limits.slip == pytest.approx(math.atan(0.3), abs=1e-6)


def test_the_heading_stays_in_the_board():
    stance = TiltTable(fixture("rigid4"), 0.7, None, {}).stance(0.6)
    forward = np.array(
        [
            math.cos(stance.rpy[2]) * math.cos(stance.rpy[1]),
            math.sin(stance.rpy[2]) * math.cos(stance.rpy[1]),
            -math.sin(stance.rpy[1]),
        ]
    )
    uphill, across = np.array([math.cos(0.6), 0.0, math.sin(0.6)]), np.array([0.0, 1.0, 0.0])
    assert math.atan2(forward @ across, forward @ uphill) == pytest.approx(0.7, abs=1e-9)


def test_where_it_does_not_stand_on_level_ground_there_is_no_slope(make):
    # the mass is ahead of both wheel pairs
    parts, wheels = [make.link("base", 50.0, com="1 0 0.2")], []
    for name, x, y in (("fl", 0.5, 0.4), ("fr", 0.5, -0.4), ("rl", -0.5, 0.4), ("rr", -0.5, -0.4)):
        parts += [
            make.link(f"w_{name}", 1e-6),
            make.joint(f"d_{name}", "base", f"w_{name}", "continuous", xyz=f"{x} {y} 0"),
        ]
        wheels.append(f"{{name: {name}, frame: w_{name}, radius: 0.1, width: 0.05}}")
    rover = make.load(*parts, sidecar=f"actuated: [d_fl, d_fr, d_rl, d_rr]\nwheels: [{', '.join(wheels)}]\n")
    data = slopes(rover, 2)
    assert np.isnan(data.tip_rad).all()
    assert np.isnan(data.stands_to_rad).all()
    assert set(data.tip_status.values) == {"tips"}


@pytest.mark.parametrize(
    ("what", "message"),
    [
        ({"headings": 0}, r"headings: must be a whole number from 1 to 3600 \(got 0\)"),
        ({"headings": True}, r"headings: must be a whole number"),
        ({"friction": 0.0}, r"friction: not a coefficient of friction \(got 0.0\); give a number above 0"),
        ({"friction": math.nan}, r"friction: not a coefficient of friction"),
        ({"gravity": -1.0, "headings": 1}, "gravity"),
    ],
)
def test_what_cannot_be_asked_is_refused(what, message):
    with pytest.raises(InputError, match=message):
        slopes(fixture("rigid4"), **what)


def test_progress_counts_headings():
    told = []
    slopes(fixture("rigid4"), 2, friction=0.3, progress=lambda done, of: told.append((done, of)))
    assert told == [(0, 2), (1, 2), (2, 2)]
    assert rp.analysis.slopes is slopes
