"""How a quantity is shown to people: degrees for radians, millimetres for lengths under a metre or so."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

SHOWN = {
    "rad": ("°", 180.0 / math.pi),
    "m": ("mm", 1000.0),
    "N m": ("N m", 1.0),
    "1": ("–", 1.0),
    "-": ("–", 1.0),
    "": ("–", 1.0),
}

TITLES = {
    "polygon": "Polygon margin",
    "tip": "Tip-over angle",
    "force_angle": "Force-angle margin",
    "energy": "Energy margin",
    "zmp": "ZMP margin",
    "loads": "Load balance",
    "clearance": "Belly clearance",
    "friction": "Friction margin",
    "torque": "Holding torque",
    "region": "Support region",
    "slack": "Robust slack",
    "feasible": "Feasible region",
    "touching": "Wheels in contact",
    "load_spread": "Load spread",
}

FIRST = (
    "tip",
    "polygon",
    "force_angle",
    "energy",
    "zmp",
    "region",
    "feasible",
    "friction",
    "slack",
    "torque",
    "clearance",
    "loads",
    "load_spread",
    "touching",
)


def ranked(measures: Iterable[str]) -> list[str]:
    """Measures in the order people look at them: tipping first; those that are not known here last."""
    return sorted(measures, key=lambda name: (FIRST.index(name) if name in FIRST else len(FIRST), name))


def shown(unit: str) -> tuple[str, float]:
    """The unit to print and the factor to it; an unknown unit is printed as it stands."""
    return SHOWN.get(unit, (unit, 1.0))


def title_of(measure: str, attributes: Any = None) -> str:
    """What to call a measure: a short word of ours, else its `long_name`, else its own name."""
    named = dict(attributes or {}).get("long_name")
    return TITLES.get(measure) or str(named or measure.replace("_", " "))
