"""Parameters that candidates state: "lubricant.FIELD" and "surface.FIELD"."""

from __future__ import annotations

from typing import Any, Mapping

from tribodyn._arguments import Arguments
from tribodyn._rows import Column, find_column
from tribodyn.units import Quantity, QuantityError, quantity
from tribodyn.v1.lubricants_pb2 import Lubricant
from tribodyn.v1.surfaces_pb2 import Surface

OWNERS = {"lubricant": Lubricant, "surface": Surface}


def is_parameter(name: str) -> bool:
    """Whether a column of a table holds values of a parameter."""
    owner, dot, _ = name.partition(".")
    return bool(dot) and owner in OWNERS


def parameter_path(arguments: Arguments, argument: str, name: str) -> str:
    """Returns the path of a parameter, "lubricant.alpha" for one."""
    owner, _, parameter = name.partition(".")
    column = _column(owner, parameter)
    if column is None:
        arguments.wrong(argument, f"{name} is no parameter of a lubricant or surface")
        return name
    return f"{owner}.{column.field.name}"


def read_parameters(arguments: Arguments, row: Mapping[str, Any]) -> dict[str, float]:
    """Returns the paths and values of the parameters that a row states, in their units."""
    out = {}
    for name, value in row.items():
        if is_parameter(name) and value is not None:
            out.update(_parameter(arguments, name, value))
    return out


def _parameter(arguments: Arguments, name: str, value: Quantity) -> dict[str, float]:
    owner, _, parameter = name.partition(".")
    column = _column(owner, parameter)
    if column is None:
        arguments.wrong(name, f"{parameter} is no parameter of a {owner}")
        return {}
    try:
        number = quantity(value, column.field.name, unit=column.unit)
    except QuantityError as error:
        arguments.wrong(name, f"{value!r} {error}")
        return {}
    return {f"{owner}.{column.field.name}": number}


def _column(owner: str, parameter: str) -> Column | None:
    """Returns the column of a scalar parameter, or None if there is none."""
    found = find_column(OWNERS[owner], parameter) if owner in OWNERS else None
    return None if found is None or found.kind != "field" or found.block is not None else found
