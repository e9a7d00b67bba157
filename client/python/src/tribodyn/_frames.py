"""Results as tables: a pandas DataFrame, or a numpy structured array if pandas is not there."""

from __future__ import annotations

from typing import Any, Iterable, Mapping, Sequence

import numpy as np
from google.protobuf.message import Message

from tribodyn._enums import enum_word
from tribodyn._warnings import Warnings, add_warnings, of_inputs, withholds_verdict
from tribodyn.v1 import results_pb2, simulations_pb2

# A pandas.DataFrame, or a Table without pandas. Both have `attrs` and columns by name.
Frame = Any

_FLANK_SLOTS = 3
_EMPTY = {int: float("nan"), str: "", bool: float("nan")}


class Table(np.ndarray):
    """A numpy structured array with ``attrs``: the form of results if pandas is not there."""

    attrs: dict[str, Any]

    def __array_finalize__(self, source: Any) -> None:
        self.attrs = dict(getattr(source, "attrs", {}))

    @property
    def columns(self) -> list[str]:
        return list(self.dtype.names or ())


def frame(columns: Mapping[str, Sequence[Any] | np.ndarray], attrs: Mapping[str, Any]) -> Frame:
    """Returns a table with these columns, of equal lengths."""
    try:
        import pandas
    except ImportError:
        return _table(columns, attrs)
    table = pandas.DataFrame(dict(columns))
    table.attrs = dict(attrs)
    return table


def _table(columns: Mapping[str, Sequence[Any] | np.ndarray], attrs: Mapping[str, Any]) -> Table:
    arrays = {name: np.asarray(values) for name, values in columns.items()}
    for name, array in arrays.items():
        if array.dtype.kind == "U":
            arrays[name] = array.astype(object)
    length = len(next(iter(arrays.values()), ()))
    out = np.empty(length, dtype=[(name, array.dtype) for name, array in arrays.items()])
    for name, array in arrays.items():
        out[name] = array
    table = out.view(Table)
    table.attrs = dict(attrs)
    return table


def columns_of(table: Any) -> dict[str, list[Any]]:
    """Returns the columns of a DataFrame, a structured array, a mapping of columns or a sequence of
    rows. A missing value is None."""
    if isinstance(table, np.ndarray) and table.dtype.names:
        columns = {name: table[name].tolist() for name in table.dtype.names}
    elif isinstance(table, Mapping) or hasattr(table, "columns"):
        names = list(table.keys() if isinstance(table, Mapping) else table.columns)
        columns = {str(name): _list(table[name]) for name in names}
    else:
        rows = [dict(row) for row in table]
        names = list(dict.fromkeys(name for row in rows for name in row))
        columns = {str(name): [row.get(name) for row in rows] for name in names}
    lengths = {len(values) for values in columns.values()}
    if len(lengths) > 1:
        raise ValueError("the columns of the table differ in length")
    return {
        name: [None if is_missing(each) else each for each in values]
        for name, values in columns.items()
    }


def is_missing(value: Any) -> bool:
    """Whether a cell holds nothing: None, NaN or pandas' NA."""
    if value is None or type(value).__name__ in ("NAType", "NaTType"):
        return True
    return isinstance(value, float) and value != value


def _list(values: Any) -> list[Any]:
    return values.tolist() if hasattr(values, "tolist") else list(values)


def _fields(message: Message, prefix: str, row: dict[str, Any], present: bool) -> None:
    """Adds the fields of a message as cells, named as in the CSV of the command line. What is not
    there is NaN, never 0. Sensitivities are left out: they are a table of their own."""
    for field in message.DESCRIPTOR.fields:
        if field.message_type is results_pb2.PointSensitivities.DESCRIPTOR:
            continue
        name = prefix + field.name
        value = getattr(message, field.name)
        if field.label == field.LABEL_REPEATED:
            if field.message_type.name == "FlankLoss":
                for slot in range(_FLANK_SLOTS):
                    there = present and slot < len(value)
                    _fields(
                        value[slot] if there else results_pb2.FlankLoss(),
                        f"{name}_{slot}_",
                        row,
                        there,
                    )
            else:
                row[f"{name}_count"] = len(value) if present else float("nan")
        elif field.message_type is not None:
            _fields(value, name + "_", row, present and message.HasField(field.name))
        elif field.enum_type is not None:
            row[name] = enum_word(field.enum_type, value) if present else ""
        elif field.cpp_type == field.CPPTYPE_DOUBLE:
            there = present and (not field.has_presence or message.HasField(field.name))
            row[name] = value if there else float("nan")
        else:
            row[name] = value if present else _EMPTY[type(value)]


