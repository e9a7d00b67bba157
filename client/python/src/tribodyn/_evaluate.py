"""Screening: variants of a lubricant and a surface at many conditions, without a job of each."""

from __future__ import annotations

import asyncio
import re
from dataclasses import dataclass, field
from typing import Any, Mapping, Sequence

from tribodyn._arguments import Arguments, full_name, set_switches
from tribodyn._figures import FigureChoice
from tribodyn._enums import enum_word
from tribodyn._frames import Frame
from tribodyn._jobs import gather
from tribodyn._parameters import is_parameter, read_parameters
from tribodyn._progress import Progress
from tribodyn._session import Session
from tribodyn._table_rows import beside, rows_with
from tribodyn._transport import Transport
from tribodyn._warnings import add_warnings
from tribodyn.errors import TribodynError, Violation, is_about_the_request
from tribodyn.v1 import points_pb2, results_pb2

_BASE = ("lubricant", "gear_set", "surface", "vehicle", "tolerance")
CONDITION = tuple(each.name for each in points_pb2.PointCondition.DESCRIPTOR.fields)
INPUTS = (*_BASE, *CONDITION)

# The server takes 2000. Smaller requests share its threads, and end within its time limit.
_MOST_POINTS = 500
_CALLS_AT_A_TIME = 4

Values = tuple[float | None, ...]


class Evaluations(Session):
    """The method of a client for tables of variants."""

    async def evaluate(
        self,
        /,
        table: Any,
        *,
        model_options: Mapping[str, Any] | None = None,
        contact_figures: bool = False,
        elasticities: Sequence[str] = (),
        elasticity_figures: Sequence[str] = (),
        carry: str | Sequence[str] = (),
        **parameters: Any,
    ) -> Frame:
        """Returns the main figures of many variants at many conditions, without jobs: rows in, rows
        out, in their order. For screening, and for loops of optimisation.

        ``table`` is as of points(), with columns lubricant, gear_set, surface, vehicle, tolerance,
        speed_kilometres_per_hour, ascent_angle_degrees, sump_temperature_celsius and
        inlet_temperature_rise_kelvin. A column "lubricant.FIELD" or "surface.FIELD" states what a
        row has in place of the parameter of its lubricant or surface, with units as of create():
        "lubricant.relaxation_time_seconds", "surface.asperity_friction_coefficient". Other columns
        ride along; one whose name is similar to that of an input or a measurement ("kv40",
        "sump_temperature") is refused unless ``carry`` names it. The server keeps nothing. A figure agrees with that of a point within the estimated errors of both.
        ``model_options`` as of Options; ``status`` as of points(); ``verdict_withheld``: a warning
        says that the row decides nothing between lubricants. ``attrs`` holds model_version, the
        revisions used, ``warnings`` as of point() and ``not_included``: what the figures leave out.

        ``contact_figures`` adds film_ratio_minimum and film_ratio_mean (lambda_s),
        contact_temperature_maximum_kelvin and contact_temperature_mean_kelvin,
        viscous_loss_power_watts, boundary_loss_power_watts, mean_friction_coefficient,
        maximum_pressure_maximum_pascals and flash_temperature_rise_maximum_kelvin, for two
        fifths of the time. ``elasticities`` names parameters, e.g.
        "lubricant.relaxation_time_seconds", "gear_set.youngs_modulus_pascals",
        "sump_temperature_celsius", "speed_kilometres_per_hour" or "wheel_torque_newton_metres", and
        adds a column "elasticity.FIGURE.PARAMETER" for each of ``elasticity_figures`` (none:
        inefficiency_energy_mean_percent): the relative change of the figure over that of the
        parameter, temperatures from 0 K, exact to rounding; NaN at a fold. A point then takes four
        to seven times as long.
        """
        given, rows = rows_with(table, parameters, INPUTS, _is_known, carry)
        evaluation = _Evaluation(
            self._transport, model_options or {}, contact_figures, elasticities, elasticity_figures
        )
        cells = await evaluation.run(rows, self._settings.progress)
        return beside(table, given, cells, evaluation.attrs)


def _is_known(name: str) -> bool:
    return name in INPUTS or is_parameter(name)


