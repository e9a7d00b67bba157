"""Maps of a fluid: viscosity over temperature and pressure, rigs over any two settings; and spectra
of histories. The server keeps none of them."""

from __future__ import annotations

import itertools
from typing import Any, Mapping, Sequence

import numpy as np

from tribodyn._frames import Frame, frame
from tribodyn._studies import Arguments, full_name, set_switches
from tribodyn._transport import Transport
from tribodyn.units import Quantity
from tribodyn.v1 import rigs_pb2, spectra_pb2, viscosities_pb2

# Fields of RigGrid of which one is set.
_LOADS = ("loads_newtons", "mean_pressures_pascals")


def numbers(
    arguments: Arguments, name: str, values: Quantity | Sequence[Quantity]
) -> list[float]:
    """Reads one value or several."""
    listed = [values] if isinstance(values, (str, float, int)) else values
    return [arguments.number(name, each) for each in listed]


def _statuses(answer: Any) -> tuple[list[str], list[str]]:
    """Returns the status and the sentence of each row."""
    refusals = [answer.refusals[n - 1] if n else None for n in answer.refusal_numbers]
    return (
        [each.reason if each else "OK" for each in refusals],
        [each.message if each else "" for each in refusals],
    )


async def viscosity(
    transport: Transport,
    lubricant: str,
    temperatures_celsius: Sequence[Quantity],
    pressures_pascals: Sequence[Quantity],
    model_options: Mapping[str, Any],
) -> Frame:
    arguments = Arguments()
    request = viscosities_pb2.EvaluateViscosityRequest(
        lubricant=full_name("lubricants", lubricant),
        temperatures_celsius=numbers(arguments, "temperatures_celsius", temperatures_celsius),
        pressures_pascals=numbers(arguments, "pressures_pascals", pressures_pascals),
    )
    set_switches(arguments, "model_options", model_options, request.model_options)
    arguments.check()
    answer = await transport.call("ViscosityService", "EvaluateViscosity", request)
    width = len(request.pressures_pascals)
    status, message = _statuses(answer)
    columns: dict[str, Any] = {
        "temperature_celsius": np.repeat(request.temperatures_celsius, width),
        "pressure_pascals": np.tile(
            request.pressures_pascals, len(request.temperatures_celsius)
        ),
        "dynamic_viscosity_pascal_seconds": np.array(answer.dynamic_viscosity_pascal_seconds),
    }
    for name in (
        "ambient_dynamic_viscosity_pascal_seconds",
        "ambient_kinematic_viscosity_square_millimetres_per_second",
        "ambient_density_kilograms_per_cubic_metre",
        "pressure_viscosity_coefficient_per_pascal",
    ):
        columns[name] = np.repeat(getattr(answer, name), width)
    columns["status"] = [each for each in status for _ in range(width)]
    columns["status_message"] = [each for each in message for _ in range(width)]
    return frame(columns, _attrs(answer))


async def rig(
    transport: Transport,
    request: rigs_pb2.EvaluateRigRequest,
    settings: Mapping[str, Quantity | Sequence[Quantity] | None],
    model_options: Mapping[str, Any],
) -> Frame:
    arguments = Arguments()
    for name, values in settings.items():
        if values is not None:
            getattr(request.grid, name).extend(numbers(arguments, name, values))
    set_switches(arguments, "model_options", model_options, request.model_options)
    arguments.check()
    answer = await transport.call("RigService", "EvaluateRig", request)
    grid = request.grid
    loads = range(sum(len(getattr(grid, name)) for name in _LOADS))
    rows = list(
        itertools.product(
            grid.supply_temperatures_celsius,
            loads,
            grid.entrainment_speeds_metres_per_second,
            grid.slide_roll_ratios_percent,
        )
    )
    columns: dict[str, Any] = {"load_newtons": np.array(answer.load_newtons)}
    columns["supply_temperature_celsius"] = np.array([row[0] for row in rows])
    columns["entrainment_speed_metres_per_second"] = np.array([row[2] for row in rows])
    columns["slide_roll_ratio_percent"] = np.array([row[3] for row in rows])
    for each in answer.DESCRIPTOR.fields:
        if each.label == each.LABEL_REPEATED and each.cpp_type == each.CPPTYPE_DOUBLE:
            columns.setdefault(each.name, np.array(getattr(answer, each.name)))
    for each in answer.uncertainties:
        for end in ("standard_uncertainty", "interval_minimum", "interval_maximum"):
            columns[f"{each.figure}_{end}"] = np.array(getattr(each, end))
    columns["status"], columns["status_message"] = _statuses(answer)
    attrs = _attrs(answer)
    attrs["range_warnings"] = {
        each.code: {"message": each.message, "rows": list(each.rows)}
        for each in answer.range_warnings
    }
    if request.draws > 0:
        columns["refused_draws"] = np.array(answer.refused_draws)
        attrs["inputs_without_uncertainty"] = list(answer.inputs_without_uncertainty)
    return frame(columns, attrs)


async def spectrum(
    transport: Transport, simulation: str, columns: Sequence[str], maximum_order: float
) -> Frame:
    name = full_name("simulations", simulation)
    request = spectra_pb2.ReadSpectrumRequest(
        name=name,
        columns=[columns] if isinstance(columns, str) else columns,
        maximum_order=maximum_order,
    )
    answer = await transport.call("SpectrumService", "ReadSpectrum", request)
    cells: dict[str, Any] = {"order": np.array(answer.orders)}
    for each in answer.columns:
        cells[each.name] = np.array(each.amplitudes)
        cells[f"phase_angle_radians.{each.name}"] = np.array(each.phase_angles_radians)
    attrs = {
        "simulation": name,
        "units": {each.name: each.unit for each in answer.columns},
        "means": {each.name: each.mean for each in answer.columns},
        "alternating_root_mean_squares": {
            each.name: each.alternating_root_mean_square_value for each in answer.columns
        },
        "mesh_cycles": answer.mesh_cycles,
        "samples_per_mesh_cycle": answer.samples_per_mesh_cycle,
        "is_periodic": answer.is_periodic,
        "mesh_frequency_hertz": answer.mesh_frequency_hertz,
        "model_version": answer.model_version,
        "input_warnings": {each.code: each.message for each in answer.input_warnings},
    }
    return frame(cells, attrs)


def _attrs(answer: Any) -> dict[str, Any]:
    return {
        "model_version": answer.model_version,
        "lubricant_revision": answer.lubricant_revision,
        "input_warnings": {each.code: each.message for each in answer.input_warnings},
    }
