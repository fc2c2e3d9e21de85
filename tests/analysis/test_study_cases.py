"""Cases: Sobol points and grids over what varies, whatever else is fixed, whichever run is drawn."""

from __future__ import annotations

import itertools
import math
import pickle
import re
import warnings
from dataclasses import fields

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import qmc

from rover_pin.analysis.cases import Cases, Questions
from rover_pin.analysis.draw import Drawer, draw
from rover_pin.analysis.quantities import Choice, Quantity, Span
from rover_pin.analysis.spec import MOST_CASES, CasesSpec
from rover_pin.errors import StudyError


def questions(
    x: Quantity = Span(0.0, 1.0),
    y: Quantity = Choice((2.0,)),
    yaw_deg: Quantity = Choice((0.0,)),
    postures: tuple[str, ...] = (),
    friction: Quantity | None = None,
    **parameters: Quantity,
) -> Questions:
    return Questions({"y": y, "x": x, "yaw_deg": yaw_deg}, friction, parameters, {}, postures)


def everything(asked: Questions, spec: CasesSpec) -> Cases:
    source = draw(asked, spec)
    return source.drawer().run(0, len(source))


def content(cases: Cases, start: int = 0, stop: int | None = None) -> dict[str, bytes]:
    """The bits of some of the cases."""
    columns = {each.name: getattr(cases, each.name) for each in fields(Cases)}
    columns |= columns.pop("parameters") | columns.pop("joints") | columns.pop("weights")
    return {
        name: np.asarray(values)[start:stop].tobytes()
        for name, values in columns.items()
        if values is not None and name != "postures"
    }


EVERYTHING = questions(
    y=Span(-1.0, 1.0),
    yaw_deg=Span(0.0, 360.0),
    postures=("a", "b", "c"),
    friction=Choice((0.3, 0.5, 0.7)),
    track=Span(1.0, 1.4),
)
GRID = CasesSpec.model_validate({"grid": {"x": 5, "y": 4, "yaw_deg": 7, "track": 3}})


def test_sobol_points_are_scipys_and_any_number_is_quiet() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        cases = everything(questions(y=Span(-1.0, 1.0)), CasesSpec(n=10, seed=7))
    unit = qmc.Sobol(2, scramble=True, seed=np.random.default_rng([7])).random_base2(4)[:10]
    np.testing.assert_array_equal(cases.y, 2.0 * unit[:, 0] - 1.0)
    np.testing.assert_array_equal(cases.x, unit[:, 1])


@given(
    spec=st.one_of(st.builds(CasesSpec, n=st.integers(1, 700), seed=st.integers(0, 5)), st.just(GRID)),
    cuts=st.lists(st.floats(0, 1), min_size=2, max_size=8),
)
@settings(max_examples=30, deadline=None, derandomize=True)
def test_any_run_of_cases_has_the_bits_of_all_at_once(spec: CasesSpec, cuts: list[float]) -> None:
    source = draw(EVERYTHING, spec)
    whole = everything(EVERYTHING, spec)
    drawer = pickle.loads(pickle.dumps(source)).drawer()
    places = [math.floor(cut * len(source)) for cut in cuts]
    for a, b in itertools.pairwise(places):  # forwards and back, with gaps, empty ones too
        start, stop = min(a, b), max(a, b)
        assert content(drawer.run(start, stop)) == content(whole, start, stop)


def test_runs_in_order_never_start_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[int] = []
    plain = qmc.Sobol

    def counted(dimensions: int, **others: object) -> object:
        made.append(dimensions)
        return plain(dimensions, **others)

    monkeypatch.setattr(qmc, "Sobol", counted)
    drawer = draw(EVERYTHING, CasesSpec(n=1000)).drawer()
    for start in (0, 10, 400, 990):
        drawer.run(start, start + 10)
    assert made == [6]
    drawer.run(0, 1)
    assert made == [6, 6]


def test_the_last_of_a_billion_cases_is_drawn_by_itself() -> None:
    cases = draw(questions(), CasesSpec(n=MOST_CASES)).drawer().run(MOST_CASES - 2, MOST_CASES)
    sequence = qmc.Sobol(1, scramble=True, seed=np.random.default_rng([0]))
    sequence.fast_forward(MOST_CASES - 2)
    np.testing.assert_array_equal(cases.x, sequence.random(2)[:, 0])
    spec = CasesSpec.model_validate({"grid": {"x": 2**15, "y": 2**15}})
    corner = draw(questions(y=Span(0.0, 1.0)), spec).drawer().run(MOST_CASES - 1, MOST_CASES)
    assert (corner.x[0], corner.y[0]) == (1.0, 1.0)


def test_cases_there_are_not() -> None:
    drawer: Drawer = draw(questions(), CasesSpec(n=5)).drawer()
    with pytest.raises(StudyError, match=r"^cases: no such cases \(got '3 to 6'\); there are 5$"):
        drawer.run(3, 6)


def test_the_digest_is_of_what_cases_are_drawn_from() -> None:
    digest = draw(EVERYTHING, CasesSpec(n=100)).digest
    assert digest == draw(EVERYTHING, CasesSpec(n=100)).digest
    others = [
        draw(EVERYTHING, CasesSpec(n=101)),
        draw(EVERYTHING, CasesSpec(n=100, seed=1)),
        draw(EVERYTHING, GRID),
        draw(questions(), CasesSpec(n=100)),
        draw(questions(x=Span(0.0, 1.0 + 1e-15)), CasesSpec(n=100)),
        draw(questions(postures=("home",)), CasesSpec(n=100)),
    ]
    assert len({digest, *(other.digest for other in others)}) == 7


