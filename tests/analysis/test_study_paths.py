"""Both paths in a study, the real ones: the same rows in the same words, to what they agree to."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from test_study_run import assert_same_bits

from rover_pin import Terrain
from rover_pin.analysis import Study
from rover_pin.analysis.job import Runner
from rover_pin.analysis.rows import Columns, words
from rover_pin.analysis.spec import CHEAP

STEEP = {"rough": {"seed": 5, "rms": 0.22, "hurst": 0.6, "size": 7, "spacing": 0.05}}
BEYOND = {"x": [-3.2, 3.2], "y": [-3.2, 3.2], "yaw_deg": [0, 360]}


def steep(n: int, **vary: Any) -> Study:
    """Rough ground beyond what the rover manages, and places beyond the map."""
    asked = {**BEYOND, **vary}
    return Study("rocker_bogie", STEEP, cases={"n": n}, vary=asked, measures=list(CHEAP))


def plainly(runner: Runner, count: int) -> Columns:
    vars(runner)["compiled"] = None
    return runner.run((0, count))


@pytest.mark.parametrize(
    "vary", [{}, {"posture": ["home", "clearance=0.3"]}, {"joints": {"steer_fl": [-0.4, 0.4]}}]
)
def test_both_paths_give_the_same_rows(vary: dict[str, Any]) -> None:
    count = 120
    job = steep(count, **vary).plan.job
    ours, wanted = Runner(job).run((0, count)), plainly(Runner(job), count)
    status = words(wanted, "status").spelled()
    assert {"settled", "off_map"} < set(status)
    assert 0 < np.count_nonzero(ours["plain_path"]) < count
    for name in ("status", "reason"):
        assert words(ours, name).spelled().tolist() == words(wanted, name).spelled().tolist()
    within = dict.fromkeys(("z_m", "roll_rad", "pitch_rad", "joint_rad"), 1e-8)
    within |= {"load_n": 1e-5, "redundant": 0.0, "force_angle": 5e-5, "force_angle_edge": 5e-5}
    for name, values in wanted.items():
        if values.dtype.kind == "f":
            np.testing.assert_allclose(ours[name], values, rtol=0, atol=within.get(name, 1e-7), err_msg=name)
    for name in CHEAP:
        assert ours[f"edges/{name}"].tolist() == wanted[f"edges/{name}"].tolist()
        limiting = words(wanted, f"{name}_limiting").spelled()
        assert np.mean(words(ours, f"{name}_limiting").spelled() == limiting) > 0.97  # ties may turn


def test_designs_vary_within_a_chunk_and_hang_on_nothing_else() -> None:
    study = Study(
        "rocker_bogie",
        STEEP,
        cases={"n": 9},
        vary={"x": "map", "y": "map", "yaw_deg": [0, 360], "parameters": {"track": [1.0, 1.4]}},
        measures=["tip"],
    )
    assert_same_bits(study.run(), study.run(chunk=4))
    ours, wanted = Runner(study.plan.job).run((0, 9)), plainly(Runner(study.plan.job), 9)
    np.testing.assert_allclose(ours["tip"], wanted["tip"], rtol=0, atol=1e-8)


def test_a_terrain_of_python_goes_the_plain_way() -> None:
    terrain = Terrain.from_function(lambda x, y: 0.05 * np.sin(x) + 0.0 * y)
    study = Study("rocker_bogie", terrain, cases={"n": 2}, vary={"x": [0, 1], "y": 0}, measures=["tip"])
    assert Runner(study.plan.job).compiled is None
    assert study.run().attrs["plain_path_cases"] == 2
