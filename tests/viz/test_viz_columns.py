"""What a study's page carries decodes back to the dataset, in Python and by the page's own scripts."""

from __future__ import annotations

import base64
import gzip
import json
import re
import shutil
import subprocess

import numpy as np
import pytest
import viz_doubles as doubles
from hypothesis import given, settings
from hypothesis import strategies as st

from rover_pin.errors import StudyError
from rover_pin.viz.page import pack as pack_module
from rover_pin.viz.page.columns import decoded, numbers, planes, unplaned, words
from rover_pin.viz.page.html import HERE
from rover_pin.viz.page.measured import main_measure, worst_cases
from rover_pin.viz.page.raster import ground_raster
from rover_pin.viz.page.study import study_page

FLOATS = st.lists(st.floats(-1e6, 1e6) | st.sampled_from([np.nan, np.inf, -np.inf]), min_size=1, max_size=60)


def same(ours, given_values, rounding):
    ours, given_values = np.asarray(ours), np.asarray(given_values)
    finite = np.isfinite(given_values)
    assert (np.isnan(ours) == np.isnan(given_values)).all()
    np.testing.assert_array_equal(ours[~finite], given_values[~finite])
    assert np.abs(ours[finite] - given_values[finite]).max(initial=0.0) <= rounding * (1 + 1e-6) + 1e-9


@settings(max_examples=80, deadline=None, derandomize=True)
@given(FLOATS)
def test_numbers_come_back_to_the_stated_rounding(values):
    column = numbers(values)
    same(decoded(column.about(), column.data), values, column.rounding)


def test_sixteen_bits_do_unless_a_tail_is_heavy():
    even = np.random.default_rng(0).uniform(-3, 5, 1000)
    assert numbers(even).kind == "u16"
    assert len(numbers(even).data) == 2000
    assert numbers(even).rounding == pytest.approx(0.5 * np.ptp(even) / 65532)
    tail = even.copy()
    tail[0] = 1e7
    assert numbers(tail).kind == "f32"
    assert numbers([2.5, 2.5, np.nan]).rounding == 0.0


def test_words_come_back():
    column = words(["settled", "tips", "settled", "no <b>"])
    assert list(decoded(column.about(), column.data)) == ["settled", "tips", "settled", "no <b>"]
    many = words(range(70_000))
    assert decoded(many.about(), many.data)[[0, 65_531, 65_532, 69_999]].tolist() == [
        "0",
        "65531",
        "...",
        "...",
    ]


def test_planes_come_back():
    values = np.arange(1000, dtype=np.uint16) * 61
    np.testing.assert_array_equal(unplaned(planes(values), "u2"), values)
    assert planes(np.array([0x0102], dtype=">u2")) == b"\x02\x01"


@pytest.fixture(scope="module")
def study():
    data, rover, terrain, stances = doubles.dataset(40)
    exact = {case: stances[case] for case in worst_cases(data, 3)}
    return data, study_page(data, rover, terrain, exact), terrain, exact


def read_back(text):
    header = json.loads(re.search(r'id="header">(.*?)</script>', text)[1])
    body = "".join(re.findall(r'class="block">([^<]*)<', text))
    assert len(body) == header["packed"]
    run, segments = gzip.decompress(base64.b64decode(body)), {}
    for name, size in header["segments"]:
        segments[name], run = run[:size], run[size:]
    assert not run
    return header, segments


def test_the_page_holds_the_datasets_numbers(study):
    data, text, _, _ = study
    header, segments = read_back(text)

    def column(name):
        about = header["columns"][name]
        return decoded(about, segments[f"column/{name}"]), about["rounding"]

    for name in (
        "x_m",
        "y_m",
        "z_m",
        "yaw_rad",
        "roll_rad",
        "pitch_rad",
        "tip",
        "polygon",
        "torque",
        "friction",
    ):
        values, rounding = column(name)
        same(values, data[name].values, rounding)
        assert rounding <= 1e-5 * np.ptp(data[name].values[np.isfinite(data[name].values)])
    for k, wheel in enumerate(data["wheel"].values):
        same(column(f"load_n/{wheel}")[0], data["load_n"].values[:, k], column(f"load_n/{wheel}")[1])
    for k, joint in enumerate(data["joint"].values):
        same(column(f"joint_rad/{joint}")[0], data["joint_rad"].values[:, k], column(f"joint_rad/{joint}")[1])
    assert list(column("status")[0]) == list(data["status"].values)
    assert list(column("tip_limiting")[0]) == list(data["tip_limiting"].values)
    assert [m["name"] for m in header["measures"]] == [
        "tip", "polygon", "torque", "clearance", "lightest_wheel", "heaviest_wheel",
    ]  # fmt: skip
    assert header["about"]["study"].startswith("robot: a </script> b")


def test_exact_stances_keep_their_contacts(study):
    _, text, _, exact = study
    header, _ = read_back(text)
    assert {int(case) for case in header["exact"]} == set(exact)
    for case, stance in exact.items():
        held = header["exact"][str(case)]
        for row, contact in zip(held["contacts"], stance.contacts, strict=True):
            assert row[0] == contact.wheel
            np.testing.assert_allclose(row[1:], [*contact.point, contact.load])


