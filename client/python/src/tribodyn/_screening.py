"""Campaigns of a client: new ones, and those that the server keeps."""

from __future__ import annotations

import hashlib
from typing import Any, Mapping, Sequence

from tribodyn._arguments import Arguments, full_name, set_switches
from tribodyn._campaigns import AsyncCampaign
from tribodyn._candidate_columns import add_attributes, add_candidates
from tribodyn._candidates import Design, Lubricants, Rig
from tribodyn._carried import check_carried
from tribodyn._csv import table_rows
from tribodyn._evaluate import INPUTS
from tribodyn._figures import FigureChoice
from tribodyn._parameters import is_parameter, read_parameters
from tribodyn._session import Session
from tribodyn._stored_campaign import MOST_CANDIDATES, SERVICE, check_size
from tribodyn._transport import Transport
from tribodyn.errors import TribodynError
from tribodyn.units import Quantity
from tribodyn.v1 import campaigns_pb2 as pb
from tribodyn.v1 import lubricants_pb2, points_pb2, rigs_pb2

_COLLECTIONS = {
    "lubricant": "lubricants",
    "gear_set": "gearSets",
    "surface": "surfaces",
    "vehicle": "vehicles",
}
_EVERY_LUBRICANT_HAS = "lubricant.thermal_conductivity_watts_per_metre_kelvin"
# Fields of a campaign that decide no figure.
_DESCRIPTIONS = ("display_name", "labels", "condition_weights", "candidate_attributes")


