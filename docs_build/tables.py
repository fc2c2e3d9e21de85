"""Tables of what registries hold: measures, and the variables of a study's result."""

from __future__ import annotations

from rover_pin.analysis.measures import known_measures, title
from rover_pin.analysis.rows import BOUNDS
from rover_pin.analysis.schema import ABOUT, ACROSS
from rover_pin.compiled.answers import COMPILED_MEASURES
from rover_pin.stability.registry import MEASURES


def measures() -> str:
    """Every measure: what it is, unit, which way is safer, what it costs and which path has it."""
    rows = ["| measure | what | unit | better | cost | in studies |", "|---|---|---|---|---|---|"]
    for name in known_measures():
        if name == BOUNDS:
            what, unit, better, cost = (
                "Load interval of each wheel within friction (studies only)",
                "N",
                "",
                "",
            )
        else:
            each = MEASURES[name]
            what, unit, better = title(name), each.unit, each.better
            cost = "little" if each.cheap else f"{each.cost_ms:g} ms"
        path = "compiled" if name in COMPILED_MEASURES else "plain path"
        rows.append(f"| `{name}` | {what} | {unit} | {better} | {cost} | {path} |")
    return "\n".join(rows) + "\n"


def variables() -> str:
    """Variables of a result that depend on no measure: unit, dimensions, meaning."""
    rows = ["| variable | unit | dimensions | what |", "|---|---|---|---|"]
    for name, (unit, what) in ABOUT.items():
        dims = "case" if name not in ACROSS else f"case, {ACROSS[name]}"
        rows.append(f"| `{name}` | {unit} | {dims} | {what} |")
    return "\n".join(rows) + "\n"
