"""Fields of lubricants, gear sets, surfaces and vehicles from arguments and rows of data sheets."""

from __future__ import annotations

import difflib
import functools
import re
from dataclasses import dataclass
from typing import Any, Callable, Mapping

from google.protobuf import json_format
from google.protobuf.message import Message

from tribodyn.errors import Violation
from tribodyn.units import QuantityError, is_temperature, quantity, unit_of, without_unit
from tribodyn.v1 import lubricants_pb2, provenance_pb2

# Names of data sheets, with the unit of bare numbers.
_TRADE_NAMES = {
    "kv40": ("kinematic_viscosity_40_celsius_square_millimetres_per_second", "mm2/s"),
    "kv100": ("kinematic_viscosity_100_celsius_square_millimetres_per_second", "mm2/s"),
    "kv100_sheared": (
        "sheared_kinematic_viscosity_100_celsius_square_millimetres_per_second",
        "mm2/s",
    ),
    "density15": ("density_15_celsius_kilograms_per_cubic_metre", "kg/m3"),
    "alpha": ("pressure_viscosity_coefficient_per_pascal", ""),
    "pressure_viscosity": ("pressure_viscosity_coefficient_per_pascal", ""),
    "title": ("display_name", ""),
    "sample_id": ("external_sample_id", ""),
}
_PROVENANCE_PARTS = ("provenance", "source", "standard_uncertainty", "warning")
_COLD = re.compile(
    r"brookfield(?:_viscosity)?(?:_at)?_?(-?\d+(?:\.\d+)?)_?(?:c|celsius|\u00b0c)?", re.I
)
_GROUPS = {
    "i": "GROUP_I",
    "1": "GROUP_I",
    "ii": "GROUP_II",
    "2": "GROUP_II",
    "iii": "GROUP_III",
    "3": "GROUP_III",
    "iv": "POLYALPHAOLEFIN",
    "4": "POLYALPHAOLEFIN",
    "pao": "POLYALPHAOLEFIN",
    "polyalphaolefin": "POLYALPHAOLEFIN",
    "ester": "ESTER",
    "pag": "POLYALKYLENE_GLYCOL",
    "polyalkyleneglycol": "POLYALKYLENE_GLYCOL",
    "polyglycol": "POLYALKYLENE_GLYCOL",
    "naphthenic": "NAPHTHENIC",
}


@dataclass(frozen=True)
class Column:
    """What the cells of a column, or an argument, set."""

    kind: str  #: "field", "nested", "label", "provenance" or "cold"
    field: Any = None  #: descriptor of the field
    block: Any = None  #: descriptor of the message that holds it; None: the resource itself
    unit: str | None = None  #: of bare numbers; None: that of the field's name
    key: str = ""  #: of a label; field and part of a provenance
    part: str = ""
    temperature_celsius: float = 0.0  #: of a Brookfield viscosity

    @property
    def path(self) -> str:
        """The path in an update mask."""
        if self.kind in ("label", "provenance"):
            return {"label": "labels", "provenance": "provenance"}[self.kind]
        return f"{self.block.name}.{self.field.name}" if self.block else self.field.name


def find_column(kind: type[Message], header: str) -> Column | None:
    """Returns the column of a header: a field, a name of data sheets ("kv40", "Density15 (g/cm3)"),
    "labels.KEY", "FIELD.provenance" and so on, or "Brookfield -40 C"; None if there is none."""
    return _found(kind, header)


def _find(kind: type[Message], header: str) -> Column | None:
    if header.startswith("labels.") and len(header) > len("labels."):
        return Column("label", key=header.removeprefix("labels."))
    word, unit = _split_header(header)
    blocks: list[tuple[Any, Any]] = [(None, each) for each in kind.DESCRIPTOR.fields]
    for each in kind.DESCRIPTOR.fields:
        if each.name == "measurements" and each.label != each.LABEL_REPEATED:
            blocks += [(each, inner) for inner in each.message_type.fields]
    name, bare = _TRADE_NAMES.get(word, (word, None))
    for block, field in blocks:
        label_of_field = without_unit(field.name)
        if field.name != name and (label_of_field != name or not unit_of(field.name)):
            continue
        if field.name != word and bare is None:
            bare = ""  # a name without its unit: a number brings its own
        if field.message_type is not None:
            return Column("nested", field, block)
        return Column("field", field, block, unit if unit else bare)
    owner, dot, part = header.rpartition(".")
    if dot and part in _PROVENANCE_PARTS:
        target = find_column(kind, owner)
        key = target.field.name if target and target.kind == "field" else owner
        return Column("provenance", key=key, part=part)
    measurements = kind.DESCRIPTOR.fields_by_name.get("measurements")
    cold = _COLD.fullmatch(word)
    if cold and kind is lubricants_pb2.Lubricant and measurements:
        field = measurements.message_type.fields_by_name["brookfield_viscosities"]
        return Column(
            "cold", field, measurements, unit or "mPa s", temperature_celsius=float(cold[1])
        )
    return None


