"""Maps of a fluid: viscosity over temperature and pressure, rigs over any two settings; and spectra
of histories. The server keeps none of them."""

from __future__ import annotations

import itertools
from typing import Any, Mapping, Sequence

import numpy as np

from tribodyn._arguments import Arguments, full_name, set_switches
from tribodyn._frames import Frame, frame
from tribodyn._session import Session
from tribodyn._warnings import of_inputs, of_rows
from tribodyn.units import Quantity
from tribodyn.v1 import rigs_pb2, spectra_pb2, viscosities_pb2

# Fields of RigGrid of which one is set.
_LOADS = ("loads_newtons", "mean_pressures_pascals")


class Maps(Session):
    """Methods of a client for figures over the settings of a fluid or a rig."""

    async def read_spectrum(
        self, simulation: str, *, columns: Sequence[str] = (), maximum_order: float = 0
    ) -> Frame:
        """Returns the spectra of the history of a simulation: amplitudes (zero to peak) and phase
        angles by order of the mesh frequency, up to ``maximum_order`` (0: 20); ``columns`` empty:
        all but time and mesh phase. A column is mean + sum of amplitude cos(2 pi order phase + phase
        angle), phase in mesh cycles. ``attrs`` holds units, means, root mean squares, and whether the
        response is periodic."""
        name = full_name("simulations", simulation)
        request = spectra_pb2.ReadSpectrumRequest(
            name=name,
            columns=[columns] if isinstance(columns, str) else columns,
            maximum_order=maximum_order,
        )
        answer = await self._call("SpectrumService", "ReadSpectrum", request)
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
            "input_warnings": of_inputs(answer.input_warnings),
        }
        return frame(cells, attrs)

    async def viscosity(
        self,
        lubricant: str,
        *,
        temperatures_celsius: Sequence[Quantity],
        pressures_pascals: Sequence[Quantity] = (0,),
        model_options: Mapping[str, Any] | None = None,
    ) -> Frame:
        """Returns the viscosity of a lubricant at each combination of temperatures (-100 to 400 C)
        and pressures above ambient (0 to 1e10 Pa), at most 100,000, with density, kinematic viscosity
        and alpha* at ambient pressure. A temperature at which a law does not hold has NaN, and the
        reason in ``status``."""
        arguments = Arguments()
        request = viscosities_pb2.EvaluateViscosityRequest(
            lubricant=full_name("lubricants", lubricant),
            temperatures_celsius=arguments.numbers("temperatures_celsius", temperatures_celsius),
            pressures_pascals=arguments.numbers("pressures_pascals", pressures_pascals),
        )
        set_switches(arguments, "model_options", model_options or {}, request.model_options)
        arguments.check()
        answer = await self._call("ViscosityService", "EvaluateViscosity", request)
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
        self,
        lubricant: str,
        *,
        radius_x_metres: Quantity,
        radius_y_metres: Quantity = 0,
        loads_newtons: Quantity | Sequence[Quantity] | None = None,
        mean_pressures_pascals: Quantity | Sequence[Quantity] | None = None,
        entrainment_speeds_metres_per_second: Quantity | Sequence[Quantity],
        slide_roll_ratios_percent: Quantity | Sequence[Quantity] = 0,
        supply_temperatures_celsius: Quantity | Sequence[Quantity] = 40,
        surface: str | None = None,
        composite_rms_height_metres: Quantity = 0,
        body_1: Mapping[str, float] | None = None,
        body_2: Mapping[str, float] | None = None,
        model_options: Mapping[str, Any] | None = None,
        draws: int = 0,
    ) -> Frame:
        """Returns traction, film, pressures and temperatures of a ball or barrelled ring on a disc at
        every combination of its settings, at most 5000: a map if two of them have many values.

        Either loads or mean pressures (of the dry contact by Hertz) are stated. ``radius_y_metres``
        0: a ball. ``surface`` None: smooth specimens. ``body_1`` (ball or ring) and ``body_2`` (disc)
        are the fields of RigBody; None: steel of 210 GPa. A refused row has NaN, and the reason in
        ``status``. ``draws`` (19 to 1999) of the stated uncertainties of lubricant and surface add
        ``{figure}_standard_uncertainty``, ``{figure}_interval_minimum`` and ``..._maximum`` (95 %)
        for each figure that they move, and ``refused_draws``; ``attrs["inputs_without_uncertainty"]``
        names what counts as exact. ``attrs["warnings"]`` as of point()."""
        arguments = Arguments()
        request = rigs_pb2.EvaluateRigRequest(
            draws=draws,
            lubricant=full_name("lubricants", lubricant),
            surface=full_name("surfaces", surface or ""),
            body_1=None if body_1 is None else rigs_pb2.RigBody(**body_1),
            body_2=None if body_2 is None else rigs_pb2.RigBody(**body_2),
        )
        arguments.set_numbers(
            request,
            {
                "radius_x_metres": radius_x_metres,
                "radius_y_metres": radius_y_metres,
                "composite_rms_height_metres": composite_rms_height_metres,
            },
        )
        settings = {
            "loads_newtons": loads_newtons,
            "mean_pressures_pascals": mean_pressures_pascals,
            "entrainment_speeds_metres_per_second": entrainment_speeds_metres_per_second,
            "slide_roll_ratios_percent": slide_roll_ratios_percent,
            "supply_temperatures_celsius": supply_temperatures_celsius,
        }
        for name, values in settings.items():
            if values is not None:
                getattr(request.grid, name).extend(arguments.numbers(name, values))
        set_switches(arguments, "model_options", model_options or {}, request.model_options)
        arguments.check()
        answer = await self._call("RigService", "EvaluateRig", request)
        columns = _rig_conditions(request.grid, answer)
        for each in answer.DESCRIPTOR.fields:
            if each.label == each.LABEL_REPEATED and each.cpp_type == each.CPPTYPE_DOUBLE:
                columns.setdefault(each.name, np.array(getattr(answer, each.name)))
        for each in answer.uncertainties:
            for end in ("standard_uncertainty", "interval_minimum", "interval_maximum"):
                columns[f"{each.figure}_{end}"] = np.array(getattr(each, end))
        columns["status"], columns["status_message"] = _statuses(answer)
        attrs = _attrs(answer)
        attrs["warnings"] = of_rows(answer.range_warnings)
        if draws > 0:
            columns["refused_draws"] = np.array(answer.refused_draws)
            attrs["inputs_without_uncertainty"] = list(answer.inputs_without_uncertainty)
        return frame(columns, attrs)


