"""The table of measures: every module of `rover_pin.stability.measures` that holds a `MEASURE`."""

from __future__ import annotations

import importlib
import pkgutil

from rover_pin.stability import measures
from rover_pin.stability.measure import Measure, ordered


def _found() -> dict[str, Measure]:
    modules = (
        importlib.import_module(f"{measures.__name__}.{info.name}")
        for info in pkgutil.iter_modules(measures.__path__)
    )
    return ordered([module.MEASURE for module in modules if hasattr(module, "MEASURE")])


MEASURES: dict[str, Measure] = _found()
"""Measures by name, the cheap ones first."""
