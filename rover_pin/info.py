"""What `rover-pin info` tells of a rover, for machines and for people."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from rover_pin.mechanism import JointSpring
from rover_pin.payload import told

if TYPE_CHECKING:
    from rover_pin.rover import Rover


def info(rover: Rover) -> dict[str, Any]:
    """Plain numbers and words, keyed by name; None where there is no limit.

    `rank` is the number of independent equations of couplings and loops at home, `redundancy` how many
    more are stated, `mobility` the joints' degrees of freedom (base excluded) less the rank.

    Raises:
        MechanismError: a loop that cannot close.
    """
    counts = rover.mobility
    return {
        "robot": rover.name,
        "mass_kg": rover.mass,
        "payload": told(rover.recipe.payload),
        "joints": {
            name: {
                "actuated": name in rover.actuated,
                "lower": _finite(rover.lower[rover.column[name]]),
                "upper": _finite(rover.upper[rover.column[name]]),
            }
            for name in rover.joints
        },
        "wheels": {
            w.name: {
                "link": w.link,
                "drive": w.drive,
                "radius_m": w.radius,
                "width_m": w.width,
                "tread_m": w.tread,
                "friction": w.friction,
                "free": w.free,
                "auxiliary": w.auxiliary,
            }
            for w in rover.wheels
        },
        "contacts": {
            f.name: {"link": f.link, "radius_m": f.radius, "friction": f.friction} for f in rover.feet
        },
        "loops": {loop.name: {"type": loop.type, "rows": loop.size} for loop in rover.loops},
        "couplings": {c.name: {"joints": dict(c.joints), "offset": c.offset} for c in rover.couplings},
        "springs": {
            s.name: {"on": s.joint if isinstance(s, JointSpring) else [s.first.label, s.second.label]}
            | {"stiffness": s.stiffness, "preload": s.preload}
            for s in rover.springs
        },
        "mobility": counts.mobility,
        "rank": counts.rank,
        "redundancy": counts.redundancy,
        "parameters": dict(rover.parameters),
        "notes": list(rover.notes),
    }


def describe(rover: Rover) -> str:
    """A few lines for people.

    Raises:
        MechanismError: a loop that cannot close.
    """
    counts = rover.mobility
    lines = [
        f"{rover.name}: {rover.mass:.6g} kg, {len(rover.joints)} joints, {len(rover.actuated)} driven",
        f"  wheels: {_names([w.name for w in rover.wheels])}",
        f"  feet: {_names([f.name for f in rover.feet])}",
        f"  loops: {_names([e.name for e in rover.loops])}",
        f"  couplings: {_names([e.name for e in rover.couplings])}",
        f"  springs: {_names([e.name for e in rover.springs])}",
        f"  mobility {counts.mobility}, rank {counts.rank}, redundancy {counts.redundancy}",
    ]
    return "\n".join(lines + [f"  note: {note}" for note in rover.notes])


def _names(names: list[str]) -> str:
    return ", ".join(names) or "none"


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