class Screening(Session):
    """Methods of a client that create and find campaigns."""

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
        carry: str | Sequence[str] = (),
    ) -> AsyncCampaign:
        """Screens candidates, one a row, at every speed and sump temperature (None: 60 km/h and
        40 C), and returns the campaign at once. The server computes and keeps it: up to 100,000
        candidates and 20 million points; candidates may take 32 MiB, 8 bytes a number, which 100,000
        with 30 parameters do.

        ``table`` is as of points(). A column "lubricant.FIELD" or "surface.FIELD" states what
        candidates have in place of the parameter of ``lubricant`` or ``surface``, as of evaluate();
        an empty cell leaves that. Other columns ride along, "name" among them, and ``carry`` as of
        evaluate(); characters of their names beyond letters, digits, "-", "_" and "." become "_". Oils that are known by their data
        sheets are Lubricants: a table cannot carry the uncertainty of what is estimated. Weights, one
        for each speed and sump temperature and above 0, are those of ranking(); None: equal.
        ``contact_figures`` and ``elasticities`` as of evaluate(), ``model_options`` as of Options.

        ``table`` may also be a Design, which the server makes, or Lubricants, each of which is a
        candidate; of these the first one is the base if ``lubricant`` is None. Candidates that are
        lubricants have the columns "name" and their parameters. ``labels``: campaigns() filters by
        them.

        ``rig``, a tribodyn.Rig, runs the candidates on a rig in place of the axle: the columns are
        those of rig(), ``surface`` None means smooth specimens, and gear set, vehicle, tolerance,
        speeds and sump temperatures are left out.

        The same call again finds its campaign by a request id that is a hash of all that decides its
        figures, goes on if it is paused, and computes nothing twice; ``request_id`` states another
        one. Title, labels, weights and other columns decide no figure: the campaign gets new ones. A budget pauses the campaign when it is spent. Raises if a parameter or condition is
        outside its range, with all of them.
        """
        arguments = Arguments()
        campaign = pb.Campaign(display_name=display_name, tolerance=tolerance or 0.0)
        set_switches(arguments, "model_options", model_options or {}, campaign.model_options)
        FigureChoice.read(arguments, contact_figures, elasticities, elasticity_figures).set(campaign)
        if rig is None:
            _set_conditions(
                arguments,
                campaign,
                [60] if speeds_kilometres_per_hour is None else speeds_kilometres_per_hour,
                [40] if sump_temperatures_celsius is None else sump_temperatures_celsius,
                speed_weights,
                sump_weights,
                ascent_angle_degrees=ascent_angle_degrees,
                inlet_temperature_rise_kelvin=inlet_temperature_rise_kelvin,
            )
        else:
            rig.set(arguments, campaign)
            _refuse_with_rig(
                arguments,
                speeds_kilometres_per_hour=speeds_kilometres_per_hour,
                sump_temperatures_celsius=sump_temperatures_celsius,
                speed_weights=speed_weights,
                sump_weights=sump_weights,
                ascent_angle_degrees=ascent_angle_degrees,
                inlet_temperature_rise_kelvin=inlet_temperature_rise_kelvin,
                gear_set=gear_set,
                vehicle=vehicle,
                tolerance=tolerance,
            )
        is_made = isinstance(table, (Design, Lubricants))
        rows = [] if is_made else table_rows(table)
        if len(rows) > MOST_CANDIDATES:
            arguments.wrong("table", f"{len(rows)} rows; allowed: at most {MOST_CANDIDATES}")
            arguments.check()
        headers = dict.fromkeys(name for row in rows for name in row)
        parameters = [name for name in headers if is_parameter(name)]
        check_carried(headers, parameters, INPUTS, carry)
        if is_made:
            table.set(arguments, campaign)
        candidates = [read_parameters(arguments, row) for row in rows]
        if not lubricant and not isinstance(table, Lubricants):
            arguments.wrong("lubricant", "is missing; only of Lubricants the first one is the base")
        arguments.check()
        found = await _found_lubricants(self._transport, campaign)
        # Names become revisions, so that a later call after a change of one is another campaign.
        base = {
            "lubricant": lubricant or next(iter(found), ""),
            "gear_set": gear_set,
            "surface": surface,
            "vehicle": vehicle,
        }
        model_version = await _pin(self._transport, campaign, base)
        # Without a column a campaign has one candidate: those that state nothing share a parameter.
        paths = [_EVERY_LUBRICANT_HAS] if rows and not any(candidates) else []
        await add_candidates(self._transport, campaign, candidates, paths)
        add_attributes(campaign, rows)
        for key, value in (labels or {}).items():
            campaign.labels.add(key=key, value=value)
        created = await self._create_or_find(campaign, request_id, [model_version, *found])
        out = AsyncCampaign(self._transport, self._settings.progress, created)
        await _go_on(out, budget_points, budget_processor_seconds)
        return out

    async def _create_or_find(
        self, campaign: pb.Campaign, request_id: str | None, beside: Sequence[str]
    ) -> pb.Campaign:
        """Creates a campaign; or finds the one with the same figures (which ``beside`` decides too),
        and gives it the title, labels and weights of this one, and the attributes unless candidates
        were added to it since."""
        request = pb.CreateCampaignRequest(
            campaign=campaign, request_id=request_id or _request_id(campaign, beside)
        )
        check_size(request, campaign, "table")
        try:
            return await self._call(SERVICE, "CreateCampaign", request, patient=True)
        except TribodynError as error:
            if request_id or error.reason != "REQUEST_ID_REUSED" or not error.resource:
                raise
            name = error.resource
        get = pb.GetCampaignRequest(name=name, view=pb.CAMPAIGN_VIEW_FULL)
        present = await self._call(SERVICE, "GetCampaign", get)
        update = pb.UpdateCampaignRequest(campaign=pb.Campaign(name=name))
        for path in _DESCRIPTIONS:
            stated = getattr(campaign, path)
            if path == "candidate_attributes" and not _has_same_candidates(campaign, present):
                continue
            if stated == getattr(present, path):
                continue
            update.update_mask.paths.append(path)
            if isinstance(stated, str):
                setattr(update.campaign, path, stated)
            else:
                getattr(update.campaign, path).extend(stated)
        if not update.update_mask.paths:
            return present
        return await self._call(SERVICE, "UpdateCampaign", update, patient=True)

    async def campaign(self, name: str) -> AsyncCampaign:
        """Returns a campaign, e.g. "12" or "campaigns/12"."""
        campaign = AsyncCampaign(
            self._transport,
            self._settings.progress,
            pb.Campaign(name=full_name("campaigns", name)),
        )
        await campaign.refresh()
        return campaign

    async def campaigns(
        self, limit: int | None = None, *, filter: str = ""
    ) -> list[AsyncCampaign]:
        """Returns campaigns, newest first; at most ``limit``. ``filter``: e.g. "labels.project = axle
        AND create_time > 2026-01-31T00:00:00Z"; ``tribodyn help filters`` lists the
        fields."""
        found: list[pb.Campaign] = []
        request = pb.ListCampaignsRequest(page_size=min(limit or 1000, 1000), filter=filter)
        while True:
            page = await self._call(SERVICE, "ListCampaigns", request)
            found += page.campaigns
            request.page_token = page.next_page_token
            if not request.page_token or (limit is not None and len(found) >= limit):
                break
        return [
            AsyncCampaign(self._transport, self._settings.progress, each) for each in found[:limit]
        ]


