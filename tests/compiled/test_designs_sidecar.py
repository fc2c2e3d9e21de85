"""Designs whose numbers stand in the sidecar alone, against rovers that the loader makes one by one."""

import pickle
from pathlib import Path

import numpy as np
import pytest

import rover_pin as rp
from rover_pin.compiled import SETTLED, Batch
from rover_pin.compiled.designs import Designs, difference
from rover_pin.compiled.machine import machine_of, pick
from rover_pin.description.sidecar import read_sidecar
from rover_pin.errors import InputError

FIXTURES = Path(__file__).parents[1] / "fixtures"
ROUGH = rp.Terrain.rough(3, 0.03, 0.8, size=10)


def with_sidecar(folder, name, sidecar):
    """A fixture's URDF with another sidecar."""
    text = (FIXTURES / name / f"{name}.urdf").read_text()
    (folder / f"{name}.urdf").write_text(text)
    (folder / "rover.yaml").write_text(f"schema: 1\n{sidecar}")
    return rp.load(folder / f"{name}.urdf")


CORNERS = ("fl", "fr", "bl", "br")

SPRUNG = """
springs:
""" + "".join(
    f'  - {{name: s_{c}, joint: slide_{c}, stiffness: "${{stiffness}}", rest: "${{rest}}", '
    f'preload: "${{{"lift" if c[0] == "f" else "-lift"}}}"}}\n'
    for c in CORNERS
) + """
wheels:
""" + "".join(
    f'  - {{name: {c}, frame: wheel_{c}, radius: "${{{"radius" if c[0] == "f" else "0.9 * radius"}}}", '
    'width: 0.1, tread: "${radius / 4}"}\n'
    for c in CORNERS
) + """
inertials: {base_link: {mass: "${mass}", com: ["${ahead}", 0, 0.1]}}
belly: [{frame: base_link, point: [0, 0, "${-ahead}"]}]
parameters:
  stiffness: {default: 4000, unit: N/m, bounds: [2500, 9000]}
  rest: {default: 0.01, bounds: [-0.02, 0.02]}
  lift: {default: 5, unit: N, bounds: [-20, 20]}
  radius: {default: 0.15, unit: m, bounds: [0.1, 0.2]}
  mass: {default: 40, unit: kg, bounds: [20, 60]}
  ahead: {default: 0.03, unit: m, bounds: [-0.1, 0.1]}
"""  # fmt: skip

FOUR_BAR = """
loops:
  - {name: leg_l, frames: [{link: knuckle_link_l, xyz: [0, 0, "${-gap}"]},
     {link: lower_link_l, xyz: ["${bar}", 0, 0]}], type: planar, axis: [0, "${gap}", 0]}
  - {name: leg_r, frames: [{link: knuckle_link_r, xyz: [0, 0, "${-gap}"]},
     {link: lower_link_r, xyz: ["${bar}", 0, 0]}], type: planar, axis: [0, 1, 0]}
couplings:
  - {name: swing, joints: {upper_l: 1, upper_r: "${gear}"}, offset: "${turn}"}
actuated: [drive_bl, drive_fl, drive_br, drive_fr]
wheels:
  - {name: bl, frame: wheel_bl, radius: 0.15, width: 0.1, tread: 0.03}
  - {name: fl, frame: wheel_fl, radius: 0.15, width: 0.1, tread: 0.03}
  - {name: br, frame: wheel_br, radius: 0.15, width: 0.1, tread: 0.03}
  - {name: fr, frame: wheel_fr, center: [0, "${-turn}", 0], radius: 0.15, width: 0.1, tread: 0.03}
parameters:
  gap: {default: 0.12, bounds: [0.11, 0.13]}
  bar: {default: 0.3, bounds: [0.29, 0.31]}
  gear: {default: 1, bounds: [0.8, 1.25]}
  turn: {default: 0, bounds: [-0.05, 0.05]}
"""


def drawn(rover, n, names=None, seed=0):
    rng = np.random.default_rng(seed)
    declared = read_sidecar(rover.recipe.sidecar_text, "rover.yaml").parameters
    return {name: rng.uniform(*declared[name].bounds, n) for name in names or declared}