def test_what_is_fixed_takes_no_dimension() -> None:
    plain = everything(questions(), CasesSpec(n=64))
    more = everything(questions(friction=Choice((0.5,)), postures=("home",)), CasesSpec(n=64))
    np.testing.assert_array_equal(plain.x, more.x)
    assert more.friction is not None
    assert set(more.friction) == {0.5}


@given(n=st.integers(1, 200), seed=st.integers(0, 5), low=st.floats(-5, 5), width=st.floats(0, 5))
@settings(max_examples=25, deadline=None, derandomize=True)
def test_cases_stay_in_their_ranges_and_more_cases_begin_alike(
    n: int, seed: int, low: float, width: float
) -> None:
    asked = questions(x=Span(low, low + width), yaw_deg=Span(0.0, 360.0), postures=("a", "b", "c"))
    cases = everything(asked, CasesSpec(n=n, seed=seed))
    assert len(cases) == n
    assert ((cases.x >= low) & (cases.x <= low + width)).all()
    assert ((cases.yaw >= 0) & (cases.yaw < 2 * math.pi)).all()
    assert set(cases.posture) <= {0, 1, 2}
    assert content(cases) == content(everything(asked, CasesSpec(n=n + 50, seed=seed)), 0, n)


def test_every_case_has_a_design_of_its_own_and_designs_are_spread_evenly() -> None:
    cases = everything(questions(track=Span(1.0, 1.4)), CasesSpec(n=1024))
    tracks = cases.parameters["track"]
    assert len(np.unique(tracks)) == 1024
    assert list(np.histogram(tracks, bins=8, range=(1.0, 1.4))[0]) == [128] * 8
    both = np.histogram2d(tracks, cases.x, bins=8, range=((1.0, 1.4), (0.0, 1.0)))[0]
    assert (both == 16).all()


def test_choices_are_drawn_evenly() -> None:
    cases = everything(questions(friction=Choice((0.3, 0.5, 0.7, 0.9))), CasesSpec(n=256))
    assert cases.friction is not None
    _, counts = np.unique(cases.friction, return_counts=True)
    assert list(counts) == [64, 64, 64, 64]


def test_a_grid_is_every_combination_and_a_circle_does_not_repeat() -> None:
    asked = questions(y=Span(0.0, 2.0), yaw_deg=Span(0.0, 360.0), track=Span(1.0, 1.4))
    spec = CasesSpec.model_validate({"grid": {"x": 2, "y": 3, "yaw_deg": 4, "track": 2}})
    cases = everything(asked, spec)
    assert len(cases) == 48
    np.testing.assert_allclose(np.rad2deg(cases.yaw[:4]), [0, 90, 180, 270])
    np.testing.assert_array_equal(np.unique(cases.x), [0.0, 1.0])
    np.testing.assert_array_equal(np.unique(cases.y), [0.0, 1.0, 2.0])
    np.testing.assert_array_equal(cases.parameters["track"], np.repeat([1.0, 1.4], 24))


@given(low=st.floats(-9, 9), width=st.floats(0.01, 9), count=st.integers(1, 60))
@settings(max_examples=25, deadline=None, derandomize=True)
def test_ticks_are_those_of_linspace(low: float, width: float, count: int) -> None:
    asked = questions(x=Span(low, low + width))
    cases = everything(asked, CasesSpec.model_validate({"grid": {"x": count}}))
    wanted = np.linspace(low, low + width, count) if count > 1 else [0.5 * (low + (low + width))]
    np.testing.assert_array_equal(cases.x, wanted)


def test_a_grid_of_n_cuts_every_range_alike() -> None:
    cases = everything(questions(y=Span(0.0, 1.0)), CasesSpec(sampler="grid", n=50))
    assert len(cases) == 49


def test_a_single_tick_is_the_middle() -> None:
    cases = everything(questions(), CasesSpec.model_validate({"grid": {"x": 1}}))
    assert list(cases.x) == [0.5]


@pytest.mark.parametrize(
    ("grid", "message"),
    [
        ({}, "cases.grid.x: has no count; add x: 10"),
        ({"x": 2, "yo": 2}, "cases.grid.yo: counts an unknown quantity; known: x"),
        ({"x": 2, "y": 2}, "cases.grid.y: counts a quantity that is no range; known: x"),
        ({"x": 2**31}, "cases.grid: has too many cases (got 2147483648); at most 1073741824"),
    ],
)
def test_grids_that_do_not_fit(grid: dict[str, int], message: str) -> None:
    with pytest.raises(StudyError, match=f"^{re.escape(message)}$"):
        draw(questions(), CasesSpec.model_validate({"grid": grid}))


def test_a_grid_without_counts() -> None:
    one = everything(questions(), CasesSpec(sampler="grid"))
    assert len(np.unique(one.x)) == len(one) == 41
    assert len(everything(questions(y=Span(0.0, 1.0)), CasesSpec(sampler="grid"))) == 21 * 21
    three = questions(y=Span(0.0, 1.0), yaw_deg=Span(0.0, 10.0))
    with pytest.raises(StudyError, match=re.escape("write cases: {grid: {")):
        draw(three, CasesSpec(sampler="grid"))
