"""Screening: variants of a lubricant and a surface at many conditions, without a job of each."""

from __future__ import annotations

import asyncio
import re
from dataclasses import dataclass, field
from typing import Any, Mapping, Sequence

from tribodyn._frames import enum_word
from tribodyn._jobs import gather
from tribodyn._progress import Progress
from tribodyn._rows import find_column
from tribodyn._studies import Arguments, full_name, set_switches
from tribodyn._transport import Transport
from tribodyn.errors import TribodynError, Violation, is_about_the_request
from tribodyn.units import Quantity, QuantityError, quantity
from tribodyn.v1 import points_pb2, results_pb2
from tribodyn.v1.lubricants_pb2 import Lubricant
from tribodyn.v1.surfaces_pb2 import Surface

BASE = ("lubricant", "gear_set", "surface", "vehicle", "tolerance")
CONDITION = (
    "speed_kilometres_per_hour",
    "ascent_angle_degrees",
    "sump_temperature_celsius",
    "inlet_temperature_rise_kelvin",
)
_VARIED = {"lubricant": Lubricant, "surface": Surface}

# The server takes 2000. Smaller requests share its threads, and end within its time limit.
_MOST_POINTS = 500
_CALLS_AT_A_TIME = 4
# Columns of the answer that every point has.
FIGURES = [
    "pinion_torque_newton_metres",
    "wheel_torque_newton_metres",
    "inefficiency_rms_percent",
    "inefficiency_energy_mean_percent",
    "mesh_loss_power_watts",
    "dynamic_transmission_error_minimum_metres",
    "dynamic_transmission_error_maximum_metres",
    "contact_loss",
    "settled",
    "period_in_mesh_cycles",
    "estimated_relative_error",
    "model",
]
CONTACT_FIGURES = [
    "film_ratio_minimum",
    "film_ratio_mean",
    "contact_temperature_maximum_kelvin",
    "contact_temperature_mean_kelvin",
    "viscous_loss_power_watts",
    "boundary_loss_power_watts",
    "mean_friction_coefficient",
    "maximum_pressure_maximum_pascals",
    "flash_temperature_rise_maximum_kelvin",
]
_DEFAULT_ELASTICITY = "inefficiency_energy_mean_percent"
_ONE_SIDED = "elasticities_one_sided"

Values = tuple[float | None, ...]


@dataclass(frozen=True)
class Extras:
    """Figures of points beside the usual ones."""

    contact_figures: bool = False
    elasticity_parameters: tuple[str, ...] = ()
    elasticity_figures: tuple[str, ...] = ()

    @staticmethod
    def read(
        arguments: Arguments,
        contact_figures: bool,
        elasticities: Sequence[str],
        elasticity_figures: Sequence[str],
    ) -> Extras:
        parameters = [elasticities] if isinstance(elasticities, str) else elasticities
        figures = [elasticity_figures] if isinstance(elasticity_figures, str) else elasticity_figures
        paths = (parameter_path(arguments, "elasticities", name) for name in parameters)
        return Extras(contact_figures, tuple(dict.fromkeys(paths)), tuple(figures))

    @staticmethod
    def of(message: Any) -> Extras:
        """Returns those of a request or campaign."""
        return Extras(
            message.contact_figures,
            tuple(message.elasticity_parameters),
            tuple(message.elasticity_figures),
        )

    def set(self, message: Any) -> None:
        """Writes them to a request or campaign."""
        message.contact_figures = self.contact_figures
        message.elasticity_parameters.extend(self.elasticity_parameters)
        message.elasticity_figures.extend(self.elasticity_figures)

    def columns(self) -> list[str]:
        """Returns the names of all columns of figures."""
        out = [*FIGURES, *(CONTACT_FIGURES if self.contact_figures else [])]
        if self.elasticity_parameters:
            out.append(_ONE_SIDED)
        for figure in self.elasticity_figures or (_DEFAULT_ELASTICITY,):
            out += [f"elasticity.{figure}.{each}" for each in self.elasticity_parameters]
        return out


def parameter_path(arguments: Arguments, argument: str, name: str) -> str:
    """Returns the path of a parameter, "lubricant.alpha" for one."""
    owner, _, parameter = name.partition(".")
    column = find_column(_VARIED[owner], parameter) if owner in _VARIED else None
    if column is None or column.kind != "field" or column.block is not None:
        arguments.wrong(argument, f"{name} is no parameter of a lubricant or surface")
        return name
    return f"{owner}.{column.field.name}"


def is_parameter(name: str) -> bool:
    """Whether evaluate() takes the name: an argument, or "lubricant." or "surface." and a field."""
    return name in BASE or name in CONDITION or name.partition(".")[0] in _VARIED


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


class Evaluation:
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
        self._extras = Extras.read(arguments, contact_figures, elasticities, elasticity_figures)
        arguments.check()
        self._calls = asyncio.Semaphore(_CALLS_AT_A_TIME)
        self._cells: dict[int, dict[str, Any]] = {}
        self.attrs: dict[str, Any] = {"model_version": "", "revisions": []}

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
        self._extras.set(out)
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
            for name in self._extras.columns()
        }
        self.attrs["model_version"] = answer.model_version
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
        empty: dict[str, Any] = {name: float("nan") for name in self._extras.columns()}
        text = "; ".join(each.description for each in violations) or message
        for index in indices:
            self._cells[index] = {**empty, "model": "", "status": reason, "status_message": text}


def _read(
    arguments: Arguments, row: Mapping[str, Any]
) -> tuple[tuple[Any, ...], dict[str, float], Values]:
    """Returns base, varied parameters and condition of a row."""
    base = tuple(row.get(name) for name in BASE)
    if not base[0]:
        arguments.wrong("lubricant", "lubricant is missing")
    condition = tuple(
        None if row.get(name) is None else arguments.number(name, row[name]) for name in CONDITION
    )
    if condition[0] is None:
        arguments.wrong(CONDITION[0], f"{CONDITION[0]} is missing")
    return base, read_varied(arguments, row), condition


def read_varied(arguments: Arguments, row: Mapping[str, Any]) -> dict[str, float]:
    """Returns the paths and values of the parameters that a row states."""
    varied = {}
    for name, value in row.items():
        owner, dot, parameter = name.partition(".")
        if dot and owner in _VARIED and value is not None:
            varied.update(_varied(arguments, owner, parameter, value))
    return varied


def _varied(arguments: Arguments, owner: str, parameter: str, value: Quantity) -> dict[str, float]:
    """Returns the path of a parameter and its value in the parameter's unit."""
    column = find_column(_VARIED[owner], parameter)
    if column is None or column.kind != "field" or column.block is not None:
        arguments.wrong(f"{owner}.{parameter}", f"{parameter} is no parameter of a {owner}")
        return {}
    try:
        number = quantity(value, column.field.name, unit=column.unit)
    except QuantityError as error:
        arguments.wrong(f"{owner}.{parameter}", f"{value!r} {error}")
        return {}
    return {f"{owner}.{column.field.name}": number}
