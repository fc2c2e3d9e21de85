"""A small tracked rover: a sprocket and an idler on the body, three sprung arms with a wheel each."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from little_rover import Builder

WHEELS = ("w1", "w2", "w2b", "w3", "w4")


@cache
def _plain() -> Any:
    return _made({}, (0.0, 1.0, 0.0), 0.0)


def tracked(
    track: Mapping[str, Any] | None = None,
    arm_axis: Sequence[float] = (0.0, 1.0, 0.0),
    beside: float = 0.0,
    driven: bool = False,
) -> Any:
    """The rover; w1 the sprocket, w2 idler at the front of an arm, w3 and w4 on the ground."""
    if track is None and tuple(arm_axis) == (0.0, 1.0, 0.0) and beside == 0.0 and not driven:
        return _plain()
    return _made(track or {}, tuple(arm_axis), beside, driven)


def _made(track: Mapping[str, Any], arm_axis: Sequence[float], beside: float, driven: bool = False) -> Any:
    builder = Builder("tracked")
    builder.link("base_link", 20.0, (0.0, 0.0, 0.05))
    arms = {"f": (0.3, arm_axis), "m": (0.0, (0.0, 1.0, 0.0)), "r": (-0.3, (0.0, 1.0, 0.0))}
    for name, (x, axis) in arms.items():
        builder.joint(
            f"arm_{name}", "base_link", f"arm_{name}_link", (x, 0.0, -0.05), axis, limits=(-0.8, 0.8)
        )
        builder.link(f"arm_{name}_link", 0.4, (-0.05, 0.0, -0.05))
    builder.sidecar["passive"] = [f"arm_{name}" for name in arms]
    del builder.sidecar["actuated"]
    if driven:
        builder.joint("drive", "base_link", "sprocket_link", (-0.45, 0.0, 0.1), kind="continuous")
        builder.link("sprocket_link", 1e-6)
    places = {
        "w1": ("sprocket_link", (0.0, 0.0, 0.0), 0.07) if driven else ("base_link", (-0.45, 0.0, 0.1), 0.07),
        "w2": ("arm_f_link", (0.2, beside, 0.02), 0.08),
        "w2b": ("arm_f_link", (0.08, 0.0, -0.12), 0.06),
        "w3": ("arm_m_link", (-0.02, 0.0, -0.14), 0.06),
        "w4": ("arm_r_link", (-0.05, 0.0, -0.13), 0.07),
    }
    builder.sidecar["wheels"] = [
        {
            "name": name,
            "frame": frame,
            "center": list(at),
            "axis": [0, 1, 0],
            "radius": r,
            "width": 0.1,
            "tread": 0.02,
        }
        for name, (frame, at, r) in places.items()
    ]
    builder.sidecar["springs"] = [
        {"name": f"s_{name}", "joint": f"arm_{name}", "stiffness": 150.0, "preload": 6.0} for name in arms
    ]
    builder.sidecar["loops"] = [{"name": "plane", "type": "level", "frame": "base_link", "axis": [0, 1, 0]}]
    builder.sidecar["tracks"] = [{"name": "t", "wheels": list(WHEELS), "length": 2.6, **track}]
    with tempfile.TemporaryDirectory() as folder:
        return builder.load(Path(folder))
