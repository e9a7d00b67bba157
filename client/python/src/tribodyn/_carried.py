"""Columns of tables that ride along without effect: those that look like inputs are refused."""

from __future__ import annotations

import difflib
from typing import Any, Collection, Sequence

from tribodyn._arguments import Arguments
from tribodyn._parameters import OWNERS, is_parameter
from tribodyn._rows import field_names, find_column, word_of
from tribodyn.units import without_unit

# Similarity (difflib's ratio) from which on a name is taken for a slip: "sump_temperatur" for
# "sump_temperature", not "batch" for "bath".
_SIMILAR = 0.85


def check_carried(
    headers: Collection[str],
    taken: Collection[str],
    inputs: Sequence[str],
    carry: str | Sequence[str],
) -> None:
    """Raises TribodynError INVALID_FIELDS, with all of them, if columns that are not ``taken`` have
    the name of an input, of a parameter or of a measurement, or one that is similar, unless
    ``carry`` names them. ``inputs``: what the caller may state elsewhere."""
    arguments = Arguments()
    carried = [carry] if isinstance(carry, str) else list(carry)
    for name in carried:
        if name not in headers:
            arguments.wrong("carry", f"the table has no column {name}")
    for header in headers:
        if header in taken or header in carried:
            continue
        meant = _meant(header, inputs)
        if meant:
            arguments.wrong(
                header,
                f"would have no effect ({meant}); rename it, or carry={[header]!r} carries it along",
            )
    arguments.check()


def _meant(header: str, inputs: Sequence[str]) -> str:
    """Returns what a header may mean; "" for a name that is like none of the service."""
    owner, _, rest = header.partition(".") if is_parameter(header) else ("", "", header)
    for name, kind in OWNERS.items():
        column = None if owner not in ("", name) else find_column(kind, rest)
        if column is None:
            continue
        if _is_description(column):
            return ""
        if column.kind == "field" and column.block is None:
            return f"is {name}.{column.field.name} meant?"
        return f"it is a measurement or a property of a {name}, which create() and import_table() take"
    word = word_of(rest)
    stem, _, part = word.rpartition(".")
    fields = {each: f"{name}." for name in reversed(OWNERS) for each in field_names(OWNERS[name])}
    if part == "uncertainty" and stem in fields:
        return ""  # each candidate's own standard uncertainty
    known = {each: each for each in inputs} | {without_unit(each): each for each in inputs}
    for name, prefix in fields.items():
        known.setdefault(name, prefix + name)
        known.setdefault(without_unit(name), prefix + name)
    similar = difflib.get_close_matches(word, known, 1, _SIMILAR)
    return f"is {known[similar[0]]} meant?" if similar else ""


def _is_description(column: Any) -> bool:
    """Whether a column holds what people write about a resource: its name, notes, labels."""
    if column.kind == "label":
        return True
    field = column.field
    return column.kind == "field" and field.cpp_type == field.CPPTYPE_STRING
