"""Traverse: planes and edges in closed form, stances against lowering, paths, what cannot be asked."""

import math

import numpy as np
import pytest
from little_rover import fixture
from scipy.optimize import brentq

import rover_pin as rp
from rover_pin.analysis import largest_step, traverse
from rover_pin.analysis.traverse.path import places, waypoints
from rover_pin.errors import InputError, OffMapError
from rover_pin.viz.traverse import plot_traverse
from rover_pin.viz.traverse_motion import traverse_run

RADIUS, HALF, WEIGHT = 0.15, 0.5, 70.0 * 9.81
COM = np.array([6.0 / 70.0, 5.0 / 70.0])
"""Of `rigid4` in the plane of the base's x and z; its axles are at (+-HALF, -0.1)."""

RISER = 0.005


def least_mu(front, front_normal, rear, rear_normal, com, climbing):
    """Two wheels at the limit of friction, the climbing one held back: the reactions meet over the mass."""

    def turned(normal, angle):
        c, s = math.cos(angle), math.sin(angle)
        return np.array([c * normal[0] + s * normal[1], -s * normal[0] + c * normal[1]])

    def moment(mu):
        a, b = turned(front_normal, math.atan(mu)), turned(rear_normal, math.atan(mu))
        forces = np.linalg.solve(np.column_stack([a, b]), [0.0, 1.0])
        return sum(
            f * ((p - com)[0] * d[1] - (p - com)[1] * d[0])
            for f, p, d in zip(forces, (front, rear), (a, b), strict=True)
        )

    return brentq(moment, 1e-6, 0.99 * math.tan(0.5 * climbing), xtol=1e-12) if climbing else 0.0


def at_the_edge(height, which):
    """Least friction of the two-axle rover as its front, or rear, wheels leave the ground at an edge."""
    phi = math.acos((RADIUS - height) / RADIUS)
    pitch = 0.0 if which == "front" else math.asin(height / (2.0 * HALF))
    along, up = np.array([math.cos(pitch), math.sin(pitch)]), np.array([-math.sin(pitch), math.cos(pitch)])
    rear = np.array([0.0, RADIUS])
    front = rear + 2.0 * HALF * along
    com = rear + (HALF + COM[0]) * along + (0.1 + COM[1]) * up
    tilted, plain = np.array([-math.sin(phi), math.cos(phi)]), np.array([0.0, 1.0])
    normals = (tilted, plain) if which == "front" else (plain, tilted)
    return least_mu(
        front - RADIUS * normals[0], normals[0], rear - RADIUS * normals[1], normals[1], com, 2 * phi
    )


@pytest.fixture(scope="module")
def stepped():
    return traverse(
        fixture("rigid4"), rp.Terrain.step(0.04, 0.0, RISER), "-0.8,0;0.8,0", step=0.04, friction=0.8
    )


@pytest.mark.parametrize("angle", [12.0, -20.0])
def test_an_inclined_plane_in_closed_form(angle):
    data = traverse(
        fixture("rigid4"), rp.Terrain.slope(angle), "0,0;0.2,0", step=0.1, measures=["tip", "polygon"]
    )
    slope = math.radians(abs(angle))
    np.testing.assert_allclose(data.friction_needed, math.tan(slope), atol=1e-6)
    np.testing.assert_allclose(4.0 * data.torque_needed, RADIUS * WEIGHT * math.sin(slope), rtol=1e-6)
    np.testing.assert_allclose(data.effort_share, data.torque_needed / 50.0, rtol=1e-6)
    np.testing.assert_allclose(data.load_n.sum("wheel"), WEIGHT, rtol=1e-9)
    assert data.attrs["passed"] == 1
    stance = rp.settle(fixture("rigid4"), rp.Terrain.slope(angle), x=0.1)
    assert float(data.polygon[1]) == pytest.approx(
        rp.stability(stance, ["polygon"])["polygon"].value, abs=1e-9
    )


