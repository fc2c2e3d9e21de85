"""The base of the study file's models: unknown keys get the nearest name, complaints are one line."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError, model_validator

from rover_pin.errors import InputError, StudyError, nearest

PLAIN = {
    "model_type": "should be a mapping of keys to values",
    "dict_type": "should be a mapping of keys to values",
    "tuple_type": "should be a list",
    "string_type": "should be a word",
}
"""Pydantic's kinds of complaint that speak of Python, for people."""

M = TypeVar("M", bound=BaseModel)


class Strict(BaseModel):
    """A frozen model without extra keys and without NaN."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, hide_input_in_errors=True)

    @model_validator(mode="before")
    @classmethod
    def _known_keys(cls, raw: Any) -> Any:
        if isinstance(raw, Mapping):
            for key in raw:
                if key not in cls.model_fields:
                    raise StudyError(
                        "unknown key", element=str(key), cure=nearest(str(key), cls.model_fields)
                    )
        return raw


def checked(model: type[M], raw: object, *, file: object = None, element: str | None = None) -> M:
    """Validate `raw`; the first complaint becomes one `StudyError` that names file, element and value.

    Raises:
        StudyError: `raw` does not fit the model.
    """
    try:
        return model.model_validate(raw)
    except ValidationError as failure:
        raise _first(failure, file, element) from None


def _first(failure: ValidationError, file: object, element: str | None) -> StudyError:
    """The first complaint of pydantic as an error of ours."""
    problem = failure.errors(include_url=False)[0]
    where = dotted([element, *problem["loc"]])
    cause = problem.get("ctx", {}).get("error")
    if isinstance(cause, InputError):
        where = dotted([where, cause.element])
        return StudyError(cause.what, file=file, element=where, value=cause.value, cure=cause.cure)
    what = PLAIN.get(problem["type"], problem["msg"].removeprefix("Input "))
    if problem["type"] == "missing":
        return StudyError("is missing", file=file, element=where)
    given = problem.get("input")
    return StudyError(what, file=file, element=where, value=repr(given) if given is None else given)


def dotted(parts: Iterable[object]) -> str | None:
    """`cases.n` from its parts; None where there are none."""
    return ".".join(str(part) for part in parts if part not in (None, "")) or None
