"""Campaigns: tables of candidates that the server screens and keeps."""

from __future__ import annotations

import asyncio
import hashlib
import re
from typing import Any, AsyncGenerator, Container, Mapping, Sequence

import numpy as np

from tribodyn._candidates import Design, Lubricants, Rig
from tribodyn._columns import read_columns
from tribodyn._csv import table_rows
from tribodyn._evaluate import CONDITION, Extras, parameter_path, read_varied
from tribodyn._frames import Frame, enum_word, frame
from tribodyn._progress import Progress
from tribodyn._studies import Arguments, full_name, set_switches
from tribodyn._transport import Backoff, Transport, new_request_id
from tribodyn.errors import TribodynError
from tribodyn.units import Quantity
from tribodyn.v1 import campaigns_pb2 as pb
from tribodyn.v1 import lubricants_pb2, points_pb2, results_pb2, rigs_pb2, surfaces_pb2

_SERVICE = "CampaignService"
# Pauses between two looks at a campaign [s]: a small one ends after some milliseconds, and a large
# one is not asked for more often than a person reads.
_FIRST_LOOK, _LATEST_LOOK = 0.01, 0.5
_FOLLOW_RETRIES = 20  # about 40 s in all: long enough for a server that drains and restarts
_NOT_COMPUTED = -1  # in refusal_number
_DEFAULTS = {"sump_temperature_celsius": 40.0, "inlet_temperature_rise_kelvin": 20.0}
_STATUS = ("status", "status_message")
_FIGURE = "inefficiency_energy_mean_percent"
# Columns of a campaign of a rig: its conditions, which the server computes, and its figures.
_RIG_COLUMNS = [
    "load_newtons",
    "entrainment_speed_metres_per_second",
    "slide_roll_ratio_percent",
    "supply_temperature_celsius",
    "traction_coefficient",
    "central_film_thickness_metres",
    "minimum_film_thickness_metres",
    "film_ratio",
    "mean_pressure_pascals",
    "maximum_pressure_pascals",
    "contact_temperature_kelvin",
    "flash_temperature_rise_kelvin",
    "boundary_friction_share",
    "limiting_stress_area_share",
]
_RIG_FIGURE = "traction_coefficient"
_COLLECTIONS = {
    "lubricant": "lubricants",
    "gear_set": "gearSets",
    "surface": "surfaces",
    "vehicle": "vehicles",
}
_GETTERS = {
    "lubricant": ("LubricantService", "GetLubricant", lubricants_pb2.GetLubricantRequest),
    "surface": ("SurfaceService", "GetSurface", surfaces_pb2.GetSurfaceRequest),
}


