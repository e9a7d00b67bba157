"""The figures of points and rigs, as their answers and campaigns name them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Sequence

from tribodyn._arguments import Arguments
from tribodyn._parameters import parameter_path
from tribodyn.v1.points_pb2 import EvaluatePointsResponse
from tribodyn.v1.rigs_pb2 import EvaluateRigResponse, RigCondition

_ONE_SIDED = "elasticities_one_sided"
# Figures of this number and above are in an answer only if the request sets contact_figures.
_FIRST_CONTACT_FIGURE = EvaluatePointsResponse.FILM_RATIO_MINIMUM_FIELD_NUMBER


def _columns(kind: Any) -> dict[str, int]:
    """Returns the names and numbers of the fields of an answer that hold one number a row."""
    return {
        field.name: field.number
        for field in kind.DESCRIPTOR.fields
        if field.label == field.LABEL_REPEATED
        and field.message_type is None
        and field.name not in ("refusal_numbers", _ONE_SIDED)
    }


_OF_POINTS = _columns(EvaluatePointsResponse)
_USUAL_FIGURES = [name for name, number in _OF_POINTS.items() if number < _FIRST_CONTACT_FIGURE]
_CONTACT_FIGURES = [name for name, number in _OF_POINTS.items() if number >= _FIRST_CONTACT_FIGURE]
_OF_CONDITIONS = (
    "sump_temperature_celsius",
    "inlet_temperature_rise_kelvin",
    "speed_kilometres_per_hour",
    "wheel_torque_newton_metres",
)
USUAL_FIGURE = "inefficiency_energy_mean_percent"  # by which candidates are ranked

# Columns of a campaign of a rig: its conditions, which the server computes, and its figures.
RIG_FIGURES = [
    *(field.name for field in RigCondition.DESCRIPTOR.fields),
    *(
        field.name
        for field in EvaluateRigResponse.DESCRIPTOR.fields
        if field.label == field.LABEL_REPEATED
        and field.cpp_type == field.CPPTYPE_DOUBLE
        and field.name not in RigCondition.DESCRIPTOR.fields_by_name
    ),
]
USUAL_RIG_FIGURE = "traction_coefficient"

# Columns of warnings that every campaign has; the first one is a figure of points too.
_WARNING_COLUMNS = ("verdict_withheld", "warning_bits")


def _path(arguments: Arguments, name: str) -> str:
    """Returns the path of a parameter. The server knows those that candidates have in common."""
    if name in _OF_CONDITIONS or name.startswith("gear_set."):
        return name
    return parameter_path(arguments, "elasticities", name)


@dataclass(frozen=True)
class FigureChoice:
    """The figures of points that a request or campaign has beside the usual ones."""

    contact_figures: bool = False
    elasticity_parameters: tuple[str, ...] = ()
    elasticity_figures: tuple[str, ...] = ()

    @staticmethod
    def read(
        arguments: Arguments,
        contact_figures: bool,
        elasticities: Sequence[str],
        elasticity_figures: Sequence[str],
    ) -> FigureChoice:
        """Returns what the arguments of a method state."""
        parameters = [elasticities] if isinstance(elasticities, str) else elasticities
        figures = [elasticity_figures] if isinstance(elasticity_figures, str) else elasticity_figures
        paths = (_path(arguments, name) for name in parameters)
        return FigureChoice(contact_figures, tuple(dict.fromkeys(paths)), tuple(figures))

    @staticmethod
    def of(message: Any) -> FigureChoice:
        """Returns that of a request or campaign."""
        return FigureChoice(
            message.contact_figures,
            tuple(message.elasticity_parameters),
            tuple(message.elasticity_figures),
        )

    def set(self, message: Any) -> None:
        """Writes it to a request or campaign."""
        message.contact_figures = self.contact_figures
        message.elasticity_parameters.extend(self.elasticity_parameters)
        message.elasticity_figures.extend(self.elasticity_figures)

    def columns(self) -> list[str]:
        """Returns the names of all columns of figures."""
        out = [*_USUAL_FIGURES, *(_CONTACT_FIGURES if self.contact_figures else [])]
        if self.elasticity_parameters:
            out.append(_ONE_SIDED)
        for figure in self.elasticity_figures or (USUAL_FIGURE,):
            out += [f"elasticity.{figure}.{each}" for each in self.elasticity_parameters]
        return out


def campaign_figures(campaign: Any) -> list[str]:
    """Returns the names of the columns that the server computes for a campaign."""
    figures = RIG_FIGURES if campaign.HasField("rig") else FigureChoice.of(campaign).columns()
    return list(dict.fromkeys([*figures, *_WARNING_COLUMNS]))
