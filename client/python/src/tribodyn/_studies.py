"""Studies that are jobs of the server: points, curves, histories and sensitivities."""

from __future__ import annotations

from typing import Any, Mapping, Sequence

from tribodyn import _simulation_requests as requests
from tribodyn._arguments import Arguments, full_name
from tribodyn._columns import read_columns
from tribodyn._frames import (
    Frame,
    frame,
    in_columns,
    point_attrs,
    point_row,
    result_attrs,
    sensitivity_columns,
    sensitivity_table,
)
from tribodyn._session import Session
from tribodyn._simulation_requests import Options
from tribodyn._warnings import Warnings, add_warnings, of_inputs
from tribodyn.errors import TribodynError
from tribodyn.units import Quantity
from tribodyn.v1 import simulations_pb2 as pb


class Studies(Session):
    """Methods of a client for one lubricant, or for a few at the same conditions."""

    async def point(
        self,
        lubricant: str,
        *,
        speed_kilometres_per_hour: Quantity | None = None,
        acceleration_metres_per_second_squared: Quantity | None = None,
        ascent_angle_degrees: Quantity | None = None,
        pinion_torque_newton_metres: Quantity | None = None,
        pinion_speed_radians_per_second: Quantity | None = None,
        gear_set: str | None = None,
        surface: str | None = None,
        vehicle: str | None = None,
        sump_temperature_celsius: Quantity | None = None,
        inlet_temperature_rise_kelvin: Quantity | None = None,
        tolerance: float | None = None,
        model: str | None = None,
        options: Options = Options(),
    ) -> Frame:
        """Returns the figures of one operating point: a table of one row.

        The point is a speed (0.1 to 400 km/h), with an acceleration (-50 to 50 m/s2) and an ascent
        (-45 to 45 degrees, or "6%"), or a torque of the pinion (-1e5 to 1e5 N m; negative: coast)
        with its speed (0.01 to 1e4 rad/s). ``sump_temperature_celsius``: -70 to 200, None: 40;
        ``inlet_temperature_rise_kelvin`` (eq 14): 0 to 300, None: 20. ``tolerance``: wanted
        relative error of inefficiencies, torque and transmission error, 1e-8 to 0.01, None: 1e-3.
        ``model``: "automatic" (the cheapest within the tolerance), "full" or "quasi-static".

        Columns are the fields of PointResult, with units in their names; a figure that is not there
        is NaN; ``verdict_withheld``: a warning says that the figures decide nothing between
        lubricants. ``attrs`` holds input_hash, model_version, platform, estimated_relative_error,
        the revisions used and the name of the simulation; ``warnings``, by code, each with its
        "level" ("note", "caution" or "withholds-verdict"), "summary", "message" and "rows" of the
        table; and ``input_warnings``, of the fluid, likewise without rows.
        """
        arguments = Arguments()
        simulation = requests.operating_point(
            arguments,
            lubricant,
            options,
            speed_kilometres_per_hour=speed_kilometres_per_hour,
            acceleration_metres_per_second_squared=acceleration_metres_per_second_squared,
            ascent_angle_degrees=ascent_angle_degrees,
            pinion_torque_newton_metres=pinion_torque_newton_metres,
            pinion_speed_radians_per_second=pinion_speed_radians_per_second,
            gear_set=gear_set,
            surface=surface,
            vehicle=vehicle,
            sump_temperature_celsius=sump_temperature_celsius,
            inlet_temperature_rise_kelvin=inlet_temperature_rise_kelvin,
            tolerance=tolerance,
            model=model,
        )
        (found,) = await self._solve(arguments, [simulation], options, "point")
        return frame(_columns(found), result_attrs(found))

    async def sensitivities(
        self,
        lubricant: str,
        *,
        speed_kilometres_per_hour: Quantity | None = None,
        acceleration_metres_per_second_squared: Quantity | None = None,
        ascent_angle_degrees: Quantity | None = None,
        pinion_torque_newton_metres: Quantity | None = None,
        pinion_speed_radians_per_second: Quantity | None = None,
        gear_set: str | None = None,
        surface: str | None = None,
        vehicle: str | None = None,
        sump_temperature_celsius: Quantity | None = None,
        inlet_temperature_rise_kelvin: Quantity | None = None,
        tolerance: float | None = None,
        options: Options = Options(),
    ) -> Frame:
        """Returns the derivatives of the figures of an operating point by every scalar parameter of
        oil, surface, gear set and conditions, exact to rounding on the grid of the solution: a table
        of one row a parameter, for loops of optimisation and budgets of uncertainty.

        Arguments as of point(). Columns: ``parameter``, e.g. "lubricant.relaxation_time" or
        "vehicle_speed"; ``unit`` (SI, temperatures in K); ``value``; for each figure
        "derivative.FIGURE", the unit of the figure over that of the parameter, and
        "elasticity.FIGURE", relative change over relative change. ``attrs``, besides those of
        point(), holds ``figures``, the values of the figures by their names, e.g. "film_ratio.mean",
        and ``one_sided``: the response is at the edge of an event, so that the derivatives hold on
        one side. Takes two to four times as long as the point. The table is empty at a fold.
        """
        arguments = Arguments()
        simulation = requests.operating_point(
            arguments,
            lubricant,
            options,
            speed_kilometres_per_hour=speed_kilometres_per_hour,
            acceleration_metres_per_second_squared=acceleration_metres_per_second_squared,
            ascent_angle_degrees=ascent_angle_degrees,
            pinion_torque_newton_metres=pinion_torque_newton_metres,
            pinion_speed_radians_per_second=pinion_speed_radians_per_second,
            gear_set=gear_set,
            surface=surface,
            vehicle=vehicle,
            sump_temperature_celsius=sump_temperature_celsius,
            inlet_temperature_rise_kelvin=inlet_temperature_rise_kelvin,
            tolerance=tolerance,
        )
        simulation.operating_point.sensitivities = True
        (found,) = await self._solve(arguments, [simulation], options, "sensitivities")
        columns, attrs = sensitivity_table(found)
        return frame(columns, attrs)

    async def curve(
        self,
        lubricant: str,
        *,
        speeds_kilometres_per_hour: Sequence[Quantity] | None = None,
        direction: str | None = None,
        independent_points: bool = False,
        ascent_angle_degrees: Quantity | None = None,
        gear_set: str | None = None,
        surface: str | None = None,
        vehicle: str | None = None,
        sump_temperature_celsius: Quantity | None = None,
        inlet_temperature_rise_kelvin: Quantity | None = None,
        tolerance: float | None = None,
        model: str | None = None,
        sensitivities: bool = False,
        options: Options = Options(),
    ) -> Frame:
        """Returns the figures at each speed, in ascending order: a table of one row a speed.

        ``speeds_kilometres_per_hour``: up to 1000 speeds; None: 20 to 140 km/h by 5. Each point
        starts from the steady state of the one before, ``direction`` "up" or "down";
        ``independent_points``: each is solved alone, in about a third of the time. A speed without
        a result has NaN, and the reason in ``status``. Other arguments, columns and ``attrs`` as of
        point(); ``branch_ends`` holds the pairs of speeds between which a branch ends.
        ``sensitivities``, of at most 300 speeds, adds "derivative.FIGURE.PARAMETER" and
        "elasticity.FIGURE.PARAMETER" as in sensitivities(); NaN where a point has none, with
        NO_SENSITIVITIES in ``warnings``.
        """
        arguments = Arguments()
        simulation = requests.curve(
            arguments,
            lubricant,
            options,
            speeds_kilometres_per_hour=speeds_kilometres_per_hour,
            direction=direction,
            independent_points=independent_points,
            ascent_angle_degrees=ascent_angle_degrees,
            gear_set=gear_set,
            surface=surface,
            vehicle=vehicle,
            sump_temperature_celsius=sump_temperature_celsius,
            inlet_temperature_rise_kelvin=inlet_temperature_rise_kelvin,
            tolerance=tolerance,
            model=model,
        )
        simulation.inefficiency_curve.sensitivities = sensitivities
        (found,) = await self._solve(arguments, [simulation], options, "curve")
        return frame({**_columns(found), **sensitivity_columns(found)}, result_attrs(found))

    async def compare(
        self,
        lubricants: Sequence[str],
        *,
        speeds_kilometres_per_hour: Sequence[Quantity] | None = None,
        direction: str | None = None,
        independent_points: bool = False,
        ascent_angle_degrees: Quantity | None = None,
        gear_set: str | None = None,
        surface: str | None = None,
        vehicle: str | None = None,
        sump_temperature_celsius: Quantity | None = None,
        inlet_temperature_rise_kelvin: Quantity | None = None,
        tolerance: float | None = None,
        model: str | None = None,
        options: Options = Options(),
    ) -> Frame:
        """Returns the curves of several lubricants in one table, with a column ``lubricant``.

        Arguments as of curve(). The curves run together; one refused lubricant refuses all.
        ``attrs["results"]`` holds the attributes of each curve by the name of its lubricant,
        ``attrs["warnings"]`` the warnings with the rows of this table.
        """
        if isinstance(lubricants, str):
            lubricants = [lubricants]
        arguments = Arguments()
        first = requests.curve(
            arguments,
            lubricants[0] if lubricants else "",
            options,
            speeds_kilometres_per_hour=speeds_kilometres_per_hour,
            direction=direction,
            independent_points=independent_points,
            ascent_angle_degrees=ascent_angle_degrees,
            gear_set=gear_set,
            surface=surface,
            vehicle=vehicle,
            sump_temperature_celsius=sump_temperature_celsius,
            inlet_temperature_rise_kelvin=inlet_temperature_rise_kelvin,
            tolerance=tolerance,
            model=model,
        )
        simulations = [_with_lubricant(first, each) for each in lubricants]
        curves = await self._solve(arguments, simulations, options, "curve")
        rows: list[dict[str, Any]] = []
        warnings: Warnings = {}
        for name, each in zip(lubricants, curves):
            for row, point in enumerate(each.result.points, len(rows)):
                add_warnings(warnings, point.result.warnings, [row])
            rows += [{"lubricant": name, **point_row(point)} for point in each.result.points]
        attrs = {name: result_attrs(each) for name, each in zip(lubricants, curves)}
        return frame(in_columns(rows), {"results": attrs, "warnings": warnings})

    async def histories(
        self,
        lubricant: str,
        columns: Sequence[str],
        *,
        mesh_cycles: int = 1,
        samples_per_mesh_cycle: int = 192,
        speed_kilometres_per_hour: Quantity | None = None,
        acceleration_metres_per_second_squared: Quantity | None = None,
        ascent_angle_degrees: Quantity | None = None,
        pinion_torque_newton_metres: Quantity | None = None,
        pinion_speed_radians_per_second: Quantity | None = None,
        gear_set: str | None = None,
        surface: str | None = None,
        vehicle: str | None = None,
        sump_temperature_celsius: Quantity | None = None,
        inlet_temperature_rise_kelvin: Quantity | None = None,
        tolerance: float | None = None,
        model: str | None = None,
        options: Options = Options(),
    ) -> Frame:
        """Returns time histories of the steady state at one operating point: one row a sample.

        ``columns``: names such as "mesh_force_newtons"; schema() lists them as "history.columns".
        ``mesh_cycles`` times ``samples_per_mesh_cycle`` rows, at most 20 million values. Other
        arguments as of point(). ``attrs["units"]`` holds the symbols of the units.
        """
        arguments = Arguments()
        simulation = requests.operating_point(
            arguments,
            lubricant,
            options,
            speed_kilometres_per_hour=speed_kilometres_per_hour,
            acceleration_metres_per_second_squared=acceleration_metres_per_second_squared,
            ascent_angle_degrees=ascent_angle_degrees,
            pinion_torque_newton_metres=pinion_torque_newton_metres,
            pinion_speed_radians_per_second=pinion_speed_radians_per_second,
            gear_set=gear_set,
            surface=surface,
            vehicle=vehicle,
            sump_temperature_celsius=sump_temperature_celsius,
            inlet_temperature_rise_kelvin=inlet_temperature_rise_kelvin,
            tolerance=tolerance,
            model=model,
        )
        wanted = simulation.operating_point.history
        wanted.columns[:] = [columns] if isinstance(columns, str) else columns
        wanted.mesh_cycles = mesh_cycles
        wanted.samples_per_mesh_cycle = samples_per_mesh_cycle
        (found,) = await self._solve(arguments, [simulation], options, "history")
        history = await self.read_history(found.name)
        history.attrs = {**point_attrs(found), **history.attrs}
        return history

    async def read_history(
        self,
        simulation: str,
        *,
        columns: Sequence[str] = (),
        start_row: int = 0,
        row_count: int = 0,
        max_points: int = 0,
    ) -> Frame:
        """Returns the history of a simulation, or a part of it; ``columns`` empty: all. With
        ``max_points`` (4 to 1,000,000) and more rows than that a min/max envelope: row 2k is the
        least and row 2k+1 the greatest value of ``attrs["rows_per_pair"]`` rows."""
        name = full_name("simulations", simulation)
        request = pb.ReadHistoryRequest(
            name=name,
            columns=columns,
            start_row=start_row,
            row_count=row_count,
            max_points=max_points,
        )
        schema, values = await read_columns(
            self._transport, "SimulationService", "ReadHistory", request
        )
        attrs = {
            "simulation": name,
            "start_row": schema.start_row,
            "total_rows": schema.total_rows,
            "rows_per_pair": schema.rows_per_pair,
            "units": {each.name: each.unit for each in schema.columns},
            "input_warnings": of_inputs(schema.input_warnings),
        }
        return frame({each.name: column for each, column in zip(schema.columns, values)}, attrs)

    async def _solve(
        self,
        arguments: Arguments,
        simulations: Sequence[pb.Simulation],
        options: Options,
        title: str,
    ) -> list[pb.Simulation]:
        """Runs all; raises the first error of one."""
        several = len(simulations) > 1
        jobs = [
            requests.request(arguments, each, options, i if several else None)
            for i, each in enumerate(simulations)
        ]
        arguments.check()
        found = []
        for outcome in await self._run_jobs(jobs, title, all_or_none=True):
            if isinstance(outcome, TribodynError):
                raise outcome
            found.append(outcome)
        return found


def _with_lubricant(simulation: pb.Simulation, lubricant: str) -> pb.Simulation:
    """Returns the same simulation of another lubricant."""
    out = pb.Simulation()
    out.CopyFrom(simulation)
    out.lubricant = full_name("lubricants", lubricant)
    return out


def _columns(simulation: pb.Simulation) -> Mapping[str, Sequence[Any]]:
    return in_columns(point_row(point) for point in simulation.result.points)
