"""The page of motions: what it carries, offline, whole or not at all."""

from __future__ import annotations

import base64
import dataclasses
import gzip
import json
import re

import numpy as np
import pytest
from motion_runs import settled_run

import rover_pin as rp
from rover_pin.errors import InputError
from rover_pin.viz.motion import motion_page, save_motion_html, save_motion_png
from rover_pin.viz.page.curves import packed_curves, worst_part
from rover_pin.viz.page.html import viewer
from rover_pin.viz.page.motion import wheel_sides
from rover_pin.viz.page.path_ground import path_ground
from rover_pin.viz.page.thin import evenly, extremes, held, line


@pytest.fixture(scope="module")
def run():
    return settled_run(rp.load("hit_mrii"), rp.Terrain.flat())


@pytest.fixture(scope="module")
def climbing():
    return settled_run(rp.load("hit_mrii"), rp.Terrain.step(0.1, 1.0), count=6, x=(-0.4, 0.6))


def carried(text):
    """Header and segments of a page."""
    header = json.loads(re.search(r'id="header">(.*?)</script>', text)[1])
    blocks = re.findall(r'class="block">([^<]*)', text)
    body = gzip.decompress(base64.b64decode("".join(blocks)))
    starts = np.cumsum([0, *(size for _, size in header["segments"])])
    return header, {
        name: body[a : a + size] for (name, size), a in zip(header["segments"], starts[:-1], strict=True)
    }


def long(run, count, **columns):
    """A run drawn out to `count` samples 0.1 s apart; its q repeats, columns of it may be given."""
    q = np.resize(run.configuration, (count, run.configuration.shape[1]))
    for name, values in columns.items():
        q[:, run.rover.column[name]] = values
    return dataclasses.replace(
        run, time=7.0 + 0.1 * np.arange(count), configuration=q, rates=0 * q, actions=("rolling",) * count,
        lifted=((),) * count, indices={}, loads={}, drift=None,
    )  # fmt: skip


def test_the_page_is_one_file_that_asks_for_nothing(run, tmp_path):
    path = save_motion_html(run, tmp_path / "run.html", title="</script><b>Raise</b>")
    text = path.read_text()
    own = re.sub(r'(class="block">)[^<]*', r"\1", text.replace(viewer(), ""))
    assert "http" not in own.replace('http-equiv="Content-Security-Policy"', "")
    assert not re.search(r"@import|url\(|\{\{", own)
    assert "connect-src 'none'" in text
    assert text.count("<script") == text.count("</script>")
    assert [file.name for file in tmp_path.iterdir()] == ["run.html"]
    assert carried(text)[0]["title"] == "</script><b>Raise</b>"


def test_frames_are_the_log(run):
    header, segments = carried(motion_page(run))
    about = header["runs"][0]
    q = np.frombuffer(segments["run/0/q"], "<f4").reshape(len(about["columns"]), about["frames"])
    np.testing.assert_allclose(q.T, run.configuration, atol=1e-6)
    loads = np.frombuffer(segments["run/0/loads"], "<f4").reshape(6, -1)
    for row, wheel in zip(loads, run.rover.wheels, strict=True):
        np.testing.assert_allclose(row, run.loads[wheel.name], rtol=1e-6)
    assert about["actions"] == [
        {"word": "chassis_raise", "from": 0.0},
        {"word": "chassis_lower", "from": 12.0},
    ]
    assert [(span["word"], span["from"]) for span in about["lifted"]] == [
        ([], 0.0), (["LF", "RM"], 8.0), ([], 12.0),
    ]  # fmt: skip