class AsyncCampaign:
    """A campaign of the server. As tribodyn.Campaign, with coroutines."""

    def __init__(self, transport: Transport, progress_form: str, message: pb.Campaign) -> None:
        self._transport = transport
        self._progress_form = progress_form
        self._details: pb.Campaign | None = None
        self.message = message

    @property
    def name(self) -> str:
        return self.message.name

    @property
    def state(self) -> str:
        return pb.Campaign.State.Name(self.message.state).lower()

    async def refresh(self) -> pb.Campaign:
        self.message = await self._get(pb.CAMPAIGN_VIEW_BASIC)
        return self.message

    async def wait(self) -> None:
        progress = Progress(self._progress_form, max(self.message.points, 1), self.name)
        try:
            async for message in self._looks():
                progress.update("points", message.points_done)
        finally:
            progress.close()

    async def follow(
        self, columns: Sequence[str] = (), *, start_row: int = 0
    ) -> AsyncGenerator[Frame, None]:
        async for message in self._looks():
            count = message.first_missing_row - start_row
            if count > 0:
                yield await self.frame(columns, start_row=start_row, row_count=count)
                start_row += count

    async def frame(
        self,
        columns: Sequence[str] = (),
        *,
        start_row: int = 0,
        row_count: int = 0,
        filter: str = "",
    ) -> Frame:
        details = await self._full()
        own = _OwnColumns(details)
        names = [columns] if isinstance(columns, str) else list(columns)
        figures = _RIG_COLUMNS if details.HasField("rig") else Extras.of(details).columns()
        names = names or [*own.names(), *figures, *_STATUS]
        arguments = Arguments()
        known = {*own.names(), *figures, *_STATUS, "candidate", "condition", "row"}
        for name in names:
            if name not in known:
                arguments.wrong("columns", f"{name} is no column of {self.name}")
        arguments.check()
        stored = [name for name in names if name in figures] + ["refusal_number", "row"]
        schema, values = await read_columns(
            self._transport,
            _SERVICE,
            "ReadCampaign",
            pb.ReadCampaignRequest(
                name=self.name,
                columns=stored,
                start_row=start_row,
                row_count=row_count,
                filter=filter,
            ),
        )
        read = dict(zip(stored, values))
        if (await self._candidates_to(schema.total_rows)) is not details:
            own = _OwnColumns(await self._full())
        cells = {name: _tight(name, each) for name, each in read.items()}
        if any(name in _STATUS for name in names):
            cells |= await self._status(read["refusal_number"].astype(int))
        rows = read["row"].astype(int)
        cells["row"] = rows
        out = {name: cells[name] if name in cells else own.column(name, rows) for name in names}
        return frame(out, {**self._attrs(), "start_row": schema.start_row})

    async def ranking(
        self,
        by: str | None = None,
        *,
        most: bool = False,
        where: Mapping[str, tuple[float | None, float | None]] | None = None,
        condition_weights: Sequence[float] = (),
        uncertainties: Mapping[str, Quantity] | None = None,
        stated_uncertainties: bool = True,
        confidence: float = 0.95,
        count: int = 1000,
    ) -> Frame:
        arguments = Arguments()
        by = by or self._usual_figure()
        request = pb.RankCandidatesRequest(
            name=self.name,
            objective=_objective(arguments, "by", by, most),
            constraints=_constraints(arguments, where),
            condition_weights=condition_weights,
            confidence=confidence,
            count=count,
            ignore_stated_uncertainties=not stated_uncertainties,
        )
        for name, value in (uncertainties or {}).items():
            _add_uncertainty(arguments, name, value, request)
        arguments.check()
        answer = await self._decide("RankCandidates", request)
        found = answer.candidates
        cells: dict[str, Any] = {by: [each.value for each in found]}
        cells["solver_error"] = [
            each.solver_error if each.HasField("solver_error") else np.nan for each in found
        ]
        for i, constraint in enumerate(where or {}):
            cells.setdefault(constraint, [each.constraint_values[i] for each in found])
        compared = [each.comparison if each.HasField("comparison") else None for each in found]
        for name in ("standard_uncertainty", "worse_probability"):
            cells[name] = [getattr(each, name) if each else np.nan for each in compared]
        cells["tied"] = np.array([each.tied if each else None for each in compared], dtype=object)
        attrs = {
            **_counts(answer),
            "ranked": answer.ranked,
            "compared": answer.compared,
            "own_uncertain_parameters": list(answer.own_uncertain_parameters),
            "shared_uncertain_parameters": list(answer.shared_uncertain_parameters),
        }
        return await self._of_candidates([each.candidate for each in found], cells, attrs)

    async def pareto(
        self,
        second: str,
        *,
        second_most: bool = False,
        first: str | None = None,
        first_most: bool = False,
        where: Mapping[str, tuple[float | None, float | None]] | None = None,
        condition_weights: Sequence[float] = (),
    ) -> Frame:
        arguments = Arguments()
        first = first or self._usual_figure()
        request = pb.FindParetoCandidatesRequest(
            name=self.name,
            first=_objective(arguments, "first", first, first_most),
            second=_objective(arguments, "second", second, second_most),
            constraints=_constraints(arguments, where),
            condition_weights=condition_weights,
        )
        arguments.check()
        answer = await self._decide("FindParetoCandidates", request)
        cells = {
            first: [each.first_value for each in answer.candidates],
            second: [each.second_value for each in answer.candidates],
        }
        attrs = {**_counts(answer), "beaten": answer.beaten, "total_size": answer.total_size}
        return await self._of_candidates(
            [each.candidate for each in answer.candidates], cells, attrs
        )

    async def effects(
        self,
        figure: str | None = None,
        *,
        columns: Sequence[str] = (),
        where: Mapping[str, tuple[float | None, float | None]] | None = None,
        condition_weights: Sequence[float] = (),
        coverage: float = 0.95,
    ) -> Frame:
        arguments = Arguments()
        figure = figure or self._usual_figure()
        request = pb.EstimateCandidateEffectsRequest(
            name=self.name,
            figure=_figure(arguments, "figure", figure),
            columns=[columns] if isinstance(columns, str) else columns,
            constraints=_constraints(arguments, where),
            condition_weights=condition_weights,
            coverage=coverage,
        )
        arguments.check()
        answer = await self._decide("EstimateCandidateEffects", request)
        own = _OwnColumns(await self._full())
        found = answer.effects
        cells: dict[str, Any] = {"column": [each.column for each in found]}
        cells["from"] = np.array(
            [own.of_candidate(each.column, each.from_candidate) for each in found], dtype=object
        )
        cells["to"] = np.array(
            [own.of_candidate(each.column, each.to_candidate) for each in found], dtype=object
        )
        for name in ("effect", "effect_minimum", "effect_maximum"):
            cells[name] = [getattr(each, name) for each in found]
        reasons = pb.ColumnWithoutEffect.Reason
        attrs = {
            **_counts(answer),
            "left_out": {
                each.column: reasons.Name(each.reason).lower().replace("_", " ")
                for each in answer.left_out
            },
            "candidates": answer.candidates,
            "degrees_of_freedom": answer.degrees_of_freedom,
            "residual_standard_deviation": answer.residual_standard_deviation_value,
            "explained_share": answer.explained_share,
        }
        return frame(cells, {**self._attrs(), **attrs})

    async def promote(
        self,
        candidate: int,
        lubricant: str = "",
        *,
        surface: str = "",
        display_name: str = "",
        validate_only: bool = False,
    ) -> pb.PromoteCandidateResponse:
        request = pb.PromoteCandidateRequest(
            name=self.name,
            candidate=int(candidate),
            lubricant_id=lubricant,
            surface_id=surface,
            display_name=display_name,
            validate_only=validate_only,
        )
        return await self._transport.call(_SERVICE, "PromoteCandidate", request)

    def _usual_figure(self) -> str:
        return _RIG_FIGURE if self.message.HasField("rig") else _FIGURE

    async def _decide(self, method: str, request: Any) -> Any:
        return await self._transport.call(_SERVICE, method, request, patient=True)

    async def _full(self) -> pb.Campaign:
        if self._details is None:
            self._details = await self._get(pb.CAMPAIGN_VIEW_FULL)
        return self._details

    async def _candidates_to(self, rows: int) -> pb.Campaign:
        """Returns the campaign with the candidates of all rows: others may have been added."""
        details = await self._full()
        if rows > details.points:
            self._details = None
        return await self._full()

    async def _of_candidates(
        self, candidates: Sequence[int], cells: Mapping[str, Any], attrs: Mapping[str, Any]
    ) -> Frame:
        """Returns a table of candidates: what they were created with, their numbers and `cells`."""
        details = await self._full()
        count = max(candidates, default=-1) + 1
        conditions = details.points // details.candidates
        details = await self._candidates_to(count * conditions)
        own = _OwnColumns(details)
        rows = np.array(candidates, dtype=int) * conditions
        out = {name: own.column(name, rows) for name in own.of_candidates()}
        out["candidate"] = np.array(candidates, dtype=int)
        return frame({**out, **cells}, {**self._attrs(), **attrs})

    async def append(
        self,
        table: Any = None,
        *,
        lubricants: Sequence[str] = (),
        request_id: str | None = None,
    ) -> None:
        request = pb.AppendCandidatesRequest(
            name=self.name, request_id=request_id or new_request_id()
        )
        request.candidate_lubricants.extend(full_name("lubricants", each) for each in lubricants)
        if table is not None:
            rows = table_rows(table)
            arguments = Arguments()
            candidates = [read_varied(arguments, row) for row in rows]
            arguments.check()
            details = await self._full()
            part = pb.Campaign(
                lubricant=details.lubricant_revision, surface=details.surface_revision
            )
            # What a table leaves out is as in the base.
            paths = dict.fromkeys(each.path for each in details.candidate_columns)
            await _add_candidates(self._transport, part, candidates, list(paths))
            texts = {each.name for each in details.candidate_attributes if each.texts}
            _add_attributes(part, rows, texts)
            request.candidate_columns.extend(part.candidate_columns)
            request.candidate_attributes.extend(part.candidate_attributes)
        self.message = await self._transport.call(
            _SERVICE, "AppendCandidates", request, patient=True
        )
        self._details = None

    async def update(
        self, *, display_name: str | None = None, labels: Mapping[str, str] | None = None
    ) -> None:
        request = pb.UpdateCampaignRequest(campaign=pb.Campaign(name=self.name))
        if display_name is not None:
            request.campaign.display_name = display_name
            request.update_mask.paths.append("display_name")
        if labels is not None:
            for key, value in labels.items():
                request.campaign.labels.add(key=key, value=value)
            request.update_mask.paths.append("labels")
        if request.update_mask.paths:
            await self._change("UpdateCampaign", request)

    async def pause(self) -> None:
        await self._change("PauseCampaign", pb.PauseCampaignRequest(name=self.name))

    async def resume(
        self,
        *,
        budget_points: int | None = None,
        budget_processor_seconds: float | None = None,
    ) -> None:
        request = pb.ResumeCampaignRequest(name=self.name)
        if budget_points is not None or budget_processor_seconds is not None:
            request.budget.points = budget_points or 0
            request.budget.processor_seconds = budget_processor_seconds or 0.0
        await self._change("ResumeCampaign", request)

    async def cancel(self) -> None:
        await self._change("CancelCampaign", pb.CancelCampaignRequest(name=self.name))

    async def delete(self) -> None:
        request = pb.DeleteCampaignRequest(name=self.name, cancel=True, allow_missing=True)
        await self._transport.call(_SERVICE, "DeleteCampaign", request)

    def _attrs(self) -> dict[str, Any]:
        message = self.message
        return {
            "campaign": message.name,
            "total_rows": message.points,
            "lubricant": message.lubricant_revision,
            "gear_set": message.gear_set_revision,
            "surface": message.surface_revision,
            "vehicle": message.vehicle_revision,
            "input_hash": message.input_hash,
            "model_version": message.model_version,
        }

    async def _get(self, view: Any) -> pb.Campaign:
        request = pb.GetCampaignRequest(name=self.name, view=view)
        return await self._transport.call(_SERVICE, "GetCampaign", request)

    async def _change(self, method: str, request: Any) -> None:
        self.message = await self._transport.call(_SERVICE, method, request)

    async def _looks(self) -> AsyncGenerator[pb.Campaign, None]:
        """Yields the campaign again and again until it is not RUNNING. Waits for a server that is
        lost, for a limited time. Raises if the campaign failed or was cancelled."""
        pause, tries_left, backoff = _FIRST_LOOK, _FOLLOW_RETRIES, Backoff()
        while True:
            try:
                message = await self.refresh()
            except TribodynError as error:
                tries_left -= 1
                if error.reason != "CANNOT_CONNECT" or tries_left == 0:
                    raise
                await asyncio.sleep(backoff.next(0.25))
                continue
            tries_left = _FOLLOW_RETRIES
            backoff.reset()
            yield message
            if message.state != pb.Campaign.RUNNING:
                break
            await asyncio.sleep(pause)
            pause = min(1.25 * pause, _LATEST_LOOK)
        if message.state == pb.Campaign.CANCELLED:
            raise TribodynError(f"{self.name} was cancelled", reason="CANCELLED")
        if message.state == pb.Campaign.FAILED:
            raise TribodynError(
                f"{self.name} failed: {message.stop.message}", reason=message.stop.reason
            )

    async def _status(self, numbers: np.ndarray) -> dict[str, np.ndarray]:
        if numbers.max(initial=0) > len(self.message.refusals):
            await self.refresh()
        reasons = ["OK", *(each.reason for each in self.message.refusals), "NOT_COMPUTED"]
        messages = ["", *(each.message for each in self.message.refusals), "not computed yet"]
        assert _NOT_COMPUTED == -1  # the last one
        return {
            "status": np.array(reasons, dtype=object)[numbers],
            "status_message": np.array(messages, dtype=object)[numbers],
        }


