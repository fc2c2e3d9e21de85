"""Whether a worker would give the same numbers: the versions there and here, and the sources."""

from __future__ import annotations

import functools
import hashlib
import os
import platform
from collections.abc import Mapping
from pathlib import Path

from rover_pin.analysis.provenance import versions
from rover_pin.errors import StudyError

SOURCES = "rover_pin's sources"
CURE = "let all workers use one environment, the one that the study is started from"


@functools.cache
def makings() -> Mapping[str, str]:
    """What the numbers of this process hang on: versions by name, and a digest of rover_pin's sources.

    Of Python the first two parts of the version: the third changes no number.
    """
    python = ".".join(platform.python_version_tuple()[:2])
    return {**versions(), "python": python, SOURCES: _sources()}


def _sources() -> str:
    """Digest of the package's files: an unreleased version has one number and many states."""
    import rover_pin

    root = Path(rover_pin.__file__).parent
    found = [
        Path(folder, name)
        for folder, _, names in os.walk(root, followlinks=True)
        for name in names
        if name.endswith(".py")
    ]
    state = hashlib.sha256()
    for path in sorted(found, key=lambda each: each.relative_to(root).as_posix()):
        state.update(path.relative_to(root).as_posix().encode() + b"\0" + path.read_bytes())
    return state.hexdigest()[:12]


def refuse_unlike(there: Mapping[str, str], here: Mapping[str, str], worker: str) -> None:
    """Refuse a worker that differs from this process.

    Raises:
        StudyError: names the worker and what differs.
    """
    names = [name for name in here if there.get(name) != here[name]]
    if names:
        unlike = ", ".join(
            f"{name} {there.get(name) or 'none'} (here {here[name] or 'none'})" for name in names
        )
        raise StudyError(f"has {unlike}", element=f"worker {worker}", cure=CURE)


def refuse_answers(answers: Mapping[str, Mapping[str, str] | Exception]) -> None:
    """Refuse a cluster in which a worker cannot do the work or would do it differently.

    Args:
        answers: by worker's address, its `makings` or why it could not tell them.

    Raises:
        StudyError: names the worker and what is missing there or differs.
    """
    for worker, answer in answers.items():
        if isinstance(answer, OSError):  # it left while it was asked
            continue
        if isinstance(answer, Exception):
            why = str(answer) if type(answer) is Exception else f"{type(answer).__name__}: {answer}"
            raise StudyError(f"cannot run rover_pin: {why}", element=f"worker {worker}", cure=CURE)
        refuse_unlike(answer, makings(), worker)
