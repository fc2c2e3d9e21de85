"""Xacro's expressions with traced numbers: evaluated as always, but no text with a token is taken for itself.

A token in a text stands for digits. Comparing such a text, looking into it or handing it to a function would
give an answer about the token, so every such place of an expression is rewritten to look for tokens first.
"""

from __future__ import annotations

import ast
import operator
from typing import Any

from rover_pin.description.trace import TOKEN, Trace, Traced

WHOLE = "traced_whole"
"""Name, in an expression's symbols, of the function that looks for tokens."""


class Expressions:
    """Evaluates the expressions of one traced run."""

    def __init__(self, trace: Trace) -> None:
        self.trace = trace

    def evaluate(self, text: str, symbols: Any, local: Any = None) -> Any:
        """What `xacro.safe_eval` does.

        Raises:
            UntraceableError: a text with a token would be taken for itself.
        """
        text = text.strip()
        outer, self.trace.place = self.trace.place, TOKEN.sub(self._shown, text)
        try:
            code = compile(text, "<expression>", "eval")
            hidden = [name for name in code.co_names if name.startswith("__")]
            if hidden:
                raise ValueError(f"Use of invalid name(s): {', '.join(hidden)}")
            tree = _Guarding(self.trace).visit(ast.parse(text, mode="eval"))
            symbols.update(__builtins__={})
            return eval(compile(ast.fix_missing_locations(tree), "<expression>", "eval"), symbols, local)
        finally:
            self.trace.place = outer

    def number(self, text: str) -> Traced | None:
        """The number that a text is: a token, with or without a sign before it."""
        bare = text.strip()
        sign = bare[:1] if bare[:1] in "+-" else ""
        found = TOKEN.fullmatch(bare[len(sign) :])
        if found is None:
            return None
        value = self.trace.of(int(found.group(1)))
        if not sign:
            return value
        self.trace.guard("ge", operator.ge, value, 0)  # "--1" is no number
        signed: Traced = -value if sign == "-" else value
        return signed

    def whole(self, value: Any) -> Any:
        """A value that holds no text with a token in it.

        Raises:
            UntraceableError: it does.
        """
        if isinstance(value, str):
            self.refuse(value, "a text in which {names} stands is compared, looked into or handed on")
        elif isinstance(value, (list, tuple, set, frozenset)):
            for part in value:
                self.whole(part)
        elif isinstance(value, dict):
            for key in value:
                self.whole(key)
                self.whole(dict.__getitem__(value, key))
        return value

    def refuse(self, text: str, what: str) -> None:
        """Nothing, where a text holds no token.

        Raises:
            UntraceableError: it does; `what` is the reason, `{names}` in it the parameters.
        """
        found = TOKEN.search(text)
        if found:
            self.trace.lose(what.format(names=self.trace.of(int(found.group(1))).trace_of()))

    def _shown(self, found: Any) -> str:
        return self.trace.of(int(found.group(1))).trace_of()


class _Guarding(ast.NodeTransformer):
    """Puts `traced_whole(...)` around what an expression compares, looks into or hands on."""

    def __init__(self, trace: Trace) -> None:
        self.trace = trace

    def visit_Compare(self, node: ast.Compare) -> ast.AST:
        self.generic_visit(node)
        node.left = _whole(node.left)
        node.comparators = [_whole(part) for part in node.comparators]
        return node

    def visit_Call(self, node: ast.Call) -> ast.AST:
        self.generic_visit(node)
        if isinstance(node.func, ast.Name) and node.func.id == "float":
            return node  # reads the number that a text is
        if isinstance(node.func, ast.Attribute):
            node.func.value = _whole(node.func.value)
        node.args = [part if isinstance(part, ast.Starred) else _whole(part) for part in node.args]
        for keyword in node.keywords:
            keyword.value = _whole(keyword.value)
        return node

    def visit_Subscript(self, node: ast.Subscript) -> ast.AST:
        self.generic_visit(node)
        node.value = _whole(node.value)
        if not isinstance(node.slice, ast.Slice):
            node.slice = _whole(node.slice)
        return node

    def visit_Starred(self, node: ast.Starred) -> ast.AST:
        self.generic_visit(node)
        node.value = _whole(node.value)
        return node

    def visit_comprehension(self, node: ast.comprehension) -> ast.AST:
        self.generic_visit(node)
        node.iter = _whole(node.iter)
        return node

    def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
        if isinstance(node.op, ast.Pow) and isinstance(node.left, ast.Name):
            found = TOKEN.fullmatch(node.left.id)
            if found:  # the text was put there as it stands: -1**2 is -(1**2)
                self.trace.guard("ge", operator.ge, self.trace.of(int(found.group(1))), 0)
        return self.generic_visit(node)

    def visit_Name(self, node: ast.Name) -> ast.AST:
        found = TOKEN.search(node.id)
        if found and found.group(0) != node.id:
            names = self.trace.of(int(found.group(1))).trace_of()
            self.trace.lose(f"a name is made with the value of {names}")
        return node


def _whole(node: ast.expr) -> ast.expr:
    return ast.Call(ast.Name(WHOLE, ast.Load()), [node], [])