def test_a_steps_edge_in_closed_form(stepped):
    first = stepped.friction_needed.where(stepped.pitch_rad > -0.03)
    front = float(first.where(stepped.x_m < 0.0).max())
    rear = float(stepped.friction_needed.where(stepped.x_m > 0.0).max())
    assert front == pytest.approx(at_the_edge(0.04, "front"), abs=5e-4)
    assert rear == pytest.approx(at_the_edge(0.04, "rear"), abs=5e-4)
    # just before it leaves the ground the edge is not felt
    k = int(np.argmax(stepped.friction_needed.values > 0.1))
    assert float(stepped.friction_needed[k - 1]) < 1e-6
    assert float(stepped.way_m[k] - stepped.way_m[k - 1]) <= 0.04 / 4096 * 1.01
    assert stepped.attrs["unresolved_m"] == 0.0
    assert float(stepped.x_m[k]) == pytest.approx(-HALF - math.sqrt(RADIUS**2 - 0.11**2), abs=2e-5)


def test_the_largest_step_lies_where_the_edge_asks_for_the_friction_given():
    found = largest_step(fixture("rigid4"), 0.12, riser=RISER, tolerance=0.008, step=0.08, friction=0.5)
    exact = min(
        brentq(lambda h, w=which: at_the_edge(h, w) - 0.5, 0.02, 0.12, xtol=1e-9)
        for which in ("front", "rear")
    )
    assert found.climbed <= exact <= found.stopped
    assert found.stopped - found.climbed <= 0.008
    assert found.limit == "friction"
    assert found.why.startswith("needs friction 0.")
    assert found.friction_needed <= 0.5
    assert dict(zip(found.trials, found.climbs, strict=True))[found.stopped] is False


def test_a_climb_beyond_what_was_asked_for_is_told():
    found = largest_step(fixture("rigid4"), 0.01, step=0.1)
    assert (found.climbed, found.stopped, found.limit) == (0.01, math.inf, "")


def test_every_stance_is_the_one_of_lowering_where_there_is_one_only():
    rover, terrain = rp.load("rocker_bogie"), rp.Terrain.rough(1, 0.08, 0.8)
    data = traverse(rover, terrain, "0,0;0.3,0;0.3,0.2", step=0.1)
    assert set(data.status.values) == {"settled"}
    assert int(data.followed.sum()) == data.sizes["step"] - 1
    assert data.yaw_rad.values[[0, -1]] == pytest.approx([0.0, math.pi / 2])
    turning = data.isel(step=data.turning.values == 1)
    assert np.ptp(turning.way_m.values) == 0.0
    for k in range(0, data.sizes["step"], 3):
        one = data.isel(step=k)
        stance = rp.settle(rover, terrain, x=float(one.x_m), y=float(one.y_m), yaw=float(one.yaw_rad))
        assert float(one.z_m) == pytest.approx(stance.position[2], abs=1e-8)
        for name in one.joint.values:
            assert float(one.joint_rad.sel(joint=name)) == pytest.approx(stance.joints[str(name)], abs=1e-8)
        for name, load in stance.loads.items():
            assert float(one.load_n.sel(wheel=name)) == pytest.approx(load, abs=1e-5)


def test_it_stops_by_friction_by_torque_and_by_tipping():
    rigid = fixture("rigid4")
    slips = traverse(rigid, rp.Terrain.slope(30.0), "0,0;1,0", friction=0.5, until_stop=True)
    assert slips.sizes["step"] == 1
    assert (slips.attrs["passed"], slips.attrs["stop_limit"], slips.attrs["stop_m"]) == (0, "friction", 0.0)
    assert slips.attrs["stop_why"] == "needs friction 0.5774 where there is 0.5"
    heavy = rigid.with_payload([(200.0, (0.0, 0.0, 0.0))])
    torque = traverse(heavy, rp.Terrain.slope(33.0), "0,0;0.01,0", friction=3.0)  # so that all pull alike
    expected = RADIUS * 270.0 * 9.81 * math.sin(math.radians(33.0)) / 4.0 / 50.0
    assert torque.attrs["stop_limit"] == "torque"
    assert float(torque.effort_share[0]) == pytest.approx(expected, rel=1e-6)
    tips = traverse(rigid, rp.Terrain.slope(70.0), "0,0;0.01,0", friction=5.0)
    assert tips.attrs["stop_limit"] == "tip"
    assert tips.attrs["stop_at"] in {"fl", "fr", "bl", "br"}
    assert np.isnan(tips.load_n).all()


