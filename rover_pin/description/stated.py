"""Locks, springs and postures of a sidecar, checked against the model's joints."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

from rover_pin.description.notes import Notes
from rover_pin.description.sidecar import Sidecar
from rover_pin.errors import PostureError, SidecarError, nearest
from rover_pin.mechanism import JointSpringSpec, Spring
from rover_pin.numerics import Array


def lockable_joints(
    sidecar: Sidecar, joints: Sequence[str], actuated: Sequence[str], file: object
) -> tuple[str, ...]:
    """The passive joints that can be locked.

    Raises:
        SidecarError: no such joint, or a driven one.
    """
    for i, name in enumerate(sidecar.locks):
        element = f"locks[{i}]"
        if name not in joints:
            raise SidecarError(
                "no moving joint of that name",
                file=file,
                element=element,
                value=name,
                cure=nearest(name, joints),
            )
        if name in actuated:
            raise SidecarError(
                "a driven joint is held anyway",
                file=file,
                element=element,
                value=name,
                cure="list passive joints only",
            )
    return tuple(dict.fromkeys(sidecar.locks))


def resolve_springs(
    sidecar: Sidecar, columns: Mapping[str, int], model: Any, file: object
) -> tuple[Spring, ...]:
    """The springs on the model.

    Raises:
        SidecarError: an unknown joint or frame.
    """
    return tuple(
        spec.resolve(columns, file=file)
        if isinstance(spec, JointSpringSpec)
        else spec.resolve(model, file=file)
        for spec in sidecar.springs
    )


def checked_postures(
    sidecar: Sidecar,
    columns: Mapping[str, int],
    held: Mapping[str, float],
    limits: Mapping[str, Array],
    notes: Notes,
    file: object,
) -> Mapping[str, Mapping[str, float]]:
    """The sidecar's postures; a joint that its limits hold may be named at its place.

    Joints that only an SRDF names, and that do not move here, are dropped with a note.

    Raises:
        PostureError: an unknown joint, or a value outside limits.
    """
    postures: dict[str, dict[str, float]] = {}
    theirs = sidecar.states.postures
    notes.many(
        sidecar.states.dropped,
        "joint {name} of the SRDF has several values: dropped from its postures",
        "{n} joints of the SRDF have several values: dropped from its postures ({names})",
    )
    for posture, values in sidecar.postures.items():
        kept = postures.setdefault(posture, {})
        for name, value in values.items():
            element = f"postures.{posture}.{name}"
            if name in held and math.isclose(value, held[name], abs_tol=1e-6):
                continue
            if name not in columns and name in theirs.get(posture, {}):
                notes.each(
                    name,
                    "joint {name} of the SRDF does not move here: dropped from its postures",
                    "{n} joints of the SRDF do not move here: dropped from its postures ({names})",
                )
                continue
            if name not in columns:
                raise PostureError(
                    "no moving joint of that name",
                    file=file,
                    element=element,
                    value=value,
                    cure=nearest(name, columns),
                )
            refuse_outside(
                name, value, limits["lower"][columns[name]], limits["upper"][columns[name]], file, element
            )
            kept[name] = float(value)
    return MappingProxyType({name: MappingProxyType(kept) for name, kept in postures.items()})


def refuse_outside(
    name: str, value: float, lower: float, upper: float, file: object = None, element: str | None = None
) -> None:
    """Nothing where `value` is within the limits, 1e-9 given for rounding.

    Raises:
        PostureError: it is not.
    """
    if not lower - 1e-9 <= value <= upper + 1e-9:
        raise PostureError(
            f"posture outside limits: Joint {name}: {lower:g} <= {value:g} <= {upper:g}",
            file=file,
            element=element,
            cure="stay within the limits",
        )
