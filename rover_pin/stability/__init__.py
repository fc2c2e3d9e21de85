"""How close a stance is to tipping, slipping and scraping.

The module can be called: `rover_pin.stability(stance)` is `rover_pin.stability.report.stability`.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rover_pin.stability.margin import Margin
    from rover_pin.statics.stance import Stance


class _CallableModule(ModuleType):
    """A module that is also the function it is about."""

    def __call__(
        self, stance: Stance, measures: Iterable[str] | None = None, friction: float | None = None
    ) -> dict[str, Margin]:
        """Every measure of a settled stance; see `rover_pin.stability.report.stability`."""
        from rover_pin.stability.report import stability

        return stability(stance, measures, friction)


sys.modules[__name__].__class__ = _CallableModule
