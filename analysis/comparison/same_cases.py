"""One study for each design, all of them with the same draws."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from rover_pin.analysis.comparison.design import Design
from rover_pin.analysis.quantities import MAP, Span
from rover_pin.analysis.study import Study
from rover_pin.analysis.yaml_file import parse_mapping
from rover_pin.errors import InputError, StudyError

DEFAULT = """\
robot: rocker_bogie
terrain: {rough: {seed: 1, rms: 0.05, hurst: 0.8, size: 20, spacing: 0.05}}
cases: {sampler: sobol, n: 1000, seed: 0}
"""
"""Where designs are compared without a study; its robot is replaced."""

EVERYWHERE: Mapping[str, Any] = {"x": MAP, "y": MAP, "yaw_deg": [0, 360]}


def studies(designs: Sequence[Design], template: Study, **keys: Any) -> dict[str, Study]:
    """Each design's study by its label: the template's with the robot, its parameters and posture replaced.

    What the wheels' reach leaves of the map is made the same for all, so that the same draws give the same
    places.

    Raises:
        InputError: a design, or a key of the study, that cannot be used; names the design.
    """
    raw = parse_mapping(template.text, template.file) | keys
    if raw.get("search") is not None:
        keys = {**keys, "search": None}
    base = template.altered(**keys)
    if base.spec.cases.sampler == "sensitivity":
        cure = "use sobol or grid"
        raise StudyError(
            "compares nothing", file=template.file, element="cases.sampler", value="sensitivity", cure=cure
        )
    vary = dict(raw.get("vary") or (EVERYWHERE if _bounded(base) else {"yaw_deg": [0, 360]}))
    asked = {each.label: _altered(base, each, vary) for each in designs}
    common = {axis: _common(axis, asked) for axis in ("x", "y") if vary.get(axis) == MAP}
    if not common:
        return asked
    return {each.label: _altered(base, each, {**vary, **common}) for each in designs}


def _bounded(study: Study) -> bool:
    """Whether the ground has an edge, so that `map` means something."""
    return bool(study.spec.terrain.build(study.folder).bounded)


def _altered(base: Study, design: Design, vary: Mapping[str, Any]) -> Study:
    """The template's study with a design in it, read and checked."""
    stated = vary.get("parameters") or {}
    twice = [name for name in design.parameters if name in stated]
    with _named(design.label):
        if twice:
            cure = "leave it out of one of them"
            raise StudyError("the study's vary says it too", element=f"parameters.{twice[0]}", cure=cure)
        own = {**vary, **({"posture": [design.posture]} if design.posture else {})}
        if design.posture and len(vary.get("posture") or ()) > 1:
            cure = "leave it out of one of them"
            raise StudyError("the study's vary says it too", element="posture", cure=cure)
        if stated or design.parameters:
            own["parameters"] = {**stated, **design.parameters}
        keys: dict[str, Any] = {"robot": design.robot, "vary": own, "sidecar": design.sidecar}
        if design.packages:
            keys["packages"] = dict(design.packages)
        study = base.altered(payload=design.payload, **keys)
        _ = study.plan
    return study


@contextlib.contextmanager
def _named(label: str) -> Iterator[None]:
    """Errors name the design."""
    try:
        yield
    except InputError as error:
        element = (error.element or "").removeprefix("vary.") or None
        where = f"design {label}" if error.file is None else f"design {label}: {error.file}"
        raise type(error)(
            error.what, file=where, element=element, value=error.value, cure=error.cure
        ) from None


def _common(axis: str, asked: Mapping[str, Study]) -> list[float]:
    """The range of x or y in which every design has room.

    Raises:
        StudyError: there is none.
    """
    spans = [study.plan.job.cases.questions.place[axis] for study in asked.values()]
    low = max(span.ends[0] for span in spans if isinstance(span, Span))
    high = min(span.ends[1] for span in spans if isinstance(span, Span))
    if low > high:
        raise StudyError("is too small for all designs at once", element="terrain", value=f"along {axis}")
    return [low, high]