# Each cell of a table asks for its header.
_found: Any = functools.lru_cache(maxsize=10_000)(_find)


def word_of(header: str) -> str:
    """Returns a header in the spelling of fields, without its unit: "sump_temperature"."""
    return _split_header(header)[0]


def field_names(kind: type[Message]) -> list[str]:
    """Returns the names of the fields of a resource, and of its measurements on data sheets."""
    return [each.name for each in kind.DESCRIPTOR.fields] + list(_TRADE_NAMES)


def unknown(kind: type[Message], header: str) -> str:
    """Returns what is wrong with a header that names no field."""
    words = field_names(kind)
    words += [without_unit(each) for each in words]
    meant = difflib.get_close_matches(word_of(header), words, 1)
    return "is unknown" + (f" (is {meant[0]} meant?)" if meant else "")


def set_cell(resource: Any, column: Column, header: str, value: Any) -> Violation | None:
    """Sets what a cell states. Returns what is wrong with it."""
    try:
        _set(resource, column, value)
    except (QuantityError, json_format.ParseError, TypeError, ValueError) as error:
        return Violation(header, f"{value!r} {error}", str(value))
    return None


def fill(
    resource: Any,
    values: Mapping[str, Any],
    violations: list[Violation],
    where: str = "",
    clears: bool = False,
) -> list[str]:
    """Sets the fields that are named. Returns their paths, and adds what is wrong to violations.
    None sets nothing, or clears the field."""
    paths: list[str] = []
    for header, value in values.items():
        column = find_column(type(resource), str(header))
        if column is None:
            violations.append(Violation(where + str(header), unknown(type(resource), str(header))))
            continue
        if value is None and not clears:
            continue
        wrong = set_cell(resource, column, where + str(header), value)
        if wrong is not None:
            violations.append(wrong)
        for path in [column.path, *_provenance_path(resource, column)]:
            if path not in paths:
                paths.append(path)
    return paths


def _provenance_path(resource: Any, column: Column) -> list[str]:
    # A new value makes the former provenance of a parameter invalid.
    has = "provenance" in resource.DESCRIPTOR.fields_by_name
    is_number = column.kind == "field" and column.field.cpp_type == column.field.CPPTYPE_DOUBLE
    return ["provenance"] if has and is_number and column.block is None else []


def _split_header(header: str) -> tuple[str, str]:
    """Returns "density15" and "g/cm3" for "Density15 (g/cm3)"."""
    text, unit = header.strip(), ""
    found = re.fullmatch(r"(.+?)\s*[(\[](.+)[)\]]", text)
    if found:
        text, unit = found[1], found[2]
    text = re.sub(r"(?<=\d)\s*\u00b0?\s*C$", "_c", text)
    return re.sub(r"[ _\t]+|-(?!\d)|(?<=\w)-(?=[a-zA-Z])", "_", text).lower().strip("_"), unit


def _set(resource: Any, column: Column, value: Any) -> None:
    if value is None:
        _clear(resource, column)
    elif column.kind == "label":
        for label in resource.labels:
            if label.key == column.key:
                label.value = str(value)
                return
        resource.labels.add(key=column.key, value=str(value))
    elif column.kind == "provenance":
        _set_provenance(resource, column, value)
    elif column.kind == "cold":
        _set_cold(resource.measurements, column, value)
    elif column.kind == "nested":
        _set_nested(
            getattr(resource, column.block.name) if column.block else resource, column, value
        )
    else:
        parent = getattr(resource, column.block.name) if column.block else resource
        field = column.field
        if field.enum_type is not None:
            setattr(parent, field.name, _enum_number(field.enum_type, value))
        elif field.cpp_type == field.CPPTYPE_STRING:
            setattr(parent, field.name, str(value))
        else:
            number = quantity(value, field.name, unit=column.unit)
            if field.cpp_type != field.CPPTYPE_DOUBLE and number != int(number):
                raise QuantityError("is not a whole number")
            is_double = field.cpp_type == field.CPPTYPE_DOUBLE
            setattr(parent, field.name, number if is_double else int(number))
            _drop_provenance(resource, column)


