"""Fewer samples of a long run: evenly chosen for the picture, extremes kept for the plots."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from rover_pin.numerics import Array

Indices = NDArray[np.int64]

GAP = 1.5
"""A silence so many times the usual one between known values, counted in samples, is a gap."""


def evenly(count: int, most: int, always: Iterable[int] = ()) -> Indices:
    """About `most` of `count` samples, the first, the last and those of `always` among them."""
    if count <= most:
        return np.arange(count)
    even = np.rint(np.linspace(0, count - 1, most)).astype(np.int64)
    return np.union1d(even, np.array([i for i in always if 0 <= i < count], dtype=np.int64))


def extremes(values: Array, most: int) -> Indices:
    """About `most` samples of values (n,), none NaN, that look like all: per stretch least and largest."""
    count = len(values)
    if count <= most:
        return np.arange(count)
    edges = np.rint(np.linspace(0, count, max(most // 2, 1) + 1)).astype(np.int64)
    kept = [0, count - 1]
    for first, end in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True):
        part = values[first:end]
        kept += [first + int(np.argmin(part)), first + int(np.argmax(part))]
    return np.unique(np.array(kept, dtype=np.int64))


def longest_silence(known: Indices) -> float:
    """Samples from one known value to the next that are no gap; any NaN is one where all else is known."""
    return GAP * float(np.median(np.diff(known))) if len(known) > 1 else np.inf


def line(time: Array, values: Array, most: int) -> tuple[Array, Array]:
    """Times and values of a plotted line of about `most` points: only what is known, extremes kept.

    NaN is what was not asked for or has no answer. Values known every so many samples are joined; where they
    are silent for longer than that, one NaN in the middle breaks the line.

    Args:
        time: (n,) s, rising.
        values: (n,), NaN where not known.
        most: points, roughly.
    """
    known = np.flatnonzero(~np.isnan(values))
    t, v = time[known], values[known]
    broken = np.flatnonzero(np.diff(known) > longest_silence(known))  # the gap follows this one
    kept = extremes(v, most)
    if not len(broken):
        return t[kept], v[kept]
    kept = np.unique(np.concatenate([kept, broken, broken + 1]))
    at = np.searchsorted(kept, broken) + 1
    middles = (t[broken] + t[broken + 1]) / 2
    return np.insert(t[kept], at, middles), np.insert(v[kept], at, np.nan)


def held(values: Array) -> Array:
    """(n,) every sample's last known value; NaN before the first, and where the next should have come."""
    known = np.flatnonzero(~np.isnan(values))
    if not len(known):
        return np.full(len(values), np.nan)
    samples = np.arange(len(values))
    last = np.searchsorted(known, samples, side="right") - 1
    source = known[np.maximum(last, 0)]
    usual = longest_silence(known) / GAP
    return np.where((last < 0) | (samples - source >= usual), np.nan, values[source])