class _OwnColumns:
    """Columns that a campaign was created with, but for the conditions of a rig."""

    def __init__(self, campaign: pb.Campaign) -> None:
        self._conditions = campaign.conditions
        self._condition_count = campaign.points // campaign.candidates
        self._of_candidates: dict[str, np.ndarray] = {}
        for each in campaign.candidate_attributes:
            values = np.array(each.texts, dtype=object) if each.texts else np.array(each.values)
            self._of_candidates[each.name] = values
        for column in campaign.candidate_columns:
            self._of_candidates[column.path] = np.array(column.values)

    def of_candidates(self) -> list[str]:
        return list(self._of_candidates)

    def names(self) -> list[str]:
        return [*self._of_candidates, *(CONDITION if self._conditions else [])]

    def of_candidate(self, name: str, candidate: int) -> Any:
        """Returns what a candidate has in one of its columns."""
        return self._of_candidates[name][candidate]

    def column(self, name: str, rows: np.ndarray) -> np.ndarray:
        """Returns the values of a column in some rows."""
        candidates, conditions = np.divmod(rows, self._condition_count)
        if name == "candidate":
            return candidates
        if name == "condition":
            return conditions
        if name in self._of_candidates:
            return self._of_candidates[name][candidates]
        default = _DEFAULTS.get(name)
        values = [
            default if default is not None and not each.HasField(name) else getattr(each, name)
            for each in self._conditions
        ]
        return np.array(values)[conditions]


