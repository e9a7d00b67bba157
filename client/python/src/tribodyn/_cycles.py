"""Drive cycles: what lubricants lose over them. The server keeps none of them."""

from __future__ import annotations

from typing import Any, Mapping, Sequence

import numpy as np

from tribodyn._arguments import Arguments, full_name, full_names, set_switches
from tribodyn._csv import rows_of
from tribodyn._enums import enum_word
from tribodyn._frames import Frame, frame, in_columns
from tribodyn._session import Session
from tribodyn._warnings import Warnings, add_warnings
from tribodyn.units import Quantity
from tribodyn.v1 import cycles_pb2 as pb

_NEDC = "nedc"
_FIGURES = (
    "input_joules",
    "loss_joules",
    "loss_share_percent",
    "inefficiency_percent",
    "loss_difference_percent",
)
# Columns of the answer by piece; the losses of the lubricants follow.
_PIECE_COLUMNS = (
    "start_seconds",
    "piece_seconds",
    "speed_kilometres_per_hour",
    "acceleration_metres_per_second_squared",
    "ascent_angle_degrees",
    "sump_temperature_celsius",
    "wheel_torque_newton_metres",
)


class Cycles(Session):
    """The method of a client for drive cycles."""

    async def cycle(
        self,
        lubricants: str | Sequence[str],
        *,
        cycle: Any = "nedc",
        sump_temperature_celsius: Quantity | None = None,
        inlet_temperature_rise_kelvin: Quantity | None = None,
        gear_set: str | None = None,
        surface: str | None = None,
        vehicle: str | None = None,
        map_tolerance: float | None = None,
        tolerance: float | None = None,
        point_by_point: bool = False,
        sheared: bool = False,
        model_options: Mapping[str, Any] | None = None,
    ) -> Frame:
        """Returns what one to eight lubricants lose over a drive cycle: one row for each lubricant
        and part of the cycle (all, standstill, drive and its phases, coast, ranges of speed).

        ``cycle`` is "nedc", a CSV file or a table with the columns time_seconds,
        speed_kilometres_per_hour (0 to 400) and, optionally, ascent_angle_degrees and
        sump_temperature_celsius: 2 to 10,000 rows, at most 20,000 s. Points are quasi-steady, from an
        adaptive map: ``map_tolerance`` (1e-5 to 0.1; None: 2e-3) is the wanted relative error of the
        energy lost; or each piece of at most 1 s is solved, ``point_by_point``, without a map
        tolerance. ``attrs`` holds ``whole``, the energies with their errors, and ``pieces``, speed,
        torque and loss over time, ``warnings`` as of point(), those of the fluids among them, and
        ``not_included``: what the figures leave out. The uncertainty of the inputs is not in them:
        compare_points() has it. A lubricant that the model refuses has NaN, and the reason in
        ``status``."""
        arguments = Arguments()
        request = pb.EvaluateCycleRequest(
            lubricants=full_names("lubricants", lubricants),
            gear_set=full_name("gearSets", gear_set or ""),
            surface=full_name("surfaces", surface or ""),
            vehicle=full_name("vehicles", vehicle or ""),
            point_by_point=point_by_point,
            sheared_lubricant=sheared,
        )
        arguments.set_numbers(
            request,
            {
                "sump_temperature_celsius": sump_temperature_celsius,
                "inlet_temperature_rise_kelvin": inlet_temperature_rise_kelvin,
                "map_tolerance": map_tolerance,
                "tolerance": tolerance,
            },
        )
        _set_cycle(arguments, cycle, request)
        set_switches(arguments, "model_options", model_options or {}, request.model_options)
        arguments.check()
        answer = await self._call("CycleService", "EvaluateCycle", request, patient=True)
        rows: list[dict[str, Any]] = []
        warnings: Warnings = {}
        for lubricant in answer.lubricants:
            own = range(len(rows), len(rows) + len(answer.parts))
            add_warnings(warnings, [*lubricant.warnings, *lubricant.input_warnings], own)
            for part, loss in zip(answer.parts, lubricant.parts or [None] * len(answer.parts)):
                rows.append(
                    {
                        "lubricant": lubricant.lubricant_revision,
                        "part": enum_word(pb.CyclePartKind.DESCRIPTOR, part.kind),
                        "minimum_speed_kilometres_per_hour": part.minimum_speed_kilometres_per_hour,
                        "maximum_speed_kilometres_per_hour": part.maximum_speed_kilometres_per_hour,
                        "duration_seconds": part.duration_seconds,
                        "distance_metres": part.distance_metres,
                        **{name: getattr(loss, name) if loss else np.nan for name in _FIGURES},
                        "status": lubricant.refusal_reason or "OK",
                        "status_message": lubricant.refusal_message,
                    }
                )
        return frame(in_columns(rows), {**_attrs(answer), "warnings": warnings})


def _set_cycle(arguments: Arguments, cycle: Any, request: pb.EvaluateCycleRequest) -> None:
    """Sets a cycle by its name, or the places of a table or CSV file."""
    if isinstance(cycle, str) and cycle.lower() == _NEDC:
        request.named_cycle = pb.NAMED_CYCLE_NEDC
        return
    names = [each.name for each in pb.CyclePlace.DESCRIPTOR.fields]
    unknown: set[str] = set()
    for i, row in enumerate(rows_of(cycle)):
        place = request.places.add()
        for name, value in row.items():
            if name not in names:
                unknown.add(name)
            elif value is not None:
                setattr(place, name, arguments.number(f"places[{i}].{name}", value))
    for name in sorted(unknown):
        arguments.wrong("cycle", f"unknown column {name}; allowed: {', '.join(names)}")


def _attrs(answer: pb.EvaluateCycleResponse) -> dict[str, Any]:
    pieces: dict[str, Any] = {name: np.array(getattr(answer, name)) for name in _PIECE_COLUMNS}
    for each in answer.lubricants:
        power = np.array(each.mesh_loss_power_watts)
        missing = np.full(len(answer.start_seconds), np.nan)
        name = f"mesh_loss_power_watts.{each.lubricant_revision}"
        pieces[name] = power if len(power) else missing
    whole = [
        {
            "lubricant": each.lubricant_revision,
            "loss_joules": each.loss_joules,
            "map_error_joules": each.map_error_joules,
            "solver_error_joules": each.solver_error_joules,
            "inefficiency_percent": each.inefficiency_percent,
            "points": each.points,
        }
        for each in answer.lubricants
    ]
    return {
        "pieces": frame(pieces, {}),
        "whole": frame(in_columns(whole), {}),
        "duration_seconds": answer.duration_seconds,
        "distance_metres": answer.distance_metres,
        "standstill_seconds": answer.standstill_seconds,
        "gear_set_revision": answer.gear_set_revision,
        "surface_revision": answer.surface_revision,
        "vehicle_revision": answer.vehicle_revision,
        "model_version": answer.model_version,
        "not_included": answer.not_included,
    }
