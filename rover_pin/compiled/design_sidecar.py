"""Numbers that stand in the sidecar alone, of many designs: formulas, springs, sizes of wheels and feet."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from rover_pin.compiled.design_rows import Entry, Sheet, Stated
from rover_pin.description.formulas import Number, Path
from rover_pin.description.reading import dotted
from rover_pin.description.recipe import Recipe
from rover_pin.description.sidecar import Sidecar, formulas_of
from rover_pin.description.trace import Ref, Trace, Traced, UntraceableError
from rover_pin.mechanism import FrameSpringSpec, JointSpringSpec

_FOLLOWED = (
    "springs.stiffness", "springs.preload", "springs.rest", "springs.length_max", "springs.frames.xyz",
    "springs.frames.rpy", "loops.length", "loops.axis", "loops.frames.xyz", "loops.frames.rpy",
    "loops.frame.xyz", "loops.frame.rpy", "couplings.joints.*", "couplings.offset", "free.*.axis",
    "free.*.limits", "inertials.*.mass", "inertials.*.com", "inertials.*.inertia", "wheels.center",
    "wheels.axis", "wheels.radius", "wheels.width", "wheels.tread", "wheels.friction", "contacts.center",
    "contacts.radius", "contacts.friction", "belly.point", "tracks.length", "tracks.wheels.radius",
    "tracks.wheels.center", "tracks.wheels.axis",
)  # fmt: skip
"""Places of the sidecar whose formulas designs follow, without indices; `*` is any name."""

_ABOVE_ZERO = ("radius", "length", "length_max")
_NOT_BELOW = ("radius", "width", "tread", "stiffness", "friction", "mass")


def read_formulas(recipe: Recipe, trace: Trace) -> dict[Path, Entry]:
    """The sidecar's formulas that hang on a parameter that varies, put on the trace.

    Raises:
        UntraceableError: one in a place from which no array of a design is made, or that cannot be followed.
    """
    if recipe.sidecar_text is None:
        return {}
    varied = {name: trace.parameter(name, recipe.parameters[name]) for name in trace.names}
    known: dict[str, Number] = {**recipe.parameters, **varied}
    entries: dict[Path, Entry] = {}
    for path, formula in formulas_of(recipe.sidecar_text, recipe.sidecar_path).items():
        if not formula.names & varied.keys():
            continue
        if not _is_followed(path):
            raise UntraceableError(
                "designs do not follow a formula here", file=recipe.sidecar_path, element=dotted(path)
            )
        trace.place = formula.text
        value = formula.value(known)
        entries[path] = Ref(value.index) if isinstance(value, Traced) else value
    trace.place = ""
    return entries


def _is_followed(path: Path) -> bool:
    """Whether designs follow a formula at this place of the sidecar."""
    steps = [step for step in path if isinstance(step, str)]
    return any(_alike(steps, pattern.split(".")) for pattern in _FOLLOWED)


def _alike(steps: Sequence[str], pattern: Sequence[str]) -> bool:
    same = (want in (step, "*") for step, want in zip(steps, pattern, strict=False))
    return len(steps) == len(pattern) and all(same)


def check_numbers(stated: Stated, sheet: Sheet) -> None:
    """Leave to the loader designs with formulas whose numbers it would refuse by themselves."""
    for path, entry in stated.items():
        numbers = sheet.row((entry,))[:, 0]
        key = path[-1]
        if path[0] == "couplings":
            sheet.require((numbers != 0.0) | (path[-2] != "joints"))
        elif key in _ABOVE_ZERO and path[0] != "contacts":
            sheet.require(numbers > 0.0)
        elif key in _NOT_BELOW or (path[-2] == "inertia" and key in (0, 1, 2)):
            sheet.require(numbers >= 0.0)


def springs(sidecar: Sidecar, sheet: Sheet) -> dict[str, Any]:
    """(n, f, 3) and (n, k, 3) values of springs between frames and on joints."""
    struts, torsions = [], []
    for i, spec in enumerate(sidecar.springs):
        stiffness = sheet.number(spec.stiffness, "springs", i, "stiffness")
        preload = sheet.number(spec.preload, "springs", i, "preload")
        if isinstance(spec, FrameSpringSpec):
            longest = sheet.number(spec.length_max, "springs", i, "length_max")
            struts.append(np.stack(np.broadcast_arrays(stiffness, preload, longest), axis=1))
        elif isinstance(spec, JointSpringSpec):
            rest = sheet.number(spec.rest, "springs", i, "rest")
            torsions.append(np.stack(np.broadcast_arrays(stiffness, rest, preload), axis=1))
    return {"strut_values": sheet.stack(struts, 3), "torsion_values": sheet.stack(torsions, 3)}


def sizes(sidecar: Sidecar, sheet: Sheet) -> dict[str, Any]:
    """(n, s) rings and treads of wheels and feet, as `Wheel` and `Foot` take them from what is stated."""
    rings, treads = [], []
    for i, spec in enumerate(sidecar.wheels):
        radius = sheet.number(spec.radius, "wheels", i, "radius")
        width = sheet.number(_width(spec.width, spec.tread), "wheels", i, "width")
        tread = np.minimum(0.5 * width, radius)
        if spec.tread is not None:
            tread = sheet.number(spec.tread, "wheels", i, "tread")
        sheet.require(tread <= radius)
        rings.append(radius - tread)
        treads.append(tread)
    for i, foot in enumerate(sidecar.contacts):
        rings.append(np.zeros(1))
        treads.append(sheet.number(foot.radius, "contacts", i, "radius"))
    return {"rings": sheet.stack(rings), "treads": sheet.stack(treads)}


def _width(width: float | None, tread: float | None) -> float:
    """A wheel's width where it may be silent, as `Placer` takes it."""
    return 2.0 * (tread or 0.0) if width is None else width
