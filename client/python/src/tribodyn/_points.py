"""Many operating points as jobs: rows in, rows out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Awaitable, Callable, Mapping, Sequence

from tribodyn import _simulation_requests as requests
from tribodyn._arguments import Arguments
from tribodyn._frames import Frame, empty_row, point_row
from tribodyn._jobs import Outcome
from tribodyn._session import Session
from tribodyn._simulation_requests import Options
from tribodyn._table_rows import beside, rows_with
from tribodyn._transport import new_request_id
from tribodyn._warnings import Warnings, add_warnings
from tribodyn.errors import TribodynError
from tribodyn.v1 import simulations_pb2 as pb

# Rows of one scene share a curve of independent points, whose figures equal those of single points
# to the last bit at a fraction of the cost of jobs. Several curves use several processors.
_MOST_SPEEDS = 50

_PARAMETERS = (
    "gear_set",
    "surface",
    "vehicle",
    "sump_temperature_celsius",
    "inlet_temperature_rise_kelvin",
    "tolerance",
    "speed_kilometres_per_hour",
    "acceleration_metres_per_second_squared",
    "ascent_angle_degrees",
    "pinion_torque_newton_metres",
    "pinion_speed_radians_per_second",
    "model",
)

_INPUTS = ("lubricant", *_PARAMETERS)

RunAll = Callable[[Sequence[pb.CreateSimulationRequest]], Awaitable[Sequence[Outcome]]]


class Points(Session):
    """The method of a client for tables of points."""

    async def points(
        self,
        /,
        table: Any,
        *,
        options: Options = Options(),
        carry: str | Sequence[str] = (),
        **parameters: Any,
    ) -> Frame:
        """Returns the whole record of many operating points: rows in, rows out, in their order.

        ``table`` is a DataFrame, a mapping of columns, a sequence of rows, or the path of a CSV
        file. Its columns are the arguments of point(): lubricant, gear_set, surface, vehicle,
        sump_temperature_celsius, speed_kilometres_per_hour and so on; ``parameters`` hold for the
        rows that state none. Other columns ride along, and ``carry`` as of evaluate(). The points are jobs, with the bits of
        point(), solved in parallel. A row that fails has NaN, the reason in ``status`` and a
        sentence in ``status_message``; the others have "OK". ``attrs["warnings"]`` and
        ``attrs["input_warnings"]`` hold the warnings as of point(), each with the rows that it holds
        for. ``options.request_id`` is not used: equal inputs are computed once anyway.
        """
        given, rows = rows_with(table, parameters, _INPUTS, _INPUTS.__contains__, carry)

        async def run(jobs: Sequence[pb.CreateSimulationRequest]) -> Sequence[Outcome]:
            return await self._run_jobs(jobs, "points")

        warnings: Warnings = {}
        input_warnings: Warnings = {}
        cells = await _solve_rows(rows, options, run, warnings, input_warnings)
        return beside(
            table, given, cells, {"warnings": warnings, "input_warnings": input_warnings}
        )


@dataclass
class _Job:
    """A request and the rows that it computes."""

    request: pb.CreateSimulationRequest
    rows: list[int]


async def _solve_rows(
    rows: Sequence[Mapping[str, Any]],
    options: Options,
    run_all: RunAll,
    warnings: Warnings,
    input_warnings: Warnings,
) -> list[dict[str, Any]]:
    """Returns the cells of each row: figures and status "OK", or NaN and the reason. Adds the
    warnings with the rows that they hold for."""
    cells: dict[int, dict[str, Any]] = {}
    points: dict[int, pb.Simulation] = {}
    for index, row in enumerate(rows):
        try:
            points[index] = _point(row, options)
        except TribodynError as error:
            cells[index] = _refused(error)
    jobs = _jobs(points, options)
    outcomes = await run_all([job.request for job in jobs])
    singly: list[_Job] = []
    for job, outcome in zip(jobs, outcomes):
        if (
            isinstance(outcome, TribodynError)
            and outcome.reason == "INVALID_FIELDS"
            and job.request.simulation.HasField("inefficiency_curve")
        ):
            # One wrong row refuses the curve: the others are computed without it.
            singly += [_Job(_request(points[row], options), [row]) for row in job.rows]
        else:
            _place(job, outcome, points, cells, warnings, input_warnings)
    for job, outcome in zip(singly, await run_all([job.request for job in singly])):
        _place(job, outcome, points, cells, warnings, input_warnings)
    return [cells[index] for index in range(len(rows))]


def _point(row: Mapping[str, Any], options: Options) -> pb.Simulation:
    arguments = Arguments()
    if row.get("lubricant") is None:
        arguments.wrong("lubricant", "lubricant is missing")
    simulation = requests.operating_point(
        arguments,
        row.get("lubricant") or "",
        options,
        **{name: row.get(name) for name in _PARAMETERS},
    )
    arguments.check()
    return simulation


def _request(simulation: pb.Simulation, options: Options) -> pb.CreateSimulationRequest:
    arguments = Arguments()
    request = requests.request(arguments, simulation, options)
    arguments.check()
    # The jobs of a table depend on all of its rows, so that the id of the options cannot name one.
    request.request_id = new_request_id()
    return request


def _jobs(points: Mapping[int, pb.Simulation], options: Options) -> list[_Job]:
    """Returns a curve for each scene of several cruise speeds, and a job for each other row."""
    groups: dict[bytes, list[int]] = {}
    jobs = []
    for index, simulation in points.items():
        study = simulation.operating_point
        if study.WhichOneof("condition") != "cruise":
            jobs.append(_Job(_request(simulation, options), [index]))
            continue
        scene = pb.Simulation()
        scene.CopyFrom(simulation)
        scene.operating_point.cruise.speed_kilometres_per_hour = 0
        groups.setdefault(scene.SerializeToString(deterministic=True), []).append(index)
    for group in groups.values():
        for first in range(0, len(group), _MOST_SPEEDS):
            rows = group[first : first + _MOST_SPEEDS]
            jobs.append(_Job(_request(_curve([points[row] for row in rows]), options), rows))
    return jobs


def _curve(simulations: Sequence[pb.Simulation]) -> pb.Simulation:
    """Returns a curve of independent points through points of one scene; of one speed, the
    point."""
    speeds = sorted({_speed(each) for each in simulations})
    if len(speeds) == 1:
        return simulations[0]
    out = pb.Simulation()
    out.CopyFrom(simulations[0])
    study = simulations[0].operating_point
    out.inefficiency_curve.CopyFrom(
        pb.InefficiencyCurveStudy(
            speeds_kilometres_per_hour=speeds,
            ascent_angle_degrees=study.cruise.ascent_angle_degrees,
            model=study.model,
            start=study.start,
            independent_points=True,
        )
    )
    return out


def _speed(simulation: pb.Simulation) -> float:
    return simulation.operating_point.cruise.speed_kilometres_per_hour


def _place(
    job: _Job,
    outcome: Outcome,
    points: Mapping[int, pb.Simulation],
    cells: dict[int, dict[str, Any]],
    warnings: Warnings,
    input_warnings: Warnings,
) -> None:
    for row in job.rows:
        if isinstance(outcome, TribodynError):
            cells[row] = _refused(outcome)
            continue
        found = outcome.result.points[0]
        if outcome.HasField("inefficiency_curve"):
            speed = _speed(points[row])
            found = min(
                outcome.result.points, key=lambda each: abs(each.speed_kilometres_per_hour - speed)
            )
        add_warnings(warnings, found.result.warnings, [row])
        add_warnings(input_warnings, outcome.result.input_warnings, [row])
        cells[row] = {
            **point_row(found),
            "simulation": outcome.name,
            "input_hash": outcome.result.input_hash,
            "model_version": outcome.result.model_version,
        }


def _refused(error: TribodynError) -> dict[str, Any]:
    message = "; ".join(each.description for each in error.violations) or error.message
    return {
        **empty_row(error.reason or error.code, message),
        "simulation": "",
        "input_hash": "",
        "model_version": "",
    }