def _figure(arguments: Arguments, argument: str, text: str) -> pb.CandidateFigure:
    """Reads "COLUMN", "COLUMN:min", "COLUMN:max" or "COLUMN:mean", each also of another campaign:
    "12/COLUMN"."""
    stated, _, word = text.partition(":")
    campaign, _, column = stated.rpartition("/")
    kinds = {
        "": pb.CandidateFigure.MEAN,
        "mean": pb.CandidateFigure.MEAN,
        "min": pb.CandidateFigure.MINIMUM,
        "max": pb.CandidateFigure.MAXIMUM,
    }
    if word not in kinds or not column:
        arguments.wrong(argument, f"{text} is not COLUMN, COLUMN:min, COLUMN:max or COLUMN:mean")
    return pb.CandidateFigure(
        column=column,
        aggregate=kinds.get(word, pb.CandidateFigure.MEAN),
        campaign=full_name("campaigns", campaign),
    )


def _objective(
    arguments: Arguments, argument: str, text: str, most: bool
) -> pb.CandidateObjective:
    return pb.CandidateObjective(figure=_figure(arguments, argument, text), wants_most=most)


def _constraints(
    arguments: Arguments, where: Mapping[str, tuple[float | None, float | None]] | None
) -> list[pb.CandidateConstraint]:
    out = []
    for text, limits in (where or {}).items():
        if not isinstance(limits, (tuple, list)) or len(limits) != 2:
            arguments.wrong("where", f"{text}: {limits!r} is not (minimum or None, maximum or None)")
            continue
        constraint = pb.CandidateConstraint(figure=_figure(arguments, "where", text))
        if limits[0] is not None:
            constraint.minimum = limits[0]
        if limits[1] is not None:
            constraint.maximum = limits[1]
        out.append(constraint)
    return out


