"""The client with coroutines. Its classes and methods are those of ``tribodyn``, which describes
them."""

from __future__ import annotations

import os
from pathlib import Path
from types import TracebackType
from typing import Any, Callable, Mapping, Sequence

from tribodyn import _cycles, _maps, _points, _profiles, _studies, _uncertainty
from tribodyn._campaigns import AsyncCampaign, start_campaign
from tribodyn._candidates import Rig
from tribodyn._columns import read_columns
from tribodyn._csv import rows_of
from tribodyn._evaluate import Evaluation, is_parameter
from tribodyn._frames import (
    Frame,
    columns_of,
    frame,
    in_columns,
    point_row,
    result_attrs,
    sensitivity_table,
)
from tribodyn._jobs import Outcome, run_all
from tribodyn._profiles import Profile
from tribodyn._progress import Progress
from tribodyn._resources import AsyncResources
from tribodyn._studies import Arguments, Options, full_name
from tribodyn._transport import Transport
from tribodyn.errors import TribodynError
from tribodyn.settings import read_settings
from tribodyn.units import Quantity
from tribodyn.v1.campaigns_pb2 import Campaign, ListCampaignsRequest
from tribodyn.v1.gear_sets_pb2 import GearSet
from tribodyn.v1.lubricants_pb2 import Lubricant
from tribodyn.v1.points_pb2 import ComparePointsRequest, ExplainPointsRequest
from tribodyn.v1.rigs_pb2 import EvaluateRigRequest, RigBody
from tribodyn.v1.schemas_pb2 import GetSchemaRequest, Schema
from tribodyn.v1 import simulations_pb2 as pb
from tribodyn.v1.surfaces_pb2 import Surface
from tribodyn.v1.vehicles_pb2 import Vehicle


