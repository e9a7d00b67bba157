"""The blocking client: ``Client``, the resources of a project, and campaigns."""

from __future__ import annotations

from types import TracebackType
from typing import Any, Generic, List, TypeVar

from google.protobuf.message import Message

from tribodyn import aio
from tribodyn._blocking import Blocking, blocking, blocking_as, blocking_iterator, run
from tribodyn._campaigns import AsyncCampaign
from tribodyn._frames import Frame
from tribodyn._resources import AsyncResources
from tribodyn.v1.campaigns_pb2 import Campaign as CampaignMessage
from tribodyn.v1.gear_sets_pb2 import GearSet
from tribodyn.v1.lubricants_pb2 import Lubricant
from tribodyn.v1.surfaces_pb2 import Surface
from tribodyn.v1.vehicles_pb2 import Vehicle

R = TypeVar("R", bound=Message)


class Resources(Blocking, Generic[R]):
    """The resources of one kind in a project: lubricants, gear sets, surfaces or vehicles.

    A field of a resource is stated under its name, with a plain number in the unit that the name
    ends in or a text with a unit (``relaxation_time_seconds="450 ns"``); without the unit in the
    name if the text has one (``relaxation_time="450 ns"``); or under the names of data sheets:
    ``kv40``, ``kv100``, ``kv100_sheared`` (mm2/s), ``density15`` (kg/m3), ``alpha`` ("20/GPa"),
    ``brookfield_-40_C`` (mPa s). Lists of measurements are texts ("205 mm2/s at 20 C; 31 mm2/s at
    100 C"), other nested messages have the form of JSON. ``labels.KEY`` is a label;
    ``FIELD.provenance``, ``FIELD.source``, ``FIELD.standard_uncertainty`` and ``FIELD.warning`` are
    the origin of a number. Pass names that are no Python words as ``**{"labels.project": "axle"}``.

    Names may have their collection ("lubricants/my-oil") and a revision ("my-oil@2").
    """

    _awaited: AsyncResources[R]

    def list(
        self,
        filter: str = "",
        *,
        order_by: str = "",
        show_deleted: bool = False,
        limit: int | None = None,
    ) -> List[R]:
        """Returns the resources that match a filter, e.g. ``kv100 > 13.5 AND labels.project =
        "axle"`` (`tribodyn help filters`), from all pages; at most ``limit``."""
        return run(
            self._awaited.list(filter, order_by=order_by, show_deleted=show_deleted, limit=limit)
        )

    def frame(self, filter: str = "", *, order_by: str = "", limit: int | None = None) -> Frame:
        """Returns the resources that match a filter as a table: one a row, units in the names of
        columns, labels in columns "labels.KEY"."""
        return run(self._awaited.frame(filter, order_by=order_by, limit=limit))

    def get(self, name: str) -> R:
        """Returns the newest revision, or that of "NAME@REVISION"."""
        return run(self._awaited.get(name))

    def create(
        self, name: str, like: R | str | None = None, *, validate_only: bool = False, **fields: Any
    ) -> R:
        """Creates a resource and returns it as stored: with fitted and estimated parameters and the
        provenance of each. ``like``: a resource, or the name of one, that sets all other fields.
        ``validate_only``: checks everything and writes nothing."""
        return run(self._awaited.create(name, like, validate_only=validate_only, **fields))

    def update(self, name: str, *, validate_only: bool = False, **fields: Any) -> R:
        """Makes a new revision with other values of these fields, and returns it; None clears a
        field. Fails with ETAG_MISMATCH if somebody else changes the resource meanwhile."""
        return run(self._awaited.update(name, validate_only=validate_only, **fields))

    def delete(self, name: str) -> R:
        """Hides the resource from lists and new studies. Results keep pointing at it."""
        return run(self._awaited.delete(name))

    def undelete(self, name: str) -> R:
        """Restores a deleted resource."""
        return run(self._awaited.undelete(name))

    def import_table(
        self, table: Any, *, replace: bool = False, validate_only: bool = False
    ) -> List[str]:
        """Creates one resource for each row, all or none, and returns their names.

        ``table`` is a DataFrame, a mapping of columns, a sequence of rows, or the path of a CSV
        file; a column "name" and others as above, headers with units in brackets ("Density15
        (g/cm3)") among them; 1 to 20,000 rows. Empty cells set nothing. ``replace``: a row whose
        name exists changes the fields of its columns; labels replace all labels."""
        return run(
            self._awaited.import_table(table, replace=replace, validate_only=validate_only)
        )