def agree(rover, values, terrain, x, y, yaw):
    """Batch over designs against settle of the loader's rovers: how many settled."""
    answers = Batch(rover, terrain).answer(x, y, yaw, parameters=values)
    settled = answers.code == SETTLED
    for i in np.flatnonzero(settled):
        made = rover.with_parameters(**{name: float(array[i]) for name, array in values.items()})
        stance = rp.settle(made, terrain, x=x[i], y=y[i], yaw=yaw[i])
        assert stance.status == "settled"
        loads = [stance.loads[name] for name in answers.wheels]
        np.testing.assert_allclose(answers.load_n[i], loads, atol=1e-5)
        np.testing.assert_allclose(answers.z_m[i], stance.position[2], atol=1e-8)
        np.testing.assert_allclose(answers.joint_rad[i], list(stance.joints.values()), atol=1e-8)
        if stance.tensions:
            np.testing.assert_allclose(answers.tension_n[i], list(stance.tensions.values()), atol=1e-5)
    return int(settled.sum())


@pytest.mark.parametrize(("name", "sidecar"), [("sprung4", SPRUNG), ("four_bar", FOUR_BAR)])
def test_a_batch_over_designs_is_the_loaders_rovers_at_rest(tmp_path, name, sidecar):
    rover = with_sidecar(tmp_path, name, sidecar)
    rng = np.random.default_rng(1)
    x, y = rng.uniform(-3.5, 3.5, (2, 25))
    assert agree(rover, drawn(rover, 25), ROUGH, x, y, rng.uniform(0, 6, 25)) >= 22


def test_an_answer_hangs_on_its_design_alone_to_the_last_bit(tmp_path):
    rover = with_sidecar(tmp_path, "sprung4", SPRUNG)
    values = drawn(rover, 60, seed=2)
    x, y = np.random.default_rng(3).uniform(-3.5, 3.5, (2, 60))
    whole = Batch(rover, ROUGH).answer(x, y, x, parameters=values)
    for rows in ([7], [41, 3, 12]):
        part = Batch(rover, ROUGH).answer(
            x[rows], y[rows], x[rows], parameters={name: array[rows] for name, array in values.items()}
        )
        for field in ("code", "z_m", "load_n", "joint_rad", "gap_m"):
            np.testing.assert_array_equal(getattr(part, field), getattr(whole, field)[rows])


TRACKED = ("track_length", "front_arm_length", "stiffness", "preload_1", "length_max_3", "r1", "r3", "d5")


def test_tracks_of_designs_are_the_loaders():
    rover = rp.load("polibot_half")
    names = [name for name in TRACKED if name in rover.parameters]
    values = {n: rover.parameters[n] * np.linspace(0.98, 1.02, 9) for n in names}
    made = Designs(rover, names).machines(values)
    assert made.valid.sum() >= 5
    for i in np.flatnonzero(made.valid):
        loaded = rover.with_parameters(**{name: array[i] for name, array in values.items()})
        assert difference(pick(made.machine, slice(i, i + 1)), machine_of(loaded), 1e-12) == ""


def test_tracked_designs_at_rest():
    rover = rp.load("polibot_half")
    rng = np.random.default_rng(4)
    names = ["track_length", "stiffness", "preload_2", "r3"]
    values = {name: rover.parameters[name] * rng.uniform(0.99, 1.01, 8) for name in names}
    assert agree(rover, values, rp.Terrain.flat(), np.zeros(8), np.zeros(8), np.zeros(8)) >= 7


def test_a_trace_with_formulas_serves_without_the_files(tmp_path):
    rover = with_sidecar(tmp_path, "four_bar", FOUR_BAR)
    here = Designs(rover, ["gap", "turn"])
    values = drawn(rover, 4, here.names)
    wanted = here.machines(values)
    there = Designs(pickle.loads(pickle.dumps(rover)), here.names, pickle.loads(pickle.dumps(here.traced)))
    for path in tmp_path.iterdir():
        path.unlink()
    assert there.refusal == ""
    assert difference(there.machines(values).machine, wanted.machine, 0.0) == ""


