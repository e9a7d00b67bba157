"""Candidates of a campaign that the server makes or finds, and the rig that they run on."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Mapping, Sequence

from tribodyn._arguments import Arguments, full_name
from tribodyn._parameters import parameter_path, read_parameters
from tribodyn.units import Quantity
from tribodyn.v1 import campaigns_pb2 as pb
from tribodyn.v1.rigs_pb2 import RigBody

_METHODS = {
    "grid": pb.CandidateDesign.GRID,
    "latin-hypercube": pb.CandidateDesign.LATIN_HYPERCUBE,
    "sobol": pb.CandidateDesign.SOBOL,
}


@dataclass(frozen=True)
class Design:
    """A design of experiments that the server makes: candidates that fill ranges of parameters, or
    that spread as the standard uncertainties of the lubricant say. Equal designs over equal bases
    have equal candidates, to the last bit."""

    method: str = "sobol"  #: "sobol", "latin-hypercube" or "grid"
    count: int = 0  #: candidates, 1 to 100,000; a grid has none: its levels decide
    seed: int = 0  #: begin of the random numbers; a grid has none
    #: parameters ("lubricant.FIELD" or "surface.FIELD") and their (lowest, highest) values, in equal
    #: differences
    ranges: Mapping[str, tuple[Quantity, Quantity]] = field(default_factory=dict)
    #: the same in equal ratios
    logarithmic_ranges: Mapping[str, tuple[Quantity, Quantity]] = field(default_factory=dict)
    #: parameters that spread by their standard uncertainty. Without these and without ranges: all
    #: parameters for which the lubricant or the surface states one
    uncertain: Sequence[str] = ()
    #: of a grid: the number of levels of each range, or by parameter
    levels: int | Mapping[str, int] = 0

    def set(self, arguments: Arguments, campaign: pb.Campaign) -> None:
        """Writes the design to a request."""
        design = campaign.candidate_design
        if self.method not in _METHODS:
            arguments.wrong("method", f"{self.method} is none of {', '.join(_METHODS)}")
        design.method = _METHODS.get(self.method, pb.CandidateDesign.SOBOL)
        design.count, design.seed = self.count, self.seed
        scales = (
            (self.ranges, pb.DesignFactor.LINEAR),
            (self.logarithmic_ranges, pb.DesignFactor.LOGARITHMIC),
        )
        for ranges, scale in scales:
            for name, limits in ranges.items():
                self._add_range(arguments, design, name, limits, scale)
        for name in self.uncertain:
            design.factors.add(parameter=parameter_path(arguments, "uncertain", name))

    def _add_range(
        self,
        arguments: Arguments,
        design: pb.CandidateDesign,
        name: str,
        limits: tuple[Quantity, Quantity],
        scale: Any,
    ) -> None:
        if not isinstance(limits, (tuple, list)) or len(limits) != 2:
            arguments.wrong("ranges", f"{name}: {limits!r} is not (lowest, highest)")
            return
        ends = [read_parameters(arguments, {name: limit}) for limit in limits]
        if not all(ends):
            return
        levels = self.levels if isinstance(self.levels, int) else self.levels.get(name, 0)
        (path,) = ends[0]
        design.factors.add(
            parameter=path,
            minimum=ends[0][path],
            maximum=ends[1][path],
            scale=scale,
            levels=levels,
        )


@dataclass(frozen=True)
class Lubricants:
    """Lubricants that are candidates: by their names, or all that satisfy a filter when the campaign
    is created. All have one law of viscosity under pressure."""

    names: Sequence[str] = ()  #: e.g. "my-oil" or "my-oil@2"
    filter: str = ""  #: as of client.lubricants.list(), e.g. "labels.series = b"

    def set(self, _: Arguments, campaign: pb.Campaign) -> None:
        """Writes the lubricants to a request."""
        campaign.candidate_lubricants.extend(full_name("lubricants", name) for name in self.names)
        campaign.lubricant_filter = self.filter


@dataclass(frozen=True)
class Rig:
    """A ball or barrelled ring on a disc, at every combination of its settings, on which candidates
    run in place of the axle. As of client.rig()."""

    radius_x_metres: Quantity  #: effective radius along the motion, e.g. "12.7mm"
    #: mean speeds of both surfaces
    entrainment_speeds_metres_per_second: Quantity | Sequence[Quantity]
    loads_newtons: Quantity | Sequence[Quantity] | None = None  #: either these or mean pressures
    mean_pressures_pascals: Quantity | Sequence[Quantity] | None = None  #: of the dry contact
    slide_roll_ratios_percent: Quantity | Sequence[Quantity] = 0
    supply_temperatures_celsius: Quantity | Sequence[Quantity] = 40
    radius_y_metres: Quantity = 0  #: across the motion; 0: a ball
    composite_rms_height_metres: Quantity = 0  #: 0: that of the surface
    body_1: Mapping[str, float] | None = None  #: ball or ring: fields of RigBody; None: steel
    body_2: Mapping[str, float] | None = None  #: disc, likewise

    def set(self, arguments: Arguments, campaign: pb.Campaign) -> None:
        """Writes the rig to a request."""
        rig = campaign.rig
        for name in ("radius_x_metres", "radius_y_metres", "composite_rms_height_metres"):
            setattr(rig, name, arguments.number(name, getattr(self, name)))
        for name in ("body_1", "body_2"):
            body = getattr(self, name)
            if body is not None:
                getattr(rig, name).CopyFrom(RigBody(**body))
        for each in rig.grid.DESCRIPTOR.fields:
            values = getattr(self, each.name)
            if values is not None:
                getattr(rig.grid, each.name).extend(arguments.numbers(each.name, values))
