"""The client with coroutines: ``Client``, whose methods are those of ``tribodyn.Client``."""

from __future__ import annotations

from types import TracebackType

from tribodyn._cycles import Cycles
from tribodyn._evaluate import Evaluations
from tribodyn._maps import Maps
from tribodyn._points import Points
from tribodyn._profiles import Profiles
from tribodyn._resources import AsyncResources
from tribodyn._screening import Screening
from tribodyn._studies import Studies
from tribodyn._transport import Transport
from tribodyn._uncertainty import Comparisons
from tribodyn.settings import read_settings
from tribodyn.v1.gear_sets_pb2 import GearSet
from tribodyn.v1.lubricants_pb2 import Lubricant
from tribodyn.v1.schemas_pb2 import GetSchemaRequest, Schema
from tribodyn.v1.surfaces_pb2 import Surface
from tribodyn.v1.vehicles_pb2 import Vehicle


class Client(Studies, Maps, Cycles, Profiles, Points, Evaluations, Comparisons, Screening):
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
        """The address of the server."""
        return self._settings.server

    @property
    def project(self) -> str:
        """The name of the project."""
        return self._settings.project

    async def close(self) -> None:
        """Closes the connection."""
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
        """Returns the constraints of one message, e.g. "Lubricant", with units and allowed ranges;
        of all messages with the allowed words, e.g. the columns of histories."""
        return await self._call("SchemaService", "GetSchema", GetSchemaRequest(message=message))
