"""Calls of the services: one channel, its credentials and metadata, retries, names of the
project."""

from __future__ import annotations

import asyncio
import logging
import random
import uuid
from contextlib import AsyncExitStack
from typing import Any, AsyncIterator, Iterator

import grpc
from google.protobuf.descriptor import Descriptor
from google.protobuf.message import Message

from tribodyn.errors import details_of, reason_of, retry_delay_of, service_error
from tribodyn.settings import DEFAULT_PROJECT, Settings

_OPTIONS = (
    # With BDP probes, gRPC would buffer megabytes of a watch stream that is not read.
    ("grpc.http2.bdp_probe", 0),
    # http_proxy is for web sites; a server on loopback or in the local network is not behind it.
    ("grpc.enable_http_proxy", 0),
    ("grpc.initial_reconnect_backoff_ms", 200),
    ("grpc.max_reconnect_backoff_ms", 2000),
    # As large as the server sends: the candidates of a campaign may take 32 MiB.
    ("grpc.max_receive_message_length", 33 << 20),
)
# Reasons of a failure amid the work, which may have had its effect.
_AMID_WORK = ("STORE_FAILED", "OUT_OF_MEMORY")
# Calls over a quota that try again at once; the others wait in line, or all would fail together.
_MOST_OVER_QUOTA = 8
# Time that a call waits for a quota until the log says so, and until it may say so again [s].
_LONG_WAIT, _BETWEEN_REPORTS = 5.0, 60.0
_LOG = logging.getLogger("tribodyn")
_REPEATABLE = ("Get", "List", "Evaluate", "Pause", "Resume", "Cancel", "Delete")


class Backoff:
    """Pauses between tries. They double and are random, so that clients that failed together do not
    retry together, and are never shorter than the server requests."""

    FIRST_SECONDS = 0.1
    LONGEST_SECONDS = 5.0

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        self._longest = self.FIRST_SECONDS

    def next(self, requested: float | None = None) -> float:
        pause = (requested or 0.0) + random.uniform(0, self._longest)
        self._longest = min(2 * self._longest, self.LONGEST_SECONDS)
        return pause


