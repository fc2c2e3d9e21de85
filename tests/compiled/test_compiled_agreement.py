"""The compiled path against the plain path: status, reason, pose, loads, measures, on every rover."""

from pathlib import Path

import numpy as np
import pytest

import rover_pin as rp
from rover_pin.compiled import COMPILED_MEASURES, OPEN, Batch
from rover_pin.description.sidecar import read_sidecar

FIXTURES = Path(__file__).parents[1] / "fixtures"
OTHERS = sorted(folder.name for folder in FIXTURES.iterdir())
BUNDLED = ["rocker_bogie", "hit_mrii"]
LINEAR = rp.Terrain.rough(4, 0.05, 0.8, size=12, interpolation="linear")
GROUNDS = {
    "moderate": rp.Terrain.rough(1, 0.05, 0.8, size=12),
    "jagged": rp.Terrain.rough(2, 0.065, 0.5, size=12),
    "high": rp.Terrain.rough(3, 0.22, 0.8, size=12),
    "slope": rp.Terrain.slope(9, 30),
    "flat": rp.Terrain.flat(),
}


def loaded(name):
    if name in BUNDLED:
        return rp.load(name)
    return rp.load(next((FIXTURES / name).glob("*.urdf")))


def places(count, seed=0, reach=5.8):
    rng = np.random.default_rng(seed)
    return *rng.uniform(-reach, reach, (2, count)), rng.uniform(0.0, 2.0 * np.pi, count)


def compare(rover, terrain, count):
    """Every answer of a batch against `settle`; how many were left open."""
    x, y, yaw = places(count)
    measures = COMPILED_MEASURES if rover.belly else COMPILED_MEASURES[:-1]
    answers = Batch(rover, terrain, measures=measures).answer(x, y, yaw)
    status, reason = answers.words()
    tables = {name: answers.labelled(name) for name in measures}
    for i in np.flatnonzero(answers.code != OPEN):
        stance = rp.settle(rover, terrain, x=x[i], y=y[i], yaw=yaw[i])
        assert (status[i], reason[i]) == (str(stance.status), stance.reason)
        if not stance.settled:
            assert np.isnan(answers.z_m[i])
            assert np.isnan(answers.load_n[i]).all()
            continue
        check_pose(answers, i, stance, rover)
        for name, margin in rp.stability(stance, measures).items():
            names, table, limiting = tables[name]
            assert answers.value[name][i] == pytest.approx(margin.value, rel=1e-6, abs=1e-7)
            assert {names[k] for k in np.flatnonzero(np.isfinite(table[i]))} == set(margin.edges)
            for edge, value in margin.edges.items():
                assert table[i, names.index(edge)] == pytest.approx(value, rel=1e-6, abs=1e-7)
            if margin.limiting is None:
                assert limiting[i] == -1
            else:
                named = margin.edges[names[limiting[i]]]
                assert named == pytest.approx(margin.value, rel=1e-6, abs=1e-7)
    return int(np.sum(answers.code == OPEN))


def check_pose(answers, i, stance, rover):
    assert answers.z_m[i] == pytest.approx(stance.position[2], abs=1e-8)
    assert answers.roll_rad[i] == pytest.approx(stance.rpy[0], abs=1e-8)
    assert answers.pitch_rad[i] == pytest.approx(stance.rpy[1], abs=1e-8)
    np.testing.assert_allclose(answers.joint_rad[i], [stance.joints[j] for j in rover.joints], atol=1e-8)
    np.testing.assert_allclose(answers.load_n[i], list(stance.loads.values()), atol=1e-5)
    assert answers.redundant[i] == stance.redundant
    for name in ("equilibrium", "gap_m", "loop_m", "complementarity"):
        assert getattr(answers, name)[i] <= 1e-8


@pytest.mark.parametrize("ground", GROUNDS)
@pytest.mark.parametrize("name", BUNDLED)
def test_bundled_rovers_as_on_the_plain_path(name, ground):
    left = compare(loaded(name), GROUNDS[ground], 40)
    assert left <= (6 if ground == "high" else 0)


@pytest.mark.parametrize("ground", ["moderate", "slope"])
@pytest.mark.parametrize("name", OTHERS)
def test_fixture_rovers_as_on_the_plain_path(name, ground):
    left = compare(loaded(name), GROUNDS[ground], 15)
    if name not in ("caster3", "rigid4", "trailing4"):
        assert left == 0


