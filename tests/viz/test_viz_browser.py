"""Pictures and pages in a real browser, where one is installed."""

from __future__ import annotations

import html
import io
import json
import os
import re
import subprocess

import numpy as np
import pinocchio as pin
import pytest
import viz_doubles as doubles
from PIL import Image

from rover_pin.viz.browser import FLAGS, BrowserError, find_browser, picture, save_png
from rover_pin.viz.page.study import study_page
from rover_pin.viz.serve import Served
from rover_pin.viz.show import stance_page

try:
    BROWSER = find_browser()
except BrowserError:
    BROWSER = ""
needs_browser = pytest.mark.skipif(not BROWSER, reason="no Chromium or Chrome is installed")


def dom(text, folder):
    """The page's elements after its scripts ran."""
    page = folder / "page.html"
    page.write_text(text, encoding="utf-8")
    flags = [*FLAGS, f"--user-data-dir={folder}/profile", "--virtual-time-budget=8000", "--dump-dom"]
    if os.geteuid() == 0:
        flags.append("--no-sandbox")
    done = subprocess.run([BROWSER, *flags, page.as_uri()], capture_output=True, timeout=180, check=False)
    return done.stdout.decode("utf-8")


def test_no_browser_is_said_with_the_cure(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    message = r"png: no Chromium or Chrome on PATH.*; install chromium, or save an HTML page"
    with pytest.raises(BrowserError, match=message):
        save_png(doubles.stance(), tmp_path / "a.png")
    assert list(tmp_path.iterdir()) == []


def test_a_browser_that_draws_nothing_is_said(monkeypatch, tmp_path):
    fake = tmp_path / "chromium"
    fake.write_text("#!/bin/sh\necho broken >&2\n")
    fake.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/bin:/usr/bin")
    with pytest.raises(
        BrowserError, match=r"chromium: made no picture \(got 'broken'\); save an HTML page instead"
    ):
        picture("<p>")


@needs_browser
def test_a_stances_picture_shows_ground_and_rover(tmp_path):
    path = save_png(doubles.stance(), tmp_path / "a.png", width=900, height=600, margins=doubles.MARGINS)
    image = np.asarray(Image.open(io.BytesIO(path.read_bytes())).convert("RGB")).astype(int)
    assert image.shape == (600, 900, 3)
    middle = image[150:550, 400:880].reshape(-1, 3)
    blue = (middle[:, 2] > middle[:, 0] + 90) & (middle[:, 2] > 120)  # loads and polygon
    magenta = (middle[:, 0] > 150) & (middle[:, 1] < 60) & (middle[:, 2] > 80)  # the centre of mass
    sand = (middle[:, 0] > middle[:, 2] + 15) & (middle[:, 0] > 120)
    assert blue.sum() > 300
    assert magenta.sum() > 30
    assert sand.mean() > 0.3


@needs_browser
def test_a_stances_page_says_its_numbers(tmp_path):
    text = dom(stance_page(doubles.stance(), doubles.MARGINS), tmp_path)
    assert re.search(r'id="robot">stand-in<', text)
    assert ">35.0<" in text
    assert ">−12.0<" in text
    assert len(re.findall(r'<span class="label', text)) == 6 + 1
    assert text.count(">limiting edge") == 1
    assert 'class="message">No 3D' not in text


@needs_browser
def test_the_study_page_poses_the_robot_as_pinocchio_does(tmp_path):
    data, rover, terrain, _ = doubles.dataset(12)
    text = study_page(data, rover, terrain, {})
    world = "picture.robots[0].world.map((m) => m.elements)"
    told = f"document.body.dataset.told = JSON.stringify([state.chosen, {world}]);"
    page = dom(text.replace('byId("loading").remove();', 'byId("loading").remove();' + told), tmp_path)
    chosen, world = json.loads(html.unescape(re.search(r'data-told="([^"]*)"', page)[1]))
    case = data.isel(case=chosen)
    joints = dict(zip(data["joint"].values, case["joint_rad"].values, strict=True))
    base = [float(case[name]) for name in ("x_m", "y_m", "z_m", "yaw_rad", "pitch_rad", "roll_rad")]
    model = rover.model
    q = np.array([*base, *(joints[name] for name in model.names[2:])])
    model_data = model.createData()
    pin.forwardKinematics(model, model_data, q)
    for joint, elements in enumerate(world, start=1):
        ours = np.array(elements).reshape(4, 4).T
        np.testing.assert_allclose(ours, model_data.oMi[joint].homogeneous, atol=2e-3)  # 16-bit columns
    assert re.search(rf">Case {chosen}<", page)
    assert page.count("<tr") > 10


@needs_browser
def test_without_webgl_the_page_says_so_and_keeps_the_rest(tmp_path):
    data, rover, terrain, _ = doubles.dataset(12)
    text = study_page(data, rover, terrain, {})
    off = """<script>
    const known = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
      return kind.startsWith("webgl") ? null : known.call(this, kind, ...rest);
    };
    </script>"""
    page = dom(text.replace("<header>", off + "<header>", 1), tmp_path)
    assert 'class="message">No 3D here: this browser has WebGL switched off' in page
    assert 'id="case-said" class="dim">settled' in page


@needs_browser
def test_a_cut_file_says_so(tmp_path):
    text = stance_page(doubles.stance(), {})
    cut = re.sub(r'(class="block">[^<]{1000})[^<]*', r"\1", text)
    assert 'class="message">No 3D here: the file is cut short: save it again' in dom(cut, tmp_path)


@needs_browser
def test_an_open_page_takes_over_another_stance(tmp_path):
    other = stance_page(doubles.stance(status="tips"), {})

    class Watched(Served):
        asked = 0

        def answer(self, path):
            self.asked += path == "/mark"
            if self.asked == 3:
                self._put(other)
            return super().answer(path)

    with Watched(stance_page(doubles.stance(), {})) as served:
        flags = [*FLAGS, f"--user-data-dir={tmp_path}/profile", "--virtual-time-budget=9000", "--dump-dom"]
        flags += ["--no-sandbox"] if os.geteuid() == 0 else []
        done = subprocess.run([BROWSER, *flags, served.url], capture_output=True, timeout=180, check=False)
    assert b'class="chip bad">tips over<' in done.stdout
    assert served.asked >= 4


@needs_browser
def test_a_study_where_nothing_settled_has_a_page(tmp_path):
    data, rover, terrain, _ = doubles.dataset(12)
    data["status"].values[:] = "tips"
    for name in ("tip", "polygon", "torque", "clearance", "load_n", "z_m"):
        data[name].values[:] = np.nan
    page = dom(study_page(data, rover, terrain, {}), tmp_path)
    assert 'id="loading"' not in page
    assert ">Case 0<" in page
    assert 'id="unposed" class="message">' in page
    assert "no settled case has it" in page
