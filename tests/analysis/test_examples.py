"""The examples: each a study of a few lines that does what its comment says."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rover_pin.analysis import Study, search, sensitivity
from rover_pin.viz.page.sweep import sweep_of

EXAMPLES = Path(__file__).parents[2] / "examples"


def study(name: str) -> Study:
    return Study.from_file(EXAMPLES / f"{name}.yaml")


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.yaml")), ids=lambda path: path.stem)
def test_an_example_is_a_few_lines(path: Path) -> None:
    text = path.read_text()
    assert text.startswith("# ")
    assert len(text.splitlines()) <= 8


def test_the_mass_brings_the_last_wheel_down() -> None:
    data = study("polibot_mass").run()
    assert (data.status == "settled").all()
    assert set(data.touching.values[data.mass < 38]) == {3.0}
    assert set(data.touching.values[data.mass > 42]) == {4.0}
    assert (np.diff(data.tension_n.values[:, 0]) <= 1e-6).all()


def test_the_track_lifts_a_wheel_and_goes_slack() -> None:
    data = study("polibot_track_length").run()
    short, long = data.isel(case=0), data.isel(case=-1)
    assert (short.touching, long.touching) == (3, 4)
    assert short.tension_n > 400
    assert long.tension_n == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("name", ["front_arm", "stiffness", "preload", "map"])
def test_sweeps_have_charts(name: str) -> None:
    data = study(f"polibot_{name}").run()
    told = sweep_of(data)
    assert told is not None
    assert len(told["axes"]) == (2 if name == "map" else 1)
    titles = [chart["title"] for chart in told["charts"]]
    assert {"Pitch", "Wheels in contact", "Load spread", "Track tension", "Wheel loads"} <= set(titles)


def test_every_length_has_a_sensitivity() -> None:
    slopes = sensitivity(study("polibot_sensitivity").run())
    assert {"track_length", "front_arm_length", "d1", "d15", "r6"} <= set(slopes.parameter.values)
    assert (slopes.answered == 4).all()
    assert float(slopes.nominal_figure.sel(figure="load_spread")) == pytest.approx(0.579, abs=1e-3)
    assert float(slopes.nominal_figure.sel(figure="tension_n/track")) == pytest.approx(299.9, abs=0.1)
    assert float(slopes.slope.sel(figure="tension_n/track", parameter="track_length")) < 0


def test_the_search_finds_a_setup_with_more_even_loads() -> None:
    asked = study("polibot_search")
    asked.spec = asked.spec.model_copy(update={"search": asked.spec.search.model_copy(update={"trials": 60})})
    data = search(asked)
    best = data.isel(case=data.attrs["best_trial"])
    assert best.load_spread < 0.9 * data.load_spread[0]
    assert 100 <= float(best.tension_n[0]) <= 400
    assert best.touching == 4
