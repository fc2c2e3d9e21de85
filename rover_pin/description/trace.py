"""Numbers that remember how they were made, so that one run of xacro serves every design.

The idea is that of operator overloading in automatic differentiation (Griewank and Walther, Evaluating
Derivatives, 2008, ch. 6): varied parameters enter as `Traced` numbers, each operation on them adds a node to
a `Trace`, and the trace is later evaluated for many values at once (`trace_values`). A comparison goes the
nominal way and is kept as a guard: only designs that would go the same way share the trace. What would turn a
traced number into a constant unseen raises `UntraceableError`.
"""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, NoReturn, TypeGuard

from rover_pin.errors import InputError

Number = int | float

TOKEN = re.compile(r"traced_(\d+)_number")
"""How a traced number stands in texts: the number of its node, in a name that an expression can hold."""


class UntraceableError(InputError):
    """A description whose numbers cannot be followed from the parameters: each design is to be read anew."""


@dataclass(frozen=True)
class Node:
    """One operation: its function's name, and its arguments, nodes as `Ref` and constants as they are."""

    operation: str
    arguments: tuple[Any, ...]


@dataclass(frozen=True)
class Ref:
    """The result of an earlier node."""

    index: int


@dataclass
class Trace:
    """All operations on traced numbers, in the order they were made.

    Attributes:
        names: the varied parameters; their nodes come first, in this order.
        nodes: operations; equal ones once.
        nominal: result of every node for the nominal parameters.
        guards: comparisons' nodes -> their nominal outcome.
        lost: why the trace does not hold, or empty.
        place: the expression being evaluated, for that sentence.
    """

    names: tuple[str, ...]
    nodes: list[Node] = field(default_factory=list)
    nominal: list[Any] = field(default_factory=list)
    guards: dict[int, bool] = field(default_factory=dict)
    lost: str = ""
    place: str = ""
    _known: dict[str, int] = field(default_factory=dict)

    def parameter(self, name: str, value: Number) -> Traced:
        """A varied parameter."""
        return self._node(Node("parameter", (name,)), value)

    def apply(self, operation: str, function: Callable[..., Any], *arguments: Any) -> Traced:
        """The result of a function of numbers, traced or not.

        Raises:
            UntraceableError: its nominal result is no real number.
        """
        value = function(*(a.value if isinstance(a, Traced) else a for a in arguments))
        if not isinstance(value, (int, float)):
            self.lose(f"{operation} gives {value}, which is no real number")
        node = Node(operation, tuple(Ref(a.index) if isinstance(a, Traced) else a for a in arguments))
        return self._node(node, value)

    def guard(self, operation: str, function: Callable[..., Any], *arguments: Any) -> bool:
        """The nominal outcome of a comparison, which from now on every design has to share."""
        result = self.apply(operation, function, *arguments)
        self.guards[result.index] = bool(result.value)
        return bool(result.value)

    def of(self, index: int) -> Traced:
        """The number of a node."""
        return Traced(self, index, self.nominal[index])

    def lose(self, reason: str) -> NoReturn:
        """Say why the trace does not hold; the first reason is kept.

        Raises:
            UntraceableError: always.
        """
        self.lost = self.lost or reason + (f" in ${{{self.place}}}" if self.place else "")
        raise UntraceableError(self.lost)

    def _node(self, node: Node, value: Any) -> Traced:
        key = repr(node)
        if key not in self._known:
            self._known[key] = len(self.nodes)
            self.nodes.append(node)
            self.nominal.append(value)
        return self.of(self._known[key])


def is_number(value: object) -> TypeGuard[Number | Traced]:
    """Whether a value is a number that a trace can hold."""
    return isinstance(value, (int, float, Traced))


def _binary(name: str, function: Callable[..., Any]) -> tuple[Callable[..., Any], Callable[..., Any]]:
    def forward(self: Traced, other: Any) -> Any:
        return self.trace.apply(name, function, self, other) if is_number(other) else NotImplemented

    def backward(self: Traced, other: Any) -> Any:
        return self.trace.apply(name, function, other, self) if is_number(other) else NotImplemented

    return forward, backward


def _unary(name: str, function: Callable[..., Any]) -> Callable[..., Any]:
    return lambda self, *digits: self.trace.apply(name, function, self, *digits)


def _comparison(name: str, function: Callable[..., Any]) -> Callable[..., Any]:
    def compare(self: Traced, other: Any) -> Any:
        return self.trace.guard(name, function, self, other) if is_number(other) else NotImplemented

    return compare


def _losing(what: str) -> Callable[..., NoReturn]:
    def lose(self: Traced, *_: Any) -> NoReturn:
        self.trace.lose(f"a number that depends on {self.trace_of()} is {what}")

    return lose


class Traced:
    """A number on a trace: behaves as its nominal value in arithmetic, and stands in texts as a token."""

    __slots__ = ("index", "trace", "value")

    def __init__(self, trace: Trace, index: int, value: Any) -> None:
        self.trace, self.index, self.value = trace, index, value

    def trace_of(self) -> str:
        """The parameters it depends on, for messages."""
        seen, stack = set(), [self.index]
        while stack:
            node = self.trace.nodes[index := stack.pop()]
            if index not in seen:
                seen.add(index)
                stack.extend(a.index for a in node.arguments if isinstance(a, Ref))
        return ", ".join(name for i, name in enumerate(self.trace.names) if i in seen)

    def __str__(self) -> str:
        return f"traced_{self.index}_number"

    __repr__ = __str__

    def __format__(self, spec: str) -> str:
        if spec:
            self.trace.lose(f"a number that depends on {self.trace_of()} is written in the format {spec!r}")
        return str(self)

    def __bool__(self) -> bool:
        return self.trace.guard("ne", operator.ne, self, 0)

    __add__, __radd__ = _binary("add", operator.add)
    __sub__, __rsub__ = _binary("sub", operator.sub)
    __mul__, __rmul__ = _binary("mul", operator.mul)
    __truediv__, __rtruediv__ = _binary("truediv", operator.truediv)
    __floordiv__, __rfloordiv__ = _binary("floordiv", operator.floordiv)
    __mod__, __rmod__ = _binary("mod", operator.mod)
    __pow__, __rpow__ = _binary("pow", operator.pow)
    __neg__, __pos__ = _unary("neg", operator.neg), _unary("pos", operator.pos)
    __abs__, __round__ = _unary("abs", abs), _unary("round", round)
    __floor__, __ceil__ = _unary("floor", math.floor), _unary("ceil", math.ceil)
    __lt__, __le__ = _comparison("lt", operator.lt), _comparison("le", operator.le)
    __gt__, __ge__ = _comparison("gt", operator.gt), _comparison("ge", operator.ge)
    __eq__, __ne__ = _comparison("eq", operator.eq), _comparison("ne", operator.ne)
    __hash__ = _losing("used as a key")
    __index__ = _losing("used as an index or a count")
    __int__ = __trunc__ = _losing("turned into a plain integer")
    __float__ = __complex__ = _losing("turned into a plain number")
