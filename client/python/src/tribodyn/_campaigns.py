"""Campaigns: tables of candidates that the server screens and keeps."""

from __future__ import annotations

import asyncio
import warnings
from typing import Any, AsyncGenerator, Mapping, Sequence

import numpy as np

from tribodyn._arguments import Arguments, full_names
from tribodyn._candidate_columns import CandidateColumns, add_attributes, add_candidates
from tribodyn._columns import read_columns
from tribodyn._csv import table_rows
from tribodyn._decisions import Decisions
from tribodyn._figures import campaign_figures
from tribodyn._enums import enum_word
from tribodyn._frames import Frame, frame
from tribodyn._parameters import read_parameters
from tribodyn._progress import Progress
from tribodyn._stored_campaign import SERVICE, check_size
from tribodyn._transport import Backoff, new_request_id
from tribodyn.errors import TribodynError
from tribodyn.v1 import campaigns_pb2 as pb
from tribodyn.v1 import results_pb2

# Pauses between two looks at a campaign [s]: a small one ends after some milliseconds, and a large
# one is not asked for more often than a person reads.
_FIRST_LOOK, _LATEST_LOOK = 0.01, 0.5
_FOLLOW_RETRIES = 20  # about 40 s in all: long enough for a server that drains and restarts
_NOT_COMPUTED = -1  # in refusal_number
_STATUS = ("status", "status_message")
_SWITCHES = (
    "contact_loss",
    "settled",
    "responses_coexist",
    "verdict_withheld",
    "elasticities_one_sided",
)
_WHOLE_NUMBERS = ("period_in_mesh_cycles", "warning_bits")