def message_cells(message: Message, prefix: str = "", present: bool = True) -> dict[str, Any]:
    """Returns the fields of a message as cells, without its lists; all NaN if it is not present."""
    row: dict[str, Any] = {}
    _fields(message, prefix, row, present)
    lists = [
        f"{prefix}{field.name}_count"
        for field in message.DESCRIPTOR.fields
        if field.label == field.LABEL_REPEATED
    ]
    return {name: value for name, value in row.items() if name not in lists}


def point_row(point: results_pb2.CurvePoint) -> dict[str, Any]:
    """Returns the cells of one point: figures, or NaN and the reason why there are none."""
    there = point.HasField("result")
    row: dict[str, Any] = {"speed_kilometres_per_hour": point.speed_kilometres_per_hour}
    _fields(point.result, "", row, there)
    if there:
        row["speed_kilometres_per_hour"] = point.result.vehicle_speed_kilometres_per_hour
    row["warnings"] = " ".join(each.code for each in point.result.warnings)
    row["verdict_withheld"] = withholds_verdict(point.result.warnings)
    row["status"] = "OK" if there else point.refusal_reason
    row["status_message"] = point.refusal_message
    return row


def empty_row(reason: str, message: str) -> dict[str, Any]:
    """Returns the cells of a point that could not be computed."""
    return point_row(results_pb2.CurvePoint(refusal_reason=reason, refusal_message=message))


def result_attrs(simulation: simulations_pb2.Simulation) -> dict[str, Any]:
    """Returns what identifies and qualifies a result."""
    result = simulation.result
    errors = [
        point.result.estimated_relative_error
        for point in result.points
        if point.result.HasField("estimated_relative_error")
    ]
    warnings: Warnings = {}
    for row, point in enumerate(result.points):
        add_warnings(warnings, point.result.warnings, [row])
    return {
        "simulation": simulation.name,
        "lubricant": simulation.lubricant_revision,
        "gear_set": simulation.gear_set_revision,
        "surface": simulation.surface_revision,
        "vehicle": simulation.vehicle_revision,
        "input_hash": result.input_hash,
        "model_version": result.model_version,
        "platform": result.platform,
        "estimated_relative_error": max(errors, default=None),
        "warnings": warnings,
        "input_warnings": of_inputs(result.input_warnings),
        "branch_ends": [
            (
                point.branch_end.followed_to_kilometres_per_hour,
                point.branch_end.gone_at_kilometres_per_hour,
            )
            for point in result.points
            if point.HasField("branch_end")
        ],
        "cache_hit": simulation.cache_hit,
    }


def point_attrs(simulation: simulations_pb2.Simulation) -> dict[str, Any]:
    """Returns the same of an operating point, for tables whose rows are no points."""
    warnings = simulation.result.points[0].result.warnings
    return {**result_attrs(simulation), "warnings": of_inputs(warnings)}


def sensitivity_table(
    simulation: simulations_pb2.Simulation,
) -> tuple[dict[str, list[Any]], dict[str, Any]]:
    """Returns columns and attributes of the sensitivities of an operating point."""
    found = simulation.result.points[0].result.sensitivities
    columns: dict[str, list[Any]] = {
        "parameter": [each.parameter for each in found.parameters],
        "unit": [each.unit for each in found.parameters],
        "value": [each.value for each in found.parameters],
    }
    for i, figure in enumerate(found.figures):
        columns[f"derivative.{figure}"] = [each.derivatives[i] for each in found.parameters]
        columns[f"elasticity.{figure}"] = [each.elasticities[i] for each in found.parameters]
    figures = dict(zip(found.figures, found.values))
    return columns, {
        **point_attrs(simulation),
        "figures": figures,
        "one_sided": found.one_sided,
    }


def sensitivity_columns(simulation: simulations_pb2.Simulation) -> dict[str, list[float]]:
    """Returns columns of the sensitivities of the points of a curve; NaN where a point has none."""
    points = [each.result.sensitivities for each in simulation.result.points]
    columns: dict[str, list[float]] = {}
    for i, found in enumerate(points):
        for parameter in found.parameters:
            for f, figure in enumerate(found.figures):
                for kind, values in (
                    ("derivative", parameter.derivatives),
                    ("elasticity", parameter.elasticities),
                ):
                    name = f"{kind}.{figure}.{parameter.parameter}"
                    columns.setdefault(name, [float("nan")] * len(points))[i] = values[f]
    return columns


def in_columns(rows: Iterable[Mapping[str, Any]]) -> dict[str, list[Any]]:
    """Returns the columns of rows that have equal keys."""
    columns: dict[str, list[Any]] = {}
    for row in rows:
        for name, value in row.items():
            columns.setdefault(name, []).append(value)
    return columns
