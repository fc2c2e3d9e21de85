"""Numbers of a sidecar as formulas of its parameters."""

import math
import pickle

import numpy as np
import pytest

import rover_pin as rp
from rover_pin.description.formulas import Formula, FormulaError
from rover_pin.description.sidecar import read_sidecar
from rover_pin.errors import SidecarError

HEAD = "schema: 1\nparameters: {k: {default: 40, bounds: [10, 90]}, r: {default: 0.2}}\n"

URDF = """<robot name="one">
  <link name="base_link"><inertial><mass value="2"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>
  </inertial></link>
  <joint name="arm" type="revolute"><parent link="base_link"/><child link="leg"/><axis xyz="0 1 0"/>
  <limit lower="-1" upper="1" effort="0" velocity="1"/></joint>
  <link name="leg"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>
  </inertial></link>
</robot>"""


def test_a_formula_is_arithmetic_on_numbers_and_arrays():
    formula = Formula(" -sqrt(a**2 + b) * cos(pi / 3) + max(a, 2) ")
    assert formula.names == {"a", "b"}
    assert formula.value({"a": 3.0, "b": 7.0}) == pytest.approx(-4.0 * 0.5 + 3.0, abs=1e-15)
    many = formula.value({"a": np.array([3.0, 0.0]), "b": 7.0})
    np.testing.assert_allclose(many, [1.0, -math.sqrt(7.0) / 2 + 2.0], atol=1e-15)


@pytest.mark.parametrize(
    "text", ["__import__('os')", "a.b", "[1]", "a if b else c", "lambda: 1", "'a'", "a[0]", "f(1)"]
)
def test_a_formula_runs_no_code(text):
    with pytest.raises(FormulaError):
        Formula(text).value({"a": 1.0, "b": 1.0, "c": 1.0})


def test_formulas_take_the_defaults_and_what_is_given():
    text = (
        HEAD
        + 'springs: [{name: s, joint: arm, stiffness: "${2 * k}"}]\nwheels: [{frame: w, radius: "${r}"}]\n'
    )
    silent = read_sidecar(text, "rover.yaml")
    assert silent.springs[0].stiffness == 80.0
    assert silent.wheels[0].radius == 0.2
    assert read_sidecar(text, "rover.yaml", {"k": 15.0}).springs[0].stiffness == 30.0


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ('springs: [{name: s, joint: a, stiffness: "${kk}"}]', "no parameter kk (got 'kk')"),
        ('springs: [{name: s, joint: a, stiffness: "${k +}"}]', "not a formula (got 'k +')"),
        ('springs: [{name: s, joint: a, stiffness: "${sinus(k)}"}]', "no function sinus"),
        ('springs: [{name: s, joint: a, stiffness: "${atan2(k)}"}]', "atan2 takes other arguments"),
        ('springs: [{name: s, joint: a, stiffness: "${k / 0}"}]', "the formula's value is not finite"),
        ('springs: [{name: s, joint: a, stiffness: "${-k}"}]', "below 0"),
        ("springs: [{name: s, joint: a, stiffness: ${k}}]", 'write formulas in quotes: "${...}"'),
    ],
)
def test_a_bad_formula_is_named_with_its_line(line, said):
    with pytest.raises(SidecarError) as found:
        read_sidecar(HEAD + line + "\n", "rover.yaml")
    assert "rover.yaml:3" in str(found.value)
    assert said in str(found.value)


def test_a_rover_takes_its_sidecars_numbers_from_its_parameters(tmp_path):
    (tmp_path / "one.urdf").write_text(URDF)
    (tmp_path / "rover.yaml").write_text(
        HEAD + 'springs: [{name: s, joint: arm, stiffness: "${k}", rest: "${r}"}]\n'
    )
    rover = rp.load(tmp_path / "one.urdf", k=50)
    assert (rover.springs[0].stiffness, rover.springs[0].rest) == (50.0, 0.2)
    assert rover.with_parameters(r=0.3).springs[0].rest == 0.3
    assert pickle.loads(pickle.dumps(rover)).springs[0].stiffness == 50.0
    (tmp_path / "rover.yaml").write_text(HEAD + 'springs: [{name: s, joint: arm, stiffness: "${k}"}]\n')
    with pytest.raises(SidecarError, match=r"parameters\.r: one\.urdf is plain URDF without arguments"):
        rp.load(tmp_path / "one.urdf")