class AsyncCampaign(Decisions):
    """A table of candidates that the server screens and keeps, whatever becomes of this program.

    Row i * conditions + k of its tables is candidate i at condition k, counted from 0. A row has the
    candidate's parameters and what rides along with them, the condition, the figures, and
    ``status``: "OK", the reason why there are no figures, or "NOT_COMPUTED".
    """

    async def wait(self) -> None:
        """Waits until the campaign has ended or is paused, with a progress bar; also over a restart
        of the server. Warns when it stalls (see ``state``), and waits on. Raises TribodynError if it
        failed or was cancelled."""
        progress = Progress(self._progress_form, max(self.message.points, 1), self.name)
        try:
            async for message in self._looks():
                progress.update("points", message.points_done)
        finally:
            progress.close()

    async def follow(
        self, columns: Sequence[str] = (), *, start_row: int = 0
    ) -> AsyncGenerator[Frame, None]:
        """Yields tables of the rows that are computed, in their order and without gaps, until the
        campaign has ended or is paused. A program that was interrupted states as ``start_row`` the
        number of rows that it has. Columns as of frame(). Raises as wait()."""
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
        """Returns rows as a table, finished or not; ``row_count`` 0: to the end. ``columns``: what
        the candidates were created with, "candidate", "condition" and "row" (numbers from 0), the
        fields of conditions, figures, "status" and "status_message"; empty: all but the three
        numbers. "verdict_withheld": a warning says that the row decides nothing between candidates;
        "warning_bits": 2^n for warning n of the server; ranking() names them. ``filter``: only rows
        of the range that satisfy all its conditions, e.g. "refusal_number > 0" (rows without
        figures) or "film_ratio_minimum < 1 AND additive = ZDDP"; the server reads it, so that
        columns have its names, e.g. "lubricant.FIELD"."""
        details = await self._full()
        own = CandidateColumns(details)
        names = [columns] if isinstance(columns, str) else list(columns)
        figures = campaign_figures(details)
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
            SERVICE,
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
            own = CandidateColumns(await self._full())
        cells = {name: _tight(name, each) for name, each in read.items()}
        if any(name in _STATUS for name in names):
            cells |= await self._status(read["refusal_number"].astype(int))
        rows = read["row"].astype(int)
        cells["row"] = rows
        out = {name: cells[name] if name in cells else own.column(name, rows) for name in names}
        return frame(out, {**self._attrs(), "start_row": schema.start_row})

    async def append(
        self,
        table: Any = None,
        *,
        lubricants: Sequence[str] = (),
        request_id: str | None = None,
    ) -> None:
        """Adds candidates behind the last one: rows of a table as of Client.screen(), or, where the
        candidates are lubricants, the names of others. What is computed stays; a campaign that has
        succeeded runs again. Parameters of the campaign that the table leaves out are as in the base;
        a parameter or another column that the campaign lacks is refused. A call with the
        ``request_id`` of an earlier one adds nothing more; None: every call adds."""
        request = pb.AppendCandidatesRequest(
            name=self.name,
            request_id=request_id or new_request_id(),
            candidate_lubricants=full_names("lubricants", lubricants),
        )
        if table is not None:
            rows = table_rows(table)
            arguments = Arguments()
            candidates = [read_parameters(arguments, row) for row in rows]
            arguments.check()
            details = await self._full()
            part = pb.Campaign(
                lubricant=details.lubricant_revision, surface=details.surface_revision
            )
            # What a table leaves out is as in the base.
            paths = dict.fromkeys(each.path for each in details.candidate_columns)
            await add_candidates(self._transport, part, candidates, list(paths))
            texts = {each.name for each in details.candidate_attributes if each.texts}
            add_attributes(part, rows, texts)
            request.candidate_columns.extend(part.candidate_columns)
            request.candidate_attributes.extend(part.candidate_attributes)
        check_size(request, request, "table")
        await self._change("AppendCandidates", request, patient=True)
        self._details = None

    async def update(
        self, *, display_name: str | None = None, labels: Mapping[str, str] | None = None
    ) -> None:
        """Changes the display name, or replaces the labels; None: they stay."""
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

    async def promote(
        self,
        candidate: int,
        lubricant: str = "",
        *,
        surface: str = "",
        display_name: str = "",
        validate_only: bool = False,
    ) -> pb.PromoteCandidateResponse:
        """Makes a candidate (number from 0) a lubricant with the id ``lubricant``, and where
        candidates have surface parameters of their own a surface with the id ``surface``. Their
        provenance names campaign, candidate and base. Returns the message with both. Raises
        TribodynError ALREADY_EXISTS if an id is taken; ``validate_only`` writes nothing."""
        request = pb.PromoteCandidateRequest(
            name=self.name,
            candidate=int(candidate),
            lubricant_id=lubricant,
            surface_id=surface,
            display_name=display_name,
            validate_only=validate_only,
        )
        return await self._call("PromoteCandidate", request)

    async def pause(self) -> None:
        """Pauses it; what is computed is kept."""
        await self._change("PauseCampaign", pb.PauseCampaignRequest(name=self.name))

    async def resume(
        self,
        *,
        budget_points: int | None = None,
        budget_processor_seconds: float | None = None,
    ) -> None:
        """Resumes it at its missing rows. Budgets count from its start and replace the present one;
        0: no limit; None of both: the present one stays."""
        request = pb.ResumeCampaignRequest(name=self.name)
        if budget_points is not None or budget_processor_seconds is not None:
            request.budget.points = budget_points or 0
            request.budget.processor_seconds = budget_processor_seconds or 0.0
        await self._change("ResumeCampaign", request)

    async def cancel(self) -> None:
        """Cancels it; what is computed is kept."""
        await self._change("CancelCampaign", pb.CancelCampaignRequest(name=self.name))

    async def delete(self) -> None:
        """Removes it for good, with its figures; cancels it first if it has not ended."""
        request = pb.DeleteCampaignRequest(name=self.name, cancel=True, allow_missing=True)
        await self._call("DeleteCampaign", request)

    async def _looks(self) -> AsyncGenerator[pb.Campaign, None]:
        """Yields the campaign again and again until it is not RUNNING. Waits for a server that is
        lost, for a limited time. Raises if the campaign failed or was cancelled."""
        pause, tries_left, backoff = _FIRST_LOOK, _FOLLOW_RETRIES, Backoff()
        was_stalled = False
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
            if message.stalled.message and not was_stalled:
                warnings.warn(f"{self.name} is stalled: {self.reason}", RuntimeWarning, stacklevel=2)
            was_stalled = message.HasField("stalled")
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


def _tight(name: str, values: np.ndarray) -> np.ndarray:
    """Returns words for models, and whole numbers and truth values where no row lacks them."""
    if name == "model":
        kind = results_pb2.PointModel.DESCRIPTOR
        words = [enum_word(kind, number) for number in range(len(kind.values))]
        return np.array(words, dtype=object)[np.nan_to_num(values).astype(int)]
    if np.isnan(values).any():
        return values
    if name in _SWITCHES:
        return values.astype(bool)
    return values.astype(int) if name in _WHOLE_NUMBERS else values
