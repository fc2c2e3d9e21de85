"""Pilot trials: margins of motion constraints lowered until no trial goes beyond a limit."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from rover_pin.errors import InputError, nearest

ROUNDING = 1e-9
"""By which an index may pass 1, and two margins count as the same."""


@dataclass(frozen=True)
class Trial:
    """One trial.

    Attributes:
        margins: it was run with, by motion constraint.
        peaks: the largest index each constraint came to, 1 at its limit.
        violated: constraints whose limit was passed.
    """

    margins: Mapping[str, float]
    peaks: Mapping[str, float]
    violated: tuple[str, ...]


@dataclass(frozen=True)
class PilotReport:
    """How the pilot trials ended.

    Attributes:
        margins: of the last trial.
        trials: all of them, in order.
        exhausted: constraints that were still violated at the least margin; empty where margins were found.
        least: the least margin that was allowed.
    """

    margins: Mapping[str, float]
    trials: tuple[Trial, ...]
    exhausted: tuple[str, ...]
    least: float

    @property
    def feasible(self) -> bool:
        """Whether the last trial kept every limit, so that its margins can be used."""
        return not self.trials[-1].violated

    def __str__(self) -> str:
        """One line for people."""
        last, count = self.trials[-1], f"{len(self.trials)} trial{'s' if len(self.trials) > 1 else ''}"
        if not self.exhausted:
            found = ", ".join(f"{name} {margin:.4g}" for name, margin in self.margins.items())
            return f"no limit is passed after {count}, with margins {found}"
        each = ", ".join(f"{name} still comes to {last.peaks[name]:.4g}" for name in self.exhausted)
        return f"no feasible margin after {count}: {each} of its limit at the least margin, {self.least:g}"


def pilot(
    run_trial: Callable[[Mapping[str, float]], Mapping[str, float]],
    start: Mapping[str, float],
    step: float = 0.05,
    least: float = 0.1,
) -> PilotReport:
    """Lower the margins of violated motion constraints, trial after trial, until none is violated.

    A trial is run with margins, which are where the control stops; it comes to a peak index, which overshoots
    them where the control reacts late, coarsely or not at all. A constraint is violated where its peak is
    above 1, its limit; then its margin is a step smaller in the next trial, at least `least`. It ends with
    the first trial that violates nothing, or when a constraint is violated at the least margin: other margins
    would not help it. As every trial but the last lowers one margin there are no more trials than steps.

    The paper's words are that margins are decreased in short pilot trials until no violations are observed;
    steps, floor and report are ours.

    Args:
        run_trial: runs a motion with margins by constraint and gives the largest index of each of them; inf
            where the motion failed for it.
        start: margin of every constraint in the first trial, in (0, 1].
        step: by which a margin is lowered, above 0.
        least: margin below which none is lowered, above 0.

    Raises:
        InputError: margins, step or least out of range; a trial that gives no index of a constraint, one of a
            constraint that has no margin, or NaN.
    """
    margins = _checked(start, step, least)
    trials: list[Trial] = []
    while True:
        peaks = _peaks(run_trial(dict(margins)), margins)
        violated = tuple(name for name, peak in peaks.items() if peak > 1.0 + ROUNDING)
        trials.append(Trial(dict(margins), peaks, violated))
        exhausted = tuple(name for name in violated if margins[name] <= least + ROUNDING)
        if exhausted or not violated:
            return PilotReport(dict(margins), tuple(trials), exhausted, least)
        margins |= {name: max(margins[name] - step, least) for name in violated}


def _checked(start: Mapping[str, float], step: float, least: float) -> dict[str, float]:
    for word, value in (("step", step), ("least", least)):
        if not (math.isfinite(value) and value > 0.0):
            raise InputError("must be a finite number above 0", element=word, value=value)
    if not start:
        raise InputError("there is no margin to lower", element="start", cure="give one a motion constraint")
    for name, margin in start.items():
        if not least <= margin <= 1.0:
            raise InputError(
                f"a margin starts between the least, {least:g}, and 1", element=name, value=margin
            )
    return dict(start)


def _peaks(given: Mapping[str, float], names: Sequence[str] | Mapping[str, float]) -> dict[str, float]:
    for name in given:
        if name not in names:
            raise InputError(
                "the trial gives an index of a constraint without a margin", element=name,
                cure=nearest(name, names),
            )  # fmt: skip
    for name in names:
        if name not in given:
            cure = "let it tell the largest one"
            raise InputError("the trial gives no index of it", element=name, cure=cure)
        if math.isnan(given[name]):
            raise InputError("the trial gives NaN for its index", element=name, cure="give inf if it failed")
    return {name: float(given[name]) for name in names}
