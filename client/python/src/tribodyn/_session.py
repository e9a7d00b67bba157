"""What the groups of methods of a client have in common."""

from __future__ import annotations

from typing import Any, Sequence

from tribodyn._jobs import Outcome, run_all
from tribodyn._progress import Progress
from tribodyn._transport import Transport
from tribodyn.settings import Settings
from tribodyn.v1 import simulations_pb2 as pb


class Session:
    """A server, a project and the form of progress: the base of all groups of methods."""

    _transport: Transport
    _settings: Settings

    async def _call(
        self, service: str, method: str, request: Any, *, patient: bool = False
    ) -> Any:
        """As Transport.call()."""
        return await self._transport.call(service, method, request, patient=patient)

    async def _run_jobs(
        self,
        requests: Sequence[pb.CreateSimulationRequest],
        title: str,
        all_or_none: bool = False,
    ) -> Sequence[Outcome]:
        """As run_all(), with progress."""
        progress = Progress(self._settings.progress, len(requests), title)
        return await run_all(self._transport, requests, progress, all_or_none)
