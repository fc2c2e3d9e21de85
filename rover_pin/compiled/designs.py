"""Designs: the arrays of many parameter values at once, from one traced run of xacro."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from rover_pin.compiled.design_machine import Made, read_blueprint
from rover_pin.compiled.machine import Machine, machine_of, pick
from rover_pin.description.trace import UntraceableError
from rover_pin.description.trace_expand import TracedText, trace_expansion
from rover_pin.errors import InputError
from rover_pin.numerics import Array

if TYPE_CHECKING:
    from rover_pin.rover import Rover

NOMINAL = 1e-13
"""Largest difference from the live rover at its own parameters, of the largest number of an array."""

SAMPLE = 1e-12
"""The same at other parameters, against rovers that the loader makes."""


class Designs:
    """A rover's arrays as functions of some of its parameters.

    A design's arrays are those of `machine_of(rover.with_parameters(...))` to 1e-12, and the same bit for bit
    whatever other designs are asked for. The first call compares three of its designs with the loader's.

    Args:
        rover: the nominal rover.
        names: its parameters that vary.
        traced: `traced` of other designs of the same files and names, where the files are not at hand; its
            sample counts here.

    Attributes:
        refusal: empty, or why every design has to be made by the loader.
        traced: the URDF with tokens; None where xacro could not be followed.
    """

    def __init__(self, rover: Rover, names: Sequence[str], traced: TracedText | None = None) -> None:
        self.rover, self.names = rover, tuple(names)
        self.traced, self.refusal = traced, ""
        self._sampled = traced is not None
        try:
            self.traced = traced or trace_expansion(rover.recipe, self.names)
            self._blueprint = read_blueprint(rover, machine_of(rover), self.traced)
            self._agree(
                self._blueprint.make({name: np.array([rover.parameters[name]]) for name in self.names}),
                self._blueprint.nominal,
                NOMINAL,
                "the nominal design",
            )
        except InputError as error:
            self.refusal = str(error)

    def machines(self, values: Mapping[str, ArrayLike]) -> Made:
        """The machines of n designs.

        Args:
            values: (n,) of every parameter that varies.

        Raises:
            UntraceableError: `refusal`, also where the sample finds a difference only now.
            InputError: another parameter, one that is missing, or unlike lengths.
        """
        if self.refusal:
            raise UntraceableError(self.refusal)
        given = _checked(values, self.names)
        if not len(next(iter(given.values()))):
            return Made(pick(self._blueprint.nominal, slice(0)), np.ones(0, dtype=bool))
        made = self._blueprint.make(given)
        if not self._sampled:
            try:
                self._sample(given, made)
            except UntraceableError as error:
                self.refusal = str(error)
                raise
        return made

    def _sample(self, given: Mapping[str, Array], made: Made) -> None:
        """Compare the first design that holds, the middle and the last one with the loader's."""
        valid = np.flatnonzero(made.valid)
        for i in dict.fromkeys(valid[[0, len(valid) // 2, -1]].tolist() if len(valid) else ()):
            values = {name: float(array[i]) for name, array in given.items()}
            shown = ", ".join(f"{name} {value:.6g}" for name, value in values.items())
            try:
                expected = machine_of(self.rover.with_parameters(**values))
            except InputError as error:
                raise UntraceableError(f"the loader refuses the design {shown}: {error}") from error
            one = Made(pick(made.machine, slice(i, i + 1)), made.valid[i : i + 1])
            self._agree(one, expected, SAMPLE, f"the design {shown}")
            self._sampled = True

    def _agree(self, made: Made, expected: Machine, tolerance: float, called: str) -> None:
        different = difference(made.machine, expected, tolerance) if made.valid.all() else "validity"
        if different:
            raise UntraceableError(
                f"followed from the parameters, {called} is another than the loader's: {different}",
                file=self.rover.source,
            )


def difference(machine: Machine, expected: Machine, tolerance: float) -> str:
    """The first array in which machines differ, and by how much; empty where they do not.

    Args:
        machine: one.
        expected: the other.
        tolerance: of the largest number of an array.
    """
    for name, array, other in zip(Machine._fields, machine, expected, strict=True):
        if array.shape != other.shape:
            return f"{name} of shape {array.shape} for {other.shape}"
        if array.dtype != np.float64:
            if not np.array_equal(array, other):
                return name
            continue
        bounded = np.isfinite(other)
        if not np.array_equal(array[~bounded], other[~bounded]):
            return name
        if bounded.any():
            size = float(np.abs(other[bounded]).max()) or 1.0
            apart = float(np.abs(array[bounded] - other[bounded]).max())
            if not apart <= tolerance * size:
                return f"{name} by {apart:.3g}"
    return ""


def _checked(values: Mapping[str, ArrayLike], names: Sequence[str]) -> dict[str, Array]:
    """(n,) values of every varied parameter."""
    if set(values) != set(names):
        raise InputError(
            "other parameters than those that vary",
            element="parameters",
            value=", ".join(sorted(values)) or "none",
            cure=f"give {', '.join(names)}",
        )
    given = {name: np.asarray(values[name], dtype=np.float64) for name in names}
    shapes = {array.shape for array in given.values()}
    if len(shapes) != 1 or len(next(iter(shapes))) != 1:
        raise InputError(
            "not one list of values per parameter, all of one length",
            element="parameters",
            value=", ".join(f"{name}: {array.shape}" for name, array in given.items()),
            cure="give arrays of shape (n,)",
        )
    return given
