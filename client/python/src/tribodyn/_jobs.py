"""Runs simulations: many at a time, watched by one stream, resumed after a broken connection."""

from __future__ import annotations

import asyncio
from typing import Any, Awaitable, Callable, Sequence, Union

import grpc

from tribodyn._progress import Progress
from tribodyn._transport import Backoff, Transport, requested_pause
from tribodyn.errors import TribodynError, is_about_the_request, service_error
from tribodyn.v1 import simulations_pb2 as pb

Outcome = Union[pb.Simulation, TribodynError]

_SERVICE = "SimulationService"
_CALLS_AT_A_TIME = 16
_MOST_WATCHED = 1000  # simulations that the server watches in one stream
_LONGEST_WATCH_SECONDS = 60.0
_WATCH_RETRIES = 20  # about 40 s in all: long enough for a server that drains and restarts
_ENDED = {pb.Simulation.SUCCEEDED, pb.Simulation.FAILED, pb.Simulation.CANCELLED}


async def run_all(
    transport: Transport,
    requests: Sequence[pb.CreateSimulationRequest],
    progress: Progress,
    all_or_none: bool = False,
) -> list[Outcome]:
    """Submits the simulations and waits for their ends. Returns, in the order of the requests, each
    with its result, or the error for which it has none. A lost server raises TribodynError.
    ``all_or_none``: a refused request cancels the others, and its error is raised.

    A thousand simulations share one stream of events. A request that is sent again after a lost
    connection starts no second simulation: each has a request_id.
    """
    run = _Run(transport, requests, progress, all_or_none)
    groups = [
        range(first, min(first + _MOST_WATCHED, len(requests)))
        for first in range(0, len(requests), _MOST_WATCHED)
    ]
    try:
        await gather(*map(run.run_some, groups))
    finally:
        progress.close()
    return [run.outcomes[index] for index in range(len(requests))]


class _Run:
    def __init__(
        self,
        transport: Transport,
        requests: Sequence[pb.CreateSimulationRequest],
        progress: Progress,
        all_or_none: bool,
    ) -> None:
        self._all_or_none = all_or_none
        self._transport = transport
        self._requests = requests
        self._progress = progress
        self._calls = asyncio.Semaphore(_CALLS_AT_A_TIME)
        self._one_group_submits = asyncio.Lock()
        self.outcomes: dict[int, Outcome] = {}

    async def run_some(self, indices: range) -> None:
        """Runs at most a thousand of the requests."""
        open_: dict[str, list[int]] = {}
        async with self._one_group_submits:
            created = await gather(*(self._create(index) for index in indices))
        refused = [each for each in created if isinstance(each, TribodynError)]
        if refused and self._all_or_none:
            started = [each for each in created if each not in refused]
            await gather(*(self._cancel(each.name) for each in started))
            raise refused[0]
        ended: list[tuple[str, list[int]]] = []
        for index, simulation in zip(indices, created):
            if isinstance(simulation, TribodynError):
                self._finish(index, simulation)
            elif simulation.state in _ENDED:
                ended.append((simulation.name, [index]))
            else:
                open_.setdefault(simulation.name, []).append(index)
        fetches = [asyncio.ensure_future(self._fetch(name, at)) for name, at in ended]
        try:
            await self._watch(open_, fetches)
            await asyncio.gather(*fetches)
        finally:
            for fetch in fetches:
                fetch.cancel()

    async def _create(self, index: int) -> Outcome:
        async with self._calls:
            try:
                return await self._transport.call(
                    _SERVICE, "CreateSimulation", self._requests[index], patient=True
                )
            except TribodynError as error:
                if not is_about_the_request(error):
                    raise
                return error

    async def _cancel(self, name: str) -> None:
        await self._transport.call(
            _SERVICE, "CancelSimulation", pb.CancelSimulationRequest(name=name)
        )

    async def _fetch(self, name: str, indices: list[int]) -> None:
        request = pb.GetSimulationRequest(name=name, view=pb.SIMULATION_VIEW_FULL)
        async with self._calls:
            try:
                simulation: Outcome = await self._transport.call(
                    _SERVICE, "GetSimulation", request, patient=True
                )
            except TribodynError as error:
                if error.reason != "NOT_FOUND":
                    raise
                simulation = _deleted(name)
        for index in indices:
            self._finish(index, _checked(simulation))

    def _finish(self, index: int, outcome: Outcome) -> None:
        self.outcomes[index] = outcome
        self._progress.update(str(index), 1)

    async def _watch(self, open_: dict[str, list[int]], fetches: list[asyncio.Task[None]]) -> None:
        """Starts a fetch for each simulation that ends. Resumes a broken stream after its last
        event."""
        request = pb.WatchSimulationsRequest()
        backoff, tries_left = Backoff(), _WATCH_RETRIES

        def ends(name: str) -> None:
            fetches.append(asyncio.ensure_future(self._fetch(name, open_.pop(name))))

        while open_:
            request.names[:] = list(open_)
            was_silent, requested = True, None
            try:
                # A watch that does not end is restarted, to notice a connection that died silently.
                async for event in self._transport.stream(
                    _SERVICE, "WatchSimulations", request, _LONGEST_WATCH_SECONDS
                ):
                    was_silent, tries_left = False, _WATCH_RETRIES
                    backoff.reset()
                    request.after_event_number = event.event_number
                    if event.name not in open_:
                        continue
                    if event.state in _ENDED or event.kind == pb.SimulationEvent.DELETED:
                        ends(event.name)
                    else:
                        for index in open_[event.name]:
                            self._progress.update(str(index), event.progress_fraction)
            except grpc.aio.AioRpcError as error:
                requested = requested_pause(error)
                if error.code() is grpc.StatusCode.DEADLINE_EXCEEDED:
                    # A watch without any event, not even a heartbeat: the server is frozen, which
                    # this call raises, or the simulation has ended unnoticed.
                    if was_silent and open_:
                        await self._check_first(open_, ends)
                elif error.code() is not grpc.StatusCode.UNAVAILABLE and requested is None:
                    raise service_error(error, self._transport.settings.server) from None
                tries_left -= requested is None
                if tries_left == 0:
                    raise service_error(error, self._transport.settings.server) from None
            if open_:
                await asyncio.sleep(backoff.next(requested or 0.25))

    async def _check_first(self, open_: dict[str, list[int]], ends: Callable[[str], None]) -> None:
        name = next(iter(open_))
        simulation = await self._transport.call(
            _SERVICE,
            "GetSimulation",
            pb.GetSimulationRequest(name=name, view=pb.SIMULATION_VIEW_BASIC),
        )
        if simulation.state in _ENDED:
            ends(name)


def _checked(simulation: Outcome) -> Outcome:
    """Returns a simulation that succeeded, or the error of one that did not."""
    if isinstance(simulation, TribodynError) or simulation.state == pb.Simulation.SUCCEEDED:
        return simulation
    if simulation.state == pb.Simulation.CANCELLED:
        return TribodynError(f"{simulation.name} was cancelled", reason="CANCELLED")
    return TribodynError(
        f"{simulation.name} failed: {simulation.error.message}", reason=simulation.error.reason
    )


def _deleted(name: str) -> TribodynError:
    return TribodynError(f"{name} was deleted", reason="SIMULATION_DELETED")


async def gather(*calls: Awaitable[Any]) -> list[Any]:
    """Awaits all; the first that raises cancels the others."""
    tasks = [asyncio.ensure_future(each) for each in calls]
    try:
        return list(await asyncio.gather(*tasks))
    finally:
        for task in tasks:
            task.cancel()
