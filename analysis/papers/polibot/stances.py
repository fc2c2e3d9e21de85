"""Figs 9 and 10 as side views: the half model at rest, with its payload, and on each obstacle."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rover_pin.analysis.papers.chart import Chart, Curve, Panel
from rover_pin.analysis.papers.polibot.reading import kinematics, read, wheel_centers

if TYPE_CHECKING:
    from rover_pin.analysis.papers.polibot.tables import Stances
    from rover_pin.statics.stance import Stance


def chart(cases: Stances) -> Chart:
    """Four side views, front to the right."""
    named = {
        "baseline": cases.baseline,
        "80 kg payload": cases.payload,
        "55 mm under W3": cases.front,
        "55 mm under W6": cases.rear,
    }
    panels = tuple(_panel(name, stance) for name, stance in named.items())
    title = "Figs 9 and 10: the stances of Tables 6 to 8 from the side"
    note = "Track, wheels and ground; front to the right, x from the sprocket's axis."
    return Chart("fig_9_10", title, "x [mm]", panels, note, beside=True)


def _panel(name: str, stance: Stance) -> Panel:
    curves = []
    turn = np.linspace(0.0, 2.0 * np.pi, 60)
    centers = wheel_centers(stance)
    for wheel in stance.rover.wheels:
        x, z = centers[wheel.name]
        curves.append(
            Curve(
                "",
                1e3 * (x + wheel.radius * np.cos(turn)),
                1e3 * (z + wheel.radius * np.sin(turn)),
                faint=True,
            )
        )
    at = kinematics(stance)
    curves += [
        Curve("", 1e3 * path[:, 0], 1e3 * path[:, 2])
        for path in (track.path(at) for track in stance.rover.tracks)
    ]
    x = np.linspace(-0.45, 0.55, 401)
    curves.append(Curve("", 1e3 * x, 1e3 * stance.terrain.height(x, np.zeros_like(x))))
    found = read(stance)
    return Panel(
        f"{name}\npitch {found.theta:.2f} deg, tension {found.tension:.0f} N", tuple(curves), equal=True
    )
