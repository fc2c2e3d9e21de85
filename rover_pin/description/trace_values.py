"""A trace evaluated for many designs at once.

Sums, products, quotients and roots are exact to rounding by IEEE 754 and so numpy's are Python's; all other
functions are called number by number as xacro called them, since numpy's own may differ in the last bit from
them, and from themselves with the numbers beside. So each design gets the bits that xacro would give it,
whatever the others are.
"""

from __future__ import annotations

import itertools
import math
import operator
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rover_pin.description.trace import Node, Ref, Trace
from rover_pin.numerics import Array

Flags = NDArray[np.bool_]

_EXACT: dict[str, Callable[..., Any]] = {
    "add": np.add,
    "sub": np.subtract,
    "mul": np.multiply,
    "truediv": np.true_divide,
    "neg": np.negative,
    "pos": np.positive,
    "abs": np.abs,
    "fabs": np.abs,
    "sqrt": np.sqrt,
    "lt": np.less,
    "le": np.less_equal,
    "gt": np.greater,
    "ge": np.greater_equal,
    "eq": np.equal,
    "ne": np.not_equal,
    "min": lambda a, b: np.where(np.less(b, a), b, a),
    "max": lambda a, b: np.where(np.greater(b, a), b, a),
    "float": np.positive,
}

_PYTHON: dict[str, Callable[..., Any]] = {
    "floordiv": operator.floordiv,
    "mod": operator.mod,
    "pow": operator.pow,
    "round": round,
    "floor": math.floor,
    "ceil": math.ceil,
    "trunc": math.trunc,
    "math.pow": math.pow,
}

_BOUNDED = frozenset({"atan", "atan2"})
"""Functions that never fail and never give more than a few radians."""

_NEVER_FAIL = _BOUNDED | {"parameter", "fabs"} | (frozenset(_EXACT) - {"truediv", "sqrt"})


@dataclass(frozen=True)
class Values:
    """What a trace gives for n designs.

    Attributes:
        count: n.
        numbers: node -> (n,), of those that are wanted or may fail.
        valid: (n,) False where xacro would go another way than the trace, or fail.
    """

    count: int
    numbers: Mapping[int, Array]
    valid: Flags


def evaluate(
    trace: Trace, parameters: Mapping[str, Array], wanted: Iterable[int], finite: Iterable[int] = ()
) -> Values:
    """Nodes of a trace, for n designs.

    Args:
        trace: from a run of xacro.
        parameters: (n,) values of its parameters.
        wanted: nodes that are asked for.
        finite: nodes that have to be finite.
    """
    count = len(next(iter(parameters.values())))
    numbers: dict[int, Array] = {}
    valid = np.ones(count, dtype=bool)
    finite = _behind_bounded(trace, finite)
    needed = _needed(trace, {*wanted, *finite, *trace.guards})
    with np.errstate(all="ignore"):
        for i in sorted(needed):
            node = trace.nodes[i]
            if node.operation == "parameter":
                numbers[i] = np.asarray(parameters[node.arguments[0]]) + 0.0  # xacro reads -0.0 as 0
                continue
            numbers[i], well = _result(node, numbers, count)
            valid &= well
    for index in finite:
        valid &= np.isfinite(numbers[index])
    for index, outcome in trace.guards.items():
        valid &= (numbers[index] != 0.0) == outcome
    return Values(count, numbers, valid)


def _needed(trace: Trace, wanted: set[int]) -> set[int]:
    """Nodes that are wanted or may fail, and all that they come from."""
    stack = [*wanted, *(i for i, node in enumerate(trace.nodes) if node.operation not in _NEVER_FAIL)]
    needed: set[int] = set()
    while stack:
        index = stack.pop()
        if index not in needed:
            needed.add(index)
            stack.extend(a.index for a in trace.nodes[index].arguments if isinstance(a, Ref))
    return needed


def _behind_bounded(trace: Trace, finite: Iterable[int]) -> set[int]:
    """The same nodes, with the arguments of a bounded function in its place: they are cheaper to have."""
    stack, found, seen = list(finite), set(), set()
    while stack:
        index = stack.pop()
        node = trace.nodes[index]
        if node.operation not in _BOUNDED:
            found.add(index)
        elif index not in seen:
            seen.add(index)
            stack.extend(a.index for a in node.arguments if isinstance(a, Ref))
    return found


def _result(node: Node, numbers: Mapping[int, Array], count: int) -> tuple[Array, Flags]:
    """(n,) results, and whether Python would have given a real one."""
    arguments = [numbers[a.index] if isinstance(a, Ref) else a for a in node.arguments]
    exact = _EXACT.get(node.operation)
    if exact is None:
        function = _PYTHON.get(node.operation) or getattr(math, node.operation)
        return each(function, *arguments, count=count)
    well = np.ones(count, dtype=bool)
    if node.operation == "truediv":
        well = np.not_equal(arguments[1], 0.0) & well
    elif node.operation == "sqrt":
        well = np.greater_equal(arguments[0], 0.0)
    return np.asarray(exact(*arguments), dtype=np.float64), well


def each(function: Callable[..., Any], *arguments: Any, count: int) -> tuple[Array, Flags]:
    """A function called number by number, and where it gave a real number; NaN elsewhere.

    Args:
        function: of Python's numbers.
        arguments: (n,) arrays, or numbers for all.
        count: n.
    """
    columns = [a.tolist() if isinstance(a, np.ndarray) else itertools.repeat(a, count) for a in arguments]
    try:
        return np.fromiter(map(function, *columns), dtype=np.float64, count=count), np.ones(count, dtype=bool)
    except (ArithmeticError, ValueError, TypeError):
        pass
    columns = [a.tolist() if isinstance(a, np.ndarray) else itertools.repeat(a, count) for a in arguments]
    results = np.full(count, np.nan)
    well = np.zeros(count, dtype=bool)
    for i, row in enumerate(zip(*columns, strict=True)):
        try:
            results[i] = float(function(*row))
        except (ArithmeticError, ValueError, TypeError):
            continue
        well[i] = True
    return results, well
