"""The `robot.yaml` of Gepetto's example-parallel-robots, in the words of our sidecar.

`closed_loop: [[a, b]]` with `type: [6d | 3d]` are welds and balls; `name_mot` are the driven joints;
`joint_name` with `joint_type: [SPHERICAL | CARDAN | UJOINT_XY | FIXED]` are joints of another type than the
URDF says; a CARDAN is a UJOINT_XY, and there is one for every two letters.
The keys are those of https://github.com/Gepetto/example-parallel-robots (`loader_tools.py`).
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rover_pin.errors import SidecarError, nearest

KEYS = ("closed_loop", "type", "name_mot", "joint_name", "joint_type")

_LOOPS = {"6d": "weld", "3d": "ball"}
_JOINTS = {"spherical": "ball", "cardan": "cardan", "fixed": "fixed"} | {
    f"ujoint_{letters}": f"cardan_{letters}" for letters in ("xy", "xz", "yx", "yz", "zx", "zy")
}


def is_gepetto(data: Mapping[str, Any]) -> bool:
    """Whether any of its keys stand in a mapping."""
    return any(key in data for key in KEYS)


def stands_in(path: Path) -> bool:
    """Whether a file is one of these: `closed_loop` begins a line of it."""
    try:
        return re.search(r"^closed_loop\s*:", path.read_text(encoding="utf-8"), re.MULTILINE) is not None
    except (OSError, UnicodeDecodeError):
        return False


def translated(data: Mapping[str, Any], file: object) -> dict[str, Any]:
    """The mapping with `loops`, `actuated` and `retype` in place of Gepetto's keys; our own keys stay.

    Raises:
        SidecarError: lists that do not fit together, an unknown type, or the driven joints said twice.
    """
    own = {key: value for key, value in data.items() if key not in KEYS}
    theirs = _loops(data, file)
    if theirs:
        own["loops"] = [*(own.get("loops") or ()), *theirs]
    if data.get("name_mot") is not None:
        if own.get("actuated") is not None or own.get("passive") is not None:
            said = "actuated" if own.get("actuated") is not None else "passive"
            raise SidecarError(
                f"says with `{said}` what is driven twice", file=file, element="name_mot", cure="keep one"
            )
        own["actuated"] = _names(data, "name_mot", file)
    retyped = _retyped(data, file)
    if retyped:
        own["retype"] = {**retyped, **(own.get("retype") or {})}
    return own


def _loops(data: Mapping[str, Any], file: object) -> list[dict[str, Any]]:
    pairs = _list(data, "closed_loop", file)
    for i, pair in enumerate(pairs):
        if not isinstance(pair, list) or len(pair) != 2 or not all(isinstance(e, str) for e in pair):
            raise SidecarError(
                "is not a pair of frames",
                file=file,
                element=f"closed_loop[{i}]",
                value=str(pair),
                cure="write [frame_a, frame_b]",
            )
    said = data.get("type")
    types = [said] * len(pairs) if isinstance(said, str) else _list(data, "type", file)
    types = types or ["6d"] * len(pairs)
    if len(types) != len(pairs) or any(str(t).lower() not in _LOOPS for t in types):
        raise SidecarError(
            "needs one of 6d, 3d for each closed loop",
            file=file,
            element="type",
            value=str(types),
            cure=f"give {len(pairs)} of them",
        )
    return [
        {"name": f"loop_{i + 1}", "frames": pair, "type": _LOOPS[str(kind).lower()]}
        for i, (pair, kind) in enumerate(zip(pairs, types, strict=True))
    ]


def _retyped(data: Mapping[str, Any], file: object) -> dict[str, str]:
    names, types = _names(data, "joint_name", file), _list(data, "joint_type", file)
    if len(names) != len(types):
        raise SidecarError(
            f"has {len(types)} types for {len(names)} joints",
            file=file,
            element="joint_type",
            cure="give one for each of joint_name",
        )
    for i, kind in enumerate(types):
        if str(kind).lower() not in _JOINTS:
            raise SidecarError(
                "is no type of a joint",
                file=file,
                element=f"joint_type[{i}]",
                value=str(kind),
                cure=nearest(str(kind), [word.upper() for word in _JOINTS]),
            )
    return {name: _JOINTS[str(kind).lower()] for name, kind in zip(names, types, strict=True)}


def _names(data: Mapping[str, Any], key: str, file: object) -> list[str]:
    names = _list(data, key, file)
    for i, name in enumerate(names):
        if not isinstance(name, str) or not name:
            raise SidecarError(
                "is no joint's name", file=file, element=f"{key}[{i}]", value=str(name), cure="give a name"
            )
    return names


def _list(data: Mapping[str, Any], key: str, file: object) -> list[Any]:
    found = data.get(key)
    if found is None:
        return []
    if not isinstance(found, list):
        raise SidecarError("not a list", file=file, element=key, value=str(found), cure="write [a, b, ...]")
    return found
