"""Lubricants with the uncertainty of their inputs: which loses less, and why."""

from __future__ import annotations

import itertools
from typing import Any, Mapping, Sequence

from tribodyn._arguments import Arguments, full_name, full_names, set_switches
from tribodyn._enums import enum_word
from tribodyn._frames import Frame, frame, in_columns, message_cells
from tribodyn._session import Session
from tribodyn._warnings import Warnings, add_warnings
from tribodyn.units import Quantity
from tribodyn.v1 import points_pb2 as pb

_VERDICT = "verdict"
_MEAN = -1  # row of what holds for the mean of the conditions


class Comparisons(Session):
    """Methods of a client for a few lubricants with the uncertainty of their inputs."""

    async def compare_points(
        self,
        lubricants: Sequence[str],
        *,
        speeds_kilometres_per_hour: Sequence[Quantity] = (60,),
        sump_temperatures_celsius: Sequence[Quantity] = (40,),
        speed_weights: Sequence[float] | None = None,
        sump_weights: Sequence[float] | None = None,
        ascent_angle_degrees: Quantity | None = None,
        inlet_temperature_rise_kelvin: Quantity | None = None,
        sump_temperature_uncertainty_kelvin: float | None = None,
        inlet_temperature_rise_uncertainty_kelvin: float | None = None,
        estimate_correlation: float | None = None,
        draws: int | None = None,
        gear_set: str | None = None,
        surface: str | None = None,
        vehicle: str | None = None,
        tolerance: float | None = None,
        model_options: Mapping[str, Any] | None = None,
        sheared: bool = False,
        contact_figures: bool = False,
    ) -> Frame:
        """Returns one to eight lubricants at every speed and sump temperature with the uncertainty
        of their inputs, one row for each lubricant and condition, and what each loses more than the
        first: `difference_percent_value` with its 95 % interval, `lower_probability` and `verdict`
        ("lower", "higher", "cannot-be-told-apart", "withheld" by a warning,
        "uncertainty-not-stated").

        Columns FIGURE_standard_uncertainty come from ``draws`` draws of the inputs (None: 199),
        FIGURE_solver_error is the solver's. Uncertainties of temperatures are standard ones, in K.
        ``estimate_correlation`` (0 to 1; None: 0.5) is that of estimates that one estimator made for
        two lubricants. ``sheared``: the lubricants after the shear test. ``contact_figures``: also
        film ratio, friction coefficient, pressure and temperatures. Of a lubricant of which nobody
        stated an uncertainty ``uncertainty_stated`` is False, and there is no interval.

        ``attrs["mean"]`` is a table of the weighted means, with the probability of the least and the
        input to measure first; ``attrs["deciding_inputs"]`` one of what would tell two lubricants
        apart: the standard uncertainty that an input would need, and its ratio to the present one;
        ``row`` is that of the difference, -1 for the mean, and with ``all_needed`` no single one would
        do. ``attrs["warnings"]`` as of point(), ``attrs["not_included"]``: what the figures leave
        out. Weights as of screen(); nothing is kept.
        """
        request = pb.ComparePointsRequest(
            lubricants=full_names("lubricants", lubricants),
            sheared_lubricant=sheared,
            contact_figures=contact_figures,
        )
        _set_scene(
            request,
            speeds_kilometres_per_hour=speeds_kilometres_per_hour,
            sump_temperatures_celsius=sump_temperatures_celsius,
            speed_weights=speed_weights,
            sump_weights=sump_weights,
            ascent_angle_degrees=ascent_angle_degrees,
            inlet_temperature_rise_kelvin=inlet_temperature_rise_kelvin,
            sump_temperature_uncertainty_kelvin=sump_temperature_uncertainty_kelvin,
            inlet_temperature_rise_uncertainty_kelvin=inlet_temperature_rise_uncertainty_kelvin,
            estimate_correlation=estimate_correlation,
            draws=draws,
            gear_set=gear_set,
            surface=surface,
            vehicle=vehicle,
            tolerance=tolerance,
            model_options=model_options,
        )
        return _compared(
            request, await self._call("PointService", "ComparePoints", request, patient=True)
        )

    async def explain(
        self,
        lubricant: str,
        other_lubricant: str,
        *,
        speeds_kilometres_per_hour: Sequence[Quantity] = (60,),
        sump_temperatures_celsius: Sequence[Quantity] = (40,),
        speed_weights: Sequence[float] | None = None,
        sump_weights: Sequence[float] | None = None,
        ascent_angle_degrees: Quantity | None = None,
        inlet_temperature_rise_kelvin: Quantity | None = None,
        sump_temperature_uncertainty_kelvin: float | None = None,
        inlet_temperature_rise_uncertainty_kelvin: float | None = None,
        estimate_correlation: float | None = None,
        draws: int | None = None,
        gear_set: str | None = None,
        surface: str | None = None,
        vehicle: str | None = None,
        tolerance: float | None = None,
        model_options: Mapping[str, Any] | None = None,
        other_surface: str | None = None,
        sheared: bool = False,
        other_sheared: bool = False,
    ) -> Frame:
        """Returns why ``other_lubricant`` loses more or less than ``lubricant``: the share of each
        of six groups of parameters in the difference, one row for each condition and group.

        ``inefficiency_percent_shapley_value_value`` is the share in percentage points, with its
        uncertainty in the columns beside it; the shares of all groups sum to the difference.
        ``..._first_effect`` and ``..._last_effect`` are what the group adds if it is exchanged before
        and after all others. ``attrs["mean"]`` is the same table for the weighted mean,
        ``attrs["interactions"]`` what pairs of groups add beyond what each adds alone;
        ``attrs["warnings"]`` and ``attrs["not_included"]`` as of compare_points().
        ``draws``: None: 99. ``other_surface``: of the other lubricant, with the boundary film that
        it makes. Other arguments as of compare_points().
        """
        request = pb.ExplainPointsRequest(
            lubricant=full_name("lubricants", lubricant),
            other_lubricant=full_name("lubricants", other_lubricant),
            other_surface=full_name("surfaces", other_surface or ""),
            sheared_lubricant=sheared,
            other_sheared_lubricant=other_sheared,
        )
        _set_scene(
            request,
            speeds_kilometres_per_hour=speeds_kilometres_per_hour,
            sump_temperatures_celsius=sump_temperatures_celsius,
            speed_weights=speed_weights,
            sump_weights=sump_weights,
            ascent_angle_degrees=ascent_angle_degrees,
            inlet_temperature_rise_kelvin=inlet_temperature_rise_kelvin,
            sump_temperature_uncertainty_kelvin=sump_temperature_uncertainty_kelvin,
            inlet_temperature_rise_uncertainty_kelvin=inlet_temperature_rise_uncertainty_kelvin,
            estimate_correlation=estimate_correlation,
            draws=draws,
            gear_set=gear_set,
            surface=surface,
            vehicle=vehicle,
            tolerance=tolerance,
            model_options=model_options,
        )
        return _explained(
            request, await self._call("PointService", "ExplainPoints", request, patient=True)
        )


