"""Joint limits: what counts as none, as a lock, or as an error."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from rover_pin.description.notes import Notes
from rover_pin.description.tree import Element, Tree

NO_LIMIT = 1e10  # rad, m, N or N m: such a number was written to mean that there is none
LOCK = 1e-6  # rad or m between the limits: such a joint does not move

_UNBOUNDED = (
    "joint {name}: no limits stated, taken as unbounded",
    "{n} joints without stated limits, taken as unbounded ({names})",
)
_IGNORED = (
    "joint {name}: limits of a continuous joint ignored",
    "limits of {n} continuous joints ignored ({names})",
)
_WIDE = (
    "joint {name}: its limits are so wide that they count as none",
    "limits of {n} joints are so wide that they count as none ({names})",
)
_NO_EFFORT = (
    "joint {name}: driven with effort 0, taken as a motor without a stated limit",
    "{n} joints driven with effort 0, taken as motors without a stated limit ({names})",
)


@dataclass(frozen=True)
class Limits:
    """Limits of a moving joint; +-inf where there are none.

    Attributes:
        lower, upper: rad or m.
        effort: N m or N; a stated 0 is a placeholder and counts as none.
        velocity: rad/s or m/s; likewise.
        no_effort: whether it was such a 0.
    """

    lower: float = -math.inf
    upper: float = math.inf
    effort: float = math.inf
    velocity: float = math.inf
    no_effort: bool = False

    @property
    def locks(self) -> bool:
        """Whether they leave nothing to move."""
        return self.upper - self.lower < LOCK


def read_limits(tree: Tree, name: str, joint: Element, notes: Notes) -> Limits:
    """The limits of a moving joint.

    `lower` and `upper` default to zero where only one of them stands, as URDF says; where neither stands the
    joint is taken to have none.

    Raises:
        DescriptionError: lower above upper, or a negative effort or velocity.
    """
    element = joint.find("limit")
    continuous = joint.get("type") == "continuous"
    if element is None:
        if not continuous:
            notes.each(name, *_UNBOUNDED)
        return Limits()
    effort, velocity = (_strength(tree, name, element, key) for key in ("effort", "velocity"))
    none = float(element.get("effort", "inf")) == 0.0
    if continuous:
        if element.get("lower") is not None or element.get("upper") is not None:
            notes.each(name, *_IGNORED)
        return Limits(effort=effort, velocity=velocity, no_effort=none)
    if element.get("lower") is None and element.get("upper") is None:
        notes.each(name, *_UNBOUNDED)
        return Limits(effort=effort, velocity=velocity, no_effort=none)
    lower, upper = float(element.get("lower", 0.0)), float(element.get("upper", 0.0))
    if lower > upper:
        raise tree.error("lower limit above the upper", f"joint {name}", f"{lower} > {upper}", "swap them")
    if lower <= -NO_LIMIT or upper >= NO_LIMIT:
        notes.each(name, *_WIDE)
    low, high = (-math.inf if lower <= -NO_LIMIT else lower), (math.inf if upper >= NO_LIMIT else upper)
    return Limits(low, high, effort, velocity, none)


def tell_zero_efforts(limits: Mapping[str, Limits], driven: Sequence[str], notes: Notes) -> None:
    """Note the driven joints whose stated effort of 0 counts as none; what hangs free has no motor anyway."""
    notes.many((name for name in driven if name in limits and limits[name].no_effort), *_NO_EFFORT)


def _strength(tree: Tree, name: str, element: Element, key: str) -> float:
    text = element.get(key)
    if text is None:
        return math.inf
    value = float(text)
    if value < 0:
        raise tree.error(f"negative {key} limit", f"joint {name}", text, "give its size")
    return math.inf if value == 0.0 or value >= NO_LIMIT else value
