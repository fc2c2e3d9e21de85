"""Ways to carry out a job, one module each: a module here with an `ENGINE` is an engine of that name.

Modules that begin with an underscore are what engines share.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from rover_pin.analysis.job import Chunk, Done
from rover_pin.analysis.rows import Columns
from rover_pin.errors import StudyError, nearest


@dataclass(frozen=True)
class Resources:
    """What an engine may use: worker processes (None: one a core), a scheduler's address."""

    workers: int | None = None
    scheduler: str | None = None


class Worker(Protocol):
    """Answers chunks of a work in one process."""

    def run(self, chunk: Chunk) -> Columns:
        """The rows of a chunk."""
        ...


class Work(Protocol):
    """What engines carry out, as `rover_pin.analysis.job.Job`; crosses processes whole."""

    def runner(self) -> Worker:
        """What answers its chunks in this process."""
        ...


class Engine(Protocol):
    """Runs every chunk once and hands each to `done`, in any order, in the calling process."""

    takes_scheduler: bool

    def workers(self, resources: Resources) -> int:
        """How many chunks run at once.

        Raises:
            StudyError: workers that cannot be had.
        """
        ...

    def run(self, job: Work, chunks: Sequence[Chunk], resources: Resources, done: Done) -> None:
        """Carry out the chunks."""
        ...


def engine_names() -> list[str]:
    """The engines there are."""
    return sorted(module.name for module in pkgutil.iter_modules(__path__) if module.name[0] != "_")


def engine(name: str, resources: Resources) -> Engine:
    """The engine of that name, checked against the resources.

    Raises:
        StudyError: no such engine, or resources it cannot use.
    """
    if name not in engine_names():
        raise StudyError("no such engine", element="engine", value=name, cure=nearest(name, engine_names()))
    found: Engine = importlib.import_module(f"{__name__}.{name}").ENGINE
    if resources.workers is not None and resources.workers < 1:
        raise StudyError("must be at least 1", element="workers", value=resources.workers)
    if resources.scheduler is not None and not found.takes_scheduler:
        raise StudyError(
            f"the engine {name} takes no scheduler",
            element="scheduler",
            value=resources.scheduler,
            cure="leave it out",
        )
    found.workers(resources)  # a cluster that is not there is found out before anything is written
    return found
