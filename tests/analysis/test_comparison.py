"""Designs side by side: the same cases, figures by hand, a known shift, none where there is none."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rover_pin as rp
from rover_pin.analysis import Comparison, Design, Study, compare, paired
from rover_pin.errors import InputError, StudyError

SLOPE = {"slope": 56}
COUNT = 40
WIDE, NARROW, AGAIN = (
    "rocker_bogie:track=1.35",
    "rocker_bogie:track=1.0",
    "rocker_bogie:track=1.35,posture=home",
)


@pytest.fixture(scope="module")
def found() -> Comparison:
    return compare(
        [WIDE, NARROW, AGAIN], terrain=SLOPE, cases={"n": COUNT, "seed": 2}, measures=["tip", "energy"]
    )


def test_all_are_asked_the_same(found: Comparison) -> None:
    one, other, _ = found.datasets.values()
    assert found.cases == COUNT
    for name in ("x_m", "y_m", "yaw_rad"):
        assert np.array_equal(one[name].values, other[name].values)
    assert set(one["track"].values) == {1.35}
    assert set(other["track"].values) == {1.0}


def test_figures_are_those_counted_by_hand(found: Comparison) -> None:
    a, b = (found.datasets[label] for label in (WIDE, NARROW))
    pair = found.pairs[0]
    tips = [np.asarray(data["status"].values == "tips") for data in (a, b)]
    stands = [np.asarray(data["status"].values == "settled") for data in (a, b)]
    assert 0 < tips[1].sum() < COUNT
    assert [each.tipping for each in found.designs[:2]] == [t.mean() for t in tips]
    assert pair.only_first == tuple(np.flatnonzero(stands[0] & ~stands[1]))
    assert sum(pair.otherwise_second.values()) == len(pair.only_first) > 0
    assert pair.only_second == tuple(np.flatnonzero(stands[1] & ~stands[0]))
    assert pair.both + pair.neither + len(pair.only_first) + len(pair.only_second) == COUNT
    for name in ("tip", "energy"):
        x, y = a[name].values[stands[0] & stands[1]], b[name].values[stands[0] & stands[1]]
        told = pair.measures[name]
        assert told.cases == len(x)
        assert told.median == pytest.approx(np.median(y - x), abs=1e-15)
        assert told.mean == pytest.approx(np.mean(y - x), abs=1e-15)
        assert told.low <= told.median <= told.high
        assert told.first_better == np.mean(x - y > 1e-7 * np.maximum(x, y))
        assert told.first_better + told.second_better + told.equal == pytest.approx(1.0)
        spread = found.designs[1].measures[name]
        assert spread.answered == stands[1].mean()
        assert (spread.median, spread.worst) == (
            np.median(b[name].values[stands[1]]),
            np.nanmin(b[name].values),
        )
        assert b[name].values[spread.worst_case] == spread.worst


def test_a_design_beside_itself_is_exactly_equal_and_nobody_wins(found: Comparison) -> None:
    assert found.same == ((WIDE, AGAIN),)
    alike = found.pairs[1]
    assert (alike.first, alike.second) == (WIDE, AGAIN)
    assert (alike.only_first, alike.only_second) == ((), ())
    for told in alike.measures.values():
        assert (told.median, told.low, told.high, told.mean) == (0.0, 0.0, 0.0, 0.0)
        assert (told.first_better, told.second_better, told.equal, told.winner) == (0.0, 0.0, 1.0, "")


def test_a_known_shift_is_recovered_within_the_interval(found: Comparison) -> None:
    base = found.datasets[WIDE]
    noise = np.random.default_rng(1).normal(0.0, 0.004, COUNT)
    shifted = base.assign(tip=base["tip"].copy(data=base["tip"].values + 0.02 + noise))
    told = paired({"a": base, "b": shifted}).pairs[0].measures["tip"]
    assert told.low <= 0.02 <= told.high
    assert told.winner == "b"
    assert told.second_better > 0.95
    low_is_good = shifted.assign(tip=shifted["tip"].assign_attrs(better="low"))
    turned = paired({"a": base.assign(tip=base["tip"].assign_attrs(better="low")), "b": low_is_good})
    assert turned.pairs[0].measures["tip"].winner == "a"


def test_the_map_is_cut_to_what_all_have_room_for() -> None:
    ground = {"rough": {"seed": 3, "rms": 0.02, "hurst": 0.8, "size": 5, "spacing": 0.05}}
    both = compare([WIDE, NARROW], terrain=ground, cases={"n": 2}, measures=["tip"])
    texts = [study.plan.job.cases.questions.place for study in both.studies.values()]
    assert texts[0] == texts[1]
    alone = Study("rocker_bogie", ground, vary={"x": "map", "parameters": {"track": 1.35}}).plan
    assert texts[1]["x"] == alone.job.cases.questions.place["x"]


def test_rovers_and_designs_are_taken_and_a_study_lends_its_questions(tmp_path: Path) -> None:
    spec = tmp_path / "s.yaml"
    spec.write_text(
        "robot: hit_mrii\nterrain: {slope: 5}\ncases: {n: 2}\nvary: {yaw_deg: [0, 9]}\nmeasures: [tip]\n"
    )
    laden = rp.load("rocker_bogie", track=1.1).with_payload([(9.0, (0.0, 0.0, 0.2))])
    found = compare(
        {"laden": laden, "bare": Design("x", "rocker_bogie", {"track": 1.1})}, spec, gravity="moon"
    )
    weights = [float(data["load_n"].values[0].sum()) for data in found.datasets.values()]
    assert weights == pytest.approx([141 * 1.62, 132 * 1.62], rel=1e-8)
    assert found.labels == ("laden", "bare")
    assert found.as_dict()["designs"][0]["payload"] == "9.0@0.0,0.0,0.2"


def test_what_one_cannot_have_is_left_out_or_refused() -> None:
    without = str(Path(__file__).parents[1] / "fixtures" / "rigid4" / "rigid4.urdf")
    found = compare(
        ["rocker_bogie", without],
        Study.from_text(
            "robot: rocker_bogie\nterrain: flat\ncases: {n: 1}\nmeasures: [tip, clearance]\n"
            "vary: {yaw_deg: 0}\n"
        ),
    )
    assert "clearance" in found.left_out[without]
    assert "clearance" not in found.units
    with pytest.raises(
        StudyError, match=r"design .*rigid4.urdf: cannot have the measure clearance: .*leave it out"
    ):
        compare(["rocker_bogie", without], terrain="flat", measures=["tip", "clearance"])


@pytest.mark.parametrize(
    ("designs", "keys", "line"),
    [
        (["rocker_bogie"], {}, "designs: there is nothing to compare with (got 1); name two or more"),
        ([WIDE, WIDE], {}, f"design: is given twice (got '{WIDE}')"),
        (["rocker_bogie", "rocker_bogie:trak=1"], {}, "parameters.trak: no such parameter; did you mean"),
        (["rocker_bogie", "rocker_bogi"], {}, "did you mean 'rocker_bogie'"),
        (["rocker_bogie", "rocker_bogie:posture=hom"], {}, "no such posture (got 'hom'); did you mean"),
        (["rocker_bogie", "rocker_bogie:track=wide"], {}, "track=wide: track: is not a number (got 'wide')"),
        (["rocker_bogie", "rocker_bogie:track=1,track=2"], {}, "is given twice (got 'track'); keep one"),
        (["rocker_bogie", "rocker_bogie:track=1,x"], {}, "is not NAME=VALUE (got 'x')"),
        ([":a=1", "rocker_bogie"], {}, "design: names no robot (got ':a=1')"),
        ([1, 2], {}, "is no design (got 'int')"),
        (["rocker_bogie", WIDE], {"vary": {"parameters": {"track": [1, 1.2]}}}, "vary says it too"),
        (["rocker_bogie", WIDE], {"cases": "sensitivity"}, "compares nothing (got 'sensitivity'); use sobol"),
        (["rocker_bogie", WIDE], {"measures": ["tipp"]}, "no such measure (got 'tipp'); did you mean 'tip'?"),
    ],
)  # fmt: skip
def test_bad_input_is_one_line(designs: list[Any], keys: dict[str, Any], line: str) -> None:
    with pytest.raises(InputError) as caught:
        compare(designs, **{"terrain": "flat", **keys})
    assert line in str(caught.value)


def test_results_of_other_cases_or_ground_are_refused(found: Comparison) -> None:
    base = found.datasets[WIDE]
    with pytest.raises(StudyError, match=r"^b: stands on another terrain \(got 'slope:56, a on slope:56'\)"):
        paired({"a": base, "b": base.assign_attrs(terrain_digest="other")})
    moved = base.assign(x_m=base["x_m"] + 1.0)
    with pytest.raises(StudyError, match=r"^b: its cases are not those of a \(got 'x_m differs'\)"):
        paired({"a": base, "b": moved})
    with pytest.raises(StudyError, match=rf"\(got '9 cases, not {COUNT}'\)"):
        paired({"a": base, "b": base.isel(case=slice(9))})
    with pytest.raises(StudyError, match="nothing to compare with"):
        paired({"a": base})
