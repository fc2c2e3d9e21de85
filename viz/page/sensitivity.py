"""The page of sensitivities: for each figure the parameters as bars, the strongest first."""

from __future__ import annotations

import html
import math
from pathlib import Path
from typing import TYPE_CHECKING

from rover_pin.viz.page.html import write_whole
from rover_pin.viz.page.sheet import card, preformatted, sheet
from rover_pin.viz.units import shown, title_of

if TYPE_CHECKING:
    import xarray as xr

MOST = 14
"""Bars a figure: the weakest are left out."""

DOUBT = 0.1
"""Nonlinearity or kink above which a slope is told as doubtful."""

NEGLIGIBLE = 1e-6
"""Change a per cent, over the figure's size, that is as good as none."""

TITLES = {"pitch_rad": "Pitch", "roll_rad": "Roll", "z_m": "Height of the root link"}
STEMS = {"load_n": "Load", "tension_n": "Track tension"}


def save_sensitivity_page(slopes: xr.Dataset, path: str | Path) -> Path:
    """Write the page of sensitivities: one offline HTML file, whole or not at all.

    Args:
        slopes: of `rover_pin.analysis.sensitivity`.
        path: of the file.

    Raises:
        InputError: the file cannot be written.
    """
    return write_whole(path, sensitivity_page(slopes).encode("utf-8"))


def sensitivity_page(slopes: xr.Dataset) -> str:
    """The page's HTML text."""
    cards = [_tornado(slopes.isel(figure=k)) for k in range(slopes.sizes["figure"])]
    quiet = [name for name, made in zip(slopes.figure.values, cards, strict=True) if not made]
    note = (
        "Bars: change of the figure for 1 % more of the parameter (1 % of its bounds' width where it is 0), "
        "blue up, orange down. Beside them the derivative. Hatched: the slopes over two "
        "steps or to the two sides differ by more than a tenth, so that it holds for small changes at most."
    )
    rest = f"<p>Nothing moves {html.escape(', '.join(map(titled, quiet)))}.</p>" if quiet else ""
    about = card("How to read it", rest + preformatted(str(slopes.attrs["study"])), note)
    title = f"{slopes.attrs['title']}: sensitivities"
    subtitle = f"{slopes.sizes['parameter']} parameters, each moved alone from the nominal design"
    return sheet(title, subtitle, [*filter(None, cards), about])


def titled(name: str) -> str:
    """What to call a figure."""
    stem, _, label = str(name).partition("/")
    return f"{STEMS[stem]}, {label}" if label else TITLES.get(stem) or title_of(stem)


def _tornado(slopes: xr.Dataset) -> str:
    """One figure's bars, or nothing where none is worth one."""
    name = str(slopes.figure.item())
    unit, factor = shown(str(slopes.figure_unit.item()))
    size = max(abs(float(slopes.nominal_figure)), 1e-3)
    changes = {str(p): _change(slopes.sel(parameter=p)) for p in slopes.parameter.values}
    kept = sorted(
        (p for p, v in changes.items() if abs(v) > NEGLIGIBLE * size), key=lambda p: -abs(changes[p])
    )
    if not kept:
        return ""
    most = abs(changes[kept[0]])
    cells = ['<span class="head"></span><span class="head"></span>']
    unit_word = "" if unit == "–" else f" {unit}"
    told = f"for +1 %{f' [{unit}]' if unit_word else ''}"
    cells += [f'<span class="head number">{told}</span><span class="head number">derivative</span>']
    for parameter in kept[:MOST]:
        each = slopes.sel(parameter=parameter)
        cells += _bar(parameter, changes[parameter], most, each, factor)
    left = f"{len(kept) - MOST} weaker ones left out." if len(kept) > MOST else ""
    value = f"nominal {factor * float(slopes.nominal_figure):.4g}{unit_word}. {left}"
    return card(titled(name), f'<div class="tornado">{"".join(cells)}</div>', value)


def _change(each: xr.Dataset) -> float:
    """The figure's change for a hundredth of a parameter; for its step where that is 0."""
    change = float(each.per_percent)
    change = float(each.slope * 2.0 * each.step) if math.isnan(change) else change
    return change if math.isfinite(change) else 0.0


def _bar(parameter: str, change: float, most: float, each: xr.Dataset, factor: float) -> list[str]:
    wide = 50.0 * abs(change) / most
    left = 50.0 if change > 0 else 50.0 - wide
    doubtful = float(each.nonlinearity) > DOUBT or float(each.kink) > DOUBT
    kind = "doubt" if doubtful else "" if change > 0 else "less"
    figure_unit, per = str(each.figure_unit.item()), str(each.parameter_unit.item())
    unit = figure_unit.replace("1", "").replace("-", "")
    unit = f"{unit or '1'}/{f'({per})' if '/' in per else per}" if per not in ("", "1") else unit
    told = f"nonlinearity {float(each.nonlinearity):.2g}, kink {float(each.kink):.2g}"
    return [
        f'<span title="{html.escape(told)}">{html.escape(parameter.replace("_", " "))}</span>',
        f'<span class="rail" title="{html.escape(told)}"><i class="{kind}" '
        f'style="left:{left:.2f}%;width:{wide:.2f}%"></i></span>',
        f'<span class="number">{factor * change:+.3g}</span>',
        f'<span class="number dim">{float(each.slope):.3g} {html.escape(unit)}</span>',
    ]
