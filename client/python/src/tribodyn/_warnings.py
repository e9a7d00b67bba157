"""Warnings of the server, by code, with the rows of a table that they hold for."""

from __future__ import annotations

from typing import Any, Iterable

from tribodyn._enums import enum_word
from tribodyn.v1.results_pb2 import WarningLevel

# By code: "level" ("note", "caution" or "withholds-verdict"), "summary", "message" of the row that
# is furthest outside or of the first one, and "rows".
Warnings = dict[str, dict[str, Any]]


def level_word(level: int) -> str:
    return enum_word(WarningLevel.DESCRIPTOR, level) or "note"


def withholds_verdict(warnings: Iterable[Any]) -> bool:
    """Whether one of the server's warnings says that figures decide nothing between lubricants."""
    return any(each.level == WarningLevel.WARNING_LEVEL_WITHHOLDS_VERDICT for each in warnings)


def add_warnings(out: Warnings, warnings: Iterable[Any], rows: Iterable[int] = ()) -> None:
    """Adds warnings that hold for some rows of a table."""
    rows = list(rows)
    for each in warnings:
        entry = out.setdefault(
            each.code,
            {
                "level": level_word(each.level),
                "summary": each.summary,
                "message": each.message,
                "rows": [],
            },
        )
        entry["rows"] = sorted({*entry["rows"], *rows})


def of_rows(warnings: Iterable[Any]) -> Warnings:
    """Returns warnings that state their rows."""
    out: Warnings = {}
    for each in warnings:
        add_warnings(out, [each], each.rows)
    return out


def of_inputs(warnings: Iterable[Any]) -> Warnings:
    """Returns warnings about inputs, which hold for all rows: they have no "rows"."""
    out: Warnings = {}
    add_warnings(out, warnings)
    for entry in out.values():
        del entry["rows"]
    return out