@pytest.mark.parametrize("name", ["rocker_bogie", "four_bar"])
def test_bilinear_maps_as_on_the_plain_path(name):
    compare(loaded(name), LINEAR, 15)


def test_a_step_as_on_the_plain_path():
    compare(loaded("rocker_bogie"), rp.Terrain.step(0.08, 0.3), 20)


@pytest.mark.parametrize("posture", ["raised", "lowered", "crab", {"clearance": 0.4}])
def test_postures_as_on_the_plain_path(posture):
    rover, terrain = loaded("hit_mrii"), GROUNDS["moderate"]
    x, y, yaw = places(10, reach=4.5)
    answers = Batch(rover, terrain).answer(x, y, yaw, postures=[posture])
    assert np.all(answers.code != OPEN)
    for i in range(10):
        stance = rp.settle(rover, terrain, x=x[i], y=y[i], yaw=yaw[i], posture=posture)
        if stance.settled:
            check_pose(answers, i, stance, rover)


def test_held_joints_vary_case_by_case():
    rover, terrain = loaded("hit_mrii"), GROUNDS["moderate"]
    x, y, yaw = places(20, reach=4.5)
    rng = np.random.default_rng(5)
    joints = {"L_act": rng.uniform(-0.2, 0.6, 20), "R_act": rng.uniform(-0.2, 0.6, 20)}
    joints |= {"LF_st": rng.uniform(-1.0, 1.0, 20)}
    answers = Batch(rover, terrain).answer(x, y, yaw, joints=joints)
    assert np.all(answers.code != OPEN)
    for i in np.flatnonzero(answers.settled):
        given = {name: float(values[i]) for name, values in joints.items()}
        check_pose(answers, i, rp.settle(rover, terrain, x=x[i], y=y[i], yaw=yaw[i], joints=given), rover)


@pytest.mark.parametrize("name", BUNDLED)
def test_every_parameter_varies_case_by_case(name):
    rover, terrain = loaded(name), GROUNDS["moderate"]
    x, y, yaw = places(10, reach=4.0)
    rng = np.random.default_rng(6)
    bounds = read_sidecar(rover.recipe.sidecar_text, rover.sidecar_path).parameters
    parameters = {}
    for key, spec in bounds.items():
        near = 0.1 * (spec.bounds[1] - spec.bounds[0])
        parameters[key] = np.clip(spec.default + rng.uniform(-near, near, 10), *spec.bounds)
    answers = Batch(rover, terrain, measures=["tip"]).answer(x, y, yaw, parameters=parameters)
    assert np.sum(answers.code == OPEN) <= 2
    for i in np.flatnonzero(answers.settled):
        design = rover.with_parameters(**{key: float(values[i]) for key, values in parameters.items()})
        stance = rp.settle(design, terrain, x=x[i], y=y[i], yaw=yaw[i])
        check_pose(answers, i, stance, design)
        assert answers.value["tip"][i] == pytest.approx(rp.stability(stance, ["tip"])["tip"].value, abs=1e-7)


def test_locks_gravity_and_payload_as_on_the_plain_path():
    rover = loaded("hit_mrii").with_payload([(20.0, (0.2, 0.1, 0.3))])
    terrain = GROUNDS["moderate"]
    x, y, yaw = places(10, reach=4.5)
    answers = Batch(rover, terrain, gravity=3.71, locks=["L_bogie"]).answer(x, y, yaw)
    assert np.any(answers.code != OPEN)
    for i in np.flatnonzero(answers.code != OPEN):
        stance = rp.settle(rover, terrain, x=x[i], y=y[i], yaw=yaw[i], gravity=3.71, locks=["L_bogie"])
        if stance.settled:
            check_pose(answers, i, stance, rover)
            assert np.sum(answers.load_n[i]) == pytest.approx(rover.mass * 3.71, rel=1e-9)


def test_auxiliary_wheels_as_on_the_plain_path(tmp_path):
    folder = FIXTURES / "bogie_min"
    sidecar = tmp_path / "rover.yaml"
    sidecar.write_text((folder / "rover.yaml").read_text().replace("free: true", "auxiliary: true"))
    rover = rp.load(next(folder.glob("*.urdf")), sidecar=sidecar)
    assert rover.bearing == (1, 2, 3, 4)
    compare(rover, GROUNDS["moderate"], 12)
