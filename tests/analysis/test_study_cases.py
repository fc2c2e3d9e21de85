"""Cases: Sobol points and grids over what varies, whatever else is fixed."""

from __future__ import annotations

import math
import re
import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import qmc

from rover_pin.analysis.cases import Cases, Questions, draw
from rover_pin.analysis.quantities import Choice, Quantity, Span
from rover_pin.analysis.spec import CasesSpec
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


def same(a: Cases, b: Cases) -> bool:
    return a.digest == b.digest


def test_sobol_points_are_scipys_and_any_number_is_quiet() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        cases = draw(questions(y=Span(-1.0, 1.0)), CasesSpec(n=10, seed=7))
    unit = qmc.Sobol(2, scramble=True, seed=np.random.default_rng([7])).random_base2(4)[:10]
    np.testing.assert_array_equal(cases.y, 2.0 * unit[:, 0] - 1.0)
    np.testing.assert_array_equal(cases.x, unit[:, 1])


def test_what_is_fixed_takes_no_dimension() -> None:
    plain = draw(questions(), CasesSpec(n=64))
    more = draw(questions(friction=Choice((0.5,)), postures=("home",)), CasesSpec(n=64))
    np.testing.assert_array_equal(plain.x, more.x)
    assert more.friction is not None
    assert set(more.friction) == {0.5}


@given(n=st.integers(1, 200), seed=st.integers(0, 5), low=st.floats(-5, 5), width=st.floats(0, 5))
@settings(max_examples=25, deadline=None, derandomize=True)
def test_cases_stay_in_their_ranges_and_more_cases_begin_alike(
    n: int, seed: int, low: float, width: float
) -> None:
    asked = questions(x=Span(low, low + width), yaw_deg=Span(0.0, 360.0), postures=("a", "b", "c"))
    cases = draw(asked, CasesSpec(n=n, seed=seed))
    assert len(cases) == n
    assert ((cases.x >= low) & (cases.x <= low + width)).all()
    assert ((cases.yaw >= 0) & (cases.yaw < 2 * math.pi)).all()
    assert set(cases.posture) <= {0, 1, 2}
    assert same(cases, draw(asked, CasesSpec(n=n, seed=seed)))


def test_parameters_are_few_robots_each_for_a_run_of_cases() -> None:
    cases = draw(questions(track=Span(1.0, 1.4)), CasesSpec(n=1000, robots=10))
    tracks = cases.parameters["track"]
    assert len(np.unique(tracks)) == 10
    assert np.count_nonzero(np.diff(tracks)) == 9
    assert list(np.histogram(tracks, bins=4, range=(1.0, 1.4))[0]) in (
        [200, 300, 300, 200],
        [300, 200, 300, 200],
    )
    own = draw(questions(track=Span(1.0, 1.4)), CasesSpec(n=100, robots=100))
    assert len(np.unique(own.parameters["track"])) == 100


def test_choices_are_drawn_evenly() -> None:
    cases = draw(questions(friction=Choice((0.3, 0.5, 0.7, 0.9))), CasesSpec(n=256))
    assert cases.friction is not None
    _, counts = np.unique(cases.friction, return_counts=True)
    assert list(counts) == [64, 64, 64, 64]


def test_a_grid_is_every_combination_and_a_circle_does_not_repeat() -> None:
    asked = questions(y=Span(0.0, 2.0), yaw_deg=Span(0.0, 360.0), track=Span(1.0, 1.4))
    spec = CasesSpec.model_validate({"grid": {"x": 2, "y": 3, "yaw_deg": 4, "track": 2}})
    cases = draw(asked, spec)
    assert len(cases) == 48
    np.testing.assert_allclose(np.rad2deg(cases.yaw[:4]), [0, 90, 180, 270])
    np.testing.assert_array_equal(np.unique(cases.x), [0.0, 1.0])
    np.testing.assert_array_equal(np.unique(cases.y), [0.0, 1.0, 2.0])
    np.testing.assert_array_equal(cases.parameters["track"], np.repeat([1.0, 1.4], 24))


def test_a_grid_of_n_cuts_every_range_alike() -> None:
    cases = draw(questions(y=Span(0.0, 1.0)), CasesSpec(sampler="grid", n=50))
    assert len(cases) == 49


def test_a_single_tick_is_the_middle() -> None:
    cases = draw(questions(), CasesSpec.model_validate({"grid": {"x": 1}}))
    assert list(cases.x) == [0.5]


@pytest.mark.parametrize(
    ("grid", "message"),
    [
        ({}, "cases.grid.x: has no count; add x: 10"),
        ({"x": 2, "yo": 2}, "cases.grid.yo: counts an unknown quantity; known: x"),
        ({"x": 2, "y": 2}, "cases.grid.y: counts a quantity that is no range; known: x"),
        ({"x": 10**8}, "cases.grid: has too many cases (got 100000000); at most 10000000"),
    ],
)
def test_grids_that_do_not_fit(grid: dict[str, int], message: str) -> None:
    with pytest.raises(StudyError, match=f"^{re.escape(message)}$"):
        draw(questions(), CasesSpec.model_validate({"grid": grid}))


def test_a_grid_without_counts() -> None:
    with pytest.raises(StudyError, match=re.escape("write cases: {grid: {x: 10}}")):
        draw(questions(), CasesSpec(sampler="grid"))
