"""Lubricants with the uncertainty of their inputs: which loses less, and why."""

from __future__ import annotations

import itertools
from typing import Any, Mapping, Sequence

from tribodyn._frames import Frame, enum_word, frame, in_columns, message_cells
from tribodyn._studies import Arguments, full_name, set_switches
from tribodyn._transport import Transport
from tribodyn.units import Quantity
from tribodyn.v1 import points_pb2 as pb

_VERDICT = "verdict"


def scene(
    arguments: Arguments,
    out: Any,
    *,
    speeds_kilometres_per_hour: Sequence[Quantity],
    sump_temperatures_celsius: Sequence[Quantity],
    speed_weights: Sequence[float] | None,
    sump_weights: Sequence[float] | None,
    ascent_angle_degrees: Quantity | None,
    inlet_temperature_rise_kelvin: Quantity | None,
    sump_temperature_uncertainty_kelvin: float | None,
    inlet_temperature_rise_uncertainty_kelvin: float | None,
    estimate_correlation: float | None,
    draws: int | None,
    gear_set: str | None,
    surface: str | None,
    vehicle: str | None,
    tolerance: float | None,
    model_options: Mapping[str, Any] | None,
) -> None:
    """Sets what requests for comparisons and explanations have in common: conditions by sump, then
    by speed, and hardware."""
    speeds = [
        arguments.number("speeds_kilometres_per_hour", each) for each in speeds_kilometres_per_hour
    ]
    sumps = [
        arguments.number("sump_temperatures_celsius", each) for each in sump_temperatures_celsius
    ]
    for sump, speed in itertools.product(sumps, speeds):
        condition = out.conditions.add(
            speed_kilometres_per_hour=speed, sump_temperature_celsius=sump
        )
        if ascent_angle_degrees is not None:
            condition.ascent_angle_degrees = arguments.number(
                "ascent_angle_degrees", ascent_angle_degrees
            )
        if inlet_temperature_rise_kelvin is not None:
            condition.inlet_temperature_rise_kelvin = arguments.number(
                "inlet_temperature_rise_kelvin", inlet_temperature_rise_kelvin
            )
    if speed_weights is not None or sump_weights is not None:
        by_speed = _weights(arguments, "speed_weights", speed_weights, len(speeds))
        by_sump = _weights(arguments, "sump_weights", sump_weights, len(sumps))
        out.condition_weights.extend(a * b for a, b in itertools.product(by_sump, by_speed))
    out.gear_set = full_name("gearSets", gear_set or "")
    out.surface = full_name("surfaces", surface or "")
    out.vehicle = full_name("vehicles", vehicle or "")
    stated = {
        "sump_temperature_uncertainty_kelvin": sump_temperature_uncertainty_kelvin,
        "inlet_temperature_rise_uncertainty_kelvin": inlet_temperature_rise_uncertainty_kelvin,
        "estimate_correlation": estimate_correlation,
        "draws": draws,
        "tolerance": tolerance,
    }
    for name, value in stated.items():
        if value is not None:
            setattr(out, name, value)
    set_switches(arguments, "model_options", model_options or {}, out.model_options)


def _weights(
    arguments: Arguments, name: str, weights: Sequence[float] | None, count: int
) -> list[float]:
    if weights is None:
        return [1.0] * count
    if len(weights) != count:
        arguments.wrong(name, f"{len(weights)} weights; allowed: {count}, one for each value")
    return [float(each) for each in weights]


