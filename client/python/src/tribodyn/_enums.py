"""Enums of the contract as words."""

from __future__ import annotations

from typing import Any


def enum_word(kind: Any, number: int) -> str:
    """Returns e.g. "quasi-static" for POINT_MODEL_QUASI_STATIC; "" for the unspecified value."""
    prefix = "".join("_" + each if each.isupper() else each.upper() for each in kind.name)[1:] + "_"
    value = kind.values_by_number.get(number)
    if value is None or number == 0:
        return ""
    return value.name.removeprefix(prefix).lower().replace("_", "-")
