"""How a case ended, as a small number that a map can hold."""

from __future__ import annotations

from collections.abc import Mapping

from rover_pin.analysis.job import INVALID
from rover_pin.compiled import GROUNDED, OFF_MAP, OPEN, SETTLED
from rover_pin.statics.stance import Status

OUTCOMES: tuple[str, ...] = (*(str(status) for status in Status), INVALID)
"""Words by their number; the first is `settled`."""

STANDS = OUTCOMES.index(str(Status.SETTLED))
UNANSWERED = len(OUTCOMES)
"""Number of a case that is still to be asked of the plain path."""

FROM_CODE: Mapping[int, int] = {
    SETTLED: STANDS,
    GROUNDED: OUTCOMES.index(str(Status.GROUNDED)),
    OFF_MAP: OUTCOMES.index(str(Status.OFF_MAP)),
    OPEN: UNANSWERED,
}
"""From the compiled path's codes."""
