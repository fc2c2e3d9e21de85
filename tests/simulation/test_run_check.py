"""A run whose parts do not fit is refused by name, with the value and the cure."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import rover_pin as rp
from rover_pin.simulation.check import checked_run
from rover_pin.simulation.run import Run


@pytest.fixture(scope="module")
def still():
    rover = rp.load("hit_mrii")
    count = 4
    q = np.tile(rover.neutral, (count, 1))
    return Run(
        rover=rover,
        terrain=rp.Terrain.flat(),
        time=np.arange(count) * 0.5,
        configuration=q,
        rates=np.zeros_like(q),
        actions=("rolling",) * count,
        lifted=((),) * count,
        indices={"height": np.full((count, 1), np.nan)},
        loads={"LF": np.array([np.nan, 350.0, 351.0, np.nan])},
        drift=np.zeros((count, 6)),
        residual=np.full(count, np.nan),
    )


def test_what_was_not_asked_for_may_be_nan(still):
    assert checked_run(still) is still


def test_one_sample_is_a_run(still):
    first = {
        name: getattr(still, name)[:1]
        for name in ("time", "configuration", "rates", "actions", "lifted", "drift", "residual")
    }
    checked_run(dataclasses.replace(still, **first, indices={}, loads={}))


def change(still, **entries):
    """Arrays of the run with single entries set."""
    out = {}
    for name, (place, value) in entries.items():
        out[name] = np.array(getattr(still, name))
        out[name][place] = value
    return dataclasses.replace(still, **out)


CASES = {
    "empty": (lambda r: dataclasses.replace(r, time=r.time[:0]), "run: has no sample; log at least where"),
    "actions": (
        lambda r: dataclasses.replace(r, actions=r.actions[:3]),
        r"actions: is not as long as the run \(got '3 entries, 4 times'\); log everything at every sample",
    ),
    "rates": (
        lambda r: dataclasses.replace(r, rates=r.rates[:, :5]),
        r"rates: has another shape than the run \(got \(4, 5\)\); give \(4, 26\): one column a name",
    ),
    "index": (
        lambda r: dataclasses.replace(r, indices={"height": np.zeros((7, 1))}),
        r"indices 'height': is not as long as the run \(got '7 entries, 4 times'\)",
    ),
    "time": (lambda r: change(r, time=(2, np.nan)), r"time\[2\]: is no finite number \(got nan\)"),
    "back": (
        lambda r: change(r, time=(3, 0.25)),
        r"time\[3\]: runs back \(got '0.25 s after 1 s'\); log samples in the order they happened",
    ),
    "q": (
        lambda r: change(r, configuration=((1, 7), np.inf)),
        r"configuration\[1\], L_act: is no finite number \(got inf\); end the run before",
    ),
    "wheel": (
        lambda r: dataclasses.replace(r, lifted=((), ("LX",), (), ())),
        r"lifted\[1\]: no wheel of that name \(got 'LX'\); did you mean 'L",
    ),
    "load": (
        lambda r: dataclasses.replace(r, loads={"RB": np.array([1.0, 2.0, np.inf, 3.0])}),
        r"loads 'RB' \[2\]: is infinite \(got inf\); NaN says that no load is known",
    ),
    "loads": (
        lambda r: dataclasses.replace(r, loads={"RB": np.zeros((4, 2))}),
        r"loads 'RB': has another shape than the run \(got \(4, 2\)\); give \(4,\): one load a sample",
    ),
    "drift": (
        lambda r: dataclasses.replace(r, drift=np.zeros((4, 5))),
        r"drift: has another shape than the run \(got \(4, 5\)\); give \(4, 6\): one column a wheel: LF, LM",
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_parts_that_do_not_fit_are_named(still, name):
    spoil, message = CASES[name]
    with pytest.raises(rp.errors.InputError, match=message):
        checked_run(spoil(still))
