"""The blocking client: ``Client`` and the resources of a project."""

from __future__ import annotations

import asyncio
import atexit
import threading
from pathlib import Path
from types import TracebackType
from typing import Any, Coroutine, Generic, Iterator, List, Mapping, Sequence, TypeVar

from google.protobuf.message import Message

from tribodyn import aio
from tribodyn._campaigns import AsyncCampaign
from tribodyn._candidates import Rig
from tribodyn._frames import Frame
from tribodyn._resources import AsyncResources
from tribodyn._profiles import Profile
from tribodyn._studies import Options
from tribodyn.units import Quantity
from tribodyn.v1.campaigns_pb2 import Campaign as CampaignMessage
from tribodyn.v1.campaigns_pb2 import PromoteCandidateResponse
from tribodyn.v1.gear_sets_pb2 import GearSet
from tribodyn.v1.lubricants_pb2 import Lubricant
from tribodyn.v1.schemas_pb2 import Schema
from tribodyn.v1.surfaces_pb2 import Surface
from tribodyn.v1.vehicles_pb2 import Vehicle

R = TypeVar("R", bound=Message)
T = TypeVar("T")


class _Loop:
    """The event loop of all blocking clients, in a thread of its own: so they also work in
    notebooks, where another loop runs already."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._loop: asyncio.AbstractEventLoop | None = None

    def run(self, work: Coroutine[Any, Any, T]) -> T:
        """Runs the work to its end; an interruption (Ctrl-C) cancels it."""
        future = asyncio.run_coroutine_threadsafe(work, self._started())
        try:
            return future.result()
        except BaseException:
            future.cancel()
            raise

    def _started(self) -> asyncio.AbstractEventLoop:
        with self._lock:
            if self._loop is None:
                self._loop = asyncio.new_event_loop()
                # gRPC's poller reports a wake-up that another loop of the process has consumed.
                self._loop.set_exception_handler(_report)
                thread = threading.Thread(
                    target=self._loop.run_forever, name="tribodyn", daemon=True
                )
                thread.start()
                atexit.register(self._stop, self._loop, thread)
            return self._loop

    @staticmethod
    def _stop(loop: asyncio.AbstractEventLoop, thread: threading.Thread) -> None:
        loop.call_soon_threadsafe(loop.stop)
        thread.join(1.0)


def _report(loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
    if not isinstance(context.get("exception"), BlockingIOError):
        loop.default_exception_handler(context)


_LOOP = _Loop()


class Resources(Generic[R]):
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

    def __init__(self, resources: AsyncResources[R]) -> None:
        self._resources = resources

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
        return _LOOP.run(
            self._resources.list(filter, order_by=order_by, show_deleted=show_deleted, limit=limit)
        )

    def frame(self, filter: str = "", *, order_by: str = "", limit: int | None = None) -> Frame:
        """Returns the resources that match a filter as a table: one a row, units in the names of
        columns, labels in columns "labels.KEY"."""
        return _LOOP.run(self._resources.frame(filter, order_by=order_by, limit=limit))

    def get(self, name: str) -> R:
        """Returns the newest revision, or that of "NAME@REVISION"."""
        return _LOOP.run(self._resources.get(name))

    def create(
        self, name: str, like: R | str | None = None, *, validate_only: bool = False, **fields: Any
    ) -> R:
        """Creates a resource and returns it as stored: with fitted and estimated parameters and the
        provenance of each. ``like``: a resource, or the name of one, that sets all other fields.
        ``validate_only``: checks everything and writes nothing."""
        return _LOOP.run(self._resources.create(name, like, validate_only=validate_only, **fields))

    def update(self, name: str, *, validate_only: bool = False, **fields: Any) -> R:
        """Makes a new revision with other values of these fields, and returns it; None clears a
        field. Fails with ETAG_MISMATCH if somebody else changes the resource meanwhile."""
        return _LOOP.run(self._resources.update(name, validate_only=validate_only, **fields))

    def delete(self, name: str) -> R:
        """Hides the resource from lists and new studies. Results keep pointing at it."""
        return _LOOP.run(self._resources.delete(name))

    def undelete(self, name: str) -> R:
        """Restores a deleted resource."""
        return _LOOP.run(self._resources.undelete(name))

    def import_table(
        self, table: Any, *, replace: bool = False, validate_only: bool = False
    ) -> List[str]:
        """Creates one resource for each row, all or none, and returns their names.

        ``table`` is a DataFrame, a mapping of columns, a sequence of rows, or the path of a CSV
        file; a column "name" and others as above, headers with units in brackets ("Density15
        (g/cm3)") among them; 1 to 20,000 rows. Empty cells set nothing. ``replace``: a row whose
        name exists changes the fields of its columns; labels replace all labels."""
        return _LOOP.run(
            self._resources.import_table(table, replace=replace, validate_only=validate_only)
        )


class Campaign:
    """A table of candidates that the server screens and keeps, whatever becomes of this program.

    Row i * conditions + k of its tables is candidate i at condition k, counted from 0. A row has the
    candidate's parameters and what rides along with them, the condition, the figures, and
    ``status``: "OK", the reason why there are no figures, or "NOT_COMPUTED".
    """

    def __init__(self, campaign: AsyncCampaign) -> None:
        self._campaign = campaign

    @property
    def name(self) -> str:
        """Its name, e.g. "campaigns/12"."""
        return self._campaign.name

    @property
    def state(self) -> str:
        """The state when the server last answered: "running", "paused", "succeeded", "failed" or
        "cancelled"."""
        return self._campaign.state

    @property
    def message(self) -> CampaignMessage:
        """The message as the server last answered it, e.g. ``message.points_done``."""
        return self._campaign.message

    def refresh(self) -> CampaignMessage:
        """Asks the server for the present message, and returns it."""
        return _LOOP.run(self._campaign.refresh())

    def wait(self) -> None:
        """Waits until the campaign has ended or is paused, with a progress bar; also over a restart
        of the server. Raises TribodynError if it failed or was cancelled."""
        _LOOP.run(self._campaign.wait())

    def follow(self, columns: Sequence[str] = (), *, start_row: int = 0) -> Iterator[Frame]:
        """Yields tables of the rows that are computed, in their order and without gaps, until the
        campaign has ended or is paused. A program that was interrupted states as ``start_row`` the
        number of rows that it has. Columns as of frame(). Raises as wait()."""
        frames = self._campaign.follow(columns, start_row=start_row)

        async def following() -> Frame:
            return await frames.__anext__()

        async def close() -> None:
            await frames.aclose()

        try:
            while True:
                try:
                    found = _LOOP.run(following())
                except StopAsyncIteration:
                    return
                yield found
        finally:
            _LOOP.run(close())

    def frame(
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
        numbers. ``filter``: only rows of the range that satisfy all its conditions, e.g.
        "refusal_number > 0" (rows without figures) or "film_ratio_minimum < 1 AND additive = ZDDP";
        the server reads it, so that columns have its names, e.g. "lubricant.FIELD"."""
        return _LOOP.run(
            self._campaign.frame(
                columns, start_row=start_row, row_count=row_count, filter=filter
            )
        )

    def append(
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
        _LOOP.run(self._campaign.append(table, lubricants=lubricants, request_id=request_id))

    def update(
        self, *, display_name: str | None = None, labels: Mapping[str, str] | None = None
    ) -> None:
        """Changes the display name, or replaces the labels; None: they stay."""
        _LOOP.run(self._campaign.update(display_name=display_name, labels=labels))

    def ranking(
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
        """Returns a table of the ``count`` best candidates (at most 1000), one a row, finished or not:
        those with least of the figure ``by`` first, or with most of it if ``most``. None: the mean
        inefficiency, of a rig the traction coefficient.

        A figure is a column with values, alone for its mean over the conditions with their weights,
        or with ":min" or ":max": "film_ratio_minimum:min"; of another campaign with the same
        candidates, "12/traction_coefficient:max". ``where`` maps figures to (minimum,
        maximum), each a number in the unit of the column or None; candidates outside are left out.
        ``uncertainties`` maps parameters to standard uncertainties: "3%" of the value, or a quantity;
        of a parameter in the table each candidate's own, of another one common to all. Those that
        lubricant and surface state count too unless ``stated_uncertainties`` is False.

        Columns: what the candidates were created with, "candidate" (numbers from 0), the figures,
        "solver_error" (a bound), "standard_uncertainty" (by the inputs), "worse_probability" (than
        the best one) and "tied": the probability is below ``confidence``. The last three are NaN and
        None beyond ``attrs["compared"]`` candidates. ``attrs`` counts the others as "excluded",
        "refused" and "missing" (not computed yet).
        """
        return _LOOP.run(
            self._campaign.ranking(
                by,
                most=most,
                where=where,
                condition_weights=condition_weights,
                uncertainties=uncertainties,
                stated_uncertainties=stated_uncertainties,
                confidence=confidence,
                count=count,
            )
        )

    def pareto(
        self,
        second: str,
        *,
        second_most: bool = False,
        first: str | None = None,
        first_most: bool = False,
        where: Mapping[str, tuple[float | None, float | None]] | None = None,
        condition_weights: Sequence[float] = (),
    ) -> Frame:
        """Returns a table of the candidates that no other one beats in both of two figures, the best
        by the first one first. Figures and ``where`` as of ranking(). ``attrs`` counts the others as
        "beaten", "excluded", "refused" and "missing"."""
        return _LOOP.run(
            self._campaign.pareto(
                second,
                second_most=second_most,
                first=first,
                first_most=first_most,
                where=where,
                condition_weights=condition_weights,
            )
        )

    def effects(
        self,
        figure: str | None = None,
        *,
        columns: Sequence[str] = (),
        where: Mapping[str, tuple[float | None, float | None]] | None = None,
        condition_weights: Sequence[float] = (),
        coverage: float = 0.95,
    ) -> Frame:
        """Returns a table of what columns of the candidates do to a figure, the largest effect first:
        from the lowest value to the highest one, or from the most frequent text to another one, by a
        linear model without interactions. "effect_minimum" and "effect_maximum" hold the effect with
        the probability ``coverage``. ``columns``: empty means all; ``attrs["left_out"]`` says which
        have no effect and why. Figures and ``where`` as of ranking()."""
        return _LOOP.run(
            self._campaign.effects(
                figure,
                columns=columns,
                where=where,
                condition_weights=condition_weights,
                coverage=coverage,
            )
        )

    def promote(
        self,
        candidate: int,
        lubricant: str = "",
        *,
        surface: str = "",
        display_name: str = "",
        validate_only: bool = False,
    ) -> PromoteCandidateResponse:
        """Makes a candidate (number from 0) a lubricant with the id ``lubricant``, and where
        candidates have surface parameters of their own a surface with the id ``surface``. Their
        provenance names campaign, candidate and base. Returns the message with both. Raises
        TribodynError ALREADY_EXISTS if an id is taken; ``validate_only`` writes nothing."""
        return _LOOP.run(
            self._campaign.promote(
                candidate,
                lubricant,
                surface=surface,
                display_name=display_name,
                validate_only=validate_only,
            )
        )

    def pause(self) -> None:
        """Pauses it; what is computed is kept."""
        _LOOP.run(self._campaign.pause())

    def resume(
        self, *, budget_points: int | None = None, budget_processor_seconds: float | None = None
    ) -> None:
        """Resumes it at its missing rows. Budgets count from its start and replace the present one;
        0: no limit; None of both: the present one stays."""
        _LOOP.run(
            self._campaign.resume(
                budget_points=budget_points, budget_processor_seconds=budget_processor_seconds
            )
        )

    def cancel(self) -> None:
        """Cancels it; what is computed is kept."""
        _LOOP.run(self._campaign.cancel())

    def delete(self) -> None:
        """Removes it for good, with its figures; cancels it first if it has not ended."""
        _LOOP.run(self._campaign.delete())


class Client:
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
        self._client = aio.Client(
            server,
            project,
            timeout_seconds=timeout_seconds,
            progress=progress,
            client_name=client_name,
            token_file=token_file,
        )
        self.lubricants: Resources[Lubricant] = Resources(self._client.lubricants)
        self.gear_sets: Resources[GearSet] = Resources(self._client.gear_sets)
        self.surfaces: Resources[Surface] = Resources(self._client.surfaces)
        self.vehicles: Resources[Vehicle] = Resources(self._client.vehicles)

    @property
    def server(self) -> str:
        """The address of the server."""
        return self._client.server

    @property
    def project(self) -> str:
        """The name of the project."""
        return self._client.project

    def close(self) -> None:
        """Closes the connection."""
        _LOOP.run(self._client.close())

    def __enter__(self) -> Client:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def schema(self, message: str = "") -> Schema:
        """Returns the constraints of one message, e.g. "Lubricant", with units and allowed ranges;
        of all messages with the allowed words, e.g. the columns of histories."""
        return _LOOP.run(self._client.schema(message))

    def point(
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
        """Returns the figures of one operating point: a table of one row.

        The point is a speed (0.1 to 400 km/h), with an acceleration (-50 to 50 m/s2) and an ascent
        (-45 to 45 degrees, or "6%"), or a torque of the pinion (-1e5 to 1e5 N m; negative: coast)
        with its speed (0.01 to 1e4 rad/s). ``sump_temperature_celsius``: -70 to 200, None: 40;
        ``inlet_temperature_rise_kelvin`` (eq 14): 0 to 300, None: 20. ``tolerance``: wanted
        relative error of inefficiencies, torque and transmission error, 1e-8 to 0.01, None: 1e-3.
        ``model``: "automatic" (the cheapest within the tolerance), "full" or "quasi-static".

        Columns are the fields of PointResult, with units in their names; a figure that is not there
        is NaN. ``attrs`` holds input_hash, model_version, platform, estimated_relative_error,
        warnings, input_warnings, the revisions used and the name of the simulation.
        """
        return _LOOP.run(
            self._client.point(
                lubricant,
                speed_kilometres_per_hour=speed_kilometres_per_hour,
                acceleration_metres_per_second_squared=acceleration_metres_per_second_squared,
                ascent_angle_degrees=ascent_angle_degrees,
                pinion_torque_newton_metres=pinion_torque_newton_metres,
                pinion_speed_radians_per_second=pinion_speed_radians_per_second,
                gear_set=gear_set,
                surface=surface,
                vehicle=vehicle,
                sump_temperature_celsius=sump_temperature_celsius,
                inlet_temperature_rise_kelvin=inlet_temperature_rise_kelvin,
                tolerance=tolerance,
                model=model,
                options=options,
            )
        )

    def sensitivities(
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
        """Returns the derivatives of the figures of an operating point by every scalar parameter of
        oil, surface, gear set and conditions, exact to rounding on the grid of the solution: a table
        of one row a parameter, for loops of optimisation and budgets of uncertainty.

        Arguments as of point(). Columns: ``parameter``, e.g. "lubricant.relaxation_time" or
        "vehicle_speed"; ``unit`` (SI, temperatures in K); ``value``; for each figure
        "derivative.FIGURE", the unit of the figure over that of the parameter, and
        "elasticity.FIGURE", relative change over relative change. ``attrs``, besides those of
        point(), holds ``figures``, the values of the figures by their names, e.g. "film_ratio.mean",
        and ``one_sided``: the response is at the edge of an event, so that the derivatives hold on
        one side. Costs 16 to 28 times the point. The table is empty at a fold.
        """
        return _LOOP.run(
            self._client.sensitivities(
                lubricant,
                speed_kilometres_per_hour=speed_kilometres_per_hour,
                acceleration_metres_per_second_squared=acceleration_metres_per_second_squared,
                ascent_angle_degrees=ascent_angle_degrees,
                pinion_torque_newton_metres=pinion_torque_newton_metres,
                pinion_speed_radians_per_second=pinion_speed_radians_per_second,
                gear_set=gear_set,
                surface=surface,
                vehicle=vehicle,
                sump_temperature_celsius=sump_temperature_celsius,
                inlet_temperature_rise_kelvin=inlet_temperature_rise_kelvin,
                tolerance=tolerance,
                options=options,
            )
        )

    def curve(
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
        """Returns the figures at each speed, in ascending order: a table of one row a speed.

        ``speeds_kilometres_per_hour``: up to 1000 speeds; None: 20 to 140 km/h by 5. Each point
        starts from the steady state of the one before, ``direction`` "up" or "down";
        ``independent_points``: each is solved alone, in about a third of the time. A speed without
        a result has NaN, and the reason in ``status``. Other arguments, columns and ``attrs`` as of
        point(); ``branch_ends`` holds the pairs of speeds between which a branch ends.
        """
        return _LOOP.run(
            self._client.curve(
                lubricant,
                speeds_kilometres_per_hour=speeds_kilometres_per_hour,
                direction=direction,
                independent_points=independent_points,
                ascent_angle_degrees=ascent_angle_degrees,
                gear_set=gear_set,
                surface=surface,
                vehicle=vehicle,
                sump_temperature_celsius=sump_temperature_celsius,
                inlet_temperature_rise_kelvin=inlet_temperature_rise_kelvin,
                tolerance=tolerance,
                model=model,
                options=options,
            )
        )

    def compare(
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
        """Returns the curves of several lubricants in one table, with a column ``lubricant``.

        Arguments as of curve(). The curves run together; one refused lubricant refuses all.
        ``attrs["results"]`` holds the attributes of each curve by the name of its lubricant.
        """
        return _LOOP.run(
            self._client.compare(
                lubricants,
                speeds_kilometres_per_hour=speeds_kilometres_per_hour,
                direction=direction,
                independent_points=independent_points,
                ascent_angle_degrees=ascent_angle_degrees,
                gear_set=gear_set,
                surface=surface,
                vehicle=vehicle,
                sump_temperature_celsius=sump_temperature_celsius,
                inlet_temperature_rise_kelvin=inlet_temperature_rise_kelvin,
                tolerance=tolerance,
                model=model,
                options=options,
            )
        )

    def histories(
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
        """Returns time histories of the steady state at one operating point: one row a sample.

        ``columns``: names such as "mesh_force_newtons"; schema() lists them as "history.columns".
        ``mesh_cycles`` times ``samples_per_mesh_cycle`` rows, at most 20 million values. Other
        arguments as of point(). ``attrs["units"]`` holds the symbols of the units.
        """
        return _LOOP.run(
            self._client.histories(
                lubricant,
                columns,
                mesh_cycles=mesh_cycles,
                samples_per_mesh_cycle=samples_per_mesh_cycle,
                speed_kilometres_per_hour=speed_kilometres_per_hour,
                acceleration_metres_per_second_squared=acceleration_metres_per_second_squared,
                ascent_angle_degrees=ascent_angle_degrees,
                pinion_torque_newton_metres=pinion_torque_newton_metres,
                pinion_speed_radians_per_second=pinion_speed_radians_per_second,
                gear_set=gear_set,
                surface=surface,
                vehicle=vehicle,
                sump_temperature_celsius=sump_temperature_celsius,
                inlet_temperature_rise_kelvin=inlet_temperature_rise_kelvin,
                tolerance=tolerance,
                model=model,
                options=options,
            )
        )

    def read_history(
        self,
        simulation: str,
        *,
        columns: Sequence[str] = (),
        start_row: int = 0,
        row_count: int = 0,
        max_points: int = 0,
    ) -> Frame:
        """Returns the history of a simulation, or a part of it; ``columns`` empty: all. With
        ``max_points`` (4 to 1,000,000) and more rows than that a min/max envelope: row 2k is the
        least and row 2k+1 the greatest value of ``attrs["rows_per_pair"]`` rows."""
        return _LOOP.run(
            self._client.read_history(
                simulation,
                columns=columns,
                start_row=start_row,
                row_count=row_count,
                max_points=max_points,
            )
        )

    def read_spectrum(
        self, simulation: str, *, columns: Sequence[str] = (), maximum_order: float = 0
    ) -> Frame:
        """Returns the spectra of the history of a simulation: amplitudes (zero to peak) and phase
        angles by order of the mesh frequency, up to ``maximum_order`` (0: 20); ``columns`` empty:
        all but time and mesh phase. A column is mean + sum of amplitude cos(2 pi order phase + phase
        angle), phase in mesh cycles. ``attrs`` holds units, means, root mean squares, and whether the
        response is periodic."""
        return _LOOP.run(
            self._client.read_spectrum(simulation, columns=columns, maximum_order=maximum_order)
        )

    def viscosity(
        self,
        lubricant: str,
        *,
        temperatures_celsius: Sequence[Quantity],
        pressures_pascals: Sequence[Quantity] = (0,),
        model_options: Mapping[str, Any] | None = None,
    ) -> Frame:
        """Returns the viscosity of a lubricant at each combination of temperatures (-100 to 400 C)
        and pressures above ambient (0 to 1e10 Pa), at most 100,000, with density, kinematic viscosity
        and alpha* at ambient pressure. A temperature at which a law does not hold has NaN, and the
        reason in ``status``."""
        return _LOOP.run(
            self._client.viscosity(
                lubricant,
                temperatures_celsius=temperatures_celsius,
                pressures_pascals=pressures_pascals,
                model_options=model_options,
            )
        )

    def cycle(
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
        """Returns what one to eight lubricants lose over a drive cycle: one row for each lubricant
        and part of the cycle (all, standstill, drive and its phases, coast, ranges of speed).

        ``cycle`` is "nedc", a CSV file or a table with the columns time_seconds,
        speed_kilometres_per_hour (0 to 400) and, optionally, ascent_angle_degrees and
        sump_temperature_celsius: 2 to 10,000 rows, at most 20,000 s. Points are quasi-steady, from an
        adaptive map: ``map_tolerance`` (1e-5 to 0.1; None: 2e-3) is the wanted relative error of the
        energy lost, or each piece of at most 1 s is solved, ``point_by_point``. ``attrs`` holds
        ``whole``, the energies with their errors, and ``pieces``, speed, torque and loss over time.
        A lubricant that the model refuses has NaN, and the reason in ``status``."""
        return _LOOP.run(
            self._client.cycle(
                lubricants,
                cycle=cycle,
                sump_temperature_celsius=sump_temperature_celsius,
                inlet_temperature_rise_kelvin=inlet_temperature_rise_kelvin,
                gear_set=gear_set,
                surface=surface,
                vehicle=vehicle,
                map_tolerance=map_tolerance,
                tolerance=tolerance,
                point_by_point=point_by_point,
                sheared=sheared,
                model_options=model_options,
            )
        )

    def roughness(
        self,
        profiles: Profile | str | Path | Sequence[Profile | str | Path],
        *,
        levelling: str | None = None,
        short_wave_cut_off_metres: Quantity | None = None,
        long_wave_cut_off_metres: Quantity | None = None,
        eq46_square_root_of_sum: bool = False,
        sampling_steps: Sequence[int] = (),
    ) -> Frame:
        """Returns the surface that measured profiles make, eqs 45 to 48, by the sampling interval: one
        row for each, with the standard uncertainties that the spread of repeats makes.

        ``profiles`` are Profile objects, or CSV files as texts, "pinion,axial,heel.csv"; repeats of a
        member and direction are averaged. ``levelling``: "least-squares-line" or "mean"; the cut-offs
        are those of a Gaussian filter (ISO 16610-21). ``sampling_steps``: every which height is taken;
        empty: 1, 2, 3, 4, 6, 8, 12 and so on while 50 heights are left. ``attrs`` holds the
        moments of each profile (``measurements``), of each member and direction (``groups``), and
        ``warnings``."""
        return _LOOP.run(
            self._client.roughness(
                profiles,
                levelling=levelling,
                short_wave_cut_off_metres=short_wave_cut_off_metres,
                long_wave_cut_off_metres=long_wave_cut_off_metres,
                eq46_square_root_of_sum=eq46_square_root_of_sum,
                sampling_steps=sampling_steps,
            )
        )

    def rig(
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
        """Returns traction, film, pressures and temperatures of a ball or barrelled ring on a disc at
        every combination of its settings, at most 5000: a map if two of them have many values.

        Either loads or mean pressures (of the dry contact by Hertz) are stated. ``radius_y_metres``
        0: a ball. ``surface`` None: smooth specimens. ``body_1`` (ball or ring) and ``body_2`` (disc)
        are the fields of RigBody; None: steel of 210 GPa. A refused row has NaN, and the reason in
        ``status``. ``draws`` (19 to 1999) of the stated uncertainties of lubricant and surface add
        ``{figure}_standard_uncertainty``, ``{figure}_interval_minimum`` and ``..._maximum`` (95 %)
        for each figure that they move, and ``refused_draws``; ``attrs["inputs_without_uncertainty"]``
        names what counts as exact."""
        return _LOOP.run(
            self._client.rig(
                lubricant,
                radius_x_metres=radius_x_metres,
                radius_y_metres=radius_y_metres,
                loads_newtons=loads_newtons,
                mean_pressures_pascals=mean_pressures_pascals,
                entrainment_speeds_metres_per_second=entrainment_speeds_metres_per_second,
                slide_roll_ratios_percent=slide_roll_ratios_percent,
                supply_temperatures_celsius=supply_temperatures_celsius,
                surface=surface,
                composite_rms_height_metres=composite_rms_height_metres,
                body_1=body_1,
                body_2=body_2,
                model_options=model_options,
                draws=draws,
            )
        )

    def points(self, table: Any, *, options: Options = Options(), **parameters: Any) -> Frame:
        """Returns the whole record of many operating points: rows in, rows out, in their order.

        ``table`` is a DataFrame, a mapping of columns, a sequence of rows, or the path of a CSV
        file. Its columns are the arguments of point(): lubricant, gear_set, surface, vehicle,
        sump_temperature_celsius, speed_kilometres_per_hour and so on; ``parameters`` hold for the
        rows that state none. Other columns ride along. The points are jobs, with the bits of
        point(), solved in parallel. A row that fails has NaN, the reason in ``status`` and a
        sentence in ``status_message``; the others have "OK". ``options.request_id`` is not used:
        equal inputs are computed once anyway.
        """
        return _LOOP.run(self._client.points(table, options=options, **parameters))

    def evaluate(
        self,
        table: Any,
        *,
        model_options: Mapping[str, Any] | None = None,
        contact_figures: bool = False,
        elasticities: Sequence[str] = (),
        elasticity_figures: Sequence[str] = (),
        **parameters: Any,
    ) -> Frame:
        """Returns the main figures of many variants at many conditions, without jobs: rows in, rows
        out, in their order. For screening, and for loops of optimisation.

        ``table`` is as of points(), with columns lubricant, gear_set, surface, vehicle, tolerance,
        speed_kilometres_per_hour, ascent_angle_degrees, sump_temperature_celsius and
        inlet_temperature_rise_kelvin. A column "lubricant.FIELD" or "surface.FIELD" states what a
        row has in place of the parameter of its lubricant or surface, with units as of create():
        "lubricant.relaxation_time_seconds", "surface.asperity_friction_coefficient". The server
        keeps nothing. A figure agrees with that of a point within the estimated errors of both.
        ``model_options`` as of Options; ``status`` as of points(). ``attrs`` holds model_version and
        the revisions used.

        ``contact_figures`` adds film_ratio_minimum and film_ratio_mean (lambda_s),
        contact_temperature_maximum_kelvin and contact_temperature_mean_kelvin,
        viscous_loss_power_watts, boundary_loss_power_watts, mean_friction_coefficient,
        maximum_pressure_maximum_pascals and flash_temperature_rise_maximum_kelvin, for two
        fifths of the time. ``elasticities`` names parameters, e.g.
        "lubricant.relaxation_time_seconds", and adds a column "elasticity.FIGURE.PARAMETER" for each
        of ``elasticity_figures`` (none: inefficiency_energy_mean_percent): the relative change of the
        figure over that of the parameter, exact to rounding; NaN at a fold. That takes some
        0.9 ms a point.
        """
        return _LOOP.run(
            self._client.evaluate(
                table,
                model_options=model_options,
                contact_figures=contact_figures,
                elasticities=elasticities,
                elasticity_figures=elasticity_figures,
                **parameters,
            )
        )

    def compare_points(
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
        """Returns one to eight lubricants at every speed and sump temperature with the uncertainty
        of their inputs, one row for each lubricant and condition, and what each loses more than the
        first: `difference_percent_value` with its 95 % interval, `lower_probability` and `verdict`
        ("lower", "higher", "cannot-be-told-apart").

        Columns FIGURE_standard_uncertainty come from ``draws`` draws of the inputs (None: 199),
        FIGURE_solver_error is the solver's. Uncertainties of temperatures are standard ones, in K.
        ``estimate_correlation`` (0 to 1; None: 0.5) is that of estimates that one estimator made for
        two lubricants. ``sheared``: the lubricants after the shear test. ``contact_figures``: also
        film ratio, friction coefficient, pressure and temperatures. ``attrs["mean"]`` is a table of
        the weighted means, with the probability of the least and the input to measure first. Weights as of screen(); nothing is kept.
        """
        return _LOOP.run(
            self._client.compare_points(
                lubricants,
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
                sheared=sheared,
                contact_figures=contact_figures,
            )
        )

    def explain(
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
        """Returns why ``other_lubricant`` loses more or less than ``lubricant``: the share of each
        of six groups of parameters in the difference, one row for each condition and group.

        ``inefficiency_percent_shapley_value_value`` is the share in percentage points, with its
        uncertainty in the columns beside it; the shares of all groups sum to the difference.
        ``..._first_effect`` and ``..._last_effect`` are what the group adds if it is exchanged before
        and after all others. ``attrs["mean"]`` is the same table for the weighted mean,
        ``attrs["interactions"]`` what pairs of groups add beyond what each adds alone.
        ``draws``: None: 99. ``other_surface``: of the other lubricant, with the boundary film that
        it makes. Other arguments as of compare_points().
        """
        return _LOOP.run(
            self._client.explain(
                lubricant,
                other_lubricant,
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
                other_surface=other_surface,
                sheared=sheared,
                other_sheared=other_sheared,
            )
        )

    def screen(
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
    ) -> Campaign:
        """Screens candidates, one a row, at every speed and sump temperature (None: 60 km/h and
        40 C), and returns the campaign at once. The server computes and keeps it: up to 100,000 candidates and 20 million
        points.

        ``table`` is as of points(). A column "lubricant.FIELD" or "surface.FIELD" states what
        candidates have in place of the parameter of ``lubricant`` or ``surface``, as of evaluate();
        an empty cell leaves that. Other columns ride along, "name" among them; characters of their
        names beyond letters, digits, "-", "_" and "." become "_". Weights, one for each speed and
        sump temperature and above 0, are those of ranking(); None: equal. ``contact_figures`` and
        ``elasticities`` as of evaluate().

        ``table`` may also be a Design, which the server makes, or Lubricants, each of which is a
        candidate; of these the first one is the base if ``lubricant`` is None. Candidates that are
        lubricants have the columns "name" and their parameters. ``labels``: campaigns() filters by
        them.

        ``rig``, a tribodyn.Rig, runs the candidates on a rig in place of the axle: the columns are
        those of rig(), ``surface`` None means smooth specimens, and gear set, vehicle, tolerance,
        speeds and sump temperatures are left out.

        The same call again finds its campaign by a request id that is a hash of all that decides its
        figures, goes on if it is paused, and computes nothing twice; ``request_id`` states another
        one. A budget pauses the campaign when it is spent. Raises if a parameter or condition is
        outside its range, with all of them.
        """
        return Campaign(
            _LOOP.run(
                self._client.screen(
                    table,
                    lubricant,
                    rig=rig,
                    speeds_kilometres_per_hour=speeds_kilometres_per_hour,
                    sump_temperatures_celsius=sump_temperatures_celsius,
                    speed_weights=speed_weights,
                    sump_weights=sump_weights,
                    ascent_angle_degrees=ascent_angle_degrees,
                    inlet_temperature_rise_kelvin=inlet_temperature_rise_kelvin,
                    gear_set=gear_set,
                    surface=surface,
                    vehicle=vehicle,
                    tolerance=tolerance,
                    model_options=model_options,
                    contact_figures=contact_figures,
                    elasticities=elasticities,
                    elasticity_figures=elasticity_figures,
                    budget_points=budget_points,
                    budget_processor_seconds=budget_processor_seconds,
                    display_name=display_name,
                    labels=labels,
                    request_id=request_id,
                )
            )
        )

    def campaign(self, name: str) -> Campaign:
        """Returns a campaign, e.g. "12" or "campaigns/12"."""
        return Campaign(_LOOP.run(self._client.campaign(name)))

    def campaigns(self, limit: int | None = None, *, filter: str = "") -> List[Campaign]:
        """Returns campaigns, newest first; at most ``limit``. ``filter``: e.g. "labels.project = axle
        AND state = RUNNING"; fields are labels.KEY, display_name, state, lubricant, gear_set,
        surface and vehicle."""
        return [
            Campaign(each) for each in _LOOP.run(self._client.campaigns(limit, filter=filter))
        ]