def test_reversed_and_crabbed_headings():
    rigid, flat = fixture("rigid4"), rp.Terrain.flat()
    back = traverse(rigid, flat, "0,0;1,0", step=1.0, reverse=True)
    assert np.cos(back.yaw_rad.values) == pytest.approx(-1.0)
    aside = traverse(rigid, flat, "0,0;0,1", step=5.0, crab=math.radians(-90.0))
    assert aside.sizes["step"] == 2  # a step longer than the path: both ends
    np.testing.assert_allclose(aside.yaw_rad, 0.0, atol=1e-12)


def test_the_motion_and_the_figure_follow_the_path(stepped, tmp_path):
    rover, terrain = fixture("rigid4"), rp.Terrain.step(0.04, 0.0, RISER)
    run = traverse_run(stepped, rover, terrain)
    q = np.asarray(run.configuration)
    np.testing.assert_allclose(q[:, 0], stepped.x_m)
    np.testing.assert_allclose(q[-1, rover.column["drive_fl"]], 1.6 / RADIUS)
    np.testing.assert_allclose(run.indices["friction needed of given"][:, 0], stepped.friction_needed / 0.8)
    assert float(run.time[-1]) == pytest.approx(16.0)
    figure = plot_traverse(stepped)
    labels = [axis.get_ylabel() for axis in figure.axes]
    assert labels == [
        "load [N]",
        "friction [–]",
        "torque [N m]",
        "Tip-over angle\n[°]",
        "posture [°]",
        "height [m]",
    ]
    page = rp.viz.save_traverse_html(stepped, rover, terrain, tmp_path / "t.html").read_text()
    assert "rigid4 along a line" in page


def test_waypoints_from_words_numbers_and_files(tmp_path):
    expected = [[0.0, 0.0], [1.0, 2.0], [-1.0, 0.5]]
    file = tmp_path / "way.csv"
    file.write_text("x, y\n0,0\n# a comment\n1,2\n1,2\n\n-1,5e-1\n")
    for given in ("0,0;1,2;-1,0.5", "0,0; 1,2;1,2;-1,0.5;", expected, np.array(expected), file, str(file)):
        np.testing.assert_array_equal(waypoints(given), expected)
    along = places(waypoints("0,0;1,0;1,1"), 0.3, 0.0)
    assert [place.way for place in along[:5]] == pytest.approx([0.0, 0.25, 0.5, 0.75, 1.0])
    assert sum(place.turning for place in along) == 9
    # a U-turn past the back takes the short way round
    yaws = [place.yaw for place in places(waypoints("0,0;-1,0.1;-2,0"), 5.0, 0.0)]
    assert np.ptp(yaws) < 0.3


@pytest.mark.parametrize(
    ("path", "message"),
    [
        ("1,2", "path: needs two different waypoints (got '1,2'); write x1,y1;x2,y2 in m"),
        ("1,2;1,2", "path: needs two different waypoints"),
        ("", "path: needs two different waypoints (got 'nothing')"),
        ("0,0;1", "path, waypoint 2: is no pair of numbers (got '1'); write x,y in m"),
        ("0,0;nan,1", "path, waypoint 2: is not finite (got 'nan,1'); write x,y in m"),
        ([(0, 0), (1, 2, 3)], "path, waypoint 2: is no pair of numbers (got '1,2,3')"),
        (3.0, "path: is no path (got '3.0'); give (x, y) pairs [m]"),
        ("nowhere.csv", "nowhere.csv: path: No such file or directory; give x1,y1;x2,y2"),
    ],
)
def test_paths_that_are_none(path, message):
    with pytest.raises(InputError) as caught:
        waypoints(path)
    assert message in str(caught.value)


def test_a_malformed_file_names_its_line(tmp_path):
    file = tmp_path / "way.csv"
    file.write_text("0,0\n1,two\n")
    with pytest.raises(InputError, match=r"way.csv: path, line 2: is no pair of numbers \(got '1,two'\)"):
        waypoints(file)
    file.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match=r"way\.csv: path: is no text"):
        waypoints(file)


