"""The page of motions in a real browser, where one is installed."""

from __future__ import annotations

import dataclasses
import html
import io
import json
import os
import re
import subprocess

import numpy as np
import pinocchio as pin
import pytest
from motion_runs import settled_run
from PIL import Image

import rover_pin as rp
from rover_pin.viz.browser import FLAGS, BrowserError, find_browser
from rover_pin.viz.motion import motion_page, save_motion_png

try:
    BROWSER = find_browser()
except BrowserError:
    BROWSER = ""
needs_browser = pytest.mark.skipif(not BROWSER, reason="no Chromium or Chrome is installed")


@pytest.fixture(scope="module")
def run():
    return settled_run(rp.load("hit_mrii"), rp.Terrain.step(0.1, 1.0), x=(-0.4, 0.6))


def dom(text, folder, fragment="", does=""):
    """The page's elements after its scripts ran, and `does` after them."""
    hook = 'byId("loading").remove();'
    assert hook in text
    page = folder / "page.html"
    page.write_text(text.replace(hook, hook + does), encoding="utf-8")
    flags = [*FLAGS, f"--user-data-dir={folder}/profile", "--virtual-time-budget=8000", "--dump-dom"]
    if os.geteuid() == 0:
        flags.append("--no-sandbox")
    command = [BROWSER, *flags, f"{page.as_uri()}#{fragment}"]
    return subprocess.run(command, capture_output=True, timeout=180, check=False).stdout.decode("utf-8")


def told(page):
    return json.loads(html.unescape(re.search(r'data-told="([^"]*)"', page)[1]))


@needs_browser
def test_the_rover_is_where_pinocchio_says_between_two_samples(run, tmp_path):
    does = "document.body.dataset.told = JSON.stringify(stage.robot.world.map((m) => m.elements));"
    page = dom(motion_page({"first": run, "second": run}), tmp_path, "run=1&t=9", does)
    data = run.rover.model.createData()
    pin.forwardKinematics(run.rover.model, data, (run.configuration[4] + run.configuration[5]) / 2)
    for joint, elements in enumerate(told(page), start=1):
        ours = np.array(elements).reshape(4, 4).T
        np.testing.assert_allclose(ours, data.oMi[joint].homogeneous, atol=2e-5)
    assert ">9.0 s<" in page
    assert re.search(r'id="action" class="chip">chassis_raise<', page)
    assert re.search(r'id="lifted" class="chip bad">LF, RM lifted<', page)
    assert len(re.findall(r'<span class="label', page)) == 6 + page.count(">limiting edge")
    assert page.count("LF lifted") == 1
    assert 'class="message">No 3D' not in page


@needs_browser
def test_plots_keys_and_the_clock_move_the_same_moment(run, tmp_path):
    does = """
      const log = [];
      const pressed = (name, more) => new KeyboardEvent("keydown", { key: name, ...more });
      const key = (name, more = {}) => document.dispatchEvent(pressed(name, more));
      const place = plots.panels[0].canvas.getBoundingClientRect();
      const middle = { clientX: place.left + plots.x(11), clientY: place.top + 5, bubbles: true };
      byId("plots").setPointerCapture = () => {};
      plots.panels[0].canvas.dispatchEvent(new PointerEvent("pointerdown", middle));
      log.push(transport.t);
      key("ArrowRight"); log.push(transport.t);
      key("ArrowLeft", { shiftKey: true }); log.push(transport.t);
      const camera = () => stage.view.viewer.camera.position.x;
      const before = camera();
      key("f"); key("End"); log.push(transport.t, camera() - before);
      key("f"); key("Home"); key("End"); log.push(Math.abs(camera() - before) > 0.5);
      key("Home"); key(" "); log.push(transport.playing);
      plots.panels[0].chips[0].chip.click();
      log.push(plots.alone.get("indices"));
      const look = (tries) => {  // frames of a busy machine may be long in coming
        if (transport.t === 0 && tries) return setTimeout(look, 50, tries - 1);
        log.push(transport.t);
        document.body.dataset.told = JSON.stringify(log);
      };
      setTimeout(look, 50, 120);
    """
    clicked, on, back, end, stayed, followed, playing, alone, later = told(
        dom(motion_page(run), tmp_path, "", does)
    )
    assert clicked == pytest.approx(11.0, abs=0.05)
    assert (on, back, end) == (12.0, 0.0, 22.0)  # next sample; back to where the action before began
    assert stayed == 0.0
    assert followed
    assert playing
    assert alone == "wheelbase"
    assert 0.0 < later < 22.0


@needs_browser
def test_limits_that_are_passed_and_runs_that_were_held_are_said(run, tmp_path):
    held = dataclasses.replace(run, status="held", reason="wheelbase is at its limit <1>")
    page = dom(motion_page(held, "Raise"), tmp_path, "t=10")
    assert 'class="chip bad">held<' in page
    assert "wheelbase is at its limit &lt;1&gt;" in page
    over = re.findall(r'<button class="key over"[^>]*><i[^>]*></i>(\w+(?: \w+)*) <b', page)
    assert over == ["wheelbase"]  # 1.2 * 5 / 5.5 at the top


@needs_browser
def test_one_sample_with_nothing_measured_has_a_page(run, tmp_path):
    first = {name: getattr(run, name)[:1] for name in ("time", "configuration", "rates", "actions", "lifted")}
    page = dom(motion_page(dataclasses.replace(run, **first, indices={}, loads={}, drift=None)), tmp_path)
    assert 'id="loading"' not in page
    assert re.findall(r'<section class="panel (\w+)"', page) == ["clearance", "attitude"]
    assert re.search(r'id="play"[^>]* disabled', page)


@needs_browser
def test_without_webgl_the_plots_still_follow_the_clock(run, tmp_path):
    off = """<script>
    const known = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
      return kind.startsWith("webgl") ? null : known.call(this, kind, ...rest);
    };
    </script>"""
    text = motion_page(run).replace("<header>", off + "<header>", 1)
    page = dom(text, tmp_path, "t=10", 'document.dispatchEvent(new KeyboardEvent("keydown", { key: "2" }));')
    assert 'class="message">No 3D here: this browser has WebGL switched off' in page
    assert re.search(r"wheelbase <b[^>]*>1.09</b>", page)
    assert ">10.0 s<" in page


@needs_browser
def test_a_strip_shows_every_moment(run, tmp_path):
    path = save_motion_png(
        run, tmp_path / "strip.png", at=[0.0, 10.0, 22.0], view="Side", width=900, height=600
    )
    image = np.asarray(Image.open(io.BytesIO(path.read_bytes())).convert("RGB")).astype(int)
    assert image.shape == (600, 900, 3)
    cells = [image[:300, :450], image[:300, 450:], image[300:, :450]]
    for cell in cells:
        blue = (cell[..., 2] > cell[..., 0] + 90) & (cell[..., 2] > 120)
        sand = (cell[..., 0] > cell[..., 2] + 15) & (cell[..., 0] > 120)
        assert blue.sum() > 150
        assert sand.mean() > 0.15
    assert np.abs(cells[0] - cells[1]).mean() > 2  # it moved
    assert (image[300:, 452:] > 245).all()  # no fourth moment