def _request_id(campaign: pb.Campaign, beside: Sequence[str]) -> str:
    """Returns a hash of all that decides the figures of a campaign."""
    inputs = pb.Campaign()
    inputs.CopyFrom(campaign)
    for path in _DESCRIPTIONS:
        inputs.ClearField(path)
    text = inputs.SerializeToString(deterministic=True) + "".join(beside).encode()
    return "screen-" + hashlib.sha256(text).hexdigest()[:32]


def _has_same_candidates(campaign: pb.Campaign, present: pb.Campaign) -> bool:
    columns = campaign.candidate_columns
    return bool(columns) and len(columns[0].values) == present.candidates


async def _go_on(
    campaign: AsyncCampaign, budget_points: int | None, budget_processor_seconds: float | None
) -> None:
    """Resumes a campaign that is paused, and sets the budget of one that runs."""
    has_budget = budget_points is not None or budget_processor_seconds is not None
    if campaign.state != "paused" and not (campaign.state in ("running", "stalled") and has_budget):
        return
    try:
        await campaign.resume(
            budget_points=budget_points or 0,
            budget_processor_seconds=budget_processor_seconds or 0.0,
        )
    except TribodynError as error:
        if error.reason != "ENDED":  # since it was created
            raise
        await campaign.refresh()


def _set_conditions(
    arguments: Arguments,
    campaign: pb.Campaign,
    speeds: Sequence[Quantity],
    sumps: Sequence[Quantity],
    speed_weights: Sequence[float] | None,
    sump_weights: Sequence[float] | None,
    **common: Quantity | None,
) -> None:
    """Sets conditions by sump, then by speed, and their weights. ``common``: what all conditions
    have."""
    speeds, sumps = list(speeds), list(sumps)
    for sump in sumps:
        for speed in speeds:
            stated = {"speed_kilometres_per_hour": speed, "sump_temperature_celsius": sump}
            arguments.set_numbers(campaign.conditions.add(), {**stated, **common})
    for name, values, weights in (
        ("speed_weights", speeds, speed_weights),
        ("sump_weights", sumps, sump_weights),
    ):
        if weights is not None and len(weights) != len(values):
            arguments.wrong(name, f"{len(weights)} weights of {len(values)} values")
            return
    if speed_weights is not None or sump_weights is not None:
        by_speed = [1.0] * len(speeds) if speed_weights is None else speed_weights
        by_sump = [1.0] * len(sumps) if sump_weights is None else sump_weights
        campaign.condition_weights.extend(float(a) * float(b) for a in by_sump for b in by_speed)


def _refuse_with_rig(arguments: Arguments, **of_axle: Any) -> None:
    for name, given in of_axle.items():
        if given is not None:
            arguments.wrong(name, f"{name} and rig: a rig has no such thing; leave out one")


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
