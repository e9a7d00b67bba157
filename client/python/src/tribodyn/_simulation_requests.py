"""Requests for studies that are jobs of the server."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Mapping, Sequence

from tribodyn._arguments import Arguments, full_name, set_switches
from tribodyn._transport import new_request_id
from tribodyn.units import Quantity
from tribodyn.v1 import results_pb2
from tribodyn.v1 import simulations_pb2 as pb

# Speeds of the paper's curves [km/h].
DEFAULT_SPEEDS = tuple(range(20, 145, 5))


@dataclass(frozen=True)
class Options:
    """What few studies state: how they are solved, and the job."""

    #: what the model includes: fields of ModelOptions, e.g. {"isothermal": True}, and of
    #: AsPublished below "as_published". "preset": "recommended" (the default) or "paper", to compare
    #: with the publication; it decides inlet_shear_heating and closed_load_sharing
    model_options: Mapping[str, Any] = field(default_factory=dict)
    #: where the search for a steady state starts: "quasi-static-equilibrium" or "large-vibration"
    start: str | None = None
    #: how the steady state is found: "automatic", "shooting" or "march"
    method: str | None = None
    march_step_tolerance: float | None = None  #: of each step of a march, 1e-11 to 1e-3; None: 1e-7
    march_settling_tolerance: float | None = (
        None  #: of a marched response, 1e-12 to 0.1; None: 1e-6
    )
    maximum_mesh_cycles: int | None = None  #: of a whole march, 1 to 100,000; None: 4000
    recorded_mesh_cycles: int | None = None  #: least record without a period, 1 to 1000; None: 50
    display_name: str = ""  #: title of the job
    labels: Mapping[str, str] = field(default_factory=dict)  #: labels of the job
    force: bool = False  #: computes although equal inputs have a result
    #: "interactive": before all other jobs of this client; "bulk": after small ones; None: by cost
    scheduling_class: str | None = None
    deadline_seconds: float | None = None  #: a job that has not ended by then fails
    #: of the job, or with "/0", "/1", ... of each of several. A program that was interrupted and
    #: runs again with the same one finds its jobs. None: random. At most 90 characters.
    request_id: str | None = None


def operating_point(
    arguments: Arguments,
    lubricant: str,
    options: Options,
    *,
    speed_kilometres_per_hour: Quantity | None,
    acceleration_metres_per_second_squared: Quantity | None,
    ascent_angle_degrees: Quantity | None,
    pinion_torque_newton_metres: Quantity | None,
    pinion_speed_radians_per_second: Quantity | None,
    model: str | None = None,
    **scene: Any,
) -> pb.Simulation:
    """Returns the simulation of an operating point; ``scene`` as of _scene()."""
    out = _scene(arguments, lubricant, options, **scene)
    study = out.operating_point
    study.SetInParent()
    torque, pinion_speed = pinion_torque_newton_metres, pinion_speed_radians_per_second
    if torque is not None or pinion_speed is not None:
        if speed_kilometres_per_hour is not None:
            arguments.wrong(
                "speed_kilometres_per_hour", "state either a speed, or a torque with a pinion speed"
            )
        if torque is None or pinion_speed is None:
            arguments.wrong(
                "pinion_torque_newton_metres",
                "pinion_torque_newton_metres and pinion_speed_radians_per_second count "
                "only together",
            )
        else:
            arguments.set_numbers(
                study.prescribed_torque,
                {
                    "pinion_torque_newton_metres": torque,
                    "pinion_speed_radians_per_second": pinion_speed,
                },
            )
    elif speed_kilometres_per_hour is None:
        arguments.wrong(
            "speed_kilometres_per_hour",
            "speed_kilometres_per_hour is missing; or state "
            "pinion_torque_newton_metres and pinion_speed_radians_per_second",
        )
    else:
        accelerates = acceleration_metres_per_second_squared is not None
        arguments.set_numbers(
            study.drive_cycle_snapshot if accelerates else study.cruise,
            {
                "acceleration_metres_per_second_squared": acceleration_metres_per_second_squared,
                "speed_kilometres_per_hour": speed_kilometres_per_hour,
                "ascent_angle_degrees": ascent_angle_degrees,
            },
        )
    _set_model(arguments, study, model, options)
    return out


def curve(
    arguments: Arguments,
    lubricant: str,
    options: Options,
    *,
    speeds_kilometres_per_hour: Sequence[Quantity] | None,
    direction: str | None,
    independent_points: bool,
    ascent_angle_degrees: Quantity | None,
    model: str | None,
    **scene: Any,
) -> pb.Simulation:
    """Returns the simulation of a curve over speed; ``scene`` as of _scene()."""
    out = _scene(arguments, lubricant, options, **scene)
    study = out.inefficiency_curve
    speeds: Any = (
        DEFAULT_SPEEDS if speeds_kilometres_per_hour is None else speeds_kilometres_per_hour
    )
    if isinstance(speeds, (str, int, float)) or not hasattr(speeds, "__iter__"):
        speeds = [speeds]
    study.speeds_kilometres_per_hour[:] = arguments.numbers("speeds_kilometres_per_hour", speeds)
    if direction is not None:
        study.direction = arguments.word(
            "direction", direction, results_pb2.SweepDirection, "SWEEP_DIRECTION_"
        )
    study.independent_points = independent_points
    arguments.set_numbers(study, {"ascent_angle_degrees": ascent_angle_degrees})
    _set_model(arguments, study, model, options)
    return out


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


def _scene(
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
        deadline_seconds=options.deadline_seconds,
    )
    arguments.set_numbers(
        out,
        {
            "sump_temperature_celsius": sump_temperature_celsius,
            "inlet_temperature_rise_kelvin": inlet_temperature_rise_kelvin,
        },
    )
    for key, value in options.labels.items():
        out.labels.add(key=key, value=value)
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


def _set_model(arguments: Arguments, study: Any, model: str | None, options: Options) -> None:
    if model is not None:
        study.model = arguments.word("model", model, results_pb2.PointModel, "POINT_MODEL_")
    if options.start is not None:
        study.start = arguments.word("start", options.start, results_pb2.PointStart, "POINT_START_")
