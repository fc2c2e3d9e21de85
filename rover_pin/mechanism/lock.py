"""Locks: passive joints that are held where they stand, as by an engaged clutch."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from rover_pin.errors import PostureError, nearest


@dataclass(frozen=True)
class Lock:
    """A joint held at a value; what is coupled, looped or sprung to it goes on through the held joint.

    Attributes:
        joint: name of the passive joint.
        value: rad or m.
    """

    joint: str
    value: float


def engage(
    names: Iterable[str], lockable: Sequence[str], posture: Mapping[str, float], *, file: object = None
) -> tuple[Lock, ...]:
    """The locks that `names` engage, each at its joint's place in `posture` (0 if silent).

    Raises:
        PostureError: a joint that the sidecar does not list under `locks`.
    """
    engaged = []
    for name in names:
        if name not in lockable:
            raise PostureError(
                "not a joint that can be locked",
                file=file,
                element="lock",
                value=name,
                cure=nearest(name, lockable) if lockable else "list it under `locks` in the sidecar",
            )
        engaged.append(Lock(name, float(posture.get(name, 0.0))))
    return tuple(engaged)
