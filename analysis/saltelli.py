"""Saltelli's sample for Sobol indices, drawn by SALib: blocks of cases that change one input at a time.

Of D inputs a block has D + 2 cases: A, then A with each input in turn taken from B, then B.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from rover_pin.analysis.quantities import Quantity
from rover_pin.analysis.sobol import spread_all
from rover_pin.errors import InputError, StudyError
from rover_pin.numerics import Array

MOST_BLOCKS = 2**20


class Saltelli:
    """The cases of `blocks` blocks, drawn at once by SALib on first use and kept."""

    def __init__(self, columns: Mapping[str, Quantity], blocks: int, seed: int) -> None:
        """Check what is asked.

        Raises:
            StudyError: blocks that are no power of two, or too many; nothing that varies.
            InputError: SALib is not installed.
        """
        self.inputs = tuple(name for name, asked in columns.items() if asked.varies)
        if not self.inputs:
            cure = "give something a range or a distribution"
            raise StudyError("nothing varies, so that nothing can matter", element="vary", cure=cure)
        if blocks & (blocks - 1):
            below = 1 << (blocks.bit_length() - 1)
            cure = f"give {below} or {2 * below}: there are {len(self.inputs) + 2} n cases"
            raise StudyError("must be a power of two", element="cases.n", value=blocks, cure=cure)
        if blocks > MOST_BLOCKS:
            raise StudyError("is too many", element="cases.n", value=blocks, cure=f"at most {MOST_BLOCKS}")
        salib()
        self._asked = dict(columns)
        self._blocks, self._seed = blocks, seed
        self.count = blocks * (len(self.inputs) + 2)
        self._drawn: Array | None = None

    def columns(self, start: int, stop: int) -> dict[str, Array]:
        """Every quantity of the cases from `start` to before `stop`."""
        if self._drawn is None and stop > start:
            self._drawn = self._sample()
        points = np.empty((0, len(self.inputs))) if self._drawn is None else self._drawn[start:stop]
        return spread_all(self._asked, points)

    def _sample(self) -> Array:
        """(count, inputs) in [0, 1)."""
        generator = np.random.default_rng([self._seed])
        sample: Array = salib()[0].sample(
            problem_of(self.inputs), self._blocks, calc_second_order=False, scramble=True, seed=generator
        )
        return sample


def problem_of(inputs: tuple[str, ...]) -> dict[str, Any]:
    """SALib's words for inputs in [0, 1): the distributions are ours."""
    return {"num_vars": len(inputs), "names": list(inputs), "bounds": [[0.0, 1.0]] * len(inputs)}


def salib() -> tuple[Any, Any]:
    """SALib's modules that draw and that analyse.

    Raises:
        InputError: it is not installed.
    """
    try:
        from SALib.analyze import sobol as analyse
        from SALib.sample import sobol as draw
    except ImportError:
        cure = "pip install 'rover-pin[uncertainty]'"
        what = "SALib is not installed, which draws and reads Sobol indices"
        raise InputError(what, element="cases.sampler", value="saltelli", cure=cure) from None
    return draw, analyse