class Client:
    """A server and a project, for one event loop. As tribodyn.Client, with coroutines."""

    def __init__(
        self,
        server: str | None = None,
        project: str | None = None,
        *,
        timeout_seconds: float | None = None,
        progress: str | None = None,
        client_name: str | None = None,
        token_file: str | None = None,
    ) -> None:
        self._settings = read_settings(server, project, timeout_seconds, progress, token_file)
        self._transport = Transport(self._settings, client_name)
        self.lubricants = AsyncResources(self._transport, Lubricant, "lubricants")
        self.gear_sets = AsyncResources(self._transport, GearSet, "gearSets")
        self.surfaces = AsyncResources(self._transport, Surface, "surfaces")
        self.vehicles = AsyncResources(self._transport, Vehicle, "vehicles")

    @property
    def server(self) -> str:
        return self._settings.server

    @property
    def project(self) -> str:
        return self._settings.project

    async def close(self) -> None:
        await self._transport.close()

    async def __aenter__(self) -> Client:
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        await self.close()

    async def schema(self, message: str = "") -> Schema:
        return await self._transport.call(
            "SchemaService", "GetSchema", GetSchemaRequest(message=message)
        )

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
        arguments = Arguments()
        simulation = _studies.scene(
            arguments,
            lubricant,
            options,
            gear_set=gear_set,
            surface=surface,
            vehicle=vehicle,
            sump_temperature_celsius=sump_temperature_celsius,
            inlet_temperature_rise_kelvin=inlet_temperature_rise_kelvin,
            tolerance=tolerance,
        )
        _studies.point(
            arguments,
            simulation,
            options,
            model=model,
            speed_kilometres_per_hour=speed_kilometres_per_hour,
            acceleration_metres_per_second_squared=acceleration_metres_per_second_squared,
            ascent_angle_degrees=ascent_angle_degrees,
            pinion_torque_newton_metres=pinion_torque_newton_metres,
            pinion_speed_radians_per_second=pinion_speed_radians_per_second,
        )
        (found,) = await self._run(arguments, [simulation], options, "point")
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
        arguments = Arguments()
        simulation = _studies.scene(
            arguments,
            lubricant,
            options,
            gear_set=gear_set,
            surface=surface,
            vehicle=vehicle,
            sump_temperature_celsius=sump_temperature_celsius,
            inlet_temperature_rise_kelvin=inlet_temperature_rise_kelvin,
            tolerance=tolerance,
        )
        study = _studies.point(
            arguments,
            simulation,
            options,
            speed_kilometres_per_hour=speed_kilometres_per_hour,
            acceleration_metres_per_second_squared=acceleration_metres_per_second_squared,
            ascent_angle_degrees=ascent_angle_degrees,
            pinion_torque_newton_metres=pinion_torque_newton_metres,
            pinion_speed_radians_per_second=pinion_speed_radians_per_second,
        )
        study.sensitivities = True
        (found,) = await self._run(arguments, [simulation], options, "sensitivities")
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
        options: Options = Options(),
    ) -> Frame:
        curves = await self._curves(
            [lubricant],
            speeds_kilometres_per_hour,
            direction,
            independent_points,
            ascent_angle_degrees,
            gear_set,
            surface,
            vehicle,
            sump_temperature_celsius,
            inlet_temperature_rise_kelvin,
            tolerance,
            model,
            options,
        )
        return frame(_columns(curves[0]), result_attrs(curves[0]))

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
        if isinstance(lubricants, str):
            lubricants = [lubricants]
        curves = await self._curves(
            list(lubricants),
            speeds_kilometres_per_hour,
            direction,
            independent_points,
            ascent_angle_degrees,
            gear_set,
            surface,
            vehicle,
            sump_temperature_celsius,
            inlet_temperature_rise_kelvin,
            tolerance,
            model,
            options,
        )
        rows = []
        for name, each in zip(lubricants, curves):
            rows += [{"lubricant": name, **point_row(point)} for point in each.result.points]
        attrs = {name: result_attrs(each) for name, each in zip(lubricants, curves)}
        return frame(in_columns(rows), {"results": attrs})

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
        arguments = Arguments()
        simulation = _studies.scene(
            arguments,
            lubricant,
            options,
            gear_set=gear_set,
            surface=surface,
            vehicle=vehicle,
            sump_temperature_celsius=sump_temperature_celsius,
            inlet_temperature_rise_kelvin=inlet_temperature_rise_kelvin,
            tolerance=tolerance,
        )
        study = _studies.point(
            arguments,
            simulation,
            options,
            model=model,
            speed_kilometres_per_hour=speed_kilometres_per_hour,
            acceleration_metres_per_second_squared=acceleration_metres_per_second_squared,
            ascent_angle_degrees=ascent_angle_degrees,
            pinion_torque_newton_metres=pinion_torque_newton_metres,
            pinion_speed_radians_per_second=pinion_speed_radians_per_second,
        )
        study.history.columns[:] = [columns] if isinstance(columns, str) else columns
        study.history.mesh_cycles = mesh_cycles
        study.history.samples_per_mesh_cycle = samples_per_mesh_cycle
        (found,) = await self._run(arguments, [simulation], options, "history")
        history = await self.read_history(found.name)
        history.attrs = {**result_attrs(found), **history.attrs}
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
            "input_warnings": {each.code: each.message for each in schema.input_warnings},
        }
        return frame({each.name: column for each, column in zip(schema.columns, values)}, attrs)

    async def read_spectrum(
        self, simulation: str, *, columns: Sequence[str] = (), maximum_order: float = 0
    ) -> Frame:
        return await _maps.spectrum(self._transport, simulation, columns, maximum_order)

    async def viscosity(
        self,
        lubricant: str,
        *,
        temperatures_celsius: Sequence[Quantity],
        pressures_pascals: Sequence[Quantity] = (0,),
        model_options: Mapping[str, Any] | None = None,
    ) -> Frame:
        return await _maps.viscosity(
            self._transport,
            lubricant,
            temperatures_celsius,
            pressures_pascals,
            model_options or {},
        )

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
        quantities = {
            "sump_temperature_celsius": sump_temperature_celsius,
            "inlet_temperature_rise_kelvin": inlet_temperature_rise_kelvin,
            "map_tolerance": map_tolerance,
            "tolerance": tolerance,
        }
        return await _cycles.evaluated(
            self._transport,
            lubricants,
            cycle=cycle,
            quantities=quantities,
            hardware={"gear_set": gear_set, "surface": surface, "vehicle": vehicle},
            point_by_point=point_by_point,
            sheared=sheared,
            model_options=model_options or {},
        )

    async def roughness(
        self,
        profiles: Profile | str | Path | Sequence[Profile | str | Path],
        *,
        levelling: str | None = None,
        short_wave_cut_off_metres: Quantity | None = None,
        long_wave_cut_off_metres: Quantity | None = None,
        eq46_square_root_of_sum: bool = False,
        sampling_steps: Sequence[int] = (),
    ) -> Frame:
        return await _profiles.evaluated(
            self._transport,
            profiles,
            levelling=levelling,
            short_wave_cut_off_metres=short_wave_cut_off_metres,
            long_wave_cut_off_metres=long_wave_cut_off_metres,
            eq46_square_root_of_sum=eq46_square_root_of_sum,
            sampling_steps=sampling_steps,
        )

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
        arguments = Arguments()
        request = EvaluateRigRequest(
            draws=draws,
            lubricant=full_name("lubricants", lubricant),
            surface=full_name("surfaces", surface or ""),
            radius_x_metres=arguments.number("radius_x_metres", radius_x_metres),
            radius_y_metres=arguments.number("radius_y_metres", radius_y_metres),
            composite_rms_height_metres=arguments.number(
                "composite_rms_height_metres", composite_rms_height_metres
            ),
            body_1=None if body_1 is None else RigBody(**body_1),
            body_2=None if body_2 is None else RigBody(**body_2),
        )
        arguments.check()
        settings = {
            "loads_newtons": loads_newtons,
            "mean_pressures_pascals": mean_pressures_pascals,
            "entrainment_speeds_metres_per_second": entrainment_speeds_metres_per_second,
            "slide_roll_ratios_percent": slide_roll_ratios_percent,
            "supply_temperatures_celsius": supply_temperatures_celsius,
        }
        return await _maps.rig(self._transport, request, settings, model_options or {})

    async def points(self, table: Any, *, options: Options = Options(), **parameters: Any) -> Frame:
        given, rows = _rows(table, parameters, lambda name: name in _points.PARAMETERS)

        async def run(requests: Sequence[pb.CreateSimulationRequest]) -> Sequence[Outcome]:
            return await run_all(self._transport, requests, self._progress(len(requests), "points"))

        return _joined(table, given, await _points.solve_rows(rows, options, run), {})

    async def evaluate(
        self,
        table: Any,
        *,
        model_options: Mapping[str, Any] | None = None,
        contact_figures: bool = False,
        elasticities: Sequence[str] = (),
        elasticity_figures: Sequence[str] = (),
        **parameters: Any,
    ) -> Frame:
        given, rows = _rows(table, parameters, is_parameter)
        evaluation = Evaluation(
            self._transport,
            model_options or {},
            contact_figures,
            elasticities,
            elasticity_figures,
        )
        cells = await evaluation.run(rows, self._settings.progress)
        return _joined(table, given, cells, evaluation.attrs)

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
        arguments = Arguments()
        named = [lubricants] if isinstance(lubricants, str) else lubricants
        request = ComparePointsRequest(
            lubricants=[full_name("lubricants", each) for each in named],
            sheared_lubricant=sheared,
            contact_figures=contact_figures,
        )
        _uncertainty.scene(
            arguments,
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
        arguments.check()
        return await _uncertainty.compared(self._transport, request)

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
        arguments = Arguments()
        request = ExplainPointsRequest(
            lubricant=full_name("lubricants", lubricant),
            other_lubricant=full_name("lubricants", other_lubricant),
            other_surface=full_name("surfaces", other_surface or ""),
            sheared_lubricant=sheared,
            other_sheared_lubricant=other_sheared,
        )
        _uncertainty.scene(
            arguments,
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
        arguments.check()
        return await _uncertainty.explained(self._transport, request)

    async def screen(
        self,
        table: Any,
        lubricant: str | None = None,
        *,
        rig: Rig | None = None,
        speeds_kilometres_per_hour: Sequence[Quantity] | None = None,
        sump_temperatures_celsius: Sequence[Quantity] | None = None,
        speed_weights: Sequence[float] | None = None,
        sump_weights: Sequence[float] | None = None,
        ascent_angle_degrees: Quantity | None = None,
        inlet_temperature_rise_kelvin: Quantity | None = None,
        gear_set: str | None = None,
        surface: str | None = None,
        vehicle: str | None = None,
        tolerance: float | None = None,
        model_options: Mapping[str, Any] | None = None,
        contact_figures: bool = False,
        elasticities: Sequence[str] = (),
        elasticity_figures: Sequence[str] = (),
        budget_points: int | None = None,
        budget_processor_seconds: float | None = None,
        display_name: str = "",
        labels: Mapping[str, str] | None = None,
        request_id: str | None = None,
    ) -> AsyncCampaign:
        return await start_campaign(
            self._transport,
            self._settings.progress,
            table,
            base={
                "lubricant": lubricant,
                "gear_set": gear_set,
                "surface": surface,
                "vehicle": vehicle,
            },
            rig=rig,
            speeds=speeds_kilometres_per_hour,
            sumps=sump_temperatures_celsius,
            speed_weights=speed_weights,
            sump_weights=sump_weights,
            ascent_angle_degrees=ascent_angle_degrees,
            inlet_temperature_rise_kelvin=inlet_temperature_rise_kelvin,
            tolerance=tolerance,
            model_options=model_options or {},
            contact_figures=contact_figures,
            elasticities=elasticities,
            elasticity_figures=elasticity_figures,
            budget_points=budget_points,
            budget_processor_seconds=budget_processor_seconds,
            display_name=display_name,
            labels=labels or {},
            request_id=request_id,
        )

    async def campaign(self, name: str) -> AsyncCampaign:
        campaign = AsyncCampaign(
            self._transport,
            self._settings.progress,
            Campaign(name=full_name("campaigns", name)),
        )
        await campaign.refresh()
        return campaign

    async def campaigns(
        self, limit: int | None = None, *, filter: str = ""
    ) -> list[AsyncCampaign]:
        found: list[Campaign] = []
        request = ListCampaignsRequest(page_size=min(limit or 1000, 1000), filter=filter)
        while True:
            page = await self._transport.call("CampaignService", "ListCampaigns", request)
            found += page.campaigns
            request.page_token = page.next_page_token
            if not request.page_token or (limit is not None and len(found) >= limit):
                break
        return [
            AsyncCampaign(self._transport, self._settings.progress, each) for each in found[:limit]
        ]

    async def _curves(
        self,
        lubricants: Sequence[str],
        speeds: Sequence[Quantity] | None,
        direction: str | None,
        independent_points: bool,
        ascent: Quantity | None,
        gear_set: str | None,
        surface: str | None,
        vehicle: str | None,
        sump: Quantity | None,
        rise: Quantity | None,
        tolerance: float | None,
        model: str | None,
        options: Options,
    ) -> list[pb.Simulation]:
        arguments = Arguments()
        simulations: list[pb.Simulation] = []
        for lubricant in lubricants:
            if simulations:
                simulations.append(pb.Simulation())
                simulations[-1].CopyFrom(simulations[0])
                simulations[-1].lubricant = full_name("lubricants", lubricant)
                continue
            simulation = _studies.scene(
                arguments,
                lubricant,
                options,
                gear_set=gear_set,
                surface=surface,
                vehicle=vehicle,
                sump_temperature_celsius=sump,
                inlet_temperature_rise_kelvin=rise,
                tolerance=tolerance,
            )
            _studies.curve(
                arguments,
                simulation,
                options,
                speeds_kilometres_per_hour=speeds,
                direction=direction,
                independent_points=independent_points,
                ascent_angle_degrees=ascent,
                model=model,
            )
            simulations.append(simulation)
        return await self._run(arguments, simulations, options, "curve")

    async def _run(
        self,
        arguments: Arguments,
        simulations: Sequence[pb.Simulation],
        options: Options,
        title: str,
    ) -> list[pb.Simulation]:
        """Runs all; raises the first error of one."""
        several = len(simulations) > 1
        requests = [
            _studies.request(arguments, each, options, i if several else None)
            for i, each in enumerate(simulations)
        ]
        arguments.check()
        outcomes = await run_all(
            self._transport, requests, self._progress(len(requests), title), all_or_none=True
        )
        found = []
        for outcome in outcomes:
            if isinstance(outcome, TribodynError):
                raise outcome
            found.append(outcome)
        return found

    def _progress(self, total: int, title: str) -> Progress:
        return Progress(self._settings.progress, total, title)


def _columns(simulation: pb.Simulation) -> Mapping[str, Sequence[Any]]:
    return in_columns(point_row(point) for point in simulation.result.points)


def _rows(
    table: Any, parameters: Mapping[str, Any], is_known: Callable[[str], bool]
) -> tuple[dict[str, list[Any]], list[dict[str, Any]]]:
    """Returns the columns of a table, and its rows with the parameters that they do not state."""
    unknown = [name for name in parameters if not is_known(name)]
    if unknown:
        raise TypeError(f"no such parameter: {', '.join(unknown)}")
    is_file = isinstance(table, (str, os.PathLike))
    given = in_columns(rows_of(table)) if is_file else columns_of(table)
    count = len(next(iter(given.values()), []))
    rows = [
        {
            **parameters,
            **{name: values[i] for name, values in given.items() if values[i] is not None},
        }
        for i in range(count)
    ]
    return given, rows


def _joined(
    table: Any,
    given: Mapping[str, list[Any]],
    cells: Sequence[Mapping[str, Any]],
    attrs: Mapping[str, Any],
) -> Frame:
    """Returns the columns of the table with those of the results beside them."""
    results = {name: each for name, each in in_columns(cells).items() if name not in given}
    out = frame({**given, **results}, attrs)
    if hasattr(table, "columns") and hasattr(out, "index"):  # both are DataFrames
        out.index = table.index
    return out
