"""Numbers as YAML gives them."""

from __future__ import annotations

import math

from rover_pin.errors import StudyError


def number(raw: object) -> float:
    """A finite float from what YAML gave (`1e-3` comes as text there).

    Raises:
        StudyError: not a number, or not a finite one.
    """
    try:
        if isinstance(raw, bool) or raw is None:
            raise TypeError
        value = float(raw)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        raise StudyError("is not a number", value=raw) from None
    if not math.isfinite(value):
        raise StudyError("is not a finite number", value=raw)
    return value