def _add_uncertainty(
    arguments: Arguments, name: str, value: Quantity, request: pb.RankCandidatesRequest
) -> None:
    """Adds a standard uncertainty: "3%" of the value, or a quantity in the parameter's unit."""
    share = value.strip() if isinstance(value, str) else ""
    if share.endswith("%"):
        try:
            relative = float(share.removesuffix("%")) / 100
        except ValueError:
            arguments.wrong("uncertainties", f"{name}: {value!r} is no share")
            return
        path = parameter_path(arguments, "uncertainties", name)
        request.uncertainties.add(parameter=path, relative_uncertainty=relative)
        return
    for path, absolute in read_varied(arguments, {name: value}).items():
        request.uncertainties.add(parameter=path, absolute_uncertainty=absolute)


def _counts(answer: Any) -> dict[str, int]:
    return {name: getattr(answer, name) for name in ("excluded", "refused", "missing")}


def _tight(name: str, values: np.ndarray) -> np.ndarray:
    """Returns words for models, and whole numbers and truth values where no row lacks them."""
    if name == "model":
        kind = results_pb2.PointModel.DESCRIPTOR
        words = [enum_word(kind, number) for number in range(len(kind.values))]
        return np.array(words, dtype=object)[np.nan_to_num(values).astype(int)]
    if np.isnan(values).any():
        return values
    if name in ("contact_loss", "settled", "elasticities_one_sided"):
        return values.astype(bool)
    return values.astype(int) if name == "period_in_mesh_cycles" else values


