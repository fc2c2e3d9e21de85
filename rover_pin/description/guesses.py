"""Guesses of `rover-pin init` that nobody has taken over yet."""

from __future__ import annotations

import re

_WAITING = re.compile(r"^# +.*# guess: ", re.MULTILINE)


def guesses_waiting(text: str) -> int:
    """How many lines of a sidecar's text are guesses, still commented out."""
    return len(_WAITING.findall(text))


def cure_for_no_contact(text: str | None) -> str:
    """What to do about a robot that touches nothing, from its sidecar's text."""
    if text is not None and guesses_waiting(text):
        return "take `# ` away from its lines that are right: guesses of rover-pin init are not used before"
    if text is None:
        return "rover-pin init URDF writes a sidecar to start from"
    return "declare `wheels` (frame, radius, width) or `contacts` in it"