def _set_scene(
    out: Any,
    *,
    speeds_kilometres_per_hour: Sequence[Quantity],
    sump_temperatures_celsius: Sequence[Quantity],
    speed_weights: Sequence[float] | None,
    sump_weights: Sequence[float] | None,
    ascent_angle_degrees: Quantity | None,
    inlet_temperature_rise_kelvin: Quantity | None,
    gear_set: str | None,
    surface: str | None,
    vehicle: str | None,
    model_options: Mapping[str, Any] | None,
    **settings: float | None,
) -> None:
    """Sets what requests for comparisons and explanations have in common: conditions by sump, then
    by speed, and hardware. ``settings``: other fields that are numbers. Raises TribodynError if an
    argument is wrong."""
    arguments = Arguments()
    speeds = arguments.numbers("speeds_kilometres_per_hour", speeds_kilometres_per_hour)
    sumps = arguments.numbers("sump_temperatures_celsius", sump_temperatures_celsius)
    for sump, speed in itertools.product(sumps, speeds):
        condition = out.conditions.add(
            speed_kilometres_per_hour=speed, sump_temperature_celsius=sump
        )
        common = {
            "ascent_angle_degrees": ascent_angle_degrees,
            "inlet_temperature_rise_kelvin": inlet_temperature_rise_kelvin,
        }
        arguments.set_numbers(condition, common)
    if speed_weights is not None or sump_weights is not None:
        by_speed = _weights(arguments, "speed_weights", speed_weights, len(speeds))
        by_sump = _weights(arguments, "sump_weights", sump_weights, len(sumps))
        out.condition_weights.extend(a * b for a, b in itertools.product(by_sump, by_speed))
    out.gear_set = full_name("gearSets", gear_set or "")
    out.surface = full_name("surfaces", surface or "")
    out.vehicle = full_name("vehicles", vehicle or "")
    for name, value in settings.items():
        if value is not None:
            setattr(out, name, value)
    set_switches(arguments, "model_options", model_options or {}, out.model_options)
    arguments.check()


