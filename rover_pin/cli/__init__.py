"""The command line `rover-pin`: thin; each command parses, calls and prints."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence

from rover_pin.errors import InputError, RoverPinError

GOOD, NO_ANSWER, BAD_INPUT = 0, 1, 2


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; returns the exit status.

    0 where all is well, 1 where the question has no good answer, 2 for bad input, with one line on stderr.
    """
    for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
        os.environ.setdefault(name, "1")  # small matrices: threads only cost; read once, when numpy loads
    given = list(sys.argv[1:] if arguments is None else arguments) or ["--help"]
    from rover_pin.cli.app import app

    try:
        status = app(given, prog_name="rover-pin", standalone_mode=False)
        sys.stdout.flush()
        return int(status or GOOD)
    except InputError as error:
        return _complain(str(error), BAD_INPUT)
    except RoverPinError as error:
        return _complain(str(error), NO_ANSWER)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # nobody reads on; end without a trace
        return NO_ANSWER
    except OSError as error:
        name = f"{error.filename}: " if error.filename else ""
        return _complain(f"{name}{error.strerror or error}", BAD_INPUT)
    except Exception as error:
        usage = getattr(error, "format_message", None)
        if usage is None:
            raise
        return _complain(f"{usage().rstrip('.')}; rover-pin --help lists commands and options", BAD_INPUT)


def _complain(text: str, status: int) -> int:
    sys.stderr.write(f"error: {' '.join(text.split())}\n")
    return status
