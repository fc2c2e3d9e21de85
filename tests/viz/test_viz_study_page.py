"""The study's page used as people use it, in a real browser; what it shows is that of the result's file."""

from __future__ import annotations

import base64
import csv
import json
import re
import time
from types import SimpleNamespace

import numpy as np
import pinocchio as pin
import pytest
import xarray as xr

from rover_pin.analysis import Study
from rover_pin.viz.browser import BrowserError
from rover_pin.viz.driven import driven, open_page
from rover_pin.viz.page.result import save_result_page
from rover_pin.viz.page.study import save_study_page

pytest.importorskip("selenium")
from selenium.webdriver import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.print_page_options import PrintOptions

GROUND = {"rough": {"seed": 3, "rms": 0.25, "hurst": 0.8, "size": 8, "spacing": 0.05}}
VARY = {"x": [-4.2, 4.2], "y": [-4.2, 4.2], "yaw_deg": [0, 360], "friction": [0.3, 0.8]}  # some off the map
BASE = ("x_m", "y_m", "z_m", "yaw_rad", "pitch_rad", "roll_rad")


@pytest.fixture(scope="module")
def browser():
    try:
        with driven(1250, 800) as driver:
            yield driver
    except BrowserError as error:
        pytest.skip(str(error))


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A study's page, and its numbers as xarray reads them from the file."""
    folder = tmp_path_factory.mktemp("page")
    out, path = folder / "out.nc", folder / "out.html"
    study = Study("rocker_bogie", GROUND, cases={"n": 400}, vary=VARY, measures=["loads", "tip", "clearance"])
    save_result_page(study.run(engine="serial", out=out), path, study=study)
    with xr.open_dataset(out, engine="h5netcdf") as opened:
        data = opened.load()
    header = json.loads(re.search(r'id="header">(.*?)</script>', path.read_text(encoding="utf-8"))[1])
    return SimpleNamespace(path=path, data=data, about=header["columns"], model=study.plan.rover.model)


def rounding(made, name):
    """What the page says of a column, and a billionth of a unit for sums."""
    return made.about[name]["rounding"] + 1e-9


def state(browser, words):
    return browser.execute_script(f"const {{ state, picture }} = roverPin; return {words};")


def text(browser, selector):
    return browser.find_element(By.CSS_SELECTOR, selector).text


def cases_in_sight(browser):
    """Numbers of the table's rows, once it has stopped laying itself out."""
    return browser.execute_async_script(
        "const told = arguments[0];"
        "const rows = () => [...document.querySelectorAll('#table tr[data-case]')]"
        ".map((r) => Number(r.dataset.case));"
        "requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(() => told(rows()))));"
    )


def click_row(browser, case):
    browser.find_element(By.CSS_SELECTOR, f'#table tr[data-case="{case}"]').click()


