"""Springs, belts and contacts of a study's page in a real browser, beside the model's own."""

import html
import json
import os
import re
import subprocess

import numpy as np
import pytest
import xarray as xr

import rover_pin as rp
from rover_pin.analysis import Study
from rover_pin.mechanism import FrameSpring, Kinematics
from rover_pin.viz.browser import FLAGS, BrowserError, find_browser
from rover_pin.viz.inside import GRIPS
from rover_pin.viz.page.several import exact_cases, several
from rover_pin.viz.page.study import study_page
from rover_pin.viz.scene import span_of

try:
    BROWSER = find_browser()
except BrowserError:
    BROWSER = ""
needs_browser = pytest.mark.skipif(not BROWSER, reason="no Chromium or Chrome is installed")


def study(robot, terrain, x, measures):
    vary = {"x": x, "y": [0.0], "yaw_deg": [20.0]}
    spec = {"robot": robot, "terrain": terrain, "cases": {"n": 4}, "vary": vary, "measures": measures}
    asked = Study.from_text(json.dumps(spec))
    return asked, asked.run(engine="serial")


def told(text, folder, does):
    """What a page's script says of itself once it is ready."""
    hook = 'byId("loading").remove();'
    assert hook in text
    page = folder / "page.html"
    does = f"document.body.dataset.told = JSON.stringify({does});"
    page.write_text(text.replace(hook, hook + does), encoding="utf-8")
    flags = [*FLAGS, f"--user-data-dir={folder}/profile", "--virtual-time-budget=8000", "--dump-dom"]
    if os.geteuid() == 0:
        flags.append("--no-sandbox")
    done = subprocess.run([BROWSER, *flags, page.as_uri()], capture_output=True, timeout=180, check=False)
    found = re.search(r'data-told="([^"]*)"', done.stdout.decode("utf-8"))
    return json.loads(html.unescape(found[1]))


@needs_browser
@pytest.mark.parametrize("robot", ["polibot_half", "x_suspension"])
def test_springs_belts_links_and_arrows_are_the_models(robot, tmp_path):
    asked, data = study(robot, "flat", [0.0, 1.0], ["loads"])
    text = study_page(data, asked.plan.rover, asked.plan.job.terrain, {})
    world = "picture.robots[0].world.map((m) => m.elements)"
    said = told(text, tmp_path, f"[state.chosen, {world}, picture.drawn, picture.marks.arrows]")
    chosen, links, drawn, arrows = said
    stance = asked.stance(chosen)
    rover = stance.rover
    at = Kinematics(rover.model, rover.model.createData(), np.array(stance.configuration))
    for joint, elements in enumerate(links, start=1):
        placed = at.data.oMi[joint].homogeneous
        np.testing.assert_allclose(np.array(elements).reshape(4, 4).T, placed, atol=5e-4)  # 16-bit columns
    for spring, shown in zip(rover.springs, drawn["springs"], strict=True):
        assert shown["name"] == spring.name
        assert shown["force"] == pytest.approx(float(spring.effort(at)), abs=5e-4 * spring.stiffness + 1e-6)
        if isinstance(spring, FrameSpring):
            ends = [spring.first.origin(at), spring.second.origin(at)]
            np.testing.assert_allclose(shown["ends"], ends, atol=5e-4)
        else:
            body = at.origin(rover.model.getJointId(spring.joint))
            np.testing.assert_allclose(shown["ends"][1], body, atol=5e-4)
    for track, shown in zip(rover.tracks, drawn["belts"], strict=True):
        assert shown["slack"] == pytest.approx(track.slack(at), abs=1e-3)
        path = track.path(at)
        away = [np.linalg.norm(path - point, axis=1).min() for point in shown["points"]]
        ours = np.linalg.norm(np.array(shown["points"])[:, None] - path[None], axis=2).min(axis=0)
        assert ours.max() < 0.03 * span_of(rover)
        assert np.median(away) < 0.03 * span_of(rover)
        grip = np.array(shown["points"])[np.array(shown["grips"])]
        assert len(grip)
        assert grip[:, 2].max() < GRIPS * span_of(rover)
    bearing = [contact for contact in stance.contacts if contact.load > 0]
    assert sorted(arrow["name"] for arrow in arrows) == sorted(contact.wheel for contact in bearing)
    for arrow in arrows:
        near = min(np.linalg.norm(contact.point - arrow["at"]) for contact in bearing)
        assert near < 2e-3


def in_a_groove():
    """A rocker-bogie whose rear wheels touch both sides of a groove: its x found by bisection."""
    rover = rp.load("rocker_bogie")
    heights = 0.8 * np.minimum(np.abs(0.05 * np.arange(121) - 3.0), 0.3)
    terrain = rp.Terrain.from_grid(np.tile(heights, (121, 1)), 0.05, interpolation="linear")
    low, high = 3.4, 3.9
    for _ in range(60):
        x = 0.5 * (low + high)
        stance = rp.settle(rover, terrain, x=x, y=3.0)
        if len(stance.contacts) > len(rover.wheels):
            return stance
        back = next(contact for contact in stance.contacts if contact.wheel == "bl")
        low, high = (x, high) if back.normal[0] > 0 else (low, x)
    raise AssertionError("no such stance")


@needs_browser
def test_a_wheel_in_a_groove_has_an_arrow_a_contact(tmp_path):
    stance = in_a_groove()
    rover = stance.rover
    names = ("x_m", "y_m", "z_m", "roll_rad", "pitch_rad", "yaw_rad")
    pose = dict(zip(names, [*stance.position, *stance.rpy], strict=True))
    joints = list(rover.joints)
    each = {name: ("case", [value, value]) for name, value in pose.items()}
    each["x_m"][1][1] += 0.3  # off the groove
    each["joint_rad"] = (("case", "joint"), [[stance.joints[name] for name in joints]] * 2)
    each["load_n"] = (("case", "wheel"), [[stance.loads[wheel.name] for wheel in rover.wheels]] * 2)
    each["status"] = ("case", ["settled"] * 2)
    each["tip"] = ("case", [0.5, 0.6], {"units": "rad", "better": "high"})
    data = xr.Dataset(each, coords={"joint": joints, "wheel": [wheel.name for wheel in rover.wheels]})
    assert several(data, rover, stance.terrain, [0, 1]) == [0]
    assert exact_cases(data, rover, stance.terrain, 0) == [0]
    text = study_page(data, rover, stance.terrain, {0: stance})
    arrows = told(text, tmp_path, "picture.marks.arrows")
    bearing = [contact for contact in stance.contacts if contact.load > 0]
    assert len(arrows) == len(bearing) > len(rover.wheels)
    for arrow, contact in zip(arrows, bearing, strict=True):
        np.testing.assert_allclose([*arrow["at"], arrow["load"]], [*contact.point, contact.load], atol=1e-6)