def _weights(
    arguments: Arguments, name: str, weights: Sequence[float] | None, count: int
) -> list[float]:
    if weights is None:
        return [1.0] * count
    if len(weights) != count:
        arguments.wrong(name, f"{len(weights)} weights; allowed: {count}, one for each value")
    return [float(each) for each in weights]


def _compared(request: pb.ComparePointsRequest, answer: pb.ComparePointsResponse) -> Frame:
    """Returns one row for each lubricant and condition."""
    rows: list[dict[str, Any]] = []
    means: list[dict[str, Any]] = []
    deciding: list[dict[str, Any]] = []
    warnings: Warnings = {}
    for lubricant in answer.lubricants:
        stated = lubricant.uncertainty_stated
        differences = list(lubricant.differences) or [None] * len(lubricant.points)
        for condition, point, difference in zip(request.conditions, lubricant.points, differences):
            row = _condition(lubricant.lubricant_revision, condition)
            figures = message_cells(point, present=not point.refusal_reason)
            row.update(figures if stated else _without_intervals(figures))
            row["uncertainty_stated"] = stated
            row.update(_difference(difference))
            row.update(_status(row, point.refusal_reason))
            add_warnings(warnings, point.warnings, [len(rows)])
            deciding += _deciding(lubricant.lubricant_revision, len(rows), difference)
            rows.append(row)
        mean: dict[str, Any] = {"lubricant": lubricant.lubricant_revision}
        figures = message_cells(
            lubricant.mean_inefficiency_percent,
            "mean_inefficiency_percent_",
            lubricant.HasField("mean_inefficiency_percent"),
        )
        mean.update(figures if stated else _without_intervals(figures))
        mean["uncertainty_stated"] = stated
        has_difference = lubricant.HasField("mean_difference")
        mean_difference = lubricant.mean_difference if has_difference else None
        mean.update(_difference(mean_difference))
        deciding += _deciding(lubricant.lubricant_revision, _MEAN, mean_difference)
        shares = lubricant.mean_difference.shares if has_difference else lubricant.mean_shares
        mean["measure_first"] = shares[0].input if shares else ""
        mean["measure_first_share"] = shares[0].variance_share if shares else float("nan")
        mean["best_probability"] = lubricant.best_probability
        means.append(mean)
    attrs = {
        "mean": frame(in_columns(means), {}),
        "draws": answer.draws,
        "estimate_correlation": answer.estimate_correlation,
        "deciding_inputs": frame(in_columns(deciding), {}),
        "warnings": warnings,
        "not_included": answer.not_included,
        "inputs_without_uncertainty": {
            each.lubricant_revision: list(each.inputs_without_uncertainty)
            for each in answer.lubricants
        },
        "revisions": [answer.gear_set_revision, answer.surface_revision, answer.vehicle_revision],
        "model_version": answer.model_version,
    }
    return frame(in_columns(rows), attrs)


def _explained(request: pb.ExplainPointsRequest, answer: pb.ExplainPointsResponse) -> Frame:
    """Returns one row for each condition and group of parameters."""
    rows: list[dict[str, Any]] = []
    warnings: Warnings = {}
    for condition, point in zip(request.conditions, answer.points):
        causes = _causes(point)
        add_warnings(warnings, point.warnings, range(len(rows), len(rows) + len(causes)))
        rows += [
            {**_condition(answer.other_lubricant_revision, condition), **cells} for cells in causes
        ]
    mean = answer.mean
    add_warnings(warnings, mean.warnings)
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
        "warnings": warnings,
        "not_included": answer.not_included,
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
    if message.verdict == pb.ComparedDifference.UNCERTAINTY_NOT_STATED:
        out = _without_intervals(out)
    out["lower_probability"] = message.lower_probability if there else float("nan")
    out[_VERDICT] = (
        enum_word(pb.ComparedDifference.Verdict.DESCRIPTOR, message.verdict) if there else ""
    )
    return out


def _without_intervals(cells: dict[str, Any]) -> dict[str, Any]:
    """Returns figures of whose inputs nobody stated an uncertainty: 0 would mean exact."""
    ends = ("standard_uncertainty", "interval_minimum", "interval_maximum")
    return {name: float("nan") if name.endswith(ends) else value for name, value in cells.items()}


def _deciding(
    lubricant: str, row: int, difference: pb.ComparedDifference | None
) -> list[dict[str, Any]]:
    """Returns what would tell a lubricant and the first one apart."""
    if difference is None:
        return []
    return [
        {
            "lubricant": lubricant,
            "row": row,
            "input": each.input,
            "input_of": each.lubricant_revision,
            "standard_uncertainty": each.standard_uncertainty,
            "factor": each.factor,
            "all_needed": difference.all_needed,
        }
        for each in difference.deciding_inputs
    ]


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
