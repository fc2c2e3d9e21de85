"""Words that the study file and the command line share: gravity, postures."""

from __future__ import annotations

from collections.abc import Mapping

from rover_pin.analysis.finite import number
from rover_pin.description.tree import HUGE
from rover_pin.errors import InputError, StudyError, nearest

GRAVITIES: Mapping[str, float] = {
    "mercury": 3.70,
    "venus": 8.87,
    "earth": 9.81,
    "moon": 1.62,
    "mars": 3.71,
    "ceres": 0.28,
    "europa": 1.31,
    "titan": 1.35,
}
"""Surface gravity, m/s2 (NASA's planetary fact sheets)."""


def gravity(raw: object) -> float:
    """Gravity in m/s2 from a positive number or the name of a world.

    Raises:
        StudyError: neither, or not positive.
    """
    if isinstance(raw, str) and raw.lower() in GRAVITIES:
        return GRAVITIES[raw.lower()]
    try:
        value = number(raw)
    except StudyError as error:
        cure = nearest(str(raw), GRAVITIES) if isinstance(raw, str) else None
        raise StudyError(f"gravity {error.what}", value=raw, cure=cure or "give m/s2") from None
    if value <= 0:
        raise StudyError("gravity must be more than zero", value=raw, cure="give m/s2 or earth, moon, mars")
    if value > HUGE:
        raise StudyError("gravity is too large to be meant", value=raw, cure="give m/s2")
    return value


def posture(word: str) -> str | dict[str, float]:
    """A posture's name, or `{"clearance": M}` from `clearance=M`.

    Raises:
        InputError: a goal other than clearance, or no positive number.
    """
    name, sign, text = word.partition("=")
    if not sign:
        return word
    if name.strip() != "clearance":
        raise InputError("no such goal", element="posture", value=word, cure="write clearance=M, or a name")
    try:
        height = number(text)
    except StudyError as error:
        raise InputError(f"clearance {error.what}", element="posture", value=word) from None
    if height <= 0:
        raise InputError(
            "clearance must be more than zero", element="posture", value=word, cure="give metres"
        )
    return {"clearance": height}
