"""A page for every command of the command line, from the application itself.

What a page `docs/commands/NAME.md` says by hand (examples, exit statuses, keys of the object) comes after
what is generated; a command without one has a page all the same.
"""

from __future__ import annotations

import inspect
from typing import Any

import typer

STATUSES = """## Exit status

0 where all is well; 1 where the question has no good answer, what there is being printed all the same; 2 for
bad input, with one line on standard error.
"""
OBJECT = """## The object of `--json`

Lengths in metres, angles in radians, forces in newtons; `null` where there is no number.
"""


def commands() -> dict[str, Any]:
    """Every command under its name, in the application's order."""
    from rover_pin.cli.app import app

    group = typer.main.get_command(app)
    return dict(getattr(group, "commands", {}))


def page(name: str, by_hand: str = "") -> str:
    """The page of a command.

    Args:
        name: the command's.
        by_hand: the text of its page below `docs/commands`, whose heading gives way.
    """
    command = commands()[name]
    text = [
        f"# rover-pin {name}",
        inspect.cleandoc(command.help or ""),
        _usage(name, command),
        _table(command),
    ]
    rest = by_hand.strip()
    if rest.startswith("# "):
        rest = rest.partition("\n")[2].strip()
    if "## Exit status" not in rest:
        rest += f"\n\n{STATUSES}"
    if "--json" in _options(command) and "## The object" not in rest:
        rest += f"\n\n{OBJECT}"
    return "\n\n".join([*text, rest.strip()]) + "\n"


def index() -> str:
    """The page that lists all commands."""
    rows = [f"| [`{name}`]({name}.md) | {summary(each)} |" for name, each in commands().items()]
    return "\n".join(["# Commands", "", _INTRODUCTION, "| command | what |", "|---|---|", *rows, ""])


_INTRODUCTION = """Every command prints a table for people, and with `--json` one object for machines.
Its exit status is

- **0** where all is well,
- **1** where the question has no good answer (the rover does not stand, a design is infeasible): the object
  is printed all the same,
- **2** for bad input, with one line on standard error: the file, the element, the value and the cure.

`rover-pin COMMAND --help` says in the terminal what these pages say.
"""


def summary(command: Any) -> str:
    """The first sentence of a command's help."""
    return inspect.cleandoc(command.help or "").split("\n\n")[0].replace("\n", " ")


def _options(command: Any) -> list[str]:
    return [name for each in command.params for name in each.opts]


def _usage(name: str, command: Any) -> str:
    words = [_metavar(each) for each in command.params if _is_argument(each)]
    return f"```text\nrover-pin {' '.join([name, *words, '[OPTIONS]'])}\n```"


def _is_argument(each: Any) -> bool:
    return not each.opts[0].startswith("-")


def _metavar(each: Any) -> str:
    word = str(each.metavar or each.name or "").upper().strip("[]")
    return word if each.required else f"[{word}]"


def _table(command: Any) -> str:
    rows = ["| option | what | default |", "|---|---|---|"]
    rows += [_row(each) for each in command.params]
    return "\n".join(rows)


def _row(each: Any) -> str:
    told = str(getattr(each, "help", "") or "")
    if _is_argument(each):
        return f"| `{_metavar(each)}` | {_cell(told)} | {'required' if each.required else _default(each)} |"
    names = ", ".join(f"`{name}`" for name in (*each.opts, *each.secondary_opts))
    flag = bool(getattr(each, "is_flag", False))
    value = "" if flag else f" <code>{_cell(_value(each))}</code>"
    times = "; may be repeated" if each.multiple else ""
    what = _cell(told).removesuffix(".") + times if times else _cell(told)
    return f"| {names}{value} | {what} | {'' if flag else _default(each)} |"


def _value(each: Any) -> str:
    return str(each.metavar or each.name.upper())


def _default(each: Any) -> str:
    default = each.default
    if default is None or default in ("", [], ()):
        return ""
    return f"`{default}`"


def _cell(text: str) -> str:
    return text.replace("|", "&#124;").replace("<", "&lt;")