def test_a_long_run_is_thinned_and_stays_small(run):
    count = 9000
    yaw = 0.01 * np.arange(count)
    wrapped = (yaw + np.pi) % (2 * np.pi) - np.pi
    rng = np.random.default_rng(4)
    log = long(run, count, base_yaw=wrapped)
    log = dataclasses.replace(
        log, indices={f"c{k}": rng.normal(size=(count, 2)) for k in range(11)},
        loads={wheel.name: rng.normal(368, 20, count) for wheel in run.rover.wheels},
        drift=rng.normal(size=(count, 6)), actions=("a",) * 4321 + ("b",) * (count - 4321),
    )  # fmt: skip
    text = motion_page(log)
    assert len(text) < 5e6
    header, segments = carried(text)
    about = header["runs"][0]
    assert about["samples"] == count
    assert 2000 <= about["frames"] <= 2004
    time = np.frombuffer(segments["run/0/time"], "<f8")
    assert {0.0, count * 0.1 - 0.1} <= set(np.round(time[[0, -1]], 9))
    assert np.isclose(time, 432.1).any()  # where the action changes
    q = np.frombuffer(segments["run/0/q"], "<f4").reshape(-1, about["frames"])
    np.testing.assert_allclose(q[3], 0.1 * time, atol=1e-4)  # yaw went on without jumps


def test_runs_share_a_rover_and_a_ground(run, climbing):
    other = settled_run(rp.load("hit_mrii"), run.terrain, count=3, x=(2.0, 3.0))
    header, segments = carried(motion_page({"a": run, "b": climbing, "c": other}))
    assert [(told["name"], told["robot"], told["ground"]) for told in header["runs"]] == [
        ("a", 0, 0), ("b", 0, 1), ("c", 0, 0),
    ]  # fmt: skip
    xs = np.frombuffer(segments["ground/0/xs"], "<f4")
    assert xs[0] < -2
    assert xs[-1] > 5


def test_curves_are_in_peoples_units_and_without_what_nobody_asked(run):
    silent = {**run.indices, "load_deviation": np.full((12, 1), np.nan)}
    about, data = packed_curves(dataclasses.replace(run, indices=silent))
    lines, at = {}, 0
    for row in about:
        points = np.frombuffer(data, "<f4", 2 * row["count"], at).reshape(2, -1)
        at += 8 * row["count"]
        lines[row["panel"], row["name"], row["part"]] = points
    assert at == len(data)
    assert ("indices", "load_deviation", -1) not in lines
    np.testing.assert_allclose(lines["indices", "wheelbase", -1][1].max(), 1.2 * 5 / 5.5, rtol=1e-5)
    np.testing.assert_allclose(lines["indices", "wheelbase", 1][1].max(), 0.9 * 5 / 5.5, rtol=1e-5)
    np.testing.assert_allclose(lines["clearance", "belly", -1][1][0], 250.0, atol=0.05)
    pitch = np.degrees(run.configuration[:, run.rover.column["base_pitch"]])
    np.testing.assert_allclose(lines["attitude", "pitch", -1], [run.time, pitch], atol=1e-5)
    names = [shape.name for shape in run.rover.shapes]
    np.testing.assert_allclose(lines["drift", names[5], -1][1][-1], 5.0, rtol=1e-6)


def test_the_worst_part_is_that_which_was_evaluated():
    index = np.array([[0.2, np.nan], [np.nan, np.nan], [0.1, np.inf]])
    np.testing.assert_array_equal(worst_part(index), [0.2, np.nan, np.inf])


def test_wheels_are_known_by_side_and_place(run):
    sides = {wheel.name: side for wheel, side in zip(run.rover.wheels, wheel_sides(run.rover), strict=True)}
    assert {name: (side["left"], side["rank"]) for name, side in sides.items()} == {
        "LF": (True, 0), "LM": (True, 1), "LB": (True, 2),
        "RF": (False, 0), "RM": (False, 1), "RB": (False, 2),
    }  # fmt: skip


def test_thinning_keeps_ends_changes_and_spikes():
    kept = evenly(10_000, 100, [4321, -1, 10_000])
    assert {0, 4321, 9999} <= set(kept.tolist())
    assert len(kept) <= 101
    values = np.sin(np.arange(10_000) / 700)
    values[[1234, 8765]] = 40, -30
    spiked = extremes(values, 200)
    assert {0, 1234, 8765, 9999} <= set(spiked.tolist())
    assert len(spiked) <= 202


