"""YAML read as nodes, and what no file of ours says: a key twice, a circle, more by aliases than it holds."""

from __future__ import annotations

import re
from typing import Any

import yaml

LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # the same, compiled, where there is one

_NUMBERS = ("tag:yaml.org,2002:int", "tag:yaml.org,2002:float")
_MOST = 1_000_000  # nodes, aliases followed
_DEEPEST = 60
_OLD = re.compile(r"[-+]?(0[0-7]+|[0-9][0-9_]*(:[0-5]?[0-9])+(\.[0-9_]*)?|[0-9][0-9_]*_[0-9_.]*)")


class RefusedError(Exception):
    """What a text says that no file of ours does.

    Attributes:
        what, cure: clauses for people.
        line: from 1, or None.
        path: keys and places down to it.
    """

    def __init__(
        self, what: str, cure: str, line: int | None = None, path: tuple[str | int, ...] = ()
    ) -> None:
        super().__init__(what)
        self.what, self.cure, self.line, self.path = what, cure, line, path


def read_yaml(text: str) -> tuple[Any, yaml.Node | None]:
    """The data of a YAML text, and its nodes for line numbers. Read safely: no tags run code.

    Raises:
        RefusedError: not YAML, or something that this module refuses.
    """
    loader = LOADER(text)
    try:
        node = loader.get_single_node()
        _check(node, (), set(), {})
        return (None if node is None else loader.construct_document(node)), node
    except yaml.YAMLError as problem:
        mark = getattr(problem, "problem_mark", None)
        why = getattr(problem, "problem", None) or str(problem)
        line = None if mark is None else min(mark.line, text.count("\n")) + 1
        raise RefusedError(f"not YAML: {why}", "check indentation, colons and brackets", line) from problem
    except RecursionError as problem:
        raise RefusedError("nested too deeply", f"at most {_DEEPEST} levels") from problem
    except (ValueError, OverflowError) as problem:  # a date that is none, a number of thousands of digits
        cure = "put words in quotes, and numbers in SI units"
        raise RefusedError(f"not YAML: {problem}", cure) from problem


def _check(node: Any, path: tuple[str | int, ...], above: set[int], sizes: dict[int, int]) -> int:
    """How many nodes stand at and below one, aliases followed; each is walked once."""
    if node is None:
        return 0
    own, line = id(node), getattr(node.start_mark, "line", 0) + 1
    if own in above:
        raise RefusedError("an alias of itself", "write it out", line, path)
    if own in sizes:
        return sizes[own]
    if len(above) > _DEEPEST:
        raise RefusedError("nested too deeply", f"at most {_DEEPEST} levels", line)
    above.add(own)
    size = 1
    if isinstance(node, yaml.MappingNode):
        seen: dict[str, int] = {}
        for key, value in node.value:
            at = key.start_mark.line + 1
            if not isinstance(key, yaml.ScalarNode):
                raise RefusedError("a key that is no name", "write key: value", at, path)
            if key.value in seen:
                what = f"stated twice, first in line {seen[key.value]}"
                raise RefusedError(what, "keep one", at, (*path, key.value))
            seen[key.value] = at
            size += 1 + _check(value, (*path, key.value), above, sizes)
    elif isinstance(node, yaml.SequenceNode):
        for i, value in enumerate(node.value):
            size += _check(value, (*path, i), above, sizes)
    elif node.tag in _NUMBERS and _OLD.fullmatch(node.value):
        # octal, base 60, or digits in groups
        what = f"{node.value!r} is another number to YAML than it looks"
        raise RefusedError(what, "write plain digits, or quotes around a name", line, path)
    if size > _MOST:
        raise RefusedError("more by aliases than a file holds", "write it out", line, path)
    above.discard(own)
    sizes[own] = size
    return size
