"""Figures on logged data: the HIT-MRII paper's numbers where they suffice, closed forms, properties."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rover_pin.analysis.locomotion import (
    energy,
    mean_power,
    power,
    relative_error,
    slip_ratio,
    traction_coefficient,
    traction_efficiency,
)
from rover_pin.errors import InputError


@pytest.mark.parametrize(
    ("commanded", "real", "percent"),
    [
        (153.82, 182.92, 18.92),
        (6422.75, 4727.74, 26.39),
        (1363.75, 978.18, 28.27),
        (17.47, 18.21, 4.24),
        (437.75, 43.65, 90.03),
    ],
)
def test_eq_42(commanded, real, percent):
    assert round(100.0 * relative_error(commanded, real), 2) == percent


def test_eq_42_over_segments():
    """Ten errors sum to 4.51 s; of ten phases of 50.67 s that is the printed 0.89 %."""
    errors = np.array([0.12, 0.07, 0.75, 1.24, 0.43, 0.22, 0.51, 0.21, 0.27, 0.69])
    asked = np.full(10, 50.674)
    assert round(100.0 * relative_error(asked, asked + errors), 2) == 0.89
    assert relative_error([1.0, -2.0], [0.5, -1.0]) == 0.5


def test_task_9_is_quicker_by_62_permille():
    assert round(100.0 * relative_error(289.0, 271.0), 1) == 6.2


def test_tractions_as_printed():
    """Task 12: 27.5 where 10 N are left, 32.5 at 8 N: pulls of 275 and 260 N, as before the lift."""
    assert traction_coefficient([275.0, 260.0, 250.0], [10.0, 8.0, 380.0]) == pytest.approx(
        [27.5, 32.5, 0.658], abs=1e-3
    )
    assert np.isnan(traction_coefficient(1.0, 0.0))


def test_energy_by_height_as_printed():
    """Task 10, kJ per 100 mm: 13.5 over 200, 27.5 over 400, 15.9 and 20.6 over 300 mm."""
    for kj, mm, printed in ((13.5, 200, 6.8), (27.5, 400, 6.9), (15.9, 300, 5.3), (20.6, 300, 6.9)):
        seconds = mm / 3.6
        total = energy([0.0, seconds], np.full(2, 1e3 * kj / seconds)) / 1e3
        assert total * 100.0 / mm == pytest.approx(printed, abs=0.051)


def test_slip():
    assert slip_ratio([0.1, 0.1, 0.1, -0.1, 0.1], [0.1, 0.05, 0.2, -0.05, -0.1]) == pytest.approx(
        [0.0, 0.5, -0.5, 0.5, 2.0]
    )
    assert slip_ratio(437.75, 43.65) == pytest.approx(0.9003, abs=1e-4)
    assert np.isnan(slip_ratio([0.0, 0.0], [0.0, 0.1])).all()


@given(st.floats(1e-3, 1.0), st.floats(0.0, 5.0), st.floats(0.1, 10.0))
def test_slip_has_no_unit_and_is_odd(c, share, unit):
    one = slip_ratio(c, share * c)
    assert slip_ratio(unit * c, unit * share * c) == pytest.approx(one)
    assert slip_ratio(-c, -share * c) == pytest.approx(one)
    assert -1.0 < one <= 1.0


def test_efficiency():
    """A wheel that pulls 50 N at 0.9 of its rim's speed, its torque the pull's: 0.9."""
    assert traction_efficiency(50.0, 0.09, 50.0 * 0.15, 0.1 / 0.15) == pytest.approx(0.9)
    assert np.isnan(traction_efficiency(50.0, 0.1, 0.0, 1.0))
    assert traction_efficiency(-5.0, 0.1, 1.0, 1.0) == pytest.approx(-0.5)


def test_power_and_energy():
    time = np.linspace(0.0, 2.0, 2001)
    rate = np.column_stack([np.sin(time), np.ones_like(time)])
    torque = np.column_stack([np.full_like(time, 2.0), np.full_like(time, -0.5)])
    watts = power(torque, rate)
    assert watts == pytest.approx(2.0 * np.sin(time) - 0.5)
    assert energy(time, watts) == pytest.approx(2.0 * (1.0 - math.cos(2.0)) - 1.0, abs=1e-6)
    assert mean_power(time, watts) == pytest.approx(energy(time, watts) / 2.0)
    assert power([1.0, 2.0], [3.0, 4.0]) == pytest.approx([3.0, 8.0])


def test_refusals():
    for make, message in (
        (
            lambda: relative_error([1.0], [1.0, 2.0]),
            "relative error: commanded and real need as many numbers",
        ),
        (
            lambda: relative_error([0.0], [1.0]),
            "relative error: nothing was commanded; leave such segments out",
        ),
        (lambda: relative_error([np.nan], [1.0]), "relative error: is no finite number"),
        (lambda: slip_ratio([], []), "commanded: is empty"),
        (
            lambda: slip_ratio([1.0, np.inf], [1.0, 1.0]),
            r"commanded\[1\]: has an entry that is no finite number",
        ),
        (lambda: slip_ratio([1.0, 2.0], [1.0, 2.0, 3.0]), "commanded, real: series are of unlike lengths"),
        (
            lambda: energy([0.0, 1.0, 1.0], [1.0, 1.0, 1.0]),
            r"time\[2\]: is not after the time before \(got 1.0\)",
        ),
        (lambda: energy([0.0], [1.0]), "time: needs at least two times"),
        (lambda: energy([0.0, 1.0], [1.0]), "time, power: series are of unlike lengths"),
    ):
        with pytest.raises(InputError, match=message):
            make()
