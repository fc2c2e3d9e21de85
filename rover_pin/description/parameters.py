"""Parameters: the numbers of a xacro that a sidecar declares and a user may set."""

from __future__ import annotations

import math
from collections.abc import Mapping

from pydantic import BaseModel, ConfigDict, FiniteFloat, model_validator

from rover_pin.errors import InputError, nearest


class ParameterSpec(BaseModel):
    """One parameter: a xacro argument of that name.

    Attributes:
        default: its value where the user says nothing.
        unit: for tables and axes.
        bounds: least and greatest value, or None.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    default: FiniteFloat
    unit: str = ""
    bounds: tuple[FiniteFloat, FiniteFloat] | None = None

    @model_validator(mode="after")
    def _ordered(self) -> ParameterSpec:
        if self.bounds is not None and not self.bounds[0] <= self.default <= self.bounds[1]:
            raise ValueError(f"default {self.default} is outside its bounds {list(self.bounds)}")
        return self


def parameter_values(declared: Mapping[str, ParameterSpec], given: Mapping[str, float]) -> dict[str, float]:
    """The value of every declared parameter.

    Raises:
        InputError: an undeclared name, something that is no finite number, or a value out of bounds.
    """
    values = {name: float(spec.default) for name, spec in declared.items()}
    for name, value in given.items():
        if name not in declared:
            cure = nearest(name, declared) if declared else "declare it under `parameters` in the sidecar"
            raise InputError("no parameter of that name", element=f"parameter {name}", cure=cure)
        values[name] = _checked(name, value, declared[name])
    return values


def _checked(name: str, value: object, spec: ParameterSpec) -> float:
    try:
        number = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        number = math.nan
    unit = f" {spec.unit}" if spec.unit else ""
    if not math.isfinite(number):
        raise InputError(
            "not a finite number", element=f"parameter {name}", value=value, cure=f"give a number{unit}"
        )
    if spec.bounds is not None and not spec.bounds[0] <= number <= spec.bounds[1]:
        raise InputError(
            "out of bounds",
            element=f"parameter {name}",
            value=value,
            cure=f"stay between {spec.bounds[0]} and {spec.bounds[1]}{unit}",
        )
    return number
