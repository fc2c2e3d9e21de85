"""Numbers of a sidecar written as formulas of its parameters: `"${track_length + 0.01}"`.

The syntax is that of xacro's expressions, of which only numbers are let in: a formula is walked, not run. On
traced parameters (`rover_pin.description.trace`) it leaves a trace, from which many designs are made at once.
"""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable, Iterator, Mapping
from typing import Any, cast

from rover_pin.description.trace import Traced, UntraceableError
from rover_pin.description.trace_functions import OF_NUMBERS, traced_symbols
from rover_pin.errors import SidecarError, nearest

Path = tuple[str | int, ...]
Number = float | Traced

WHOLE = re.compile(r"\s*\$\{([^{}]+)\}\s*")
"""A text that is one formula."""

PLAIN = ("parameters", "schema", "embedded")
"""Keys of the sidecar that hold no formulas."""

SYNTAX = "write numbers, parameters, functions, + - * / // % ** and ( )"

_CONSTANTS = {"pi": math.pi, "e": math.e, "tau": math.tau}


def _round(value: Any, digits: Any = None) -> Any:
    """Python's, whose digits are a whole number."""
    return round(value) if digits is None else round(value, int(digits))


_FUNCTIONS: dict[str, Callable[..., Any]] = traced_symbols(
    {name: getattr(math, name) for name in sorted(OF_NUMBERS) if hasattr(math, name)}
    | {"abs": abs, "min": min, "max": max, "round": _round, "int": int, "float": float}
)
_BINARY: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv, ast.Mod: operator.mod, ast.Pow: operator.pow,
}  # fmt: skip
_UNARY: dict[type[ast.unaryop], Callable[[Any], Any]] = {
    ast.USub: operator.neg, ast.UAdd: operator.pos, ast.Not: operator.not_,
}  # fmt: skip
_COMPARED: dict[type[ast.cmpop], Callable[[Any, Any], Any]] = {
    ast.Lt: operator.lt, ast.LtE: operator.le, ast.Gt: operator.gt, ast.GtE: operator.ge,
    ast.Eq: operator.eq, ast.NotEq: operator.ne,
}  # fmt: skip


class FormulaError(ValueError):
    """What is wrong with a formula, and the cure."""

    def __init__(self, what: str, cure: str) -> None:
        super().__init__(what)
        self.cure = cure


class Formula:
    """An expression of numbers, parameters and functions of `math`, compared and chosen between as in Python.

    Args:
        text: without the `${ }`.

    Attributes:
        text: as given.
        names: what it calls by name: parameters, pi, e, tau.

    Raises:
        FormulaError: it is none.
    """

    def __init__(self, text: str) -> None:
        self.text = text.strip()
        try:
            self._tree = ast.parse(self.text, mode="eval").body
            self.names = frozenset(_names(self._tree))
        except FormulaError:
            raise
        except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
            raise FormulaError("not a formula", SYNTAX) from error

    def value(self, values: Mapping[str, Number]) -> Number:
        """Its value.

        Args:
            values: of the parameters; a parameter called `e` hides the constant.

        Raises:
            FormulaError: an unknown name, or no finite value at these parameters.
            UntraceableError: an operation that a trace does not follow.
        """
        try:
            found = _value(self._tree, values)
            if isinstance(found, Traced):
                return found
            if not isinstance(found, complex) and math.isfinite(found):
                return float(found)
        except (FormulaError, UntraceableError):
            raise
        except (ArithmeticError, ValueError, TypeError):  # TypeError: a complex number is compared
            pass
        shown = ", ".join(f"{name} = {values[name]}" for name in sorted(self.names) if name in values)
        raise FormulaError("the formula has no finite value", f"check it{shown and ' at '}{shown}")


def _names(tree: ast.expr) -> Iterator[str]:
    """Names that stand for numbers.

    Raises:
        FormulaError: something that is no part of a formula.
    """
    if isinstance(tree, ast.Name):
        yield tree.id
        return
    if isinstance(tree, ast.Call) and not tree.keywords and tree.args:
        _function(tree)
        parts = tree.args
    elif isinstance(tree, ast.Constant) and type(tree.value) in (int, float):
        parts = []
    elif isinstance(tree, ast.BinOp) and type(tree.op) in _BINARY:
        parts = [tree.left, tree.right]
    elif isinstance(tree, ast.UnaryOp) and type(tree.op) in _UNARY:
        parts = [tree.operand]
    elif isinstance(tree, ast.Compare) and all(type(op) in _COMPARED for op in tree.ops):
        parts = [tree.left, *tree.comparators]
    elif isinstance(tree, ast.BoolOp):
        parts = tree.values
    elif isinstance(tree, ast.IfExp):
        parts = [tree.test, tree.body, tree.orelse]
    else:
        raise FormulaError(f"`{ast.unparse(tree)}` is no part of a formula", SYNTAX)
    for part in parts:
        yield from _names(part)


