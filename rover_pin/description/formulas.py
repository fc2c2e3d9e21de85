"""Numbers of a sidecar written as formulas of its parameters: `"${track_length + 0.01}"`."""

from __future__ import annotations

import ast
import operator
import re
from collections.abc import Callable, Iterator, Mapping
from typing import Any, cast

import numpy as np

from rover_pin.errors import SidecarError, nearest
from rover_pin.numerics import Array

Path = tuple[str | int, ...]
Number = float | Array

WHOLE = re.compile(r"\s*\$\{(.+)\}\s*", re.DOTALL)
"""A text that is one formula."""

PLAIN = ("parameters", "schema")
"""Keys of the sidecar that hold no formulas."""

_CONSTANTS = {"pi": np.pi, "e": np.e, "tau": 2.0 * np.pi}
_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "sin": np.sin, "cos": np.cos, "tan": np.tan, "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan,
    "atan2": np.arctan2, "sqrt": np.sqrt, "exp": np.exp, "log": np.log, "hypot": np.hypot, "abs": np.abs,
    "radians": np.radians, "degrees": np.degrees, "min": np.minimum, "max": np.maximum,
}  # fmt: skip
_BINARY: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: np.divide,
    ast.Pow: np.power,
}  # fmt: skip


class FormulaError(ValueError):
    """What is wrong with a formula, and the cure."""

    def __init__(self, what: str, cure: str) -> None:
        super().__init__(what)
        self.cure = cure


class Formula:
    """An expression of numbers, parameters, + - * / **, brackets and functions such as `sqrt`.

    Args:
        text: without the `${ }`.

    Attributes:
        text: as given.
        names: the parameters it is made of.

    Raises:
        FormulaError: it is none.
    """

    def __init__(self, text: str) -> None:
        self.text = text.strip()
        try:
            self._tree = ast.parse(self.text, mode="eval").body
        except SyntaxError as error:
            raise FormulaError("not a formula", "write numbers, parameters, + - * / ** and ( )") from error
        self.names = frozenset(_names(self._tree)) - set(_CONSTANTS)

    def value(self, values: Mapping[str, Number]) -> Number:
        """Its value; an array where a parameter is one.

        Args:
            values: of the parameters, numbers or arrays (n,).

        Raises:
            FormulaError: an unknown name.
        """
        with np.errstate(all="ignore"):
            found: Number = _value(self._tree, {**_CONSTANTS, **values})
        return found


def _names(tree: ast.expr) -> Iterator[str]:
    """Names that stand for numbers.

    Raises:
        FormulaError: something that is no part of a formula.
    """
    if isinstance(tree, ast.Name):
        yield tree.id
    elif isinstance(tree, ast.BinOp) and type(tree.op) in _BINARY:
        yield from _names(tree.left)
        yield from _names(tree.right)
    elif isinstance(tree, ast.UnaryOp) and isinstance(tree.op, ast.USub | ast.UAdd):
        yield from _names(tree.operand)
    elif isinstance(tree, ast.Call) and isinstance(tree.func, ast.Name) and not tree.keywords:
        if tree.func.id not in _FUNCTIONS:
            raise FormulaError(f"no function {tree.func.id}", f"use {', '.join(sorted(_FUNCTIONS))}")
        for argument in tree.args:
            yield from _names(argument)
    elif not (isinstance(tree, ast.Constant) and type(tree.value) in (int, float)):
        raise FormulaError(
            f"`{ast.unparse(tree)}` is no part of a formula", "write numbers, parameters, + - * / ** and ( )"
        )


def _value(tree: ast.expr, values: Mapping[str, Number]) -> Any:
    if isinstance(tree, ast.Constant):
        return float(tree.value)  # type: ignore[arg-type]
    if isinstance(tree, ast.Name):
        if tree.id not in values:
            known = [name for name in values if name not in _CONSTANTS]
            cure = nearest(tree.id, known) if known else "declare it under `parameters`"
            raise FormulaError(f"no parameter {tree.id}", cure or "declare it under `parameters`")
        return values[tree.id]
    if isinstance(tree, ast.UnaryOp):
        inner = _value(tree.operand, values)
        return -inner if isinstance(tree.op, ast.USub) else inner
    if isinstance(tree, ast.BinOp):
        return _BINARY[type(tree.op)](_value(tree.left, values), _value(tree.right, values))
    call = cast("ast.Call", tree)  # `_names` has let nothing else pass
    name = cast("ast.Name", call.func).id
    try:
        return _FUNCTIONS[name](*(_value(argument, values) for argument in call.args))
    except TypeError as error:
        raise FormulaError(f"{name} takes other arguments", "check how many it is given") from error


def formulas_in(data: Any, path: Path = ()) -> Iterator[tuple[Path, str]]:
    """Where formulas stand in a sidecar's data, and their texts."""
    if isinstance(data, str):
        found = WHOLE.fullmatch(data)
        if found:
            yield path, found.group(1)
        return
    entries = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in entries:
        if path or key not in PLAIN:
            yield from formulas_in(value, (*path, key))


def fill_in(
    data: dict[str, Any], values: Mapping[str, float], told: Callable[[Path], tuple[object, str]]
) -> None:
    """Put the values of all formulas into a sidecar's data.

    Args:
        data: changed in place.
        values: of the parameters.
        told: the file with its line, and the key's name, of a path.

    Raises:
        SidecarError: a formula that is none, or whose value is not finite.
    """
    for path, text in list(formulas_in(data)):
        file, element = told(path)
        try:
            value = float(Formula(text).value(values))
        except FormulaError as error:
            raise SidecarError(str(error), file=file, element=element, value=text, cure=error.cure) from error
        if not np.isfinite(value):
            raise SidecarError("the formula's value is not finite", file=file, element=element, value=text,
                               cure="check it at these parameters")  # fmt: skip
        owner: Any = data
        for step in path[:-1]:
            owner = owner[step]
        owner[path[-1]] = value