@dataclass
class _Group:
    """Rows of one base, whose candidates differ in the same parameters."""

    base: tuple[Any, ...]
    paths: tuple[str, ...]
    candidates: dict[Values, dict[Values, list[int]]] = field(default_factory=dict)


@dataclass
class _Request:
    """A request, and the rows of the table that its candidates and conditions are."""

    message: points_pb2.EvaluatePointsRequest
    rows: list[list[list[int]]]  # by candidate, then by condition

    def at(self, candidate: int | None, condition: int | None) -> list[int]:
        """Returns the rows of a candidate or of a condition; None: of all."""
        chosen = self.rows if candidate is None else [self.rows[candidate]]
        cells = [
            cell for row in chosen for cell in (row if condition is None else [row[condition]])
        ]
        return [index for cell in cells for index in cell]


class _Evaluation:
    """Evaluates the rows of one table."""

    def __init__(
        self,
        transport: Transport,
        model_options: Mapping[str, Any],
        contact_figures: bool,
        elasticities: Sequence[str],
        elasticity_figures: Sequence[str],
    ) -> None:
        self._transport = transport
        self._model_options = points_pb2.EvaluatePointsRequest().model_options
        arguments = Arguments()
        set_switches(arguments, "model_options", model_options, self._model_options)
        self._figures = FigureChoice.read(
            arguments, contact_figures, elasticities, elasticity_figures
        )
        arguments.check()
        self._calls = asyncio.Semaphore(_CALLS_AT_A_TIME)
        self._cells: dict[int, dict[str, Any]] = {}
        self.attrs: dict[str, Any] = {
            "model_version": "",
            "revisions": [],
            "warnings": {},
            "not_included": "",
        }

    async def run(
        self, rows: Sequence[Mapping[str, Any]], progress_form: str
    ) -> list[dict[str, Any]]:
        """Returns the cells of each row: figures and status "OK", or NaN and the reason."""
        groups: dict[tuple[Any, ...], _Group] = {}
        for index, row in enumerate(rows):
            arguments = Arguments()
            base, varied, condition = _read(arguments, row)
            if arguments.violations:
                self._refuse([index], "INVALID_FIELDS", arguments.violations)
                continue
            paths = tuple(varied)
            group = groups.setdefault((base, paths), _Group(base, paths))
            conditions = group.candidates.setdefault(tuple(varied.values()), {})
            conditions.setdefault(condition, []).append(index)
        requests = [each for group in groups.values() for each in self._requests(group)]
        progress = Progress(progress_form, len(requests), "evaluate")

        async def evaluate(number: int, request: _Request) -> None:
            await self._evaluate(request)
            progress.update(str(number), 1)

        try:
            await gather(*(evaluate(*each) for each in enumerate(requests)))
        finally:
            progress.close()
        return [self._cells[index] for index in range(len(rows))]

    def _requests(self, group: _Group) -> list[_Request]:
        """Returns requests for candidates with equal conditions, so that no other point is solved."""
        by_conditions: dict[tuple[Values, ...], list[Values]] = {}
        for candidate, cells in group.candidates.items():
            by_conditions.setdefault(tuple(cells), []).append(candidate)
        out = []
        for conditions, candidates in by_conditions.items():
            width = min(len(conditions), _MOST_POINTS)
            height = max(1, _MOST_POINTS // width)
            for left in range(0, len(conditions), width):
                for top in range(0, len(candidates), height):
                    chosen, at = candidates[top : top + height], conditions[left : left + width]
                    rows = [[group.candidates[each][one] for one in at] for each in chosen]
                    out.append(_Request(self._message(group, chosen, at), rows))
        return out

    def _message(
        self, group: _Group, candidates: Sequence[Values], conditions: Sequence[Values]
    ) -> points_pb2.EvaluatePointsRequest:
        lubricant, gear_set, surface, vehicle, tolerance = group.base
        out = points_pb2.EvaluatePointsRequest(
            lubricant=full_name("lubricants", lubricant or ""),
            gear_set=full_name("gearSets", gear_set or ""),
            surface=full_name("surfaces", surface or ""),
            vehicle=full_name("vehicles", vehicle or ""),
            model_options=self._model_options,
            tolerance=tolerance or 0.0,
        )
        self._figures.set(out)
        for i, path in enumerate(group.paths):
            out.candidate_columns.add(path=path, values=[each[i] for each in candidates])
        for values in conditions:
            stated = {name: value for name, value in zip(CONDITION, values) if value is not None}
            out.conditions.add(**stated)
        return out

    async def _evaluate(self, request: _Request) -> None:
        """Evaluates a request; the rows that the server refuses are left out of a second one."""
        while request.rows and request.rows[0]:
            try:
                async with self._calls:
                    answer = await self._transport.call(
                        "PointService", "EvaluatePoints", request.message, patient=True
                    )
                return self._place(request, answer)
            except TribodynError as error:
                if not is_about_the_request(error):
                    raise
                if not self._leave_out(request, error):
                    return self._refuse(
                        request.at(None, None), error.reason, error.violations, error.message
                    )

    def _place(self, request: _Request, answer: points_pb2.EvaluatePointsResponse) -> None:
        elasticities = {
            f"elasticity.{each.figure}.{each.parameter}": each.values
            for each in answer.elasticities
        }
        columns = {
            name: elasticities[name] if name in elasticities else getattr(answer, name)
            for name in self._figures.columns()
        }
        self.attrs["model_version"] = answer.model_version
        self.attrs["not_included"] = answer.not_included
        for each in answer.warnings:
            for row in each.rows:
                candidate, condition = divmod(row, answer.conditions)
                add_warnings(self.attrs["warnings"], [each], request.rows[candidate][condition])
        for kind in ("lubricant", "gear_set", "surface", "vehicle"):
            revision = getattr(answer, kind + "_revision")
            if revision not in self.attrs["revisions"]:
                self.attrs["revisions"].append(revision)
        for i, candidate in enumerate(request.rows):
            for k, indices in enumerate(candidate):
                at = answer.conditions * i + k
                number = answer.refusal_numbers[at]
                if number:
                    refusal = answer.refusals[number - 1]
                    self._refuse(indices, refusal.reason, (), refusal.message)
                    continue
                cells = {name: values[at] for name, values in columns.items()}
                cells["model"] = enum_word(results_pb2.PointModel.DESCRIPTOR, cells["model"])
                for index in indices:
                    self._cells[index] = {**cells, "status": "OK", "status_message": ""}

    def _leave_out(self, request: _Request, error: TribodynError) -> bool:
        """Removes the candidates and conditions that the server refuses. Returns false if it refuses
        something else."""
        bad: list[dict[int, list[Violation]]] = [{}, {}]  # candidates, conditions
        for each in error.violations:
            candidate = re.match(r"candidate_columns\[\d+\]\.values\[(\d+)\]", each.field)
            condition = re.match(r"conditions\[(\d+)\]", each.field)
            found = candidate or condition
            if found is None:
                continue
            bad[0 if candidate else 1].setdefault(int(found[1]), []).append(each)
        for i in sorted(bad[0], reverse=True):
            self._refuse(request.at(i, None), error.reason, bad[0][i])
            del request.rows[i]
            for column in request.message.candidate_columns:
                del column.values[i]
        for k in sorted(bad[1], reverse=True):
            self._refuse(request.at(None, k), error.reason, bad[1][k])
            del request.message.conditions[k]
            for row in request.rows:
                del row[k]
        return bool(bad[0] or bad[1])

    def _refuse(
        self,
        indices: Sequence[int],
        reason: str,
        violations: Sequence[Violation],
        message: str = "",
    ) -> None:
        empty: dict[str, Any] = {name: float("nan") for name in self._figures.columns()}
        text = "; ".join(each.description for each in violations) or message
        for index in indices:
            self._cells[index] = {**empty, "model": "", "status": reason, "status_message": text}


def _read(
    arguments: Arguments, row: Mapping[str, Any]
) -> tuple[tuple[Any, ...], dict[str, float], Values]:
    """Returns base, varied parameters and condition of a row."""
    base = tuple(row.get(name) for name in _BASE)
    if not base[0]:
        arguments.wrong("lubricant", "lubricant is missing")
    condition = tuple(
        None if row.get(name) is None else arguments.number(name, row[name]) for name in CONDITION
    )
    if condition[0] is None:
        arguments.wrong(CONDITION[0], f"{CONDITION[0]} is missing")
    return base, read_parameters(arguments, row), condition
