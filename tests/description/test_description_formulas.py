"""Numbers of a sidecar as formulas of its parameters."""

import math
import pickle

import numpy as np
import pytest

import rover_pin as rp
from rover_pin.description.formulas import Formula, FormulaError
from rover_pin.description.sidecar import read_sidecar
from rover_pin.description.trace import Trace
from rover_pin.description.trace_values import evaluate
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


def test_a_formula_is_arithmetic():
    formula = Formula(" -sqrt(a**2 + b) * cos(pi / 3) + max(a, 2) ")
    assert formula.names == {"a", "b", "pi"}
    assert formula.value({"a": 3.0, "b": 7.0}) == pytest.approx(-4.0 * 0.5 + 3.0, abs=1e-15)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("7 // 2 + 7 % 4", 6.0),
        ("+a - -1", 4.0),
        ("1 / 2 * radians(180)", math.pi / 2),
        ("math.atan2(1, -1) + hypot(a, 4)", 0.75 * math.pi + 5.0),
        ("round(10 / 3, 2) + int(-2.7) + floor(-2.1) + ceil(2.1) + round(2.5)", 3.33 - 2.0 - 3.0 + 3.0 + 2.0),
        ("a if 1 < a <= 3 and not a == 2 else -a", 3.0),
        ("1 if a > 5 or a != 3 else 2", 2.0),
        ("min(a, 2, 1) + abs(-a) + float(a > 2)", 5.0),
        ("e**0 + tau - 2 * pi", 1.0),
    ],
)
def test_a_formula_is_what_python_makes_of_it(text, value):
    assert Formula(text).value({"a": 3.0}) == pytest.approx(value, abs=1e-15)


def test_a_parameter_hides_a_constant_of_its_name():
    assert Formula("2 * e").value({"e": 5.0}) == 10.0


@pytest.mark.parametrize(
    "text",
    [
        "__import__('os')",
        "a.b",
        "[1]",
        "lambda: 1",
        "'a'",
        "a[0]",
        "f(1)",
        "a := 1",
        "(1, 2)",
        "True",
        "1j",
        "[x for x in a]",
        "max(*a)",
        "round(a, ndigits=1)",
        "math.sys",
        "abs()",
        "a @ b",
        "a in b",
        "a;b",
        "",
        "(" * 3000 + ")" * 3000,
        "-" * 20000 + "1",
        "a.__class__",
        "{a}",
        "sin",
    ],
)
def test_a_formula_runs_no_code(text):
    with pytest.raises(FormulaError):
        Formula(text).value({"a": 1.0, "b": 1.0})


@pytest.mark.parametrize("text", ["9**9**9**9", "int(9)**int(9)**int(9)", "1e308 * 10", "gamma(a * 1e6)"])
def test_a_power_without_end_ends(text):
    with pytest.raises(FormulaError, match="no finite value"):
        Formula(text).value({"a": 1.0})


@pytest.mark.parametrize(
    "text", ["k * 2 + sin(k)", "k**2 / (k - 1) if k > 1 else 0", "round(k, 1) // 0.3 % 2", "min(k, 3) + pi"]
)
def test_a_traced_formula_gives_the_same_bits_for_many(text):
    formula = Formula(text)
    trace = Trace(("k",))
    left = formula.value({"k": trace.parameter("k", 2.5)})
    numbers = np.linspace(1.5, 4.0, 11)
    found = evaluate(trace, {"k": numbers}, [left.index])
    assert found.valid.all()
    assert found.numbers[left.index].tolist() == [formula.value({"k": k}) for k in numbers.tolist()]


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
        (
            'springs: [{name: s, joint: a, stiffness: "${kk}"}]',
            "no parameter kk (got '${kk}'); did you mean 'k'?",
        ),
        (
            'springs: [{name: s, joint: a, stiffness: "${k +}"}]',
            "not a formula (got '${k +}'); write numbers, param",
        ),
        (
            'springs: [{name: s, joint: a, stiffness: "${sinus(k)}"}]',
            "no function sinus (got '${sinus(k)}'); did you mean 'sin",
        ),
        ('springs: [{name: s, joint: a, stiffness: "${atan2(k)}"}]', "atan2 takes other arguments"),
        (
            'springs: [{name: s, joint: a, stiffness: "${k / 0}"}]',
            "no finite value (got '${k / 0}'); check it at k = 40",
        ),
        (
            'springs: [{name: s, joint: a, stiffness: "-${k}"}]',
            "a formula is only part of the text (got '-${k}'); put all",
        ),
        ('springs: [{name: s, joint: a, stiffness: "${k}${k}"}]', "a formula is only part of the text"),
        ('springs: [{name: "${k}", joint: a, stiffness: 1}]', "springs[0].name: not a name"),
        ('springs: [{name: s, joint: a, stiffness: "${(-k)**0.5}"}]', "no finite value"),
        ('springs: [{name: s, joint: a, stiffness: "${(-k)**0.5 < 1}"}]', "no finite value"),
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
    with pytest.raises(
        SidecarError, match=r"parameters\.r: one\.urdf .* and no formula of the sidecar uses it"
    ):
        rp.load(tmp_path / "one.urdf")


def test_xacro_and_sidecar_share_parameters(tmp_path):
    head = '<robot name="one" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="m" default="1"/>'
    text = URDF.replace('<robot name="one">', head).replace('value="2"', 'value="$(arg m)"')
    (tmp_path / "one.urdf.xacro").write_text(text)
    head = "schema: 1\nparameters: {m: {default: 3}, k: {default: 2}%s}\n"
    spring = "springs:\n  - name: s\n    joint: arm\n    stiffness: ${k * m}\n"
    (tmp_path / "rover.yaml").write_text(head % "" + spring)
    rover = rp.load(tmp_path / "one.urdf.xacro", m=5)
    assert (rover.mass, rover.springs[0].stiffness) == (6.0, 10.0)
    assert rover.recipe.sidecar_text == head % "" + spring
    (tmp_path / "rover.yaml").write_text(head % ", kk: {default: 1}" + spring)
    with pytest.raises(SidecarError) as found:
        rp.load(tmp_path / "one.urdf.xacro")
    assert str(found.value) == (
        f"{tmp_path}/rover.yaml: parameters.kk: no <xacro:arg> of that name in one.urdf.xacro, "
        "and no formula of the sidecar uses it; known: m"
    )
