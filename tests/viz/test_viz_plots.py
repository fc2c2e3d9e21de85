"""Figures for papers."""

from __future__ import annotations

import numpy as np
import pytest
import viz_doubles as doubles

from rover_pin.errors import InputError, StudyError
from rover_pin.viz.plots import cell_values, plot_distributions, plot_map


@pytest.fixture(scope="module")
def study():
    return doubles.dataset(60)


@pytest.mark.parametrize(
    ("measure", "statistic"), [("tip", "worst"), ("tip", "best"), ("torque", "worst"), ("tip", "median")]
)
def test_cells_against_a_loop(study, measure, statistic):
    data = study[0]
    xs, ys, values, counts = cell_values(data, measure, statistic)
    x, y, all_values = data["x_m"].values, data["y_m"].values, data[measure].values
    assert counts.sum() == len(x)
    for j in range(len(ys) - 1):
        for i in range(len(xs) - 1):
            inside = (
                (x >= xs[i])
                & (x < xs[i + 1] + (i == len(xs) - 2))
                & (y >= ys[j])
                & (y < ys[j + 1] + (j == len(ys) - 2))
            )
            kept = np.sort(all_values[inside & (data["status"].values == "settled")])
            if not len(kept):
                assert np.isnan(values[j, i])
                continue
            if data[measure].attrs["better"] == "low":
                kept = kept[::-1]
            at = {"worst": 0, "median": (len(kept) - 1) // 2, "best": len(kept) - 1}[statistic]
            assert values[j, i] == kept[at]


def test_the_map_says_measure_unit_and_which_way_is_worse(study, tmp_path):
    data, _, terrain, _ = study
    figure = plot_map(data, terrain=terrain)
    label = figure.axes[1].get_ylabel()
    assert label == "Tip-over angle [°], worst of a cell, low is worse"
    assert figure.axes[0].collections[0].get_cmap().name == "cividis"
    for suffix in ("png", "svg"):
        figure.savefig(tmp_path / f"map.{suffix}")
    assert "Tip-over angle [°]" in (tmp_path / "map.svg").read_text()


def test_a_measure_of_both_signs_is_centred_on_zero(study):
    mesh = plot_map(study[0], "clearance").axes[0].collections[0]
    assert mesh.get_cmap().name == "PuOr"
    assert mesh.norm.vmin == -mesh.norm.vmax


def test_distributions_have_a_panel_a_measure_and_the_loads(study, tmp_path):
    figure = plot_distributions(study[0])
    labels = [axes.get_xlabel() for axes in figure.axes]
    assert labels == [
        "Tip-over angle [°]  → better",
        "Polygon margin [mm]  → better",
        "Holding torque [N m]  ← better",
        "Belly clearance [mm]  → better",
        "wheel",
    ]
    assert [text.get_text() for text in figure.axes[-1].get_xticklabels()] == [
        "fl",
        "ml",
        "bl",
        "fr",
        "mr",
        "br",
    ]
    figure.savefig(tmp_path / "spread.png")


def test_a_study_where_nothing_settled_is_still_drawn(study):
    data = study[0].copy(deep=True)
    data["status"].values[:] = "tips"
    for name in ("tip", "polygon", "torque", "clearance"):
        data[name].values[:] = np.nan
    texts = [text.get_text() for axes in plot_distributions(data).axes for text in axes.texts]
    assert texts == ["no settled case has it"] * 4
    assert plot_map(data).axes


def test_unknown_words_are_said(study):
    with pytest.raises(
        StudyError, match=r"measure: the study has no such measure \(got 'tipp'\); did you mean 'tip'"
    ):
        plot_map(study[0], "tipp")
    with pytest.raises(
        InputError, match=r"statistic: no such statistic \(got 'mean'\); use worst, median or best"
    ):
        plot_map(study[0], statistic="mean")
