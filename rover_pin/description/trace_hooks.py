"""Xacro with expressions, literals, conditions and names that mind tokens."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Any

from rover_pin.description.expand import Arguments
from rover_pin.description.trace import TOKEN, Trace, Traced
from rover_pin.description.trace_expression import WHOLE, Expressions
from rover_pin.description.trace_functions import traced_symbols


class Kept(Arguments):
    """Xacro's arguments, tokens among them; `$(eval ...)` is not given those."""

    def __init__(self, given: dict[str, str], trace: Trace) -> None:
        super().__init__(given)
        self.trace = trace
        self.closed = False

    def __getitem__(self, name: str) -> str:
        """The argument's text."""
        value = super().__getitem__(name)
        if self.closed and TOKEN.search(value):
            self.trace.lose(f"$(eval ...) asks for {name}, which is not followed there")
        return value


@contextlib.contextmanager
def around_xacro(arguments: Kept) -> Iterator[None]:
    """Xacro with `_Hooks` in place of some of its functions; as it was, afterwards."""
    from xacrodoc import xacrodoc as engine

    xacro, substitution_args = engine.xacro, engine.substitution_args
    hooks = _Hooks(arguments, xacro, substitution_args)
    symbols = _Symbols(xacro, hooks.expressions)
    placed = (
        (xacro, "_global_symbols", symbols),
        (xacro, "safe_eval", hooks.expressions.evaluate),
        (xacro, "get_boolean_value", hooks.boolean),
        (xacro, "abs_filename_spec", hooks.file_name),
        (xacro, "is_valid_name", hooks.property_name),
        (xacro.Table, "_eval_literal", staticmethod(hooks.literal)),
        (substitution_args, "_eval", hooks.closed),
    )
    usual = [vars(owner)[name] for owner, name, _ in placed]
    for owner, name, hook in placed:
        setattr(owner, name, hook)
    try:
        yield
    finally:
        for (owner, name, _), value in zip(placed, usual, strict=True):
            setattr(owner, name, value)


class _Hooks:
    """What stands in for xacro's functions; each sees to tokens and then does as usual."""

    def __init__(self, arguments: Kept, xacro: Any, substitution_args: Any) -> None:
        self.arguments = arguments
        self.expressions = Expressions(arguments.trace)
        self._literal, self._boolean = xacro.Table._eval_literal, xacro.get_boolean_value
        self._file_name, self._valid_name = xacro.abs_filename_spec, xacro.is_valid_name
        self._eval = substitution_args._eval

    def literal(self, value: Any) -> Any:
        """A property's or macro parameter's value: a token alone is the number it stands for."""
        if not (isinstance(value, str) and TOKEN.search(value)):
            return self._literal(value)
        if len(value) >= 2 and value[0] == value[-1] == "'":
            return value[1:-1]
        number = self.expressions.number(value)
        return value if number is None else number

    def boolean(self, value: Any, condition: Any) -> Any:
        """A condition; of texts only whole numbers are one, so that designs share the number itself."""
        if isinstance(value, str) and TOKEN.search(value):
            number = self.expressions.number(value)
            if number is None:
                self.expressions.refuse(value, "a condition is a text in which {names} stands")
            elif number == number.value:
                value = str(number.value)
        return self._boolean(value, condition)

    def file_name(self, name: str) -> Any:
        """A file that is included or read."""
        self.expressions.refuse(name, "a file is named by {names}")
        return self._file_name(name)

    def property_name(self, name: str) -> Any:
        """Whether a property may bear a name."""
        self.expressions.refuse(name, "a property is named by {names}")
        return self._valid_name(name)

    def closed(self, text: str, context: Any) -> Any:
        """`$(eval ...)`, which reads arguments by rules of its own."""
        self.arguments.closed = True
        try:
            return self._eval(text, context)
        finally:
            self.arguments.closed = False


class _Symbols(dict[str, Any]):
    """Xacro's global symbols with functions that keep the trace; a token is the number it stands for."""

    def __init__(self, xacro: Any, expressions: Expressions) -> None:
        usual = xacro._global_symbols
        super().__init__(traced_symbols(usual, expressions.number))
        self.trace = expressions.trace
        self[WHOLE] = expressions.whole
        for name, value in usual.items():
            if isinstance(value, xacro.NameSpace):
                space = xacro.NameSpace()
                dict.update(space, traced_symbols(dict(value)))
                self[name] = space

    def __missing__(self, name: str) -> Traced:
        """The number of a token."""
        found = TOKEN.fullmatch(name)
        if found is None:
            raise KeyError(name)
        return self.trace.of(int(found.group(1)))
