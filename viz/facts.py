"""What a stance's page says in words and numbers beside the picture."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.viz.arrows import lightest
from rover_pin.viz.scene import span_of
from rover_pin.viz.support import corners, limiting_edge
from rover_pin.viz.units import ranked, shown, title_of

if TYPE_CHECKING:
    from rover_pin.stability.margin import Margin
    from rover_pin.statics.stance import Stance
    from rover_pin.viz.scene import Drawn

STATUS_WORDS = {
    "settled": "settled",
    "tips": "tips over",
    "grounded": "grounded",
    "off_map": "off the map",
    "slack": "touches nothing",
    "loose": "loose joint",
    "no_convergence": "not converged",
}


def margins_of(stance: Stance) -> Mapping[str, Margin]:
    """Every measure of a settled stance; none of another."""
    if not stance.settled:
        return {}
    from rover_pin.stability.report import stability

    return dict(stability(stance))


def facts(stance: Stance, margins: Mapping[str, Margin], drawn: Drawn) -> dict[str, Any]:
    """Plain values for the page `stance`.

    Args:
        stance: what is shown.
        margins: its measures by name.
        drawn: what `draw` said of the picture.
    """
    status = str(stance.status)
    return {
        "robot": stance.rover.name,
        "terrain": stance.terrain.label,
        "status": status,
        "status_words": STATUS_WORDS.get(status, status),
        "reason": stance.reason,
        "weight_n": stance.weight,
        "redundant": stance.redundant,
        "loads": [{"name": name, "value": value} for name, value in stance.loads.items()]
        if stance.settled
        else [],
        "lightest": lightest(stance) if stance.settled else None,
        "margins": [_margin(name, margins[name]) for name in ranked(margins)],
        "pose": _pose(stance),
        "residuals": [{"name": name, "value": value} for name, value in stance.residuals.items()],
        "contour_m": drawn.contour_m,
        "unread": list(drawn.unread),
        "labels": _labels(stance),
        "springs": _springs(stance),
        "slack": _slack(stance),
        "target": [float(part) for part in stance.com],
        "yaw": float(stance.rpy[2]),
        "span": span_of(stance.rover),
    }


def _margin(name: str, margin: Margin) -> dict[str, Any]:
    unit, factor = shown(margin.unit)
    return {
        "title": title_of(name),
        "value": margin.value * factor,
        "unit": unit,
        "limiting": margin.limiting,
        "better": margin.better,
        "note": margin.note,
    }


def _pose(stance: Stance) -> list[dict[str, Any]]:
    rows = [
        {"name": axis, "value": value, "unit": "m"}
        for axis, value in zip("xyz", stance.position, strict=True)
    ]
    for angle, value in zip(("roll", "pitch", "yaw"), stance.rpy, strict=True):
        rows.append({"name": angle, "value": float(np.degrees(value)), "unit": "°"})
    from rover_pin.viz.tree import joint_nodes

    slides = {node.name: node.slides for node in joint_nodes(stance.rover.model)}
    for name, value in stance.joints.items():
        if slides.get(name, False):
            rows.append({"name": name, "value": 1000 * value, "unit": "mm"})
        else:
            rows.append({"name": name, "value": float(np.degrees(value)), "unit": "°"})
    return rows


def edge_label(stance: Stance, limiting: str | None) -> dict[str, Any] | None:
    """The name of the marked edge of the support polygon, and its middle, m; None where there is none."""
    edge = limiting_edge(stance, limiting) if stance.settled else None
    if edge is None:
        return None
    ring = corners(stance)
    a, b = ring[edge], ring[(edge + 1) % len(ring)]
    return {"at": [float(part) for part in (a.point + b.point) / 2], "name": f"{a.wheel}–{b.wheel}"}


def _springs(stance: Stance) -> list[dict[str, Any]]:
    """Each spring's force, N, or torque, N m, and each track's tension."""
    from rover_pin.viz.tree import joint_nodes

    turning = {node.name for node in joint_nodes(stance.rover.model) if node.fixed and not node.slides}
    rows = []
    for spring in stance.rover.springs:
        if spring.name in stance.springs:
            unit = "N m" if getattr(spring, "joint", None) in turning else "N"
            rows.append({"name": spring.name, "value": stance.springs[spring.name], "unit": unit})
    tensions = getattr(stance, "tensions", {})
    return rows + [{"name": name, "value": value, "unit": "N"} for name, value in tensions.items()]


def _slack(stance: Stance) -> list[dict[str, Any]]:
    """Slack of each track, m: what is drawn taut and is not."""
    from rover_pin.mechanism import Kinematics

    if not stance.rover.tracks:
        return []
    at = Kinematics(stance.rover.model, stance.rover.model.createData(), np.array(stance.configuration))
    return [{"name": track.name, "slack": float(track.slack(at))} for track in stance.rover.tracks]


def _labels(stance: Stance) -> list[dict[str, Any]]:
    """A label at the head of each contact's arrow."""
    heaviest = max((contact.load for contact in stance.contacts), default=0.0)
    if not stance.settled or heaviest <= 0:
        return []
    light, scale = lightest(stance), 0.4 * span_of(stance.rover) / heaviest
    return [
        {
            "at": [float(c.point[0]), float(c.point[1]), float(c.point[2] + c.load * scale)],
            "name": c.wheel,
            "load": c.load,
            "light": c.wheel == light,
        }
        for c in stance.contacts
        if c.load > 1e-3 * heaviest
    ]
