"""Traced numbers and texts, against Python's own evaluation and xacro run anew."""

import math
import textwrap

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import rover_pin as rp
from rover_pin.description.trace import TOKEN, Trace, UntraceableError
from rover_pin.description.trace_expand import trace_expansion
from rover_pin.description.trace_functions import traced_symbols
from rover_pin.description.trace_values import evaluate

SYMBOLS = {"min": min, "max": max, "abs": abs, "float": float, "int": int, "round": round, **vars(math)}

leaves = st.sampled_from(["x", "y", "2", "0.5", "3"])
expressions = st.recursive(
    leaves,
    lambda inner: st.one_of(
        st.tuples(inner, st.sampled_from(["+", "-", "*", "/", "//", "%"]), inner).map(
            lambda t: f"({t[0]} {t[1]} {t[2]})"
        ),
        inner.map(lambda e: f"({e})**2"),
        inner.map(lambda e: f"-({e})"),
        st.tuples(
            st.sampled_from(["sqrt", "sin", "atan", "abs", "floor", "radians", "float", "int"]), inner
        ).map(lambda t: f"{t[0]}({t[1]})"),
        st.tuples(st.sampled_from(["min", "max", "atan2", "hypot"]), inner, inner).map(
            lambda t: f"{t[0]}({t[1]}, {t[2]})"
        ),
    ),
    max_leaves=8,
)


def plain(expression, x, y):
    """Python's result, or None where it has none that is real."""
    try:
        value = eval(expression, {**SYMBOLS, "x": x, "y": y})
    except (ArithmeticError, ValueError):
        return None
    return None if isinstance(value, complex) else float(value)


@settings(max_examples=150, deadline=None)
@given(
    expressions,
    st.lists(st.floats(-3, 3), min_size=4, max_size=4),
    st.lists(st.floats(-3, 3), min_size=4, max_size=4),
)
def test_a_trace_gives_pythons_bits(expression, xs, ys):
    trace = Trace(("x", "y"))
    known = {"x": trace.parameter("x", 1.25), "y": trace.parameter("y", 0.75)}
    try:
        result = eval(expression, {**traced_symbols(SYMBOLS), **known})
    except (ArithmeticError, ValueError):
        return  # nor does the nominal design exist
    if not hasattr(result, "index"):
        return  # a constant
    out = evaluate(trace, {"x": np.array(xs), "y": np.array(ys)}, [result.index])
    for i, (x, y) in enumerate(zip(xs, ys, strict=True)):
        wanted = plain(expression, x + 0.0, y + 0.0)
        if wanted is None:
            assert not out.valid[i]
        elif out.valid[i]:
            got = out.numbers[result.index][i]
            assert got == wanted or (math.isnan(got) and math.isnan(wanted))
        else:
            assert math.isinf(wanted) or "int" in expression or "floor" in expression


def test_guards_leave_out_designs_that_go_another_way():
    trace = Trace(("x",))
    x = trace.parameter("x", 2.0)
    y = x * 3 if x > 1 else x + 1
    out = evaluate(trace, {"x": np.array([1.5, 0.5, 1.0])}, [y.index])
    assert out.valid.tolist() == [True, False, False]
    assert out.numbers[y.index][0] == 4.5


def test_equal_operations_are_one_node():
    trace = Trace(("x",))
    x = trace.parameter("x", 2.0)
    assert (x * 2 + 1).index == (x * 2 + 1).index
    assert (x + 1).index != (x + 1.0).index  # they are written otherwise


XACRO = """
<robot name="bot" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="a" default="2"/>
  <xacro:arg name="b" default="0.5"/>
  <xacro:property name="a" value="$(arg a)"/>
  <xacro:property name="b" value="$(arg b)"/>
  {body}
  <link name="base"><inertial><origin xyz="{xyz}"/><mass value="1"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
</robot>
"""
SIDECAR = "schema: 1\nparameters: {a: {default: 2}, b: {default: 0.5}}\n"


def load(folder, body="", xyz="0 0 0"):
    (folder / "bot.urdf.xacro").write_text(textwrap.dedent(XACRO.format(body=body, xyz=xyz)))
    (folder / "rover.yaml").write_text(SIDECAR)
    return rp.load(folder / "bot.urdf.xacro")


def property_of(value):
    return f'<xacro:property name="p" value="{value}"/>'


GOOD = {
    "an argument in an expression": ("", "${$(arg a)/2 + b} 0 0"),
    "a sign before an argument": (property_of("-$(arg b)"), "${p*2} -$(arg b) 0"),
    "pieces of text": (property_of("${a} 0"), "${p} 1"),
    "a list": (
        property_of("${[a, b, 1]}"),
        "${p[0]} ${p[1]} ${p[:2][1]}",
    ),
    "a dictionary": (property_of("${dict(x=a, y=b)}"), "${p['x']} ${p['y']} 0"),
    "min, max, abs of the name spaces": ("", "${python.min(a, b)} ${python.abs(-a)} ${math.sqrt(b)}"),
    "an argument's text as a number": ("", "${float(xacro.arg('b')) * a} 0 0"),
    "a formatted text": ("", "${'%s %s' % (a, b)} 0"),
    "a condition": ('<xacro:if value="${a &gt; 1}">' + property_of("${b}") + "</xacro:if>", "${p} 0 0"),
    "an argument as a condition": (
        '<xacro:if value="$(arg a)">' + property_of("1") + "</xacro:if>",
        "${p} 0 ${b}",
    ),
    "a macro's default": (
        '<xacro:macro name="m" params="w:=${2*a} v:=^|1">'
        '<xacro:property name="p" value="${w+v}" scope="parent"/></xacro:macro><xacro:m/>',
        "${p} 0 ${b}",
    ),
    "an argument's default": ('<xacro:arg name="c" default="${a+b}"/>', "$(arg c) 0 0"),
    "round, int": ("", "${round(b, 1)} ${int(a)} ${round(a)}"),
}