def _function(call: ast.Call) -> Callable[..., Any]:
    """The function that is called, `sin` or `math.sin`.

    Raises:
        FormulaError: there is none of that name.
    """
    called = ast.unparse(call.func)
    found = _FUNCTIONS.get(called.removeprefix("math."))
    if found is None:
        raise FormulaError(f"no function {called}", nearest(called, _FUNCTIONS))
    return found


def _value(tree: ast.expr, values: Mapping[str, Number]) -> Any:
    """A number; whole ones as floats, whose powers end."""
    if isinstance(tree, ast.Constant):
        return float(cast("float", tree.value))  # `_names` has let nothing else pass
    if isinstance(tree, ast.Name):
        return _named(tree.id, values)
    if isinstance(tree, ast.UnaryOp):
        return _UNARY[type(tree.op)](_value(tree.operand, values))
    if isinstance(tree, ast.BinOp):
        return _BINARY[type(tree.op)](_value(tree.left, values), _value(tree.right, values))
    if isinstance(tree, ast.IfExp):
        return _value(tree.body if _value(tree.test, values) else tree.orelse, values)
    if isinstance(tree, ast.Compare):
        numbers = [_value(part, values) for part in (tree.left, *tree.comparators)]
        pairs = zip(tree.ops, numbers, numbers[1:], strict=False)
        return all(_COMPARED[type(op)](one, other) for op, one, other in pairs)
    if isinstance(tree, ast.BoolOp):
        stops = isinstance(tree.op, ast.Or)
        return next((stops for part in tree.values if bool(_value(part, values)) == stops), not stops)
    call = cast("ast.Call", tree)
    arguments = [_value(part, values) for part in call.args]
    try:
        result = _function(call)(*arguments)
    except TypeError as error:
        raise FormulaError(
            f"{ast.unparse(call.func)} takes other arguments", "check how many it is given"
        ) from error
    return float(result) if isinstance(result, int) else result


def _named(name: str, values: Mapping[str, Number]) -> Number:
    """The value of a parameter, else of a constant.

    Raises:
        FormulaError: neither is called so.
    """
    if name in values:
        return values[name]
    if name in _CONSTANTS:
        return _CONSTANTS[name]
    cure = nearest(name, values) if values else "declare it under `parameters`"
    raise FormulaError(f"no parameter {name}", cure)


def formulas_in(data: Any, path: Path = ()) -> Iterator[tuple[Path, str]]:
    """Where texts with `${` stand in a sidecar's data."""
    if isinstance(data, str):
        if "${" in data:
            yield path, data
        return
    entries = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in entries:
        if path or key not in PLAIN:
            yield from formulas_in(value, (*path, key))


def formula_of(text: str) -> Formula:
    """The formula that a text is.

    Raises:
        FormulaError: it is none, or more than one.
    """
    found = WHOLE.fullmatch(text)
    if found is None:
        raise FormulaError("a formula is only part of the text", 'put all of it into one "${ }"')
    return Formula(found.group(1))


def fill_in(
    data: dict[str, Any], values: Mapping[str, float], told: Callable[[Path], tuple[object, str]]
) -> None:
    """Put the values of all formulas into a sidecar's data.

    Args:
        data: changed in place.
        values: of the parameters.
        told: the file with its line, and the key's name, of a path.

    Raises:
        SidecarError: a formula that is none, of an unknown parameter, or whose value is not finite.
    """
    for path, text in list(formulas_in(data)):
        try:
            value = formula_of(text).value(values)
        except FormulaError as error:
            file, element = told(path)
            raise SidecarError(str(error), file=file, element=element, value=text, cure=error.cure) from error
        owner: Any = data
        for step in path[:-1]:
            owner = owner[step]
        owner[path[-1]] = value