def drag(browser, selector, first, last):
    """Over shares of an element's width."""
    box = browser.find_element(By.CSS_SELECTOR, selector)
    browser.execute_script("arguments[0].scrollIntoView({ block: 'center' })", box)
    width = box.size["width"]
    at = [round((share - 0.5) * width) for share in (first, last)]
    moves = ActionChains(browser, duration=50).move_to_element_with_offset(box, at[0], 0).click_and_hold()
    moves.move_to_element_with_offset(box, sum(at) // 2, 0).move_to_element_with_offset(box, at[1], 0)
    moves.release().perform()


def settled(data):
    return data["status"].values.astype(str) == "settled"


def link_transforms(made, case):
    """By Pinocchio at the file's pose."""
    row = made.data.isel(case=case)
    joints = dict(zip(row["joint"].values, row["joint_rad"].values, strict=True))
    q = np.array([*(float(row[name]) for name in BASE), *(joints[n] for n in list(made.model.names)[2:])])
    data = made.model.createData()
    pin.forwardKinematics(made.model, data, q)
    return [data.oMi[k].homogeneous for k in range(1, made.model.njoints)]


def check_case(browser, made, case):
    """Links, loads, measures and pose that the page shows are the file's."""
    row = made.data.isel(case=case)
    assert text(browser, "#case-name") == f"Case {case}"
    links = state(browser, "picture.robots[0].world.map((m) => m.elements)")
    reach = 2.0  # m, from the base to what turns
    angles = max(rounding(made, f"joint_rad/{name}") for name in made.data["joint"].values)
    angles += sum(rounding(made, name) for name in ("roll_rad", "pitch_rad", "yaw_rad"))
    room = reach * angles + max(rounding(made, name) for name in BASE[:3])
    assert room < 3e-3
    for shown, ours in zip(links, link_transforms(made, case), strict=True):
        np.testing.assert_allclose(np.array(shown).reshape(4, 4).T, ours, atol=room)
    arrows = {arrow["name"]: arrow for arrow in state(browser, "picture.marks.arrows")}
    for wheel, load in zip(row["wheel"].values, row["load_n"].values, strict=True):
        sum_of = sum(arrow["load"] for name, arrow in arrows.items() if name == wheel)
        assert sum_of == pytest.approx(float(load), abs=rounding(made, f"load_n/{wheel}"))
    told = dict(re.findall(r"^(.+?) ([−\d. ]+) ?\S", text(browser, "#case-margins"), re.M))
    for title, name, factor in (
        ("Tip-over angle", "tip", 180 / np.pi),
        ("Belly clearance", "clearance", 1e3),
    ):
        value = told[title].replace("−", "-").strip()
        last = 0.5 * 10.0 ** -len(value.partition(".")[2])
        room = last + factor * rounding(made, name)
        assert float(value) == pytest.approx(factor * float(row[name]), abs=room)
    pose = dict(re.findall(r"^([xyz]) ([−\d.]+) m", text(browser, "#case-pose"), re.M))
    for axis, value in pose.items():
        ours = float(row[f"{axis}_m"])
        assert float(value.replace("−", "-")) == pytest.approx(ours, abs=5e-4 + rounding(made, f"{axis}_m"))
    assert len(pose) == 3


def test_a_permalink_opens_its_case(browser, made):
    case = int(np.flatnonzero(settled(made.data))[-1])
    open_page(browser, made.path, f"case={case}&measure=clearance&cell=median")
    check_case(browser, made, case)
    assert state(browser, "[state.measure.name, state.statistic]") == ["clearance", "median"]
    open_page(browser, made.path, "case=400")
    assert text(browser, "#notice") == "There is no case 400 here: give one from 0 to 399."


def test_a_click_on_the_map_shows_the_cells_worst(browser, made):
    open_page(browser, made.path)
    cells = state(
        browser, "(({ x0, y0, wide, tall, nx, ny }) => ({ x0, y0, wide, tall, nx, ny }))(state.cells)"
    )
    x, y = made.data["x_m"].values, made.data["y_m"].values
    column = np.clip(np.floor((x - cells["x0"]) / cells["wide"]), 0, cells["nx"] - 1)
    line = np.clip(np.floor((y - cells["y0"]) / cells["tall"]), 0, cells["ny"] - 1)
    place = (line * cells["nx"] + column).astype(int)
    good = settled(made.data)
    full = np.bincount(place[good], minlength=cells["nx"] * cells["ny"])
    cell = int(np.argmax(full))
    inside = np.flatnonzero(good & (place == cell))
    assert len(inside) > 5
    worst = int(inside[np.argmin(made.data["tip"].values[inside])])
    middle = [
        cells["x0"] + (cell % cells["nx"] + 0.5) * cells["wide"],
        cells["y0"] + (cell // cells["nx"] + 0.5) * cells["tall"],
    ]
    canvas = browser.find_element(By.ID, "map")
    # Metres to pixels by the corners of the frame that is drawn, not by the page's own inverse.
    left, top, k, x0, y1 = browser.execute_script(
        "const { ground } = roverPin.state; const s = getComputedStyle(arguments[0]);"
        "const w = parseFloat(s.width) - 56; const h = parseFloat(s.height) - 42;"
        "const k = Math.min(w / (ground.x1 - ground.x0), h / (ground.y1 - ground.y0));"
        "return [46 + (w - k * (ground.x1 - ground.x0)) / 2, 8 + (h - k * (ground.y1 - ground.y0)) / 2, k,"
        " ground.x0, ground.y1]",
        canvas,
    )
    px, py = left + k * (middle[0] - x0), top + k * (y1 - middle[1])
    offset = round(px - canvas.size["width"] / 2), round(py - canvas.size["height"] / 2)
    ActionChains(browser, duration=20).move_to_element_with_offset(canvas, *offset).click().perform()
    check_case(browser, made, worst)
    assert f"case={worst}&" in browser.current_url
    tip = text(browser, "#map-tip")
    assert tip.endswith(f" · {int((place == cell).sum())} cases")
    assert tip.startswith(f"worst {np.degrees(made.data['tip'].values[worst]):.1f} °")


def test_filter_sort_link_and_csv(browser, made):
    data = made.data
    open_page(browser, made.path)
    drag(browser, 'canvas[data-measure="tip"]', 0.2, 0.7)
    drag(browser, 'canvas[data-measure="clearance"]', 0.3, 1.2)
    found = dict(re.findall(r"(\w+)\.range=([^&]*)", browser.current_url))
    passing = settled(data)
    for name in ("tip", "clearance"):
        low, high = (
            float(end) if end else sign * np.inf
            for end, sign in zip(found[name].split(".."), (-1, 1), strict=True)
        )
        values = data[name].values
        edge = np.minimum(np.abs(values - low), np.abs(values - high)) <= rounding(made, name)
        assert not edge.any()  # else rounding may let it in or not
        passing &= (values >= low) & (values <= high)
    assert found["clearance"].endswith("..")
    count = int(passing.sum())
    assert 20 < count < 300
    assert text(browser, "#subtitle").startswith(f"{count} of 400 cases")
    assert text(browser, 'button[data-status="settled"]') == f"{count} of {settled(data).sum()} settled"
    assert sum(state(browser, "[...state.cells.shown]")) == count

    browser.find_element(By.CSS_SELECTOR, 'button[data-sort="x_m"]').click()
    browser.find_element(By.CSS_SELECTOR, 'button[data-sort="x_m"]').click()
    order = np.flatnonzero(passing)[np.argsort(-data["x_m"].values[passing], kind="stable")]
    rows = cases_in_sight(browser)
    assert len(rows) >= 5
    assert rows == order[: len(rows)].tolist()
    click_row(browser, rows[3])
    check_case(browser, made, int(order[3]))
    browser.find_element(By.TAG_NAME, "body").send_keys("n")
    check_case(browser, made, int(order[4]))
    worst = int(np.flatnonzero(passing)[np.argmin(data["tip"].values[passing])])
    browser.find_element(By.TAG_NAME, "body").send_keys("w")
    check_case(browser, made, worst)

    link = browser.current_url
    open_page(browser, made.path, link.partition("#")[2])
    assert browser.current_url == link
    assert state(browser, "[state.chosen, state.selection.count]") == [worst, count]
    assert worst in cases_in_sight(browser)
    check_csv(browser, made, order)
    browser.get(
        f"{made.path.as_uri()}#case={worst}&tip.range=9..10"
    )  # the same page: only the fragment differs
    assert text(browser, "#table tbody") == "No case passes the filter."
    assert text(browser, "#case-said").endswith("left out by the filter")
    browser.find_element(By.ID, "clear").click()
    assert text(browser, "#subtitle").startswith("400 cases")
    assert worst in cases_in_sight(browser)


def check_csv(browser, made, order):
    """The selection in the table's order, every column to its rounding."""
    browser.find_element(By.ID, "csv").click()
    path = browser.downloads / "cases.csv"
    until = time.monotonic() + 60
    while not path.is_file() and time.monotonic() < until:
        time.sleep(0.02)
    with path.open(encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    data = made.data.isel(case=order)
    assert [int(row["case"]) for row in rows] == order.tolist()
    assert [row["status"] for row in rows] == ["settled"] * len(order)
    assert [row["tip_limiting"] for row in rows] == data["tip_limiting"].values.astype(str).tolist()
    columns = {name: data[name].values for name in (*BASE, "tip", "clearance", "loads", "friction_given")}
    columns |= {f"load_n/{w}": data["load_n"].values[:, k] for k, w in enumerate(data["wheel"].values)}
    columns |= {f"joint_rad/{j}": data["joint_rad"].values[:, k] for k, j in enumerate(data["joint"].values)}
    for name, values in columns.items():
        ours = np.array([float(row[name]) for row in rows])
        np.testing.assert_allclose(ours, values, rtol=0, atol=1.1 * rounding(made, name), err_msg=name)


def test_cases_without_an_answer_are_counted_and_said(browser, made):
    status = made.data["status"].values.astype(str)
    words, counts = np.unique(status, return_counts=True)
    assert len(words) > 1
    other = words[words != "settled"][0]
    open_page(browser, made.path)
    for word, count in zip(words, counts, strict=True):
        assert text(browser, f'button[data-status="{word}"] b') == str(count)
    browser.find_element(By.CSS_SELECTOR, f'button[data-status="{other}"]').click()
    rows = cases_in_sight(browser)
    assert {status[case] for case in rows} == {other}
    assert f"status={other}" in browser.current_url
    click_row(browser, rows[0])
    unposed = browser.find_element(By.ID, "unposed").is_displayed()
    assert unposed == bool(np.isnan(made.data["z_m"].values[rows[0]]))


def test_it_prints_on_one_sheet(browser, made):
    open_page(browser, made.path)
    options = PrintOptions()
    options.orientation = "landscape"
    pdf = base64.b64decode(browser.print_page(options))
    assert len(re.findall(rb"/Type\s*/Page\b", pdf)) == 1
    assert len(pdf) > 50_000  # pictures and all


CUT, DAMAGED = "the file is cut short: save it again", "the file is damaged: save it again"
HARM = {
    "block cut": (lambda page: re.sub(r'(class="block">[^<]{900})[^<]{40}', r"\1", page), CUT),
    "bytes changed": (lambda page: re.sub(r'(class="block">[^<]{9000}).{9}', r"\1AAAAAAAAA", page), DAMAGED),
    "header changed": (lambda page: page.replace('"wheels":[', '"wheels":[[', 1), DAMAGED),
    "file cut": (
        lambda page: page[: int(0.6 * len(page))],
        "the file is cut short or damaged: save it again.",
    ),
}


@pytest.mark.parametrize(("harm", "said"), HARM.values(), ids=HARM)
def test_a_damaged_file_says_so(browser, made, tmp_path, harm, said):
    whole = made.path.read_text(encoding="utf-8")
    path = tmp_path / "harmed.html"
    path.write_text(harm(whole), encoding="utf-8")
    open_page(browser, path)
    assert text(browser, "#loading") == f"This page cannot be shown: {said}"


def test_where_masses_vary_the_mark_is_over_the_middle_of_the_loads(browser, tmp_path):
    vary = {"yaw_deg": [0, 360], "payload": {"kg": [20, 60], "x": [-0.2, 0.2], "y": [-0.2, 0.2], "z": 0.3}}
    study = Study("rocker_bogie", "flat", cases={"n": 2}, vary=vary, measures=["tip"])
    path = tmp_path / "heavy.html"
    save_study_page(study.run(engine="serial"), path, rover=study.plan.rover, terrain=study.plan.job.terrain)
    off = []
    for case in range(2):
        open_page(browser, path, f"case={case}")
        shown = np.array(state(browser, "picture.com"))
        com = np.array(study.stance(case).com)
        np.testing.assert_allclose(shown[:2], com[:2], atol=2e-3)
        plain = np.array(state(browser, "picture.robots[0].com()"))
        off.append(np.hypot(*(plain - com)[:2]))
    assert max(off) > 0.02