WRONG = {
    "a radius": ('wheels: [{frame: wheel_fl, radius: "${b}", width: 0.1}]', 0.0, "not above 0"),
    "a tread": ('wheels: [{frame: wheel_fl, radius: 0.15, tread: "${b}"}]', 0.2, "tread is more than"),
    "a width": ('wheels: [{frame: wheel_fl, radius: 0.15, width: "${b}"}]', -1.0, "below 0"),
    "a wheel's axis": (
        'wheels: [{frame: wheel_fl, radius: 0.15, tread: 0.01, axis: ["${b}", 0, 0]}]', 0.0, "points nowhere",
    ),
    "a friction": ('contacts: [{frame: wheel_fl, friction: "${b}"}]', -0.1, "below 0"),
    "a stiffness": ('springs: [{name: s, joint: slide_fl, stiffness: "${b}"}]', -1.0, "below 0"),
    "a length": (
        'springs: [{name: s, frames: [wheel_fl, base_link], stiffness: 1, length_max: "${b}"}]', 0.0,
        "not above 0",
    ),
    "a coefficient": ('couplings: [{name: c, joints: {slide_fl: "${b}", slide_fr: 1}}]', 0.0, "not 0"),
    "a mass": ('inertials: {base_link: {mass: "${b}"}}', -1.0, "below 0"),
    "a moment": ('inertials: {base_link: {mass: 1, inertia: ["${b}", 1, 1, 0, 0, 0]}}', -1.0, "below 0"),
    "a loop's axis": (
        'loops: [{name: l, frames: [wheel_fl, wheel_fr], type: planar, axis: [0, 0, "${b}"]}]', 0.0,
        "`axis` is zero",
    ),
    "no value": ('belly: [{frame: base_link, point: [0, 0, "${1 / b}"]}]', 0.0, "no finite value"),
    "a root": ('belly: [{frame: base_link, point: [0, 0, "${b**0.5}"]}]', -1.0, "no finite value"),
    "a wheel inside another": (
        "wheels: [{frame: wheel_fl, radius: 0.1, tread: 0}, {frame: wheel_bl, radius: 0.1, tread: 0}]\n"
        'tracks: [{name: t, wheels: [wheel_fl, {wheel: wheel_bl, radius: "${b}"}], length: 3}]',
        3.0, "wheel_fl is swallowed by wheel_bl",
    ),
    "pulleys across": (
        "tracks: [{name: t, wheels: [{frame: base_link, radius: 0.1}, {frame: slide_fl, radius: 0.1}, "
        '{frame: wheel_fl, center: ["${b}", 0.3, 0.4], radius: 0.05}, '
        "{frame: slide_bl, center: [0, 0, 2], radius: 0.05}], length: 3}]",
        -0.8, "not in order around the loop",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
def test_a_design_that_is_no_rover_is_left_to_the_loader(tmp_path, case):
    sidecar, value, message = WRONG[case]
    rover = with_sidecar(tmp_path, "sprung4", f"{sidecar}\nparameters: {{b: {{default: 0.1}}}}\n")
    designs = Designs(rover, ["b"])
    assert designs.refusal == ""
    assert designs.machines({"b": [0.1, value, 0.12]}).valid.tolist() == [True, False, True]
    with pytest.raises(InputError, match=message):
        rover.with_parameters(b=value)


def test_a_choice_goes_the_nominal_way_or_to_the_loader(tmp_path):
    sidecar = 'wheels: [{frame: wheel_fl, width: 0.1, radius: "${0.1 if b < 1 else 0.2}"}]\n'
    rover = with_sidecar(tmp_path, "sprung4", f"{sidecar}parameters: {{b: {{default: 0.1}}}}\n")
    made = Designs(rover, ["b"]).machines({"b": [0.5, 2.0]})
    assert made.valid.tolist() == [True, False]
    assert rover.with_parameters(b=2.0).wheels[0].radius == 0.2


REFUSED = {
    "postures.home.slide_fl": 'postures: {home: {slide_fl: "${b}"}}',
    "up[1]": 'up: [0, "${b}", 1]',
    "couplings.a": 'couplings: [{name: a, joints: {slide_fl: 1, slide_fr: "${b}"}}, '
    "{name: c, joints: {slide_fr: 1, slide_fl: 10}}]",
}


@pytest.mark.parametrize("place", REFUSED)
def test_what_designs_do_not_follow_is_a_refusal_that_names_it(tmp_path, place):
    rover = with_sidecar(tmp_path, "sprung4", f"{REFUSED[place]}\nparameters: {{b: {{default: 0.1}}}}\n")
    assert place in Designs(rover, ["b"]).refusal
    assert rover.with_parameters(b=0.1).parameters == {"b": 0.1}
