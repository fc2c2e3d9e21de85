"""A stance as the object and the tables that `settle` prints."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from rover_pin.cli.output import figure, fixed, line, new_table, print_table
from rover_pin.payload import told as payload_told

if TYPE_CHECKING:
    from rover_pin.stability.margin import Margin
    from rover_pin.statics.stance import Stance


def measured(stance: Stance, friction: float | None) -> dict[str, Margin]:
    """Every measure of a settled stance; none of another."""
    if not stance.settled:
        return {}
    from rover_pin.stability.report import stability

    return dict(stability(stance, friction=friction))


def stance_object(stance: Stance, margins: Mapping[str, Margin]) -> dict[str, Any]:
    """What `settle --json` prints; lengths in m, angles in rad, forces in N."""
    contacts: dict[str, list[dict[str, Any]]] = {shape.name: [] for shape in stance.rover.shapes}
    for contact in stance.contacts:
        told = {"point_m": contact.point, "normal": contact.normal, "load_n": _load(stance, contact.load)}
        contacts[contact.wheel].append(told)
    return {
        "robot": stance.rover.name,
        "status": str(stance.status),
        "reason": stance.reason,
        "base": {"position_m": stance.position, "rpy_rad": stance.rpy},
        "joints": stance.joints,
        "wheels": {
            name: {
                "load_n": _load(stance, stance.loads.get(name)),
                "gap_m": stance.gaps.get(name),
                "contacts": contacts[name],
            }
            for name in contacts
        },
        "tensions_n": stance.tensions,
        **_pulling(stance),
        "springs_n": stance.springs,
        "stability": {
            name: {
                "value": margin.value,
                "unit": margin.unit,
                "limiting": margin.limiting,
                "edges": margin.edges,
                **({"note": margin.note} if margin.note else {}),
                **({"outline_m": margin.outline} if margin.outline else {}),
            }
            for name, margin in margins.items()
        },
        "unanswered": unanswered(stance, margins),
        "residuals": stance.residuals,
        "gravity": stance.gravity,
        "payload": payload_told(stance.rover.recipe.payload),
        "redundant": stance.redundant,
        "undetermined": stance.undetermined,
        "notes": stance.rover.notes,
    }


def unanswered(stance: Stance, margins: Mapping[str, Margin]) -> dict[str, str]:
    """Measures of a settled stance without an answer, and why: the rover cannot have them, or not here."""
    from rover_pin.stability.report import inapplicable

    if not stance.settled:
        return {}
    closed = {name: margin.note for name, margin in margins.items() if margin.note and not margin.edges}
    return {**inapplicable(stance.rover), **closed}


def _pulling(stance: Stance) -> dict[str, object]:
    """What is known of tractions, where a resistance asks for them."""
    if not stance.resistance:
        return {}
    return {
        "tight_tensions_n": stance.tight,
        "tractions_n": stance.tractions,
        "traction_ratio": stance.traction_ratio,
    }


def _load(stance: Stance, load: float | None) -> float | None:
    """A load, which only a settled stance has."""
    return load if stance.settled else None


def print_stance(stance: Stance, margins: Mapping[str, Margin]) -> None:
    """The stance for people: status, pose, wheels, measures, residuals."""
    reason = f": {stance.reason}" if stance.reason else ""
    line(f"{stance.rover.name} on {stance.terrain.label}: {stance.status}{reason}")
    x, y, z = (fixed(part, 4) for part in stance.position)
    roll, pitch, yaw = (fixed(math.degrees(angle), 3) for angle in stance.rpy)
    line(f"x {x}  y {y}  z {z} m   roll {roll}  pitch {pitch}  yaw {yaw} deg")
    if not stance.settled:
        return
    _print_wheels(stance)
    _print_inside(stance)
    _print_measures(margins)
    for name, why in unanswered(stance, margins).items():
        line(f"{name}: {why}")
    line("residuals: " + "  ".join(f"{name} {value:.1e}" for name, value in stance.residuals.items()))
    if stance.redundant:
        line(
            f"redundant: {stance.redundant} supports more than equilibrium determines; least squares of loads"
        )
    if stance.undetermined:
        line(f"undetermined, kept at the posture: {', '.join(stance.undetermined)}")


def _print_wheels(stance: Stance) -> None:
    table = new_table("", "wheel", "load N", "share %", "gap mm", "contacts")
    total = sum(stance.loads.values())
    for shape in stance.rover.shapes:
        load = stance.loads.get(shape.name, 0.0)
        touching = sum(contact.wheel == shape.name for contact in stance.contacts)
        gap = 1e3 * stance.gaps.get(shape.name, math.nan)
        share = 100.0 * load / total if total else math.nan
        table.add_row(
            shape.name, f"{load:.2f}", f"{share:.1f}", f"{gap:.3f}" if abs(gap) > 5e-4 else "0", str(touching)
        )
    print_table(table)


def _print_inside(stance: Stance) -> None:
    """Tracks and springs, a line each."""
    for name, tension in stance.tensions.items():
        tight = stance.tight.get(name, tension)
        strands = f"{tension:.2f} N" if tight == tension else f"{tight:.2f} N tight, {tension:.2f} N slack"
        line(f"track {name}: {strands}")
    rover = stance.rover
    turning = {name for name, turns in zip(rover.dof_names, rover.turning, strict=True) if turns}
    units = {s.name: "N m" if getattr(s, "joint", None) in turning else "N" for s in rover.springs}
    for name, force in stance.springs.items():
        stop = stance.stops.get(name)
        line(f"spring {name}: {force:.2f} {units[name]}" + (f", stop {stop:.2f} N" if stop else ""))
    if stance.resistance:
        pulled = "  ".join(f"{name} {force:.2f}" for name, force in stance.tractions.items() if force)
        line(f"tractions N against {stance.resistance:g} N: {pulled}")
        line(f"tangential over vertical force: {stance.traction_ratio:.4f}")


def _print_measures(margins: Mapping[str, Margin]) -> None:
    table = new_table("", "measure", "limiting", "better", "value", "unit", left=3)
    for name, margin in margins.items():
        table.add_row(name, margin.limiting or "-", margin.better, figure(margin.value, 5), margin.unit)
    print_table(table)
