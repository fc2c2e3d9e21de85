"""Pages: whole and offline, bundled right, written whole or not at all."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
import viz_doubles as doubles

from rover_pin.errors import InputError
from rover_pin.viz.page.html import HERE, bundle, page, viewer, write_whole
from rover_pin.viz.page.pack import Pack, json_text
from rover_pin.viz.page.study import study_page
from rover_pin.viz.show import save_html, stance_page


@pytest.fixture(scope="module")
def pages():
    stance = doubles.stance()
    data, rover, terrain, stances = doubles.dataset(24)
    return {
        "stance": stance_page(stance, doubles.MARGINS),
        "study": study_page(data, rover, terrain, {0: stances[0]}),
    }


def own_part(text):
    """The page without Meshcat's viewer, its licences and the packed bytes."""
    bare = text.replace(viewer(), "")
    return re.sub(r'(<script type="text/plain" class="block">)[^<]*', r"\1", bare)


@pytest.mark.parametrize("name", ["stance", "study"])
def test_a_page_asks_for_nothing_from_outside(pages, name):
    text = pages[name]
    assert "http" not in own_part(text).replace('http-equiv="Content-Security-Policy"', "")
    assert not re.search(r"<(link|img|iframe|script)[^>]*\s(src|href)=", text)
    assert not re.search(r"@import|url\(", own_part(text))
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', text)[1]
    assert "default-src 'none'" in policy
    assert "connect-src 'none'" in policy
    assert "http" not in policy


def test_the_viewers_only_addresses_are_xml_namespaces_and_licences():
    code = viewer().split("*/\n", 1)[1]
    found = set(re.findall(r"https?://[\w./-]+", re.sub(r"/\*.*?\*/", "", code, flags=re.S)))
    assert found <= {"http://www.w3.org/1999/xhtml"}
    assert "Robin Deits" in viewer()
    assert "</script" not in viewer().lower()


@pytest.mark.parametrize("name", ["stance", "study"])
def test_scripts_close_where_they_should(pages, name):
    text = pages[name]
    assert text.count("<script") == text.count("</script>")
    assert "{{" not in own_part(text)


@pytest.mark.parametrize("entry", ["stance.js", "study.js", "motion.js"])
def test_a_bundle_is_one_script_with_each_name_once(entry):
    text = bundle(entry)
    assert not re.search(r"^(import|export)\b", text, re.M)
    names = re.findall(r"^(?:async )?(?:function|class|const|let) (\w+)", text, re.M)
    assert len(names) == len(set(names)), sorted(n for n in names if names.count(n) > 1)


def test_the_pages_use_every_script():
    used = bundle("study.js") + bundle("stance.js") + bundle("motion.js")
    for path in (HERE / "js").glob("*.js"):
        first = path.read_text().splitlines()[0]
        assert first in used, path.name


@pytest.mark.skipif(shutil.which("node") is None, reason="node is not installed")
@pytest.mark.parametrize("entry", ["stance.js", "study.js", "motion.js"])
def test_a_bundle_is_valid_script(entry, tmp_path):
    path = tmp_path / "bundle.js"
    path.write_text(bundle(entry))
    done = subprocess.run(["node", "--check", str(path)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_what_a_user_named_cannot_break_out_of_the_page():
    bad = "</script><script>alert(1)</script>"
    text = page("stance", bad, Pack({"stance": {"robot": bad}}, {"commands": b""}))
    assert "alert(1)</script>" not in text
    assert json.loads(json_text({"a": bad, "b": [np.float64(1.5), float("nan")], "c": np.arange(2)})) == {
        "a": bad,
        "b": [1.5, None],
        "c": [0, 1],
    }


def test_a_file_is_written_whole_or_not_at_all(tmp_path, monkeypatch):
    target = tmp_path / "page.html"
    assert write_whole(target, b"old") == target

    def fail(self, other):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "replace", fail)
    with pytest.raises(
        InputError, match=r"page\.html: cannot be written .*No space left.*choose another path"
    ):
        write_whole(target, b"new")
    assert target.read_bytes() == b"old"
    assert [path.name for path in tmp_path.iterdir()] == ["page.html"]


def test_no_such_folder_is_said(tmp_path):
    with pytest.raises(InputError, match=r"nowhere/page\.html: cannot be written .*name a file in a folder"):
        save_html(doubles.stance(), tmp_path / "nowhere" / "page.html", margins={})


def test_a_stance_that_does_not_stand_says_why(tmp_path):
    text = save_html(doubles.stance(status="tips"), tmp_path / "page.html").read_text()
    header = json.loads(re.search(r'id="header">(.*?)</script>', text)[1])["stance"]
    assert (header["status_words"], header["reason"]) == ("tips over", "wheel 'fl' would pull")
    assert header["loads"] == header["margins"] == header["labels"] == []


def test_the_stances_facts_are_in_peoples_units(pages):
    header = json.loads(re.search(r'id="header">(.*?)</script>', pages["stance"])[1])["stance"]
    rows = {row["title"]: row for row in header["margins"]}
    assert [rows["Tip-over angle"][k] for k in ("value", "unit")] == [pytest.approx(np.degrees(0.61)), "°"]
    assert [rows["Belly clearance"][k] for k in ("value", "unit", "limiting")] == [-12.0, "mm", "body"]
    assert header["margins"][0]["title"] == "Tip-over angle"
    assert header["lightest"] == "ml"
    pose = {row["name"]: row for row in header["pose"]}
    assert [pose["mast"][k] for k in ("value", "unit")] == [pytest.approx(100.0), "mm"]
