"""The command line's words for terrain: `flat`, `slope:DEG`, `step:HEIGHT,X`, `rough:SEED,RMS,HURST`."""

from __future__ import annotations

from pathlib import Path

from rover_pin.errors import TerrainError, nearest

WORDS: dict[str, tuple[str, ...]] = {
    "flat": (),
    "slope": ("DEG",),
    "step": ("HEIGHT", "X"),
    "rough": ("SEED", "RMS", "HURST"),
}
"""Word: the numbers that follow its colon."""


def usage(word: str) -> str:
    """How a word is written, as `slope:DEG`."""
    return ":".join([word, ",".join(WORDS[word])]) if WORDS[word] else word


def split_word(text: str) -> tuple[str, list[float]] | None:
    """(word, numbers) where `text` is a terrain word, None where it must be a file.

    Raises:
        TerrainError: a known word with the wrong numbers, or neither a word nor anything like a file.
    """
    word, colon, rest = text.strip().partition(":")
    if word in WORDS:
        return word, _numbers(text, word, rest if colon else None)
    path = Path(text)
    if text.strip() and (path.exists() or path.suffix or len(path.parts) > 1):
        return None
    known = ", ".join(usage(w) for w in WORDS)
    cure = nearest(word, WORDS)
    hint = f"{cure} " if cure.startswith("did you mean") else ""
    raise TerrainError("not a terrain", value=text, cure=f"{hint}give a file or one of {known}")


def _numbers(text: str, word: str, rest: str | None) -> list[float]:
    wanted = WORDS[word]
    parts = [] if rest is None else rest.split(",")
    if len(parts) != len(wanted):
        raise TerrainError(
            f"terrain {word!r} takes {len(wanted) or 'no'} number{'s' * (len(wanted) != 1)}",
            value=text,
            cure=f"write {usage(word)}",
        )
    values = []
    for name, part in zip(wanted, parts, strict=True):
        try:
            values.append(float(part))
        except ValueError:
            raise TerrainError(f"{name} is not a number", value=text, cure=f"write {usage(word)}") from None
        if name == "SEED" and not values[-1].is_integer():
            raise TerrainError("SEED is not a whole number", value=text, cure=f"write {usage(word)}")
    return values
