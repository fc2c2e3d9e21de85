"""One traced run of xacro: the URDF text with tokens where numbers depend on varied parameters."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from rover_pin.description.expand import Arguments, run_xacro, written
from rover_pin.description.notes import Notes
from rover_pin.description.packages import Packages
from rover_pin.description.recipe import Recipe
from rover_pin.description.trace import TOKEN, Trace, Traced, UntraceableError
from rover_pin.description.trace_expression import WHOLE, Expressions
from rover_pin.description.trace_functions import traced_symbols
from rover_pin.errors import DescriptionError, InputError


@dataclass(frozen=True)
class TracedText:
    """A URDF with tokens, and what they stand for."""

    text: str
    trace: Trace


def trace_expansion(recipe: Recipe, names: Sequence[str]) -> TracedText:
    """The URDF of a recipe, anew from its files, with some parameters traced.

    Raises:
        UntraceableError: a number cannot be followed, or the files no longer give the recipe's text.
    """
    trace = Trace(tuple(names))
    arguments = {name: written(value) for name, value in recipe.parameters.items()}
    if not names:
        raise UntraceableError("no parameter varies", element="parameters")
    for name in names:
        if name not in arguments:
            raise UntraceableError("no parameter of that name", element=f"parameter {name}")
        value = float(arguments[name])
        arguments[name] = str(trace.parameter(name, int(value) if value.is_integer() else value))
    try:
        source = recipe.source.read_text(encoding="utf-8")
        packages = Packages(recipe.source, recipe.packages)
        with _traced(trace, kept := _Kept(arguments, trace)):
            text, _ = run_xacro(recipe.source, source, kept, packages, Notes(), recipe.skip_missing_includes)
    except (OSError, UnicodeDecodeError, InputError) as error:
        what = error.what if isinstance(error, DescriptionError) else str(error)
        raise UntraceableError(trace.lost or what, file=recipe.source) from error
    if trace.lost:
        raise UntraceableError(trace.lost, file=recipe.source)
    if TOKEN.sub(lambda found: str(trace.nominal[int(found.group(1))]), text) != recipe.text:
        raise UntraceableError(
            "followed from the parameters, xacro's text is another than the one loaded",
            file=recipe.source,
            cure="load anew if files have changed; else an expression depends on how a number is written",
        )
    return TracedText(text, trace)


class _Kept(Arguments):
    """Xacro's arguments, tokens among them; `$(eval ...)` is not given those."""

    def __init__(self, given: dict[str, str], trace: Trace) -> None:
        super().__init__(given)
        self.trace = trace
        self.closed = False

    def __getitem__(self, name: str) -> str:
        value = super().__getitem__(name)
        if self.closed and TOKEN.search(value):
            self.trace.lose(f"$(eval ...) asks for {name}, which is not followed there")
        return value


@contextlib.contextmanager
def _traced(trace: Trace, arguments: _Kept) -> Iterator[None]:
    """Xacro with expressions, literals, conditions and file names that mind tokens."""
    from xacrodoc import xacrodoc as engine

    xacro, substitution_args = engine.xacro, engine.substitution_args
    expressions = Expressions(trace)
    usual = {
        (owner, name): getattr(owner, name)
        for owner, name in (
            (xacro, "_global_symbols"),
            (xacro, "safe_eval"),
            (xacro, "get_boolean_value"),
            (xacro, "abs_filename_spec"),
            (xacro, "is_valid_name"),
            (substitution_args, "_eval"),
        )
    }
    literal = xacro.Table._eval_literal

    def eval_literal(value: Any) -> Any:
        if isinstance(value, str) and TOKEN.search(value):
            number = expressions.number(value)
            quoted = len(value) >= 2 and value[0] == value[-1] == "'"
            return value[1:-1] if quoted else value if number is None else number
        return literal(value)

    def boolean(value: Any, condition: Any) -> Any:
        if isinstance(value, str) and TOKEN.search(value):
            number = expressions.number(value)
            if number is None:
                expressions.refuse(value, "a condition is a text in which {names} stands")
            elif number == number.value:  # of texts, only whole numbers are conditions
                value = str(number.value)
        return usual[xacro, "get_boolean_value"](value, condition)

    def file_name(name: str) -> Any:
        expressions.refuse(name, "a file is named by {names}")
        return usual[xacro, "abs_filename_spec"](name)

    def valid_name(name: str) -> Any:
        expressions.refuse(name, "a property is named by {names}")
        return usual[xacro, "is_valid_name"](name)

    def closed_eval(text: str, context: Any) -> Any:
        arguments.closed = True
        try:
            return usual[substitution_args, "_eval"](text, context)
        finally:
            arguments.closed = False

    symbols = _Symbols(xacro, usual[xacro, "_global_symbols"], trace)
    symbols[WHOLE] = expressions.whole
    xacro._global_symbols, xacro.safe_eval = symbols, expressions.evaluate
    xacro.get_boolean_value, xacro.abs_filename_spec, xacro.is_valid_name = boolean, file_name, valid_name
    substitution_args._eval = closed_eval
    xacro.Table._eval_literal = staticmethod(eval_literal)
    try:
        yield
    finally:
        for (owner, name), value in usual.items():
            setattr(owner, name, value)
        xacro.Table._eval_literal = staticmethod(literal)


class _Symbols(dict[str, Any]):
    """Xacro's global symbols with functions that keep the trace; a token is the number it stands for."""

    def __init__(self, xacro: Any, usual: dict[str, Any], trace: Trace) -> None:
        super().__init__(traced_symbols(usual))
        self.trace = trace
        for name, value in usual.items():
            if isinstance(value, xacro.NameSpace):
                space = xacro.NameSpace()
                dict.update(space, traced_symbols(dict(value)))
                self[name] = space

    def __missing__(self, name: str) -> Traced:
        found = TOKEN.fullmatch(name)
        if found is None:
            raise KeyError(name)
        return self.trace.of(int(found.group(1)))
