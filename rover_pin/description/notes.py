"""What the loader dropped, guessed or found suspect, told once each and in order."""

from __future__ import annotations


class Notes:
    """Sentences for `rover-pin info`; a repeated one is kept once."""

    def __init__(self) -> None:
        self._lines: dict[str, None] = {}

    def add(self, line: str) -> None:
        """Keep one sentence."""
        self._lines.setdefault(" ".join(line.split()), None)

    def many(self, names: list[str], one: str, several: str) -> None:
        """Keep one sentence for all `names`: `{name}` in `one`, `{n}` and `{names}` in `several`."""
        if len(names) == 1:
            self.add(one.format(name=names[0]))
        elif names:
            shown = ", ".join(names[:6]) + (", ..." if len(names) > 6 else "")
            self.add(several.format(n=len(names), names=shown))

    def lines(self) -> tuple[str, ...]:
        """All sentences, in the order they were told."""
        return tuple(self._lines)
