"""Arguments of studies as requests. All wrong arguments are reported together."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Mapping, Sequence

from tribodyn._transport import new_request_id
from tribodyn.errors import Violation, invalid_fields
from tribodyn.units import Quantity, QuantityError, quantity
from tribodyn.v1 import results_pb2
from tribodyn.v1 import simulations_pb2 as pb

# Speeds of the paper's curves [km/h].
DEFAULT_SPEEDS = tuple(range(20, 145, 5))


@dataclass(frozen=True)
class Options:
    """What few studies state: how they are solved, and the job."""

    #: what the model includes: fields of ModelOptions, e.g. {"isothermal": True}, and of
    #: AsPublished below "as_published"
    model_options: Mapping[str, Any] = field(default_factory=dict)
    #: where the search for a steady state starts: "quasi-static-equilibrium" or "large-vibration"
    start: str | None = None
    #: how the steady state is found: "automatic", "shooting" or "march"
    method: str | None = None
    march_step_tolerance: float | None = None  #: of each step of a march, 1e-11 to 1e-3; None: 1e-7
    march_settling_tolerance: float | None = (
        None  #: of a marched response, 1e-12 to 0.1; None: 1e-6
    )
    maximum_mesh_cycles: int | None = None  #: longest march, 1 to 100,000; None: 4000
    recorded_mesh_cycles: int | None = None  #: record without a period, 1 to 1000; None: 50
    display_name: str = ""  #: title of the job
    labels: Mapping[str, str] = field(default_factory=dict)  #: labels of the job
    force: bool = False  #: computes although equal inputs have a result
    #: "interactive": before all other jobs of this client; "bulk": after small ones; None: by cost
    scheduling_class: str | None = None
    deadline_seconds: float | None = None  #: a job that has not ended by then fails
    #: of the job, or with "/0", "/1", ... of each of several. A program that was interrupted and
    #: runs again with the same one finds its jobs. None: random. At most 90 characters.
    request_id: str | None = None


class Arguments:
    """Reads arguments and collects what is wrong with them."""

    def __init__(self) -> None:
        self.violations: list[Violation] = []

    def number(self, name: str, value: Quantity) -> float:
        try:
            return quantity(value, name)
        except QuantityError as error:
            self.violations.append(Violation(name, f"{value!r} {error}", repr(value)))
            return float("nan")

    def word(self, name: str, value: str, kind: Any, prefix: str) -> Any:
        """Returns the number of an enum's value for a word such as "quasi-static"."""
        words = {
            each.name.removeprefix(prefix).lower().replace("_", "-"): each.number
            for each in kind.DESCRIPTOR.values
            if each.number
        }
        plain = str(value).lower().replace("_", "-").replace(" ", "-")
        if plain not in words:
            allowed = ", ".join(words)
            self.violations.append(
                Violation(name, f"{name} = {value}; allowed: {allowed}", str(value), allowed)
            )
        return words.get(plain, 0)

    def wrong(self, name: str, description: str) -> None:
        self.violations.append(Violation(name, description))

    def check(self) -> None:
        """Raises TribodynError if an argument is wrong."""
        if self.violations:
            raise invalid_fields(self.violations)


def full_name(collection: str, name: str) -> str:
    """Returns "lubricants/my-oil" for "my-oil"; other names as they are."""
    return name if "/" in name or not name else f"{collection}/{name}"


def scene(
    arguments: Arguments,
    lubricant: str,
    options: Options,
    *,
    gear_set: str | None,
    surface: str | None,
    vehicle: str | None,
    sump_temperature_celsius: Quantity | None,
    inlet_temperature_rise_kelvin: Quantity | None,
    tolerance: float | None,
) -> pb.Simulation:
    """Returns a simulation without a study."""
    out = pb.Simulation(
        lubricant=full_name("lubricants", str(lubricant)),
        gear_set=full_name("gearSets", gear_set or ""),
        surface=full_name("surfaces", surface or ""),
        vehicle=full_name("vehicles", vehicle or ""),
        display_name=options.display_name,
    )
    if sump_temperature_celsius is not None:
        out.sump_temperature_celsius = arguments.number(
            "sump_temperature_celsius", sump_temperature_celsius
        )
    if inlet_temperature_rise_kelvin is not None:
        out.inlet_temperature_rise_kelvin = arguments.number(
            "inlet_temperature_rise_kelvin", inlet_temperature_rise_kelvin
        )
    for key, value in options.labels.items():
        out.labels.add(key=key, value=value)
    if options.deadline_seconds is not None:
        out.deadline_seconds = options.deadline_seconds
    solver = out.solver_options
    for name in (
        "march_step_tolerance",
        "march_settling_tolerance",
        "maximum_mesh_cycles",
        "recorded_mesh_cycles",
    ):
        if getattr(options, name) is not None:
            setattr(solver, name, getattr(options, name))
    if tolerance is not None:
        solver.tolerance = tolerance
    if options.method is not None:
        solver.method = arguments.word(
            "method", options.method, results_pb2.SteadyStateMethod, "STEADY_STATE_METHOD_"
        )
    set_switches(arguments, "model_options", options.model_options, out.model_options)
    return out


