"""A paper: how it is cited, which robots it needs, and what computes its figures."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rover_pin.analysis.papers.chart import Chart
from rover_pin.analysis.papers.finding import VERDICTS, Finding

if TYPE_CHECKING:
    from rover_pin.rover import Rover
    from rover_pin.simulation.run import Run


@dataclass(frozen=True)
class Results:
    """What came out.

    Attributes:
        findings: row by row, in the paper's order.
        charts: its figures.
        runs: motions by name, where the paper has some.
    """

    findings: tuple[Finding, ...]
    charts: tuple[Chart, ...] = ()
    runs: Mapping[str, Run] = field(default_factory=dict)

    @property
    def verdicts(self) -> dict[str, int]:
        """How many rows have each verdict."""
        return {word: sum(f.verdict == word for f in self.findings) for word in VERDICTS}


@dataclass(frozen=True)
class Paper:
    """A paper that is reproduced here.

    Attributes:
        key: what the command line calls it.
        title: its title.
        citation: authors, journal, year, as far as known.
        robots: bundled robots that its figures are computed with.
        compute: its findings and charts, from those robots by name.
        remarks: what a reader has to know: conventions, misprints, where the numbers of its robot come from.
    """

    key: str
    title: str
    citation: str
    robots: tuple[str, ...]
    compute: Callable[[Mapping[str, Rover]], Results]
    remarks: tuple[str, ...] = ()

    def results(self, robots: Mapping[str, Rover] | None = None) -> Results:
        """Compute everything.

        Args:
            robots: rovers to compute with in place of the bundled ones of the same names.

        Raises:
            DescriptionError: a robot is not bundled.
        """
        from rover_pin.loader import load

        given = robots or {}
        return self.compute({name: given[name] if name in given else load(name) for name in self.robots})