def _rig_conditions(
    grid: rigs_pb2.RigGrid, answer: rigs_pb2.EvaluateRigResponse
) -> dict[str, Any]:
    """Returns the conditions of the rows of a map as columns."""
    rows = list(
        itertools.product(
            grid.supply_temperatures_celsius,
            range(sum(len(getattr(grid, name)) for name in _LOADS)),
            grid.entrainment_speeds_metres_per_second,
            grid.slide_roll_ratios_percent,
        )
    )
    return {
        "load_newtons": np.array(answer.load_newtons),
        "supply_temperature_celsius": np.array([row[0] for row in rows]),
        "entrainment_speed_metres_per_second": np.array([row[2] for row in rows]),
        "slide_roll_ratio_percent": np.array([row[3] for row in rows]),
    }


def _statuses(answer: Any) -> tuple[list[str], list[str]]:
    """Returns the status and the sentence of each row."""
    refusals = [answer.refusals[n - 1] if n else None for n in answer.refusal_numbers]
    return (
        [each.reason if each else "OK" for each in refusals],
        [each.message if each else "" for each in refusals],
    )


def _attrs(answer: Any) -> dict[str, Any]:
    return {
        "model_version": answer.model_version,
        "lubricant_revision": answer.lubricant_revision,
        "input_warnings": of_inputs(answer.input_warnings),
    }
