"""One traced run of xacro: the URDF text with tokens where numbers depend on varied parameters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from rover_pin.description.expand import is_xacro, run_xacro, written
from rover_pin.description.notes import Notes
from rover_pin.description.packages import Packages
from rover_pin.description.recipe import Recipe
from rover_pin.description.trace import TOKEN, Trace, UntraceableError
from rover_pin.description.trace_hooks import Kept, around_xacro
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
    if not is_xacro(recipe.source, recipe.text):  # all that varies stands in the sidecar
        return TracedText(recipe.text, trace)
    try:
        source = recipe.source.read_text(encoding="utf-8")
        packages = Packages(recipe.source, recipe.packages)
        with around_xacro(kept := Kept(arguments, trace)):
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