@pytest.mark.parametrize(
    ("what", "message"),
    [
        ({"step": 0.0}, "step: must be a finite number above 0 (got 0.0); give a length above 0 in m"),
        ({"step": math.nan}, "step: must be a finite number above 0"),
        ({"step": 1e-9}, "step: makes too many places along the path"),
        ({"friction": -1.0}, "friction: must be a finite number above 0"),
        ({"crab": math.inf}, "crab: must be a finite number"),
        ({"measures": ["tipp"]}, "measures: no such measure (got 'tipp'); did you mean 'tip'?"),
        ({"posture": "kneeling"}, "kneeling"),
    ],
)
def test_what_cannot_be_asked_is_refused(what, message):
    with pytest.raises(InputError) as caught:
        traverse(fixture("rigid4"), rp.Terrain.flat(), "0,0;1,0", **what)
    assert message in str(caught.value)


def test_a_path_off_the_map_and_wheels_off_the_map():
    terrain = rp.Terrain.rough(1, 0.01, 0.8, size=4.0)
    with pytest.raises(OffMapError) as caught:
        traverse(fixture("rigid4"), terrain, "0,0;1,0;1,3")
    assert "waypoint 3 of the path is not on the map (got '1,3'); the map spans x -2 to 2 m" in str(
        caught.value
    )
    data = traverse(fixture("rigid4"), terrain, "1.2,0;1.6,0", step=0.2)
    assert (data.attrs["passed"], data.attrs["stop_limit"]) == (0, "off_map")
    assert data.attrs["stop_at"] in {"fl", "fr"}
    assert 0.0 < data.attrs["stop_m"] < 0.2  # front wheels reach 0.65 m ahead


@pytest.mark.parametrize("name", ["highest", "riser", "tolerance"])
def test_largest_steps_numbers_are_checked(name):
    with pytest.raises(InputError, match=rf"{name}: must be a finite number above 0 \(got -1.0\)"):
        largest_step(fixture("rigid4"), **{name: -1.0})


def test_an_edge_that_is_not_a_number_and_paths_that_miss_the_step():
    rigid = fixture("rigid4")
    with pytest.raises(InputError, match=r"edge: must be a finite number \(got nan\)"):
        largest_step(rigid, 0.1, edge=math.nan)
    for path, message in (
        ("5,0;6,0", "path: does not go up the step: where it starts, its foremost wheel is at x = 5.5 m"),
        ("-2,0;0.4,0", "path: does not go up the step: where it ends, its rearmost wheel is at x = -0.1 m"),
        ("-2,0;-2,3", "path: does not go up the step: where it ends, its rearmost wheel is at x = -2.4 m"),
    ):
        with pytest.raises(InputError) as caught:
            largest_step(rigid, 0.1, path=path)
        assert message in str(caught.value)
        assert "the riser is at x = -0.005 to 0 m" in str(caught.value)


def test_where_no_step_is_climbed_the_least_that_was_tried_is_told():
    found = largest_step(fixture("rigid4"), 0.02, riser=RISER, tolerance=0.006, step=0.3, friction=0.02)
    assert (found.climbed, found.limit, found.climbs) == (0.0, "friction", (False,) * 3)
    assert found.stopped == pytest.approx(0.005)
    assert math.isnan(found.friction_needed)
    assert math.isnan(found.torque_needed)


@pytest.fixture(scope="module")
def bumps():
    """A rocker-bogie along a line over a surface that is even in y, hence alike on both sides."""
    terrain = rp.Terrain.from_function(
        lambda x, y: 0.06 * np.sin(2.3 * x) * np.cos(1.7 * y) + 0.02 * np.cos(4.1 * x)
    )
    return terrain, traverse(rp.load("rocker_bogie"), terrain, "-0.4,0;0.4,0", step=0.1)