async def compared(transport: Transport, request: pb.ComparePointsRequest) -> Frame:
    """Returns one row for each lubricant and condition."""
    answer = await transport.call("PointService", "ComparePoints", request, patient=True)
    rows, means = [], []
    for lubricant in answer.lubricants:
        differences = list(lubricant.differences) or [None] * len(lubricant.points)
        for condition, point, difference in zip(request.conditions, lubricant.points, differences):
            row = _condition(lubricant.lubricant_revision, condition)
            row.update(message_cells(point, present=not point.refusal_reason))
            row.update(_difference(difference))
            row.update(_status(row, point.refusal_reason))
            rows.append(row)
        mean: dict[str, Any] = {"lubricant": lubricant.lubricant_revision}
        mean.update(
            message_cells(
                lubricant.mean_inefficiency_percent,
                "mean_inefficiency_percent_",
                lubricant.HasField("mean_inefficiency_percent"),
            )
        )
        has_difference = lubricant.HasField("mean_difference")
        mean.update(_difference(lubricant.mean_difference if has_difference else None))
        shares = lubricant.mean_difference.shares if has_difference else lubricant.mean_shares
        mean["measure_first"] = shares[0].input if shares else ""
        mean["measure_first_share"] = shares[0].variance_share if shares else float("nan")
        mean["best_probability"] = lubricant.best_probability
        means.append(mean)
    attrs = {
        "mean": frame(in_columns(means), {}),
        "draws": answer.draws,
        "estimate_correlation": answer.estimate_correlation,
        "inputs_without_uncertainty": {
            each.lubricant_revision: list(each.inputs_without_uncertainty)
            for each in answer.lubricants
        },
        "revisions": [answer.gear_set_revision, answer.surface_revision, answer.vehicle_revision],
        "model_version": answer.model_version,
    }
    return frame(in_columns(rows), attrs)


async def explained(transport: Transport, request: pb.ExplainPointsRequest) -> Frame:
    """Returns one row for each condition and group of parameters."""
    answer = await transport.call("PointService", "ExplainPoints", request, patient=True)
    rows = []
    for condition, point in zip(request.conditions, answer.points):
        rows += [
            {**_condition(answer.other_lubricant_revision, condition), **cells}
            for cells in _causes(point)
        ]
    mean = answer.mean
    attrs = {
        "mean": frame(in_columns(_causes(mean)), {}),
        "interactions": frame(
            in_columns(
                {
                    "group": _group(each.group),
                    "other_group": _group(each.other_group),
                    "inefficiency_percent": each.inefficiency_percent,
                    "mesh_loss_power_watts": each.mesh_loss_power_watts,
                }
                for each in mean.interactions
            ),
            {},
        ),
        "inefficiency_percent": mean.inefficiency_percent.value,
        "other_inefficiency_percent": mean.other_inefficiency_percent.value,
        "inefficiency_difference_percent": mean.inefficiency_difference_percent.value,
        "inefficiency_difference_interval": (
            mean.inefficiency_difference_percent.interval_minimum,
            mean.inefficiency_difference_percent.interval_maximum,
        ),
        "solver_error_percent": mean.inefficiency_difference_percent.solver_error,
        "draws": answer.draws,
        "estimate_correlation": answer.estimate_correlation,
        "lubricant": answer.lubricant_revision,
        "other_lubricant": answer.other_lubricant_revision,
        "revisions": [
            answer.gear_set_revision,
            answer.surface_revision,
            answer.other_surface_revision,
            answer.vehicle_revision,
        ],
        "model_version": answer.model_version,
    }
    return frame(in_columns(rows), attrs)


def _condition(lubricant: str, condition: pb.PointCondition) -> dict[str, Any]:
    return {
        "lubricant": lubricant,
        "speed_kilometres_per_hour": condition.speed_kilometres_per_hour,
        "sump_temperature_celsius": condition.sump_temperature_celsius,
    }


def _difference(difference: pb.ComparedDifference | None) -> dict[str, Any]:
    """Returns the cells of a difference from the first lubricant; None: of the first itself."""
    message = difference or pb.ComparedDifference()
    there = message.HasField("difference_percent")
    out = message_cells(message.difference_percent, "difference_percent_", there)
    out["lower_probability"] = message.lower_probability if there else float("nan")
    out[_VERDICT] = (
        enum_word(pb.ComparedDifference.Verdict.DESCRIPTOR, message.verdict) if there else ""
    )
    return out


def _status(row: dict[str, Any], reason: str) -> dict[str, str]:
    """Returns status and its sentence in place of the fields of the message."""
    row.pop("refusal_reason")
    return {"status": reason or "OK", "status_message": row.pop("refusal_message")}


def _causes(point: pb.DifferenceExplanation) -> list[dict[str, Any]]:
    status = {
        "status": point.refusal_reason or "OK",
        "status_message": point.refusal_message,
    }
    if not point.causes:
        return [{**message_cells(pb.DifferenceCause(), present=False), **status}]
    return [
        {**message_cells(cause), "group": _group(cause.group), **status} for cause in point.causes
    ]


def _group(number: int) -> str:
    return enum_word(pb.ParameterGroup.DESCRIPTOR, number)