async def start_campaign(
    transport: Transport,
    progress_form: str,
    table: Any,
    *,
    base: Mapping[str, str | None],
    rig: Rig | None,
    speeds: Sequence[Quantity] | None,
    sumps: Sequence[Quantity] | None,
    speed_weights: Sequence[float] | None,
    sump_weights: Sequence[float] | None,
    ascent_angle_degrees: Quantity | None,
    inlet_temperature_rise_kelvin: Quantity | None,
    tolerance: float | None,
    model_options: Mapping[str, Any],
    contact_figures: bool,
    elasticities: Sequence[str],
    elasticity_figures: Sequence[str],
    budget_points: int | None,
    budget_processor_seconds: float | None,
    display_name: str,
    labels: Mapping[str, str],
    request_id: str | None,
) -> AsyncCampaign:
    """Creates a campaign, or finds the one that an equal call made, and resumes it if it is
    paused."""
    arguments = Arguments()
    campaign = pb.Campaign(display_name=display_name, tolerance=tolerance or 0.0)
    set_switches(arguments, "model_options", model_options, campaign.model_options)
    Extras.read(arguments, contact_figures, elasticities, elasticity_figures).set(campaign)
    if rig is not None:
        rig.set(arguments, campaign)
        of_axle = {
            "speeds_kilometres_per_hour": speeds,
            "sump_temperatures_celsius": sumps,
            "speed_weights": speed_weights,
            "sump_weights": sump_weights,
            "ascent_angle_degrees": ascent_angle_degrees,
            "inlet_temperature_rise_kelvin": inlet_temperature_rise_kelvin,
            "gear_set": base["gear_set"],
            "vehicle": base["vehicle"],
            "tolerance": tolerance,
        }
        for name, given in of_axle.items():
            if given is not None:
                arguments.wrong(name, f"{name} and rig: a rig has no such thing; leave out one")
        speeds, sumps, base = [], [], {**base, "gear_set": None, "vehicle": None}
    speeds = [60] if speeds is None else list(speeds)
    sumps = [40] if sumps is None else list(sumps)
    for sump in sumps:
        for speed in speeds:
            condition = campaign.conditions.add()
            stated = (speed, ascent_angle_degrees, sump, inlet_temperature_rise_kelvin)
            for name, value in zip(CONDITION, stated):
                if value is not None:
                    setattr(condition, name, arguments.number(name, value))
    _set_weights(arguments, campaign, (speeds, speed_weights), (sumps, sump_weights))
    is_made = isinstance(table, (Design, Lubricants))
    rows = [] if is_made else table_rows(table)
    if is_made:
        table.set(arguments, campaign)
    candidates = [read_varied(arguments, row) for row in rows]
    if not base["lubricant"] and not isinstance(table, Lubricants):
        arguments.wrong("lubricant", "is missing; only of Lubricants the first one is the base")
    arguments.check()
    found = await _found_lubricants(transport, campaign)
    # Names become revisions, so that a later call after a change of one is another campaign.
    first = {"lubricant": base["lubricant"] or next(iter(found), "")}
    model_version = await _pin(transport, campaign, {**base, **first})
    await _add_candidates(transport, campaign, candidates)
    _add_attributes(campaign, rows)
    for key, value in labels.items():
        campaign.labels.add(key=key, value=value)
    if request_id is None:
        inputs = campaign.SerializeToString(deterministic=True) + model_version.encode()
        inputs += "".join(found).encode()
        request_id = "screen-" + hashlib.sha256(inputs).hexdigest()[:32]
    request = pb.CreateCampaignRequest(campaign=campaign, request_id=request_id)
    out = AsyncCampaign(
        transport,
        progress_form,
        await transport.call(_SERVICE, "CreateCampaign", request, patient=True),
    )
    has_budget = budget_points is not None or budget_processor_seconds is not None
    if out.state == "paused" or (out.state == "running" and has_budget):
        try:
            await out.resume(
                budget_points=budget_points or 0,
                budget_processor_seconds=budget_processor_seconds or 0.0,
            )
        except TribodynError as error:
            if error.reason != "ENDED":  # since it was created
                raise
            await out.refresh()
    return out


def _set_weights(
    arguments: Arguments,
    campaign: pb.Campaign,
    *axes: tuple[Sequence[Quantity], Sequence[float] | None],
) -> None:
    (speeds, of_speeds), (sumps, of_sumps) = axes
    for name, values, weights in (
        ("speed_weights", speeds, of_speeds),
        ("sump_weights", sumps, of_sumps),
    ):
        if weights is not None and len(weights) != len(values):
            arguments.wrong(name, f"{len(weights)} weights of {len(values)} values")
            return
    if of_speeds is not None or of_sumps is not None:
        of_speeds = [1.0] * len(speeds) if of_speeds is None else of_speeds
        of_sumps = [1.0] * len(sumps) if of_sumps is None else of_sumps
        campaign.condition_weights.extend(float(a) * float(b) for a in of_sumps for b in of_speeds)


