"""The picture of a mobility map: what is drawn where, in which colours, at which size."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pytest
import xarray as xr

from rover_pin import Terrain, load
from rover_pin.viz import plot_mobility
from rover_pin.viz.footprint import footprint


def made(worst: Any, best: Any, share: Any, *, better: str = "high", unit: str = "rad") -> xr.Dataset:
    rows, columns = np.shape(worst)
    cell = ("y", "x")
    return xr.Dataset(
        {
            "worst": (cell, np.asarray(worst, float), {"units": unit, "better": better}),
            "best": (cell, np.asarray(best, float), {"units": unit, "better": better}),
            "settled_share": (cell, np.asarray(share, float)),
        },
        coords={"x": 0.5 * np.arange(columns), "y": 0.5 * np.arange(rows)},
        attrs={"measure": "tip", "robot": "one", "terrain": "yard", "headings": 8, "spacing": 0.5},
    )


@pytest.fixture
def some() -> xr.Dataset:
    """A place without an answer, one with an answer in some headings."""
    return made([[np.nan, 0.2], [0.4, 0.6]], [[np.nan, 0.5], [0.7, 0.8]], [[0.0, 0.5], [1.0, 1.0]])


def test_both_maps_share_a_scale_and_say_what_they_show(some: xr.Dataset) -> None:
    figure = plot_mobility(some)
    worst, best, bar = figure.axes
    assert (worst.get_title(), best.get_title()) == ("worst heading", "best heading")
    assert worst.images[0].norm is best.images[0].norm
    assert worst.images[0].get_extent() == [-0.25, 0.75, -0.25, 0.75]
    assert bar.get_ylabel() == "Tip-over angle [°], higher is better"
    assert figure.get_suptitle() == "Tip-over angle of one on yard, 8 headings at each place"
    assert (worst.get_xlabel(), worst.get_ylabel()) == ("x [m]", "y [m]")


def test_places_without_an_answer_are_clear_over_hatching(some: xr.Dataset) -> None:
    figure = plot_mobility(some)
    axes = figure.axes[0]
    assert np.ma.getmaskarray(axes.images[0].get_array()).tolist() == [[True, False], [False, False]]
    assert axes.patch.get_hatch()
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert labels == ["no heading settles", "some headings do not settle"]


@pytest.mark.parametrize(
    ("worst", "better", "colours"),
    [
        ([[0.1, 0.2], [0.3, 0.4]], "high", "cividis"),
        ([[0.1, 0.2], [0.3, 0.4]], "low", "cividis_r"),
        ([[-0.1, 0.2], [0.3, 0.4]], "high", "PuOr"),
    ],
)
def test_signed_values_are_centred_on_zero(worst: Any, better: str, colours: str) -> None:
    image = plot_mobility(made(worst, worst, np.ones((2, 2)), better=better)).axes[0].images[0]
    assert image.get_cmap().name == colours
    if colours == "PuOr":
        assert image.norm.vmin == -image.norm.vmax


def test_values_that_fail_closed_and_maps_without_answers_can_be_drawn() -> None:
    closed = made([[-np.inf, 0.2], [0.3, 0.4]], [[-np.inf, 0.3], [0.3, 0.4]], np.ones((2, 2)))
    nothing = made(np.full((2, 2), np.nan), np.full((2, 2), np.nan), np.zeros((2, 2)))
    for data in (closed, nothing):
        plot_mobility(data, load("rocker_bogie"), Terrain.flat()).savefig(io.BytesIO(), format="png")
    assert not np.ma.getmaskarray(plot_mobility(closed).axes[0].images[0].get_array()).any()


def test_the_rover_is_drawn_to_scale() -> None:
    """Outer corners of the wheels: wheelbase and two radii long, track and a width wide."""
    xmin, xmax, ymin, ymax = footprint(load("rocker_bogie")).bounds
    assert xmax - xmin == pytest.approx(1.2 + 2 * 0.13)
    assert ymax - ymin == pytest.approx(1.2 + 0.11)
    turned = footprint(load("hit_mrii"))
    assert len(turned.wheels) == 6
