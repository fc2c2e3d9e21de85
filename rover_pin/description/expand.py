"""Xacro without ROS: a description file in, URDF text out."""

from __future__ import annotations

import ast
import contextlib
import io
import re
from collections.abc import Callable, Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

from rover_pin.description.notes import Notes
from rover_pin.description.packages import Packages
from rover_pin.errors import DescriptionError, SidecarError, nearest

_TAG = re.compile(r"<xacro:\w")
_MACRO = re.compile(r"<xacro:macro\b[^>]*\bname\s*=\s*[\"']([^\"']+)")


class Arguments(dict[str, str]):
    """Xacro's arguments; remembers which names the files asked for."""

    def __init__(self, given: Mapping[str, str]) -> None:
        super().__init__(given)
        self.asked: set[str] = set()

    def __contains__(self, name: object) -> bool:
        self.asked.add(str(name))
        return super().__contains__(name)

    def __getitem__(self, name: str) -> str:
        self.asked.add(name)
        return super().__getitem__(name)


def expand(
    path: Path,
    values: Mapping[str, float],
    packages: Packages,
    notes: Notes,
    skip_missing_includes: bool = False,
    declared_in: object = None,
    used: Collection[str] = (),
) -> str:
    """The URDF text of a file.

    Plain URDF is returned as it stands; xacro runs for `.xacro` files and where xacro tags are found. Xacro
    evaluates expressions: load only files you trust.

    Args:
        path: the file.
        values: xacro argument -> number.
        packages: where `$(find package)` looks.
        notes: told of skipped includes and of xacro's warnings.
        skip_missing_includes: leave out includes whose file or package is not there.
        declared_in: the file that declares the arguments, named in errors.
        used: names that its own formulas use, and that need be no xacro argument.

    Raises:
        DescriptionError: the file cannot be read, or xacro refuses it, or nothing comes out.
        SidecarError: a value for a name that is no xacro argument of these files and of no formula.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise DescriptionError(
            f"cannot be read: {error}", file=path, cure="give a URDF or xacro text file"
        ) from error
    if not is_xacro(path, text):
        _refuse_undeclared(path, values, None, declared_in, used)
        return text
    arguments = Arguments({name: written(value) for name, value in values.items()})
    expanded, asked = run_xacro(path, text, arguments, packages, notes, skip_missing_includes)
    _refuse_undeclared(path, values, asked, declared_in, used)
    if "<link" not in expanded:
        macros = _MACRO.findall(text)
        cure = (
            f"it only defines the macro {', '.join(macros[:4])}: name the file that calls it"
            if macros
            else "check the arguments and the <xacro:if> conditions"
        )
        raise DescriptionError("the xacro expands to no link", file=path, cure=cure)
    return expanded


def is_xacro(path: Path, text: str) -> bool:
    """Whether xacro has to run on a file."""
    return path.suffix == ".xacro" or bool(_TAG.search(text))


def run_xacro(
    path: Path, text: str, arguments: Arguments, packages: Packages, notes: Notes, skip: bool
) -> tuple[str, set[str]]:
    """The expanded text, and the arguments that the files asked for.

    Raises:
        DescriptionError: xacro refuses it.
    """
    from xacrodoc import xacrodoc as engine

    said = io.StringIO()
    try:
        with _around_xacro(packages, notes, skip), contextlib.redirect_stderr(said):
            engine.xacro.init_stacks(str(path))
            document = engine.xacro.parse(text)
            engine.xacro.process_doc(document, mappings=arguments)
            expanded = str(document.toxml())
    except DescriptionError:
        raise
    except Exception as error:  # xacro raises whatever an expression of the file raises
        raise DescriptionError(f"xacro: {error}", file=path, cure=_cure(str(error), packages)) from error
    for line in said.getvalue().splitlines():
        if line.strip():
            notes.add(f"xacro: {line.strip()}")
    return expanded, arguments.asked


def written(value: float) -> str:
    """A whole number without a point, so that an expression may count with it."""
    return str(int(value)) if value.is_integer() and abs(value) < 1e15 else repr(value)


def _cure(message: str, packages: Packages) -> str:
    missing = re.search(r"package://([^/\s]+)", message)
    if missing:
        name = missing.group(1)
        return (
            f"tried {', '.join(packages.tried(name))}; "
            f"give its folder: packages={{'{name}': ...}} or --package {name}=..., or skip missing includes"
        )
    if "No such file" in message:
        return "put the file there, or skip missing includes"
    if "unknown macro" in message:
        return "include the file that defines the macro"
    if "Undefined substitution argument" in message:
        return "declare it with <xacro:arg> and a default, or as a parameter in the sidecar"
    return "mend the expression in the xacro file"


def _towers(expression: str) -> bool:
    """Whether an exponent holds a power, as 9**9**9, whose digits fill the memory."""
    try:
        tree = ast.parse(expression.strip(), mode="eval")
    except (SyntaxError, ValueError, RecursionError):
        return False  # xacro says what is wrong with it
    return any(_is_power(inner) for power in filter(_is_power, ast.walk(tree)) for inner in _exponent(power))


def _is_power(node: ast.AST) -> bool:
    return isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow)


def _exponent(power: Any) -> Iterator[ast.AST]:
    return ast.walk(power.right)


@contextlib.contextmanager
def _around_xacro(packages: Packages, notes: Notes, skip: bool) -> Iterator[None]:
    """Xacro with our package finder and, if wanted, missing includes left out.

    An unknown package becomes the path `package://name`, so that it fails only where a file of it is needed
    (an include), not where it is merely named (a mesh).
    """
    from xacrodoc import xacrodoc as engine

    xacro, substitution_args = engine.xacro, engine.substitution_args

    def find(name: str) -> str:
        folder = packages.find(name)
        return f"package://{name}" if folder is None else str(folder)

    def include(element: Any, macros: Any, symbols: Any, process: Callable[..., Any]) -> None:
        try:
            usual_include(element, macros, symbols, process)
        except xacro.XacroException as error:
            if not (skip and isinstance(error.exc, OSError)):
                raise
            notes.add(f"include {element.getAttribute('filename')} is missing: skipped")
            xacro.replace_node(element, by=None)

    def evaluate(expression: str, *symbols: Any) -> Any:
        if _towers(expression):
            raise ValueError("a power in an exponent may not end: put it into a property of its own")
        return usual_eval(expression, *symbols)

    usual_find, usual_include = substitution_args._eval_find, xacro.process_include
    usual_eval = xacro.safe_eval
    substitution_args._eval_find, xacro.process_include, xacro.safe_eval = find, include, evaluate
    try:
        yield
    finally:
        substitution_args._eval_find, xacro.process_include = usual_find, usual_include
        xacro.safe_eval = usual_eval


def refuse_undeclared(
    path: Path, values: Mapping[str, float], declared_in: object, used: Collection[str]
) -> None:
    """Nothing where a formula uses every parameter of a file without arguments.

    Raises:
        SidecarError: one is used by none.
    """
    _refuse_undeclared(path, values, None, declared_in, used)


def _refuse_undeclared(
    path: Path,
    values: Mapping[str, float],
    asked: set[str] | None,
    declared_in: object,
    used: Collection[str],
) -> None:
    """`asked`: the arguments that xacro asked for, None for plain URDF."""
    for name in values:
        if name in used or (asked is not None and name in asked):
            continue
        plain = f"{path.name} is plain URDF without arguments"
        unknown = plain if asked is None else f"no <xacro:arg> of that name in {path.name}"
        raise SidecarError(
            f"{unknown}, and no formula of the sidecar uses it",
            file=declared_in,
            element=f"parameters.{name}",
            cure=nearest(name, asked) if asked else "remove it",
        )
