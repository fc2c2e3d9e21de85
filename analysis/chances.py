"""How often a study's rover tips or slips: shares of the drawn cases, each with its interval.

Cases that are drawn independently (sampler `random`) make a binomial count, for which the interval of
Clopper and Pearson (scipy's `binomtest`, method `exact`) covers with at least its confidence. Points of a
scrambled Sobol sequence are not independent: they fill the space more evenly, the error of a share is as a
rule smaller, and the same interval is then wider than need be; that is no theorem for every set, so it is
told as `conservative`. Of a Saltelli sample only the first and the last case of each block count: the
others repeat their values.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rover_pin.errors import StudyError

if TYPE_CHECKING:
    import xarray as xr

TIPPING = ("tip", "polygon", "force_angle", "energy", "zmp")
"""Measures that are below zero past tipping, the first of them that there is counts."""

FALLEN = ("tips", "loose", "slack")
"""Statuses of a rover that does not stand; grounded, off the map and the like say nothing of tipping."""

INTERVALS = {
    "random": "exact binomial (Clopper-Pearson)",
    "sobol": "Clopper-Pearson, as if drawn independently: conservative for scrambled Sobol points",
    "saltelli": "Clopper-Pearson, as if drawn independently, of each block's two ends: conservative",
}
"""What the interval is, by sampler; others draw nothing."""

CONFIDENCE = 0.95


@dataclass(frozen=True)
class Probability:
    """A share of the drawn cases.

    Attributes:
        event: `tipping` or `slipping`.
        rule: when a case counts, in words.
        count, cases: those that do, of those that say.
        silent: cases that do not say, left out.
        low, high: ends of the interval.
        interval: what it is, in words.
    """

    event: str
    rule: str
    count: int
    cases: int
    silent: int
    low: float
    high: float
    interval: str

    @property
    def share(self) -> float:
        """The estimate."""
        return self.count / self.cases


def probabilities(data: xr.Dataset, measure: str | None = None, below: float = 0.0) -> list[Probability]:
    """The probabilities of tipping and, where friction was measured, of slipping; none where none were drawn.

    Args:
        data: the result of a study with the sampler `sobol`, `random` or `saltelli`.
        measure: whose margin counts for tipping; silent: the first of `TIPPING` that the result has.
        below: a margin below this counts, in the measure's SI unit.

    Raises:
        StudyError: the result has no such measure.
    """
    sampler = str(data.attrs.get("sampler", ""))
    if sampler not in INTERVALS:
        return []
    if measure is not None and (measure not in data or f"{measure}_limiting" not in data):
        raise StudyError("the study has no such measure", element="measure", value=measure)
    chosen = measure or next((name for name in TIPPING if name in data), None)
    drawn = _drawn(data, sampler)
    status = data["status"].values[drawn].astype(str)
    settled = status == "settled"
    tipped, rule = np.isin(status, FALLEN), "no stance"
    said = settled | tipped
    if chosen is not None:
        margin = data[chosen].values[drawn]
        worse = margin < below if data[chosen].attrs.get("better", "high") == "high" else margin > below
        tipped = tipped | (settled & worse)
        said = said & ~(settled & np.isnan(margin))
        unit = str(data[chosen].attrs.get("units", ""))
        rule = f"no stance, or {chosen} below {below:g}{f' {unit}' if unit not in ('', '1', '-') else ''}"
    out = [_probability("tipping", rule, tipped, said, sampler)]
    if "friction" in data:
        margin = data["friction"].values[drawn]
        stands = settled & ~np.isnan(margin)
        rule = "the stance needs more friction than there is; of those that stand"
        out.append(_probability("slipping", rule, margin < 0.0, stands, sampler))
    return [each for each in out if each is not None]


def _drawn(data: xr.Dataset, sampler: str) -> NDArray[np.int64]:
    """Cases that each are a draw of their own."""
    count = int(data.sizes["case"])
    if sampler != "saltelli":
        return np.arange(count)
    block = len(str(data.attrs["inputs"]).split("\n")) + 2
    return np.sort(np.concatenate([np.arange(0, count, block), np.arange(block - 1, count, block)]))


def _probability(
    event: str, rule: str, happened: NDArray[np.bool_], said: NDArray[np.bool_], sampler: str
) -> Probability | None:
    from scipy.stats import binomtest

    cases = int(said.sum())
    if not cases:
        return None
    count = int((happened & said).sum())
    ends = binomtest(count, cases).proportion_ci(CONFIDENCE, method="exact")
    silent = len(said) - cases
    return Probability(
        event, rule, count, cases, silent, float(ends.low), float(ends.high), INTERVALS[sampler]
    )