def _clear(resource: Any, column: Column) -> None:
    if column.kind == "label":
        _keep(resource.labels, lambda each: each.key != column.key)
    elif column.kind == "cold":
        _keep(
            resource.measurements.brookfield_viscosities,
            lambda each: each.temperature_celsius != column.temperature_celsius,
        )
    elif column.kind == "provenance":
        _keep(resource.provenance, lambda each: each.field != column.key)
    else:
        parent = getattr(resource, column.block.name) if column.block else resource
        parent.ClearField(column.field.name)
        _drop_provenance(resource, column)


def _drop_provenance(resource: Any, column: Column) -> None:
    if column.block is None and "provenance" in resource.DESCRIPTOR.fields_by_name:
        _keep(resource.provenance, lambda each: each.field != column.field.name)


def _keep(rows: Any, is_kept: Callable[[Any], bool]) -> None:
    kept = [each for each in rows if is_kept(each)]
    del rows[:]
    rows.extend(kept)


def _set_nested(parent: Any, column: Column, value: Any) -> None:
    """Sets a message or a list of messages from JSON's form, from messages, or lists of viscosities
    and densities from "205 mm2/s at 20 C; 31 mm2/s at 100 C"."""
    field = column.field
    if isinstance(value, str):
        if parent.DESCRIPTOR is not lubricants_pb2.LubricantMeasurements.DESCRIPTOR:
            raise QuantityError("is a text; a mapping or a list is needed")
        parent.ClearField(field.name)
        for part in filter(str.strip, value.split(";")):
            _add_measurement(getattr(parent, field.name).add(), part)
        return
    if isinstance(value, Message):
        value = json_format.MessageToDict(value, preserving_proto_field_name=True)
    if isinstance(value, (list, tuple)):
        value = [
            json_format.MessageToDict(each, preserving_proto_field_name=True)
            if isinstance(each, Message)
            else each
            for each in value
        ]
    parent.ClearField(field.name)
    json_format.ParseDict({field.name: value}, parent)


def _add_measurement(row: Any, text: str) -> None:
    value, at, rest = text.partition(" at ")
    if not at:
        raise QuantityError('must be "VALUE UNIT at TEMPERATURE C"; separate several by semicolons')
    temperature, within, uncertainty = rest.partition("+-")
    row.temperature_celsius = quantity(temperature, "temperature_celsius")
    fields = row.DESCRIPTOR.fields_by_name
    if within:
        if "relative_standard_uncertainty" not in fields:
            raise QuantityError("takes no uncertainty")
        row.relative_standard_uncertainty = quantity(uncertainty, "relative_standard_uncertainty")
    names = [each for each in fields if "viscosity" in each or each.startswith("density")]
    problem: QuantityError | None = None
    for name in names:
        try:
            setattr(row, name, quantity(value, name, unit="" if len(names) > 1 else None))
            return
        except QuantityError as error:
            problem = error
    raise QuantityError(
        "must be a kinematic viscosity (mm2/s) or a dynamic one (mPa s)"
        if len(names) > 1
        else str(problem)
    )


def _set_cold(measurements: Any, column: Column, value: Any) -> None:
    number = quantity(value, "dynamic_viscosity_millipascal_seconds", unit=column.unit)
    rows = measurements.brookfield_viscosities
    _keep(rows, lambda each: each.temperature_celsius != column.temperature_celsius)
    rows.add(
        temperature_celsius=column.temperature_celsius, dynamic_viscosity_millipascal_seconds=number
    )


def _set_provenance(resource: Any, column: Column, value: Any) -> None:
    entries = [each for each in resource.provenance if each.field == column.key]
    entry = entries[0] if entries else resource.provenance.add(field=column.key)
    entry.computed = False
    if column.part == "provenance":
        entry.provenance = _enum_number(provenance_pb2.Provenance.DESCRIPTOR, value)
    elif column.part == "standard_uncertainty":
        # A difference of temperatures is in kelvin, whatever its field is called.
        name = column.key if not is_temperature(column.key) else "difference_kelvin"
        entry.standard_uncertainty = quantity(value, name)
    else:
        setattr(entry, column.part, str(value))


def _enum_number(kind: Any, value: Any) -> int:
    """Returns the number of an enum's value by a word in any usual spelling."""
    prefix = re.sub(r"(?<!^)(?=[A-Z])", "_", kind.name).upper() + "_"
    words = {each.name.removeprefix(prefix): each.number for each in kind.values if each.number}
    word = re.sub(r"[ -]", "_", str(value).strip()).upper().removeprefix(prefix)
    if kind.name == "BaseOilClass" and word not in words:
        plain = re.sub(r"[^a-z0-9]", "", str(value).lower())
        word = _GROUPS.get(re.sub(r"^(api)?(group|gruppe|gr)?", "", plain), word)
    if word not in words:
        allowed = ", ".join(each.lower().replace("_", "-") for each in words)
        raise QuantityError(f"must be one of {allowed}")
    return words[word]
