"""One design and its neighbours: each parameter moved a little, alone, the others as they are."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rover_pin.analysis.quantities import Choice, Quantity
from rover_pin.analysis.spec import CasesSpec
from rover_pin.errors import StudyError, nearest
from rover_pin.numerics import Array

MOVES = 4
"""Cases a parameter: two far from the nominal value, two near."""

TWO_SIDED = (-1.0, 1.0, -0.5, 0.5)
ONE_SIDED = (0.5, 1.0, 0.25, 0.5)
"""The moves in steps; one-sided where a bound is in the way, turned round at an upper one."""


class OneByOne:
    """Case 0 is the nominal design; then `MOVES` cases for each parameter that is probed, in their order."""

    def __init__(self, columns: Mapping[str, Quantity], parameters: Mapping[str, Quantity]) -> None:
        """Take what `probes` gave for the parameters, and one value of everything else.

        Raises:
            StudyError: something else varies, or nothing is probed.
        """
        probed = {name: asked for name, asked in parameters.items() if asked.varies}
        for name, asked in columns.items():
            if asked.varies and name not in probed:
                cure = "give one value: sensitivities are taken at one place and one design"
                raise StudyError("varies", element=f"vary.{name}", cure=cure)
        if not probed:
            cure = "declare parameters in the sidecar"
            raise StudyError("there is no parameter to move", element="cases.to", cure=cure)
        self._values = {
            name: np.asarray(asked.values) for name, asked in probed.items() if isinstance(asked, Choice)
        }
        self._still = {name: asked.ends[0] for name, asked in columns.items() if name not in probed}
        self.count = 1 + MOVES * len(probed)

    def columns(self, start: int, stop: int) -> dict[str, Array]:
        """Every quantity of the cases from `start` to before `stop`."""
        case = np.arange(start, stop)
        whose, move = np.divmod(case - 1, MOVES)
        out = {name: np.full(len(case), value) for name, value in self._still.items()}
        for k, (name, values) in enumerate(self._values.items()):
            moved = (whose == k) & (case > 0)
            out[name] = np.asarray(np.where(moved, values[1 + move], values[0]))
        return out


def probes(
    spec: CasesSpec,
    given: Mapping[str, Quantity],
    values: Mapping[str, float],
    bounds: Mapping[str, tuple[float, float] | None],
) -> dict[str, Quantity]:
    """What a study of sensitivity asks of the parameters: the nominal value, then its `MOVES` neighbours.

    Args:
        spec: its `step` is the share of a parameter's value that it is moved by (of its bounds' width where
            it is 0), `to` the parameters; all where silent.
        given: nominal values of the study file.
        values: of every declared parameter.
        bounds: of every declared parameter.

    Raises:
        StudyError: no such parameter, a range instead of one number, or a step that cannot be told.
    """
    for name, asked in given.items():
        if asked.varies:
            cure = "give one number, the nominal one"
            raise StudyError("varies", element=f"vary.parameters.{name}", value=list(asked.ends), cure=cure)
    nominal = {**values, **{name: asked.ends[0] for name, asked in given.items()}}
    for name in spec.to or ():
        if name not in values:
            raise StudyError("no such parameter", element="cases.to", value=name, cure=nearest(name, values))
    return {
        name: Choice((value, *_neighbours(name, value, spec.step, bounds[name])))
        if spec.to is None or name in spec.to
        else Choice((value,))
        for name, value in nominal.items()
        if spec.to is None or name in spec.to or name in given
    }


def _neighbours(name: str, value: float, share: float, bounds: tuple[float, float] | None) -> list[float]:
    step = share * abs(value)
    if step == 0.0:
        if bounds is None or bounds[0] == bounds[1]:
            cure = "give it bounds in the sidecar, another value, or leave it out of cases.to"
            raise StudyError("is 0, so that a share of it is no step", element=name, cure=cure)
        step = share * (bounds[1] - bounds[0])
    low, high = bounds or (-np.inf, np.inf)
    moves: tuple[float, ...] = TWO_SIDED
    if value - step < low:
        moves = ONE_SIDED
    elif value + step > high:
        moves = tuple(-move for move in ONE_SIDED)
    last = value + (1.0 if moves[1] > 0 else -1.0) * step
    if not low <= last <= high:
        cure = f"give a smaller cases.step than {share:g}"
        raise StudyError("has bounds closer than a step", element=name, value=list(bounds or ()), cure=cure)
    return [value + move * step for move in moves]