def test_loads_carry_the_weight_and_sides_are_alike_all_along(bumps):
    rover, (_, data) = rp.load("rocker_bogie"), bumps
    np.testing.assert_allclose(data.load_n.sum("wheel"), rover.mass * 9.81, rtol=1e-8)
    for left, right in (("fl", "fr"), ("ml", "mr"), ("bl", "br")):
        np.testing.assert_allclose(data.load_n.sel(wheel=left), data.load_n.sel(wheel=right), rtol=1e-6)
    np.testing.assert_allclose(data.roll_rad, 0.0, atol=1e-9)
    assert float(np.ptp(data.load_n.sel(wheel="fl").values)) > 5.0  # there is something to tell


def test_gravity_and_a_terrain_that_is_turned_round(bumps):
    rover, (terrain, data) = rp.load("rocker_bogie"), bumps
    moon = traverse(rover, terrain, "-0.4,0;0.4,0", step=0.1, gravity=1.62)
    share = 1.62 / 9.81
    np.testing.assert_allclose(moon.load_n, share * data.load_n, rtol=1e-6)
    np.testing.assert_allclose(moon.torque_needed, share * data.torque_needed, atol=1e-4)
    np.testing.assert_allclose(moon.friction_needed, data.friction_needed, atol=1e-6)
    np.testing.assert_allclose(moon.pitch_rad, data.pitch_rad, atol=1e-9)
    # the same places and headings, gone through the other way about: no stance remembers where it came from
    back = traverse(rover, terrain, "0.4,0;-0.4,0", step=0.1, reverse=True)
    assert np.cos(back.yaw_rad.values) == pytest.approx(1.0)
    np.testing.assert_allclose(back.load_n.values[::-1], data.load_n, atol=1e-5)
    np.testing.assert_allclose(back.friction_needed.values[::-1], data.friction_needed, atol=1e-6)


def test_a_rover_alike_at_both_ends_asks_the_same_both_ways():
    """Two axles, the load in the middle, on a hump even in x: forwards along +x is backwards along -x."""
    rover = fixture("rigid4").with_payload([(11.0, (-6.0 / 11.0, -3.0 / 11.0, 0.0))])
    np.testing.assert_allclose(rp.settle(rover, rp.Terrain.flat()).com[:2], 0.0, atol=1e-9)
    hump = rp.Terrain.from_function(lambda x, y: 0.2 * np.exp(-(x**2)))
    there = traverse(rover, hump, "-0.6,0;0.6,0", step=0.2)
    again = traverse(rover, hump, "0.6,0;-0.6,0", step=0.2)
    for name in ("friction_needed", "pitch_rad", "z_m"):
        np.testing.assert_allclose(there[name], again[name], atol=1e-6)
    np.testing.assert_allclose(there.torque_needed, again.torque_needed, atol=1e-3)
    for wheel, other in (("fl", "fl"), ("br", "br")):
        np.testing.assert_allclose(there.load_n.sel(wheel=wheel), again.load_n.sel(wheel=other), atol=1e-4)
    # and what it asks for on the way up it asks for, the other way about, on the way down
    np.testing.assert_allclose(there.friction_needed, there.friction_needed[::-1], atol=1e-6)


def test_a_wheel_that_rises_at_once_stops_it_and_one_that_falls_does_not():
    rover = rp.load("rocker_bogie")
    terrain = rp.Terrain.step(0.13, 0.0, 0.005)  # as high as the wheels' radius
    up = traverse(rover, terrain, "-0.9,0;-0.5,0", step=0.1, friction=2.0, measures=(), until_stop=True)
    assert (up.attrs["passed"], up.attrs["stop_limit"]) == (0, "leap")
    assert up.attrs["stop_at"] in {"fl", "fr"}
    before, after = (up.wheel_m.sel(wheel=up.attrs["stop_at"]).values[k] for k in (-2, -1))
    moved = float(np.linalg.norm(after - before))
    assert moved > 0.02  # m, within less than a millimetre of the way
    assert float(up.way_m[-1] - up.way_m[-2]) < 1e-3
    assert up.attrs["stop_why"] == (
        f"{up.attrs['stop_at']} would have to move {1e3 * moved:.3g} mm at once,"
        " and what is asked for between is not known"
    )
    down = traverse(rover, terrain, "0.9,0;-0.5,0", step=0.1, friction=2.0, measures=())
    assert "leap" not in down.limit.values
    assert float(down.pitch_rad.max()) > 0.05
