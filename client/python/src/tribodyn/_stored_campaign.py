"""A campaign as the server keeps it: its message, and tables about its candidates."""

from __future__ import annotations

from typing import Any, Mapping, Sequence

import numpy as np

from tribodyn._candidate_columns import CandidateColumns
from tribodyn._frames import Frame, frame
from tribodyn._transport import Transport
from tribodyn.errors import invalid_fields, violation
from tribodyn.v1 import campaigns_pb2 as pb

SERVICE = "CampaignService"
MOST_BYTES = 32 << 20  # of a request with candidates, as the contract states it
MOST_CANDIDATES = 100_000


def check_size(request: Any, candidates: Any, field: str) -> None:
    """Raises, as the server would, if a request with candidates takes too many bytes: before it is
    sent. States how many such candidates do not. `candidates`: the message that has them."""
    size = request.ByteSize()
    if size <= MOST_BYTES:
        return
    columns = [each.values for each in candidates.candidate_columns]
    columns += [each.texts or each.values for each in candidates.candidate_attributes]
    count = max(map(len, columns), default=0)
    raise invalid_fields(
        [
            violation(
                field,
                f"{count} candidates take {size} bytes with their attributes; allowed: "
                f"{MOST_BYTES} bytes, which {count * MOST_BYTES // size} such candidates take; make "
                "several campaigns",
            )
        ]
    )


class StoredCampaign:
    """The base of the groups of methods of a campaign."""

    def __init__(self, transport: Transport, progress_form: str, message: pb.Campaign) -> None:
        self._transport = transport
        self._progress_form = progress_form
        self._details: pb.Campaign | None = None
        self.message = message

    @property
    def name(self) -> str:
        """Its name, e.g. "campaigns/12"."""
        return self.message.name

    @property
    def state(self) -> str:
        """The state when the server last answered: "running", "paused", "succeeded", "failed",
        "cancelled", or "stalled": it runs, but the server cannot write its rows."""
        if self.message.HasField("stalled"):
            return "stalled"
        return pb.Campaign.State.Name(self.message.state).lower()

    @property
    def reason(self) -> str:
        """Why it is stalled, paused or failed, for people; "" if it is none of these."""
        return self.message.stalled.message or self.message.stop.message

    def __repr__(self) -> str:
        return (
            f"<{self.name}: {self.state}, {self.message.points_done} of {self.message.points} points"
            f"{': ' * bool(self.reason)}{self.reason}>"
        )

    async def refresh(self) -> pb.Campaign:
        """Fetches the present message from the server and returns it."""
        self.message = await self._get(pb.CAMPAIGN_VIEW_BASIC)
        return self.message

    async def _call(self, method: str, request: Any, *, patient: bool = False) -> Any:
        return await self._transport.call(SERVICE, method, request, patient=patient)

    async def _change(self, method: str, request: Any, *, patient: bool = False) -> None:
        """Makes a call that answers the changed campaign."""
        self.message = await self._call(method, request, patient=patient)

    async def _get(self, view: Any) -> pb.Campaign:
        return await self._call("GetCampaign", pb.GetCampaignRequest(name=self.name, view=view))

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
        own = CandidateColumns(details)
        rows = np.array(candidates, dtype=int) * conditions
        out = {name: own.column(name, rows) for name in own.of_candidates()}
        out["candidate"] = np.array(candidates, dtype=int)
        return frame({**out, **cells}, {**self._attrs(), **attrs})

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
