"""From a study's words to its work: robot and terrain read, every name and range checked, cases drawn."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pinocchio as pin

from rover_pin.analysis.cases import Questions
from rover_pin.analysis.declared import asked_of, declared
from rover_pin.analysis.draw import draw
from rover_pin.analysis.job import Job
from rover_pin.analysis.provenance import digest, versions
from rover_pin.analysis.quantities import MAP, Choice, Quantity, Span
from rover_pin.analysis.rovers import load_from, loaded
from rover_pin.analysis.rows import BOUNDS, Layout
from rover_pin.analysis.spec import StudySpec, VarySpec
from rover_pin.analysis.weights import check_weights, weights_of
from rover_pin.analysis.words import posture
from rover_pin.errors import InputError, StudyError, naming, nearest
from rover_pin.stability.report import inapplicable

if TYPE_CHECKING:
    from rover_pin.description.trace_expand import TracedText
    from rover_pin.rover import Rover
    from rover_pin.terrain import Terrain


@dataclass(frozen=True)
class Plan:
    """A study ready to run.

    Attributes:
        job: the work.
        rover: the robot as loaded.
        left_out: measures that this robot cannot have, and why.
        fingerprint: what the result hangs on, by name, as digests.
    """

    job: Job
    rover: Rover
    left_out: Mapping[str, str]
    fingerprint: Mapping[str, str]


def plan(spec: StudySpec, folder: Path, file: object, given: Rover | None = None) -> Plan:
    """Read everything a study names; relative files count from `folder`, a `given` rover is not read.

    Raises:
        InputError: a file, name or range that cannot be used; errors of the study name `file`.
    """
    with naming(file):
        terrain: Terrain = spec.terrain.build(folder)
        base = load_from(spec, folder) if given is None else loaded(given, spec)
        asked = asked_of(spec, base)
    rovers = _corner_rovers(base, asked, file)
    rover = rovers[0]
    _check_names(spec, rover, file)
    with naming(file):
        check_weights(weights_of(spec.vary), rover)
        cases = draw(_questions(spec.vary, asked, rovers, terrain), spec.cases)
    wheels = tuple(shape.name for shape in rover.shapes)
    margins = [name for name in spec.measures if name != BOUNDS]
    left_out = inapplicable(rover, margins)
    measures = tuple(name for name in spec.measures if name not in left_out)
    job = Job(
        rover=rover,
        terrain=terrain,
        cases=cases,
        layout=Layout(
            wheels,
            tuple(rover.joints),
            measures,
            tracks=tuple(track.name for track in rover.tracks),
            auxiliary=tuple(wheel.name for wheel in rover.wheels if wheel.auxiliary),
            units={name: each.unit for name, each in declared(rover).items() if each.unit},
        ),
        gravity=spec.gravity,
        locks=spec.locks,
        traced=_traced(rover, asked, measures),
    )
    made_of = {
        "the cases": cases.digest,
        "the measures": digest(repr(spec.measures)),
        "gravity, payload or locks": digest(
            repr((spec.gravity, rover.recipe.payload, rover.recipe.masses, spec.locks))
        ),
        "the robot's description": hashlib.sha256(
            repr([(each.urdf, each.recipe.parameters) for each in rovers]).encode()
        ).hexdigest(),
        "the sidecar": digest(rover.recipe.sidecar_text or ""),
        "the terrain": terrain.digest,
        **{f"the version of {name}": text for name, text in versions().items()},
    }
    return Plan(job, rover, left_out, made_of)


def _traced(rover: Rover, asked: Mapping[str, Quantity], measures: Sequence[str]) -> TracedText | None:
    """The robot's description as a function of its parameters, for the compiled path, or None.

    Found out once and here, at designs that hang on nothing but the study, so that no worker needs the files
    and none decides otherwise.
    """
    if not asked:
        return None
    from rover_pin.compiled import COMPILED_MEASURES, Designs

    if not set(measures) <= set(COMPILED_MEASURES):
        return None
    designs = Designs(rover, tuple(asked))
    if designs.refusal:
        return None
    ends = {name: np.array(quantity.ends) for name, quantity in asked.items()}
    try:
        designs.machines(
            {name: np.array([low, 0.5 * (low + high), high]) for name, (low, high) in ends.items()}
        )
    except InputError:
        return None
    return designs.traced


def _corner_rovers(plain: Rover, asked: Mapping[str, Quantity], file: object) -> list[Rover]:
    """The rover as declared, then with all parameters at their least and at their greatest.

    Raises:
        InputError: the rover cannot be built; where the parameters are the cause, they are named.
    """
    rovers = [plain]
    for end in (0, 1) if asked else ():
        corner = {name: quantity.ends[end] for name, quantity in asked.items()}
        try:
            rovers.append(plain.with_parameters(**corner))
        except InputError as error:
            name = (error.element or "").removeprefix("parameter ")
            where = f"vary.parameters.{name}" if name in asked else "vary.parameters"
            raise StudyError(
                error.what, file=file, element=where, value=error.value, cure=error.cure
            ) from None
    return rovers


def _check_names(spec: StudySpec, rover: Rover, file: object) -> None:
    """Refuse postures, joints and locks that the rover does not have, and joint ranges beyond its limits."""
    for word in spec.vary.posture or ():
        if isinstance(posture(word), str) and word not in rover.postures and word != "home":
            cure = nearest(word, [*rover.postures, "home"])
            raise StudyError("no such posture", file=file, element="vary.posture", value=word, cure=cure)
    for name, asked in spec.vary.joints.items():
        if name not in rover.joints:
            cure = nearest(name, rover.joints)
            raise StudyError("no such joint", file=file, element=f"vary.joints.{name}", cure=cure)
        column = rover.column[name]
        limits = (float(rover.lower[column]), float(rover.upper[column]))
        if asked.ends[0] < limits[0] or asked.ends[1] > limits[1]:
            cure = f"stay within [{limits[0]:g}, {limits[1]:g}]"
            what = "goes beyond the joint's limits"
            raise StudyError(
                what, file=file, element=f"vary.joints.{name}", value=list(asked.ends), cure=cure
            )
    for name in spec.locks:
        if name not in rover.passive:
            cure = nearest(name, rover.passive)
            raise StudyError("no such passive joint", file=file, element="locks", value=name, cure=cure)


def _questions(
    vary: VarySpec, parameters: Mapping[str, Quantity], rovers: list[Rover], terrain: Terrain
) -> Questions:
    """What varies, the map resolved."""
    reach = max(wheel_reach(rover) for rover in rovers)
    xmin, xmax, ymin, ymax = terrain.extent
    return Questions(
        place={
            "y": _place("y", vary.y, (ymin, ymax), reach),
            "x": _place("x", vary.x, (xmin, xmax), reach),
            "yaw_deg": vary.yaw_deg,
        },
        friction=vary.friction,
        parameters=parameters,
        joints=vary.joints,
        postures=vary.posture or (),
        weights=weights_of(vary),
    )


def _place(axis: str, asked: Quantity | str | None, edges: tuple[float, float], reach: float) -> Quantity:
    """The range of x or y: the map less the wheels' reach, its middle where nothing was asked."""
    bounded = all(math.isfinite(edge) for edge in edges)
    if asked is None:
        return Choice((0.5 * (edges[0] + edges[1]) if bounded else 0.0,))
    if not isinstance(asked, str):
        return asked
    if not bounded:
        cure = f"give a range, as {axis}: [-5, 5]"
        raise StudyError("this terrain has no edge", element=f"vary.{axis}", value=MAP, cure=cure)
    low, high = edges[0] + reach, edges[1] - reach
    if low > high:
        size = f"{edges[1] - edges[0]:.3g} m along {axis}"
        cure = f"the wheels need {2 * reach:.3g} m"
        raise StudyError("is too small for the rover", element="terrain", value=size, cure=cure)
    return Span(low, high)


def wheel_reach(rover: Rover) -> float:
    """Largest horizontal distance [m] from the base's origin to a wheel's outside, level and at home."""
    q = np.zeros(rover.model.nq)
    for name, value in rover.home.items():
        q[rover.column[name]] = value
    data = rover.model.createData()
    pin.forwardKinematics(rover.model, data, q)
    reach = 0.0
    for shape in rover.shapes:
        center = data.oMi[shape.joint].act(np.asarray(shape.center))
        reach = max(reach, math.hypot(center[0], center[1]) + shape.ring + shape.tread)
    return reach
