"""What xacro's expressions may call, for traced numbers."""

from __future__ import annotations

import builtins
import math
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from rover_pin.description.trace import Traced, is_number

OF_NUMBERS = frozenset(
    {"acos", "acosh", "asin", "asinh", "atan", "atan2", "atanh", "cbrt", "ceil", "copysign", "cos", "cosh"}
    | {"degrees", "erf", "erfc", "exp", "exp2", "expm1", "fabs", "floor", "fmod", "gamma", "hypot", "lgamma"}
    | {"log", "log10", "log1p", "log2", "pow", "radians", "remainder", "sin", "sinh", "sqrt", "tan", "tanh"}
    | {"trunc"}
)
"""Functions of `math` from numbers to a number."""

_BLIND = ("isinstance", "issubclass", "type", "vars", "complex", "divmod")
"""Builtins whose answer would not tell that it depends on a traced number."""

Function = Callable[..., Any]


def traced_symbols(
    symbols: Mapping[str, Any], number: Callable[[str], Traced | None] = lambda text: None
) -> dict[str, Any]:
    """The same names, with functions in place that keep the trace.

    Args:
        symbols: names -> values, of xacro's global symbols or of one of their name spaces.
        number: the traced number that a text is, if it is one.
    """
    own: dict[str, Any] = dict(symbols)
    for name, value in symbols.items():
        if not callable(value):
            continue
        of_math: Any = getattr(math, name, None)
        builtin: Any = getattr(builtins, name, None)
        if value is of_math:
            own[name] = _of_math(name, value)
        elif value is builtin:
            if name in ("min", "max"):
                own[name] = _extreme(name, value)
            elif name == "float":
                own[name] = _float(number)
            elif name == "int":
                own[name] = _int
            elif name in _BLIND:
                own[name] = _refusing(name, value)
    return own


def first_traced(values: Iterable[Any]) -> Traced | None:
    """The first traced number among values, or in lists of them."""
    for value in values:
        if isinstance(value, Traced):
            return value
        if isinstance(value, (list, tuple, set, frozenset)):
            found = first_traced(value)
        elif isinstance(value, dict):
            found = first_traced(value.values())
        else:
            found = None
        if found is not None:
            return found
    return None


def _of_math(name: str, function: Function) -> Function:
    def call(*arguments: Any) -> Any:
        found = first_traced(arguments)
        if found is None:
            return function(*arguments)
        if name not in OF_NUMBERS or not all(map(is_number, arguments)):
            found.trace.lose(f"{name}() of a number that depends on {found.trace_of()} is not followed")
        return found.trace.apply("math.pow" if name == "pow" else name, function, *arguments)

    return call


def _refusing(name: str, function: Function) -> Function:
    def call(*arguments: Any) -> Any:
        found = first_traced(arguments)
        if found is not None:
            found.trace.lose(f"{name}() of a number that depends on {found.trace_of()} is not followed")
        return function(*arguments)

    return call


def _extreme(name: str, function: Function) -> Function:
    """`min` or `max`: of numbers an operation, without a guard on which of them it is."""

    def call(*arguments: Any, **options: Any) -> Any:
        values = list(arguments[0]) if len(arguments) == 1 else list(arguments)
        found = first_traced(values)
        if found is None or options or not all(map(is_number, values)):
            return function(values, **options)
        result = values[0]
        for value in values[1:]:
            plain = first_traced((result, value)) is None
            result = function(result, value) if plain else found.trace.apply(name, function, result, value)
        return result

    return call


def _float(number: Callable[[str], Traced | None]) -> Function:
    def call(value: Any = 0.0) -> Any:
        found = number(value) if isinstance(value, str) else value
        return found.trace.apply("float", float, found) if isinstance(found, Traced) else float(value)

    return call


def _int(value: Any = 0, *base: Any) -> Any:
    return value.trace.apply("trunc", math.trunc, value) if isinstance(value, Traced) else int(value, *base)