async def _found_lubricants(transport: Transport, campaign: pb.Campaign) -> list[str]:
    """Replaces lubricants that are candidates by their revisions. Returns these, or those that
    satisfy the filter."""
    names = list(campaign.candidate_lubricants)
    for i, name in enumerate(names):
        get = lubricants_pb2.GetLubricantRequest(name=name)
        lubricant = await transport.call("LubricantService", "GetLubricant", get)
        names[i] = f"{name.partition('@')[0]}@{lubricant.revision}"
    campaign.candidate_lubricants[:] = names
    if not campaign.lubricant_filter:
        return names
    request = lubricants_pb2.ListLubricantsRequest(
        filter=campaign.lubricant_filter, page_size=1000, read_mask={"paths": ["name", "revision"]}
    )
    while True:
        page = await transport.call("LubricantService", "ListLubricants", request)
        names += [f"{each.name}@{each.revision}" for each in page.lubricants]
        request.page_token = page.next_page_token
        if not request.page_token:
            return names


async def _pin(transport: Transport, campaign: pb.Campaign, base: Mapping[str, str | None]) -> str:
    """Sets the revisions of the base, and returns the version of the model."""
    if campaign.HasField("rig"):
        return await _pin_rig(transport, campaign, base)
    request = points_pb2.EvaluatePointsRequest(
        model_options=campaign.model_options,
        tolerance=campaign.tolerance,
        conditions=campaign.conditions[:1],
    )
    for kind, collection in _COLLECTIONS.items():
        name = base[kind]
        if name:
            setattr(request, kind, full_name(collection, name))
    answer = await transport.call("PointService", "EvaluatePoints", request, patient=True)
    for kind in _COLLECTIONS:
        setattr(campaign, kind, getattr(answer, kind + "_revision"))
    return answer.model_version


async def _pin_rig(
    transport: Transport, campaign: pb.Campaign, base: Mapping[str, str | None]
) -> str:
    """As _pin(), of a rig."""
    request = rigs_pb2.EvaluateRigRequest(
        lubricant=full_name("lubricants", base["lubricant"] or ""),
        surface=full_name("surfaces", base["surface"] or ""),
        model_options=campaign.model_options,
    )
    for field, value in campaign.rig.ListFields():
        if field.message_type is None:
            setattr(request, field.name, value)
        else:
            getattr(request, field.name).CopyFrom(value)
    answer = await transport.call("RigService", "EvaluateRig", request, patient=True)
    campaign.lubricant, campaign.surface = answer.lubricant_revision, answer.surface_revision
    return answer.model_version


async def _add_candidates(
    transport: Transport,
    campaign: pb.Campaign,
    candidates: Sequence[Mapping[str, float]],
    paths: Sequence[str] = (),
) -> None:
    """Adds a column for each parameter, `paths` among them; a candidate that states none has that of
    the base."""
    for path in dict.fromkeys([*paths, *(path for each in candidates for path in each)]):
        values = [each.get(path) for each in candidates]
        if None in values:
            owner, _, field = path.partition(".")
            service, method, kind = _GETTERS[owner]
            resource = await transport.call(service, method, kind(name=getattr(campaign, owner)))
            usual = getattr(resource, field)
            values = [usual if each is None else each for each in values]
        campaign.candidate_columns.add(path=path, values=values)


def _add_attributes(
    campaign: pb.Campaign, rows: Sequence[Mapping[str, Any]], texts: Container[str] = ()
) -> None:
    """Adds the columns of the table that are no parameters; those in `texts` hold texts."""
    columns = dict.fromkeys(name for row in rows for name in row)
    for name in columns:
        if name.partition(".")[0] in _GETTERS and "." in name:
            continue
        attribute = campaign.candidate_attributes.add(name=re.sub(r"[^A-Za-z0-9._-]", "_", name))
        values = [row.get(name) for row in rows]
        is_number = all(isinstance(each, (int, float)) and np.isfinite(each) for each in values)
        if is_number and attribute.name not in texts:
            attribute.values.extend(float(each) for each in values if each is not None)
        else:
            attribute.texts.extend("" if each is None else str(each) for each in values)
