"""Errors for people: what is wrong, in which file and element, with which value, and the cure."""

from __future__ import annotations

import contextlib
import difflib
import re
from collections.abc import Iterable, Iterator

_LONGEST = 400  # letters of a value or an element that a message shows
_WORD = re.compile(rf"\w{{{_LONGEST},}}")  # no file's path is one such word


class RoverPinError(Exception):
    """Base of every error that rover_pin raises on purpose.

    Attributes:
        what: what is wrong, in a clause.
        file: the file it stands in, or None.
        element: the joint, link, wheel, key or flag concerned, or None.
        value: the offending value, or None.
        cure: what to do about it, or None.
        problem: the failed numerical problem (matrices, iterates), where there is one.
    """

    def __init__(
        self,
        what: str,
        *,
        file: object = None,
        element: str | None = None,
        value: object = None,
        cure: str | None = None,
        problem: object = None,
    ) -> None:
        self.what = what
        self.file = None if file is None else str(file)
        self.element = None if element is None else str(element)
        self.value = value
        self.cure = cure
        self.problem = problem
        super().__init__(str(self))

    def __str__(self) -> str:
        """One line: `file: element: what (got value); cure`."""
        head = ": ".join(part for part in (self.file, _short(self.element)) if part)
        text = f"{head}: {self.what}" if head else self.what
        if self.value is not None:
            shown = repr(self.value) if isinstance(self.value, str) else str(self.value)
            text += f" (got {_short(shown)})"
        if self.cure:
            text += f"; {self.cure}"
        return _WORD.sub(lambda word: str(_short(word.group())), " ".join(text.split()))

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle by fields, so that the error crosses process boundaries whole."""
        fields = (self.what, self.file, self.element, self.value, self.cure)
        return (_rebuild, (type(self), *fields))


def _short(text: str | None) -> str | None:
    """Its beginning and end, where it would fill a screen."""
    return text if text is None or len(text) <= _LONGEST else f"{text[: _LONGEST - 60]} ... {text[-50:]}"


@contextlib.contextmanager
def naming(file: object) -> Iterator[None]:
    """Let errors from within that name no file name this one."""
    try:
        yield
    except RoverPinError as error:
        if error.file is None and file is not None:
            error.file = str(file)
            error.args = (str(error),)
        raise


def _rebuild(
    kind: type[RoverPinError],
    what: str,
    file: str | None,
    element: str | None,
    value: object,
    cure: str | None,
) -> RoverPinError:
    return kind(what, file=file, element=element, value=value, cure=cure)


class InputError(RoverPinError, ValueError):
    """Something the user gave cannot be used; the command line exits with status 2."""


class DescriptionError(InputError):
    """A URDF or xacro file that cannot be used."""


class SidecarError(InputError):
    """A file beside the URDF (`rover.yaml`, `control.yaml`) that cannot be used."""


class MechanismError(InputError):
    """Loops, couplings, springs or locks that contradict each other or the joints."""


class PostureError(InputError):
    """A posture or joint value that the rover cannot take."""


class TerrainError(InputError):
    """A height map or terrain word that cannot be used."""


class OffMapError(TerrainError):
    """The place asked for is not on the map."""


class StudyError(InputError):
    """A study file, a dataset or a run that cannot be used."""


class SolverError(RoverPinError):
    """A numerical problem that failed where an answer was owed; `problem` keeps it."""


def nearest(name: str, known: Iterable[str]) -> str:
    """Name the nearest known names, `did you mean 'a' or 'b'?`, else list what there is."""
    names = sorted(set(known))
    close = difflib.get_close_matches(name[:_LONGEST], names, n=3, cutoff=0.5)
    if close:
        return "did you mean " + " or ".join(repr(c) for c in close) + "?"
    if not names:
        return "there are none"
    shown = ", ".join(names[:12]) + (", ..." if len(names) > 12 else "")
    return f"known: {shown}"
