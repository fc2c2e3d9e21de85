"""What the loader dropped, guessed or found suspect, told once each and in order."""

from __future__ import annotations

from collections.abc import Iterable


class Notes:
    """Sentences for `rover-pin info`: each once, and alike ones of several elements as one."""

    def __init__(self, lines: Iterable[str] = ()) -> None:
        self._told: dict[tuple[str, str], dict[str, None]] = {(line, ""): {} for line in lines}

    def add(self, line: str) -> None:
        """Keep one sentence."""
        self._told.setdefault((" ".join(line.split()), ""), {})

    def each(self, name: str, one: str, several: str) -> None:
        """Keep a sentence about an element; told of several with the same words, they share one.

        Args:
            name: the element's.
            one: the sentence for a single one, with `{name}`.
            several: the sentence for more, with `{n}` and `{names}`.
        """
        self._told.setdefault((one, several), {})[name] = None

    def many(self, names: Iterable[str], one: str, several: str) -> None:
        """`each` for all `names`."""
        for name in names:
            self.each(name, one, several)

    def lines(self) -> tuple[str, ...]:
        """All sentences, in the order they were first told."""
        return tuple(_sentence(one, several, list(names)) for (one, several), names in self._told.items())


def _sentence(one: str, several: str, names: list[str]) -> str:
    if not several:
        return one
    if len(names) == 1:
        return one.format(name=names[0])
    shown = ", ".join(names[:6]) + (", ..." if len(names) > 6 else "")
    return several.format(n=len(names), names=shown)
