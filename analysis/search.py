"""A search for the design that is best in one figure and keeps bounds on others."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from rover_pin.analysis.cases import Cases
from rover_pin.analysis.chance import Chance
from rover_pin.analysis.draw import draw
from rover_pin.analysis.figures import figures
from rover_pin.analysis.job import Job, Runner
from rover_pin.analysis.quantities import Quantity, Span
from rover_pin.analysis.rows import Columns, joined, words
from rover_pin.analysis.search_score import check_figures, in_degrees, score
from rover_pin.analysis.search_spec import SearchSpec
from rover_pin.analysis.spec import CasesSpec
from rover_pin.errors import InputError, StudyError

if TYPE_CHECKING:
    import xarray as xr

    from rover_pin.analysis.study import Study

PLACES = 20
"""Places that each design is asked at, where they vary and the study does not say how many."""


class TrialCases:
    """The cases of designs that become known one after the other: each at the same places."""

    def __init__(self, places: Cases) -> None:
        self.places = places
        self.designs: list[Mapping[str, float]] = []

    def run(self, start: int, stop: int) -> Cases:
        """The cases from `start` to before `stop`."""
        case = np.arange(start, stop)
        trial, at = np.divmod(case, len(self.places))
        own = self.places
        names = self.designs[0] if self.designs else {}
        return Cases(
            x=own.x[at],
            y=own.y[at],
            yaw=own.yaw[at],
            postures=own.postures,
            posture=own.posture[at],
            friction=None if own.friction is None else own.friction[at],
            parameters={name: np.array([self.designs[t][name] for t in trial]) for name in names},
            joints={name: values[at] for name, values in own.joints.items()},
            weights={name: values[at] for name, values in own.weights.items()},
        )


def search(study: Study, progress: Callable[[int, int], None] | None = None) -> xr.Dataset:
    """Try designs as the study's `search` says, by a tree-structured Parzen estimator with constraints.

    The first trial is the nominal design. A design that does not settle counts as worth nothing and far from
    every bound. The same seed gives the same trials.

    Args:
        study: with a `search` entry; `vary.parameters` gives the ranges.
        progress: called with finished and all trials.

    Returns:
        The Dataset of a study over all trials' cases (`trial_of_case` says whose), with dimension trial:
        `objective`, `violation` (0 or less where every bound is kept). Attributes `best_trial` (-1 where no
        trial keeps every bound), `goal`, `better`.

    Raises:
        StudyError: no search entry, nothing to vary, an unknown figure, or Optuna is not installed.
    """
    spec = study.spec.search
    if spec is None:
        cure = "write search: {minimise: load_spread}, say"
        raise StudyError("has no search", file=study.file, element="search", cure=cure)
    optuna = _optuna()
    job = study.plan.job
    asked = {name: each for name, each in job.cases.questions.parameters.items() if each.varies}
    if not asked:
        cure = "give them ranges: vary: {parameters: {track: [1.0, 1.4]}}"
        raise StudyError("no parameter varies", file=study.file, element="vary.parameters", cure=cure)
    fixed = {n: q.ends[0] for n, q in job.cases.questions.parameters.items() if n not in asked}
    trials = Trials(spec, job, _places(job, study.spec.cases))
    check_figures(spec, trials.known)
    sampler = optuna.samplers.TPESampler(seed=spec.seed, multivariate=True)
    direction = "minimize" if spec.minimise else "maximize"
    tried = optuna.create_study(direction=direction, sampler=sampler)
    tried.enqueue_trial({name: _within(asked[name], job.rover.parameters[name]) for name in asked})
    kinds = {name: _distribution(optuna, each) for name, each in asked.items()}
    for k in range(spec.trials):
        trial = tried.ask(kinds)
        told, violations = trials.tell({**fixed, **{name: float(trial.params[name]) for name in asked}})
        for name, excess in zip((*spec.subject_to, "settled"), violations, strict=True):
            trial.set_constraint(name, excess)
        tried.tell(trial, told)
        if progress is not None:
            progress(k + 1, spec.trials)
    return trials.dataset(study)


class Trials:
    """Designs answered one after the other, and what they were worth."""

    def __init__(self, spec: SearchSpec, job: Job, places: Cases) -> None:
        self._spec, self._job = spec, job
        self._cases = TrialCases(places)
        self._runner = Runner(job, self._cases)
        self._parts: list[Columns] = []
        self._scores: list[tuple[float, list[float]]] = []

    @property
    def known(self) -> list[str]:
        """Names of the figures that a design answers with."""
        layout = self._job.layout
        wide = {"load_n": len(layout.wheels), "tension_n": len(layout.tracks)}
        return list(
            in_degrees(figures(lambda name: np.zeros((0, wide[name]) if name in wide else 0), layout))
        )

    def tell(self, design: Mapping[str, float]) -> tuple[float, list[float]]:
        """What a design is worth, and by how much it breaks each bound."""
        self._cases.designs.append(design)
        count, each = len(self._cases.designs), len(self._cases.places)
        columns = self._runner.run(((count - 1) * each, count * each))
        settled = words(columns, "status").spelled() == "settled"
        values = in_degrees(figures(lambda name: columns[name], self._job.layout))
        self._parts.append(columns)
        self._scores.append(score(self._spec, values, settled))
        return self._scores[-1]

    def dataset(self, study: Study) -> xr.Dataset:
        """All of it."""
        from rover_pin.analysis.dataset import dataset

        count, each = len(self._scores), len(self._cases.places)
        data = dataset(study, joined(self._parts), self._cases.run(0, count * each))
        worth = np.array([told for told, _ in self._scores])
        broken = np.array([max(violations) for _, violations in self._scores])
        kept = np.flatnonzero(broken <= 0.0)
        sign = self._spec.sign
        best = int(kept[np.argmin(sign * worth[kept])]) if len(kept) else -1
        data["trial_of_case"] = ("case", np.repeat(np.arange(count), each))
        data["objective"] = ("trial", worth, {"long_name": self._spec.goal})
        data["violation"] = ("trial", broken, {"long_name": "largest excess over a bound, over its size"})
        return data.assign_attrs(
            best_trial=best, goal=self._spec.goal, better="low" if sign > 0 else "high", places=each
        )


def _places(job: Job, spec: CasesSpec) -> Cases:
    """Where each design is asked: one place, or those that the study draws."""
    questions = dataclasses.replace(job.cases.questions, parameters={})
    if not any(asked.varies for asked in questions.columns.values()):
        count = draw(questions, CasesSpec(n=1))
    elif spec.sampler == "sobol" and spec.n is None:
        count = draw(questions, spec.model_copy(update={"n": PLACES}))
    else:
        count = draw(questions, spec)
    return count.drawer().run(0, len(count))


def _within(asked: Quantity, value: float) -> float:
    """The value a quantity has that is nearest to one."""
    if isinstance(asked, Span | Chance):
        low, high = asked.ends
        return min(max(value, low), high)
    return min(asked.values, key=lambda each: abs(each - value))


def _distribution(optuna: Any, asked: Quantity) -> Any:
    """The quantity in the words of Optuna."""
    if isinstance(asked, Span | Chance):
        return optuna.distributions.FloatDistribution(*asked.ends)
    return optuna.distributions.CategoricalDistribution(asked.values)


def _optuna() -> Any:
    """Optuna, quiet.

    Raises:
        InputError: it is not installed.
    """
    try:
        import optuna
    except ImportError:
        cure = "pip install 'rover-pin[search]'"
        raise InputError("Optuna is not installed, which searches", element="search", cure=cure) from None
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    return optuna
