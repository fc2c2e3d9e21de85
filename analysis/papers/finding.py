"""A finding: what a paper says of one quantity, what we compute, and the verdict."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

REPRODUCED, PARTLY, NOT_REPRODUCED, IN_SAMPLE = "reproduced", "partly", "not reproduced", "in sample"
VERDICTS = (REPRODUCED, PARTLY, NOT_REPRODUCED, IN_SAMPLE)

NEAR = 3.0
"""Times what the paper's statement leaves open, up to which a value is reproduced partly."""

Value = float | str | None


@dataclass(frozen=True)
class Finding:
    """One row of a comparison.

    Attributes:
        quantity: what it is, in a few words.
        unit: of the numbers; empty where they are words.
        paper: what the paper's model gives or its text says.
        ours: what we compute; None where nothing could be computed.
        verdict: of VERDICTS; `in sample` where the paper's own value went into what we compute with.
        reason: why that verdict.
        where: table, figure or section of the paper.
        measured: what the paper measured on the real machine, where it did.

    Raises:
        ValueError: an unknown verdict, or no reason.
    """

    quantity: str
    unit: str
    paper: Value
    ours: Value
    verdict: str
    reason: str
    where: str = ""
    measured: float | None = None

    def __post_init__(self) -> None:
        if self.verdict not in VERDICTS:
            raise ValueError(f"{self.quantity}: {self.verdict!r} is none of {', '.join(VERDICTS)}")
        if not self.reason:
            raise ValueError(f"{self.quantity}: a verdict needs its reason")

    @property
    def error(self) -> float | None:
        """Ours less the paper's, in the unit."""
        return _difference(self.ours, self.paper)

    @property
    def error_percent(self) -> float | None:
        """Of ours, relative to the paper's model."""
        return _percent(self.ours, self.paper)

    @property
    def error_to_measured_percent(self) -> float | None:
        """Of ours, relative to the paper's measurement."""
        return _percent(self.ours, self.measured)

    def as_row(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "quantity": self.quantity,
            "unit": self.unit,
            "paper": self.paper,
            "ours": self.ours,
            "verdict": self.verdict,
            "reason": self.reason,
            "where": self.where,
            "measured": self.measured,
            "error": self.error,
            "error_percent": self.error_percent,
            "error_to_measured_percent": self.error_to_measured_percent,
        }


def _difference(ours: Value, other: Value) -> float | None:
    if isinstance(ours, str) or isinstance(other, str) or ours is None or other is None:
        return None
    return ours - other


def _percent(ours: Value, other: Value) -> float | None:
    difference = _difference(ours, other)
    if difference is None or isinstance(other, str) or not other:
        return None
    return 100.0 * difference / abs(other)


def fitted(
    quantity: str,
    unit: str,
    paper: float,
    ours: float,
    *,
    where: str,
    measured: float | None = None,
    why: str,
) -> Finding:
    """A value that what we compute with was identified from: `in sample` whatever comes out."""
    return Finding(quantity, unit, paper, _known(ours), IN_SAMPLE, why, where, measured)


def compared(
    quantity: str,
    unit: str,
    paper: float,
    ours: float,
    *,
    within: float,
    where: str,
    measured: float | None = None,
    used: bool = False,
    at_most: str = REPRODUCED,
    why: str = "",
) -> Finding:
    """A number beside a number.

    Within what the statement leaves open it is reproduced, within NEAR times that partly, else not.

    Args:
        quantity: what it is.
        unit: of the numbers.
        paper: what the paper says.
        ours: what we compute; NaN where nothing came out.
        within: what the statement leaves open, in the unit: half of its last digit, or what its words mean.
        where: in the paper.
        measured: what the paper measured.
        used: whether the statement went into what we compute with; it is `in sample` then where it holds.
        at_most: verdict where it agrees, PARTLY where the comparison is an indirect one.
        why: further words for the reason.
    """
    value = _known(ours)
    if value is None:
        return Finding(quantity, unit, paper, None, NOT_REPRODUCED, _joined("no value comes out", why), where)
    apart = abs(value - paper)
    size = f"{apart:.2g} {unit}".strip()
    open_ = f"{within:.2g} {unit}".strip()
    if apart <= within:
        verdict = IN_SAMPLE if used else at_most
        text = f"within the {open_} that the statement leaves open"
    elif apart <= NEAR * within:
        verdict, text = PARTLY, f"{size} apart, more than the {open_} that the statement leaves open"
    else:
        verdict, text = NOT_REPRODUCED, f"{size} apart; the statement leaves {open_} open"
    return Finding(quantity, unit, paper, value, verdict, _joined(text, why), where, measured)


def claimed(
    quantity: str,
    unit: str,
    paper: str,
    ours: Value,
    holds: bool,
    *,
    where: str,
    used: bool = False,
    at_most: str = REPRODUCED,
    why: str,
) -> Finding:
    """A statement in words, which holds or does not.

    Args:
        quantity: what it is about.
        unit: of our number.
        paper: the statement, in short.
        ours: the number or the words that it is judged by; None where nothing came out.
        holds: whether it holds for us.
        where: in the paper.
        used: whether the statement went into what we compute with.
        at_most: verdict where it holds.
        why: what it was judged by.
    """
    verdict = NOT_REPRODUCED if not holds or ours is None else IN_SAMPLE if used else at_most
    value = _known(ours) if isinstance(ours, float) else ours
    return Finding(quantity, unit, paper, value, verdict, why, where)


def _known(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _joined(*parts: str) -> str:
    return "; ".join(part for part in parts if part)