def test_values_nobody_asked_for_are_joined_and_silence_is_a_gap():
    time = np.arange(100) * 0.1
    values = np.where(np.arange(100) % 10 == 0, time, np.nan)  # every second
    t, v = line(time, values, 50)
    np.testing.assert_allclose(t, np.arange(10))
    np.testing.assert_allclose(v, np.arange(10))
    np.testing.assert_allclose(held(values)[[0, 9, 10, 99]], [0, 0, 1, 9])
    values[20] = np.nan  # silent from 1 to 3 s
    t, v = line(time, values, 50)
    assert t[np.isnan(v)] == pytest.approx([2.0])
    assert held(values)[19] == 1.0
    assert np.isnan(held(values)[20:30]).all()
    assert held(values)[30] == 3.0
    assert np.isnan(held(np.full(100, np.nan))).all()


def test_where_every_sample_is_known_one_that_is_not_is_a_gap():
    time, values = np.arange(3000) * 0.01, np.sin(np.arange(3000) / 90)
    values[1500] = np.nan
    t, v = line(time, values, 100)
    assert t[np.isnan(v)] == pytest.approx([15.0])
    np.testing.assert_array_equal(held(values), values)


def test_the_ground_is_the_terrains_and_ends_where_it_ends():
    rough = rp.Terrain.rough(2, 0.05, 0.8, size=8)
    about, data = path_ground(rough, np.array([-2.0, 1.0]), np.array([0.0, 0.5]), 2.0)
    xs, ys = (np.frombuffer(data[name], "<f4").astype(float) for name in ("xs", "ys"))
    heights = np.frombuffer(data["heights"], "<f4").reshape(about["ny"], about["nx"])
    assert (np.diff(xs) > 0).all()
    assert (np.diff(ys) > 0).all()
    assert (xs[0], xs[-1], ys[0], ys[-1]) == pytest.approx(rough.extent, abs=1e-5)
    np.testing.assert_allclose(heights, rough.height(*np.meshgrid(xs, ys)), atol=1e-5)
    for k in range(-3, 3):  # lines are drawn along whole metres
        assert np.abs(xs - k).min() < 1e-6
    assert about["grid"] == 1.0
    assert len(data["tones"]) == about["nx"] * about["ny"]


def test_a_step_keeps_its_edges():
    _, data = path_ground(rp.Terrain.step(0.2, 0.5, spacing=0.05), np.zeros(1), np.zeros(1), 1.5)
    xs = np.frombuffer(data["xs"], "<f4")
    for edge in (0.45, 0.5):
        assert np.abs(xs - edge).min() < 1e-6


REFUSED = {
    "none": (lambda run: [], "runs: there is none to show; give a Run, or several"),
    "kind": (lambda run: {"a": run, "b": 3}, r"b: is no run \(got 'int'\)"),
    "short": (
        lambda run: [run, dataclasses.replace(run, lifted=run.lifted[1:])],
        r"run 2: lifted: is not as long as the run \(got '11 entries, 12 times'\); log everything",
    ),
    "empty": (lambda run: dataclasses.replace(run, time=run.time[:0]), "run: has no sample"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_shown_is_said_and_nothing_is_written(run, tmp_path, name):
    spoil, message = REFUSED[name]
    with pytest.raises(InputError, match=message):
        save_motion_html(spoil(run), tmp_path / "a.html")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"at": 99.0}, r"at: is outside the run \(got 99.0\); between 0 and 22 s"),
        ({"at": []}, r"at: .* \(got 0\); name between 1 and 24"),
        ({"at": "noon"}, r"at: is no time \(got 'noon'\); give seconds"),
        ({"view": "Below"}, r"view: no such view \(got 'Below'\); use one of Iso, Side, Front, Top"),
    ],
)
def test_a_picture_of_no_moment_is_refused(run, tmp_path, keywords, message):
    with pytest.raises(InputError, match=message):
        save_motion_png(run, tmp_path / "a.png", **keywords)
    assert list(tmp_path.iterdir()) == []