class Transport:
    """A server and a project. Belongs to the event loop in which its first call is made."""

    def __init__(self, settings: Settings, client_name: str | None) -> None:
        self.settings = settings
        self._metadata: tuple[tuple[str, str], ...] = ()
        if client_name:
            self._metadata += (("tribodyn-client", client_name),)
        if settings.token:
            self._metadata += (("authorization", f"Bearer {settings.token}"),)
        self._channel: grpc.aio.Channel | None = None
        self._was_connected = False
        self._next_report = 0.0  # time of the loop
        self._line = asyncio.Semaphore(_MOST_OVER_QUOTA)

    async def close(self) -> None:
        if self._channel is not None:
            await self._channel.close()
            self._channel = None

    async def call(
        self, service: str, method: str, request: Message, *, patient: bool = False
    ) -> Any:
        """Makes one call within the time limit. Retries, where that is safe, when the server is
        lost, and when it turns the request away and requests a pause: without a limit if that
        quota lasts no longer than the time limit, or if ``patient``."""
        self._add_project(request)
        loop = asyncio.get_running_loop()
        deadline = loop.time() + self.settings.timeout_seconds
        backoff = Backoff()
        function = self._function(service, method, request)
        waited_for_connection = is_in_line = False
        waited = 0.0
        async with AsyncExitStack() as line:
            while True:
                try:
                    answer = await function(
                        request, timeout=max(0.001, deadline - loop.time()), metadata=self._metadata
                    )
                    self._was_connected = True
                    self._remove_project(answer)
                    return answer
                except grpc.aio.AioRpcError as error:
                    status = details_of(error)
                    self._was_connected |= status is not None
                    never_sent = _never_connected(error)
                    if never_sent and not self._was_connected:
                        # gRPC may report a connection in progress as failed: one more try.
                        if waited_for_connection or not await self._is_ready(1.0):
                            raise service_error(error, self.settings.server) from None
                        waited_for_connection = True
                        continue
                    requested = retry_delay_of(status) if status else None
                    reason = reason_of(status) if status else ""
                    is_gone = (
                        error.code() is grpc.StatusCode.UNAVAILABLE or requested is not None
                    ) and (never_sent or may_repeat(request))
                    turned_away = requested is not None and reason not in _AMID_WORK
                    is_over_quota = (
                        reason == "QUOTA_EXCEEDED"
                        and requested is not None
                        and requested <= self.settings.timeout_seconds
                    )
                    if is_over_quota and not is_in_line:
                        await line.enter_async_context(self._line)
                        is_in_line = True
                    if is_over_quota:
                        backoff.reset()
                    pause = backoff.next(requested)
                    if is_over_quota or (patient and turned_away):
                        deadline = loop.time() + pause + self.settings.timeout_seconds
                    elif not (is_gone or turned_away) or loop.time() + pause >= deadline:
                        raise service_error(error, self.settings.server) from None
                    waited += pause
                    if is_over_quota and waited >= _LONG_WAIT and loop.time() >= self._next_report:
                        self._next_report = loop.time() + _BETWEEN_REPORTS
                        _LOG.warning("waits: %s", error.details())
                    await asyncio.sleep(pause)

    async def stream(
        self, service: str, method: str, request: Message, timeout: float | None = None
    ) -> AsyncIterator[Any]:
        """Yields the messages of a stream. Raises AioRpcError when it breaks."""
        self._add_project(request)
        function = self._function(service, method, request)
        call = function(request, timeout=timeout, metadata=self._metadata)
        try:
            async for message in call:
                self._was_connected = True
                self._remove_project(message)
                yield message
        finally:
            call.cancel()

    def _function(self, service: str, method: str, request: Message) -> Any:
        if self._channel is None:
            self._channel = self._connect()
        described = request.DESCRIPTOR.file.services_by_name[service].methods_by_name[method]
        make = (
            self._channel.unary_stream if described.server_streaming else self._channel.unary_unary
        )
        return make(
            f"/tribodyn.v1.{service}/{method}",
            request_serializer=lambda message: message.SerializeToString(),
            response_deserializer=described.output_type._concrete_class.FromString,
        )

    def _connect(self) -> grpc.aio.Channel:
        """Returns a channel with the credentials of the settings. Sends nothing."""
        settings = self.settings
        if not settings.uses_tls:
            return grpc.aio.insecure_channel(settings.server, options=_OPTIONS)
        credentials = grpc.ssl_channel_credentials(
            settings.authorities, settings.key, settings.certificate
        )
        return grpc.aio.secure_channel(settings.server, credentials, options=_OPTIONS)

    async def _is_ready(self, seconds: float) -> bool:
        assert self._channel is not None
        try:
            await asyncio.wait_for(self._channel.channel_ready(), seconds)
        except asyncio.TimeoutError:
            return False
        return True

    def _add_project(self, request: Message) -> None:
        """Makes names without a project names of the project."""
        if self.settings.project == DEFAULT_PROJECT:
            return
        prefix = f"projects/{self.settings.project}"
        if "parent" in request.DESCRIPTOR.fields_by_name:
            if not request.parent:
                request.parent = prefix
            return
        _change_names(
            request,
            lambda name: name if not name or name.startswith("projects/") else f"{prefix}/{name}",
        )

    def _remove_project(self, answer: Message) -> None:
        if self.settings.project != DEFAULT_PROJECT:
            prefix = f"projects/{self.settings.project}/"
            _change_names(answer, lambda name: name.removeprefix(prefix))


def may_repeat(request: Message) -> bool:
    """Whether a request may be sent again when the fate of the first try is unknown: it reads,
    checks, or has the same effect however often it is carried out."""
    kind, fields = request.DESCRIPTOR.name, request.DESCRIPTOR.fields_by_name

    def is_set(field: str) -> bool:
        return field in fields and bool(getattr(request, field))

    # The repetition of a deletion for good would not find what the first one deleted.
    if kind.startswith(("Delete", "Purge")) and "allow_missing" in fields:
        return is_set("allow_missing")
    return kind.startswith(_REPEATABLE) or is_set("validate_only") or is_set("request_id")


def requested_pause(error: grpc.aio.AioRpcError) -> float | None:
    """Returns the seconds after which a request that the server turned away may be sent again; None
    for another error."""
    status = details_of(error)
    return retry_delay_of(status) if status else None


def new_request_id() -> str:
    """Returns a random id for a request."""
    return str(uuid.uuid4())


def _never_connected(error: grpc.aio.AioRpcError) -> bool:
    return error.code() is grpc.StatusCode.UNAVAILABLE and (error.details() or "").startswith(
        "failed to connect to all addresses"
    )


def _is_resource(kind: Descriptor) -> bool:
    """Whether messages have the name of a resource: those of a service, and events of jobs."""
    return kind.name == "SimulationEvent" or kind.name + "Service" in kind.file.services_by_name


def _named(message: Message) -> Iterator[Message]:
    """Yields the message and the resources that are fields of it, or elements of one."""
    yield message
    for field, value in message.ListFields():
        if field.message_type is not None and _is_resource(field.message_type):
            yield from value if field.label == field.LABEL_REPEATED else [value]


def _change_names(message: Message, change: Any) -> None:
    for each in _named(message):
        fields = each.DESCRIPTOR.fields_by_name
        if "name" in fields and fields["name"].type == fields["name"].TYPE_STRING:
            if each.name:
                each.name = change(each.name)
        if "names" in fields:
            each.names[:] = [change(name) for name in each.names]