class Campaign(Blocking):
    """A table of candidates that the server screens and keeps, whatever becomes of this program.

    Row i * conditions + k of its tables is candidate i at condition k, counted from 0. A row has the
    candidate's parameters and what rides along with them, the condition, the figures, and
    ``status``: "OK", the reason why there are no figures, or "NOT_COMPUTED".
    """

    _awaited: AsyncCampaign

    @property
    def name(self) -> str:
        """Its name, e.g. "campaigns/12"."""
        return self._awaited.name

    @property
    def state(self) -> str:
        """The state when the server last answered: "running", "paused", "succeeded", "failed",
        "cancelled", or "stalled": it runs, but the server cannot write its rows."""
        return self._awaited.state

    @property
    def reason(self) -> str:
        """Why it is stalled, paused or failed, for people; "" if it is none of these."""
        return self._awaited.reason

    def __repr__(self) -> str:
        return repr(self._awaited)

    @property
    def message(self) -> CampaignMessage:
        """The message as the server last answered it, e.g. ``message.points_done``."""
        return self._awaited.message

    refresh = blocking(AsyncCampaign.refresh)
    wait = blocking(AsyncCampaign.wait)
    follow = blocking_iterator(AsyncCampaign.follow)
    frame = blocking(AsyncCampaign.frame)
    append = blocking(AsyncCampaign.append)
    update = blocking(AsyncCampaign.update)
    ranking = blocking(AsyncCampaign.ranking)
    pareto = blocking(AsyncCampaign.pareto)
    effects = blocking(AsyncCampaign.effects)
    promote = blocking(AsyncCampaign.promote)
    pause = blocking(AsyncCampaign.pause)
    resume = blocking(AsyncCampaign.resume)
    cancel = blocking(AsyncCampaign.cancel)
    delete = blocking(AsyncCampaign.delete)


def _campaigns(found: List[AsyncCampaign]) -> List[Campaign]:
    return [Campaign(each) for each in found]


class Client(Blocking):
    """A server and a project. Safe for concurrent use; the constructor sends nothing.

    ``server`` is "HOST:PORT" or "unix:PATH"; without it TRIBODYN_SERVER, then the configuration
    file of the command line (~/.config/tribodyn/config), then the socket of the user's own
    tribodynd, then 127.0.0.1:50651. ``token_file`` names the file with the token; the socket needs
    none. It, ``project``, ``timeout_seconds`` (of one call; 30) and ``progress`` ("auto": bars in
    notebooks and terminals, "lines" or "none") come likewise from the environment
    (TRIBODYN_TOKEN_FILE) or the file. ``client_name`` separates programs of one user in the
    server's fair queue: a notebook with another name than a screening does not wait for it.

    Every method raises TribodynError. A call is repeated, where that is safe, after the pause that
    the server states, when the server is lost or turns it away. Studies are jobs of the server,
    which goes on when this program ends; equal inputs are computed once.
    """

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
        client = aio.Client(
            server,
            project,
            timeout_seconds=timeout_seconds,
            progress=progress,
            client_name=client_name,
            token_file=token_file,
        )
        super().__init__(client)
        self.lubricants: Resources[Lubricant] = Resources(client.lubricants)
        self.gear_sets: Resources[GearSet] = Resources(client.gear_sets)
        self.surfaces: Resources[Surface] = Resources(client.surfaces)
        self.vehicles: Resources[Vehicle] = Resources(client.vehicles)

    @property
    def server(self) -> str:
        """The address of the server."""
        return self._awaited.server

    @property
    def project(self) -> str:
        """The name of the project."""
        return self._awaited.project

    def __enter__(self) -> Client:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    close = blocking(aio.Client.close)
    schema = blocking(aio.Client.schema)
    point = blocking(aio.Client.point)
    sensitivities = blocking(aio.Client.sensitivities)
    curve = blocking(aio.Client.curve)
    compare = blocking(aio.Client.compare)
    histories = blocking(aio.Client.histories)
    read_history = blocking(aio.Client.read_history)
    read_spectrum = blocking(aio.Client.read_spectrum)
    viscosity = blocking(aio.Client.viscosity)
    cycle = blocking(aio.Client.cycle)
    roughness = blocking(aio.Client.roughness)
    rig = blocking(aio.Client.rig)
    points = blocking(aio.Client.points)
    evaluate = blocking(aio.Client.evaluate)
    compare_points = blocking(aio.Client.compare_points)
    explain = blocking(aio.Client.explain)
    screen = blocking_as("Campaign", Campaign, aio.Client.screen)
    campaign = blocking_as("Campaign", Campaign, aio.Client.campaign)
    campaigns = blocking_as("List[Campaign]", _campaigns, aio.Client.campaigns)