@pytest.mark.parametrize("case", GOOD)
def test_texts_of_other_designs_are_xacros(tmp_path, case):
    rover = load(tmp_path, *GOOD[case])
    traced = trace_expansion(rover.recipe, ["a", "b"])
    designs = [(2.0, 0.5), (3.0, 0.25), (7.0, 0.125), (2.0, 1.75)]
    given = {"a": np.array([a for a, _ in designs]), "b": np.array([b for _, b in designs])}
    out = evaluate(traced.trace, given, range(len(traced.trace.nodes)))
    assert out.valid[0]
    for i, (a, b) in enumerate(designs):
        if out.valid[i]:
            text = TOKEN.sub(lambda found, i=i: repr(float(out.numbers[int(found[1])][i])), traced.text)
            expected = rover.with_parameters(a=a, b=b).recipe.text
            assert numbers(text) == numbers(expected)
    assert out.valid.sum() > (1 if "as a condition" not in case else 0)


def numbers(text):
    xyz = text.split('xyz="')[1].split('"')[0]
    return [float(part.replace("--", "")) for part in xyz.split()]


LOST = {
    "an index": (
        property_of("${[1, 2, 3, 4][a]}"),
        "a number that depends on a is used as an index or a count",
    ),
    "a count": (property_of("${([0] * a)[0]}"), "a number that depends on a is used as an index or a count"),
    "a key": (property_of("${dict([(2, 1)])[a]}"), "a number that depends on a is used as a key"),
    "digits": (property_of("${'%.3f' % b}"), "a number that depends on b is turned into a plain number"),
    "a type": (
        property_of("${1 * python.isinstance(a, int)}"),
        "isinstance() of a number that depends on a is not followed",
    ),
    "a function": (
        property_of("${1 * isfinite(a*b)}"),
        "isfinite() of a number that depends on a, b is not followed",
    ),
    "a compared text": (
        property_of("${1 * ('$(arg a)' == '6')}"),
        "a text in which a stands is compared, looked into or handed on",
    ),
    "a compared property": (
        '<xacro:property name="t" value="w $(arg a)"/>' + property_of("${1 if t == 'w 6' else 2}"),
        "a text in which a stands is compared, looked into or handed on",
    ),
    "a split text": (
        '<xacro:property name="t" value="w $(arg a)"/>' + property_of("${t.split()[1]}"),
        "a text in which a stands is compared, looked into or handed on",
    ),
    "a written number": (
        property_of("${len(str(a))}"),
        "a text in which a stands is compared, looked into or handed on",
    ),
    "a property's name": (
        '<xacro:property name="q_$(arg a)" value="1"/>' + property_of("1"),
        "a property is named by a",
    ),
    "a file's name": (
        '<xacro:include filename="part_$(arg a)*.xacro"/>' + property_of("1"),
        "a file is named by a",
    ),
    "a text's letters": (
        '<xacro:property name="t" value="w $(arg a)"/>' + property_of("${[*t][2]}"),
        "a text in which a stands is compared, looked into or handed on",
    ),
    "an argument's text in a function": (
        property_of("${int(xacro.arg('a'))}"),
        "a text in which a stands is compared, looked into or handed on",
    ),
    "eval": (property_of("$(eval a * 2)"), "$(eval ...) asks for a, which is not followed there"),
    "a made name": (property_of("${pi + a$(arg a)}"), "a name is made with the value of a"),
}


@pytest.mark.parametrize("case", LOST)
def test_what_would_lose_the_trace_is_refused(tmp_path, case):
    body, reason = LOST[case]
    if case == "a made name":
        body = '<xacro:property name="a2" value="1"/>' + body
    rover = load(
        tmp_path, body, "${p} 0 0" if case not in ("a property's name", "a file's name") else "1 0 0"
    )
    with pytest.raises(UntraceableError) as caught:
        trace_expansion(rover.recipe, ["a", "b"])
    assert reason in str(caught.value)
    assert "bot.urdf.xacro" in str(caught.value)
    assert rp.load(rover.source).recipe.text == rover.recipe.text  # xacro is left as it was


def test_a_negative_power_of_a_pasted_argument_is_a_guard(tmp_path):
    rover = load(tmp_path, "", "${$(arg b)**2} 0 0")  # of -1 xacro makes -1**2 = -1
    trace = trace_expansion(rover.recipe, ["b"]).trace
    out = evaluate(trace, {"b": np.array([0.5, -1.0])}, range(len(trace.nodes)))
    assert out.valid.tolist() == [True, False]


def test_files_that_changed_since_are_refused(tmp_path):
    rover = load(tmp_path, "", "${a} 0 0")
    path = tmp_path / "bot.urdf.xacro"
    path.write_text(path.read_text().replace("${a} 0 0", "${a} 0 1"))
    with pytest.raises(UntraceableError, match="xacro's text is another than the one loaded"):
        trace_expansion(rover.recipe, ["a"])


def test_an_unknown_parameter_is_refused(tmp_path):
    rover = load(tmp_path)
    with pytest.raises(UntraceableError, match="parameter c: no parameter of that name"):
        trace_expansion(rover.recipe, ["c"])
    with pytest.raises(UntraceableError, match="no parameter varies"):
        trace_expansion(rover.recipe, [])