def point(
    arguments: Arguments,
    simulation: pb.Simulation,
    options: Options,
    *,
    speed_kilometres_per_hour: Quantity | None = None,
    acceleration_metres_per_second_squared: Quantity | None = None,
    ascent_angle_degrees: Quantity | None = None,
    pinion_torque_newton_metres: Quantity | None = None,
    pinion_speed_radians_per_second: Quantity | None = None,
    model: str | None = None,
) -> pb.OperatingPointStudy:
    """Sets and returns the study of an operating point."""
    study = simulation.operating_point
    study.SetInParent()
    if pinion_torque_newton_metres is not None or pinion_speed_radians_per_second is not None:
        if speed_kilometres_per_hour is not None:
            arguments.wrong(
                "speed_kilometres_per_hour", "state either a speed, or a torque with a pinion speed"
            )
        if pinion_torque_newton_metres is None or pinion_speed_radians_per_second is None:
            arguments.wrong(
                "pinion_torque_newton_metres",
                "pinion_torque_newton_metres and pinion_speed_radians_per_second count "
                "only together",
            )
            return study
        load = study.prescribed_torque
        load.pinion_torque_newton_metres = arguments.number(
            "pinion_torque_newton_metres", pinion_torque_newton_metres
        )
        load.pinion_speed_radians_per_second = arguments.number(
            "pinion_speed_radians_per_second", pinion_speed_radians_per_second
        )
    elif speed_kilometres_per_hour is None:
        arguments.wrong(
            "speed_kilometres_per_hour",
            "speed_kilometres_per_hour is missing; or state "
            "pinion_torque_newton_metres and pinion_speed_radians_per_second",
        )
    else:
        moving: Any = study.cruise
        if acceleration_metres_per_second_squared is not None:
            moving = study.drive_cycle_snapshot
            moving.acceleration_metres_per_second_squared = arguments.number(
                "acceleration_metres_per_second_squared", acceleration_metres_per_second_squared
            )
        moving.speed_kilometres_per_hour = arguments.number(
            "speed_kilometres_per_hour", speed_kilometres_per_hour
        )
        if ascent_angle_degrees is not None:
            moving.ascent_angle_degrees = arguments.number(
                "ascent_angle_degrees", ascent_angle_degrees
            )
    _set_model(arguments, study, model, options)
    return study


def curve(
    arguments: Arguments,
    simulation: pb.Simulation,
    options: Options,
    *,
    speeds_kilometres_per_hour: Sequence[Quantity] | None = None,
    direction: str | None = None,
    independent_points: bool = False,
    ascent_angle_degrees: Quantity | None = None,
    model: str | None = None,
) -> pb.InefficiencyCurveStudy:
    """Sets and returns the study of a curve over speed."""
    study = simulation.inefficiency_curve
    speeds: Any = (
        DEFAULT_SPEEDS if speeds_kilometres_per_hour is None else speeds_kilometres_per_hour
    )
    if isinstance(speeds, (str, int, float)) or not hasattr(speeds, "__iter__"):
        speeds = [speeds]
    study.speeds_kilometres_per_hour[:] = [
        arguments.number("speeds_kilometres_per_hour", each) for each in speeds
    ]
    if direction is not None:
        study.direction = arguments.word(
            "direction", direction, results_pb2.SweepDirection, "SWEEP_DIRECTION_"
        )
    study.independent_points = independent_points
    if ascent_angle_degrees is not None:
        study.ascent_angle_degrees = arguments.number("ascent_angle_degrees", ascent_angle_degrees)
    _set_model(arguments, study, model, options)
    return study


def request(
    arguments: Arguments, simulation: pb.Simulation, options: Options, index: int | None = None
) -> pb.CreateSimulationRequest:
    """Returns the request to create a simulation; ``index`` counts those of one call."""
    out = pb.CreateSimulationRequest(simulation=simulation, force=options.force)
    out.request_id = options.request_id or new_request_id()
    if options.request_id and index is not None:
        out.request_id += f"/{index}"
    if options.scheduling_class is not None:
        out.scheduling_class = arguments.word(
            "scheduling_class", options.scheduling_class, pb.SchedulingClass, "SCHEDULING_CLASS_"
        )
    return out


def _set_model(arguments: Arguments, study: Any, model: str | None, options: Options) -> None:
    if model is not None:
        study.model = arguments.word("model", model, results_pb2.PointModel, "POINT_MODEL_")
    if options.start is not None:
        study.start = arguments.word("start", options.start, results_pb2.PointStart, "POINT_START_")


def set_switches(arguments: Arguments, path: str, switches: Mapping[str, Any], out: Any) -> None:
    fields = out.DESCRIPTOR.fields_by_name
    for name, value in switches.items():
        described = fields.get(name)
        if described is None:
            arguments.wrong(f"{path}.{name}", f"{name} is unknown; allowed: {', '.join(fields)}")
        elif described.message_type is not None:
            set_switches(arguments, f"{path}.{name}", value, getattr(out, name))
        elif described.enum_type is not None:
            kind = getattr(type(out), described.enum_type.name)
            setattr(out, name, arguments.word(f"{path}.{name}", value, kind, name.upper() + "_"))
        else:
            setattr(out, name, bool(value))
