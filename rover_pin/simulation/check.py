"""A run whose parts fit each other, or an error that says which does not."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from rover_pin.errors import InputError, nearest

if TYPE_CHECKING:
    from rover_pin.numerics import Array
    from rover_pin.simulation.run import Run


def checked_run(run: Run) -> Run:
    """The same run, where every part has one entry a sample and says something.

    NaN is nothing measured and stays, in indices, values, loads, drift, residual and apart; it is refused in
    times and configurations. One sample is a run.

    Raises:
        InputError: no sample, parts of different length, a time that is not finite or runs back, a
            configuration that is not finite, an infinite load, a wheel that the rover does not have.
    """
    count = len(run.time)
    if count == 0:
        raise InputError("has no sample", element="run", cure="log at least where it started")
    _time(np.asarray(run.time, dtype=np.float64))
    names = run.rover.dof_names
    _shape("configuration", run.configuration, (count, len(names)), "one column a name of rover.dof_names")
    _shape("rates", run.rates, (count, len(names)), "one column a name of rover.dof_names")
    _configuration(run.configuration, names)
    for element, words in (("actions", run.actions), ("lifted", run.lifted)):
        _length(element, words, count)
    for element, parts in (("indices", run.indices), ("values", run.values)):
        for name, values in parts.items():
            _length(f"{element} {name!r}", values, count)
    _wheels(run, count)
    for element, column in (("residual", run.residual), ("apart", run.apart)):
        if column is not None:
            _length(element, column, count)
    return run


def _time(time: Array) -> None:
    if time.ndim != 1:
        raise InputError("has more than one axis", element="time", value=time.shape, cure="give shape (n,)")
    if not np.isfinite(time).all():
        bad = int(np.flatnonzero(~np.isfinite(time))[0])
        raise InputError(
            "is no finite number",
            element=f"time[{bad}]",
            value=float(time[bad]),
            cure="log the seconds of every sample",
        )
    back = np.flatnonzero(np.diff(time) < 0)
    if len(back):
        raise InputError(
            "runs back",
            element=f"time[{back[0] + 1}]",
            value=f"{time[back[0] + 1]:g} s after {time[back[0]]:g} s",
            cure="log samples in the order they happened; undoing an action takes time too",
        )


def _configuration(configuration: Array, names: Sequence[str]) -> None:
    bad = np.argwhere(~np.isfinite(configuration))
    if len(bad):
        sample, column = (int(i) for i in bad[0])
        raise InputError(
            "is no finite number",
            element=f"configuration[{sample}], {names[column]}",
            value=float(configuration[sample, column]),
            cure="end the run before the sample that has no configuration",
        )


def _wheels(run: Run, count: int) -> None:
    """Everything that is by wheel."""
    known = [shape.name for shape in run.rover.shapes]
    for sample, names in enumerate(run.lifted):
        _known(f"lifted[{sample}]", names, known)
    _known("loads", run.loads, known)
    for name, load in run.loads.items():
        _shape(f"loads {name!r}", load, (count,), "one load a sample, NaN where none is known")
        if np.isinf(load).any():
            sample = int(np.flatnonzero(np.isinf(load))[0])
            raise InputError(
                "is infinite",
                element=f"loads {name!r} [{sample}]",
                value=float(load[sample]),
                cure="NaN says that no load is known",
            )
    if run.drift is not None:
        cure = f"one column a wheel: {', '.join(known)}"
        _length("drift", run.drift, count)
        _shape("drift", run.drift, (count, run.drift.shape[1] if run.drift.ndim == 2 else len(known)), cure)
        if run.drift.shape[1] not in (len(run.rover.wheels), len(known)):
            _shape("drift", run.drift, (count, len(known)), cure)


def _known(element: str, names: Sequence[str] | Mapping[str, object], known: Sequence[str]) -> None:
    for name in names:
        if name not in known:
            raise InputError("no wheel of that name", element=element, value=name, cure=nearest(name, known))


def _length(element: str, part: Sequence[object] | Array, count: int) -> None:
    if len(part) != count:
        raise InputError(
            "is not as long as the run",
            element=element,
            value=f"{len(part)} entries, {count} times",
            cure="log everything at every sample, NaN where there is nothing",
        )


def _shape(element: str, part: Array, shape: tuple[int, ...], cure: str) -> None:
    if np.shape(part) != shape:
        raise InputError("has another shape than the run", element=element, value=np.shape(part),
                         cure=f"give {shape}: {cure}")  # fmt: skip