def test_the_ground_comes_back(study):
    _, text, terrain, _ = study
    header, segments = read_back(text)
    about = header["ground"]
    codes = np.cumsum(
        unplaned(segments["ground"], "u2").reshape(about["ny"], about["nx"]), axis=1, dtype=np.uint16
    )
    X, Y = np.meshgrid(
        about["x0"] + about["dx"] * np.arange(about["nx"]), about["y0"] + about["dy"] * np.arange(about["ny"])
    )
    assert np.abs(about["low"] + about["step"] * codes - terrain.height(X, Y)).max() <= 0.5001 * about["step"]


def test_a_large_map_is_thinned_and_a_level_one_fits():
    big = doubles.Hills(extent=(0.0, 90.0, 0.0, 30.0))
    about, _ = ground_raster(big, np.array([0.0, 90.0]), np.array([0.0, 30.0]), 1.6)
    assert (about["nx"], about["x0"]) == (640, 0.0)
    about, data = ground_raster(doubles.Hills(height=0.0), np.zeros(1), np.zeros(1), 1.6)
    assert not any(data)
    assert about["contour"] == 0.0


def test_blocks_are_cut_and_join(study, monkeypatch):
    monkeypatch.setattr(pack_module, "BLOCK", 100)
    data = bytes(np.random.default_rng(0).integers(0, 255, 5000, dtype=np.uint8))
    text = pack_module.Pack({}, {"a": data[:2000], "b": data[2000:]}).scripts()
    assert text.count('class="block"') > 50
    _, segments = read_back(text)
    assert segments == {"a": data[:2000], "b": data[2000:]}


@pytest.mark.skipif(shutil.which("node") is None, reason="node is not installed")
def test_the_pages_own_scripts_read_the_same_numbers(study, tmp_path):
    data, text, terrain, _ = study
    header, segments = read_back(text)
    for source in (HERE / "js").glob("*.js"):
        (tmp_path / source.name).write_text(source.read_text())
    (tmp_path / "package.json").write_text('{"type": "module"}')
    packed = {name: base64.b64encode(part).decode() for name, part in segments.items() if "robot" not in name}
    (tmp_path / "in.json").write_text(json.dumps({"header": header, "segments": packed}))
    (tmp_path / "run.js").write_text("""
import { readFileSync } from "node:fs";
import { Cases } from "./columns.js";
import { Ground } from "./ground.js";
const { header, segments } = JSON.parse(readFileSync("in.json"));
const bytes = (text) => new Uint8Array(Buffer.from(text, "base64"));
const parts = new Map(Object.entries(segments).map(([k, v]) => [k, bytes(v)]));
const cases = new Cases(header, parts);
const ground = new Ground(header.ground, parts.get("ground"));
const out = { tip: [...cases.column("tip")].map(String), polygon: [...cases.column("polygon")].map(String),
  torque: [...cases.column("torque")].map(String),
  status: Array.from({length: cases.count}, (_, i) => cases.at("status", i)),
  order: [...cases.order("tip").order], low: [...cases.order("torque").order],
  median: cases.quantile("tip", 0.5),
  heights: [[0.3, 0.2], [-1.1, 2.0]].map(([x, y]) => ground.at(x, y)) };
console.log(JSON.stringify(out));
""")
    done = subprocess.run(["node", "run.js"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    out = json.loads(done.stdout)
    for name in ("tip", "polygon", "torque"):
        ours = np.array([float(v.replace("Infinity", "inf")) for v in out[name]])
        same(ours, decoded(header["columns"][name], segments[f"column/{name}"]), 1e-6)
    assert out["status"] == list(data["status"].values)
    usable = int(np.isfinite(data["tip"].values).sum())
    assert out["order"][:usable] == worst_cases(data, usable)
    assert out["low"][:usable] == worst_cases(data, usable, "torque")
    for (x, y), (h, hx, hy) in zip([(0.3, 0.2), (-1.1, 2.0)], out["heights"], strict=True):
        assert h == pytest.approx(float(terrain.height(x, y)), abs=1e-3)
        np.testing.assert_allclose([hx, hy], terrain.gradient(x, y), atol=0.02)


def test_the_worst_are_the_worst(study):
    data = study[0]
    tip, settled = data["tip"].values, data["status"].values == "settled"
    brute = sorted((i for i in range(len(tip)) if settled[i]), key=lambda i: tip[i])
    assert worst_cases(data, 10) == brute[:10]
    assert np.isneginf(data["polygon"].values[worst_cases(data, 1, "polygon")[0]])
    assert worst_cases(data, 1, "torque") == [int(np.nanargmax(data["torque"].values))]


def test_unknown_measures_and_empty_studies_are_said(study):
    data, _, terrain, _ = study
    with pytest.raises(
        StudyError, match=r"measure: the study has no such measure \(got 'polygn'\); did you mean 'polygon'"
    ):
        main_measure(data, "polygn")
    with pytest.raises(StudyError, match="the study has no case"):
        study_page(data.isel(case=slice(0, 0)), doubles.rover(), terrain, {})


def test_without_measures_the_lightest_wheel_counts(study):
    data, _, terrain, _ = study
    bare = data.drop_vars([n for n in data.data_vars if "better" in data[n].attrs and data[n].ndim == 1])
    assert main_measure(bare) == "lightest_wheel"
    assert worst_cases(bare, 1) == [int(np.nanargmin(data["load_n"].values.min(axis=1)))]
    assert worst_cases(bare, 1, "heaviest_wheel") == [int(np.nanargmax(data["load_n"].values.max(axis=1)))]
    assert read_back(study_page(bare, doubles.rover(), terrain, {}))[0]["first"] == "lightest_wheel"
