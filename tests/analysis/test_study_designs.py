"""Parameters that vary: every case a design of its own, without the files where the work is done."""

import pickle
import shutil
from pathlib import Path

import numpy as np

import rover_pin
from rover_pin.analysis import Study

ROBOT = Path(rover_pin.__file__).parent / "urdf"


def test_designs_are_answered_where_their_files_are_not(tmp_path):
    for name in ("rocker_bogie", "solids.xacro"):
        copy = shutil.copytree if (ROBOT / name).is_dir() else shutil.copy
        copy(ROBOT / name, tmp_path / name)
    study = Study(
        tmp_path / "rocker_bogie" / "rocker_bogie.urdf.xacro",
        {"rough": {"seed": 1, "rms": 0.05, "hurst": 0.8, "size": 8}},
        cases={"n": 64},
        vary={"x": "map", "y": "map", "parameters": {"track": [1.0, 1.4], "com_x": 0.01}},
        measures=["tip"],
    )
    here = study.run()
    travelled = pickle.dumps(study.plan.job)
    shutil.rmtree(tmp_path / "rocker_bogie")
    away = pickle.loads(travelled).runner().run((0, 64))
    np.testing.assert_array_equal(away["z_m"], here["z_m"].values)
    np.testing.assert_array_equal(away["tip"], here["tip"].values)
    assert here.attrs["plain_path_cases"] == 0
