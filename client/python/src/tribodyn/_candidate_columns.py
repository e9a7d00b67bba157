"""What candidates of a campaign were created with, as columns."""

from __future__ import annotations

import re
from typing import Any, Container, Mapping, Sequence

import numpy as np

from tribodyn._evaluate import CONDITION
from tribodyn._parameters import is_parameter
from tribodyn._transport import Transport
from tribodyn.errors import Violation, invalid_fields
from tribodyn.v1 import campaigns_pb2 as pb
from tribodyn.v1 import lubricants_pb2, surfaces_pb2

_DEFAULTS = {"sump_temperature_celsius": 40.0, "inlet_temperature_rise_kelvin": 20.0}
_GETTERS = {
    "lubricant": ("LubricantService", "GetLubricant", lubricants_pb2.GetLubricantRequest),
    "surface": ("SurfaceService", "GetSurface", surfaces_pb2.GetSurfaceRequest),
}


class CandidateColumns:
    """Columns that a campaign was created with, but for the conditions of a rig."""

    def __init__(self, campaign: pb.Campaign) -> None:
        self._conditions = campaign.conditions
        self._condition_count = campaign.points // campaign.candidates
        self._of_candidates: dict[str, np.ndarray] = {}
        for each in campaign.candidate_attributes:
            values = np.array(each.texts, dtype=object) if each.texts else np.array(each.values)
            self._of_candidates[each.name] = values
        for column in campaign.candidate_columns:
            self._of_candidates[column.path] = np.array(column.values)

    def of_candidates(self) -> list[str]:
        return list(self._of_candidates)

    def names(self) -> list[str]:
        return [*self._of_candidates, *(CONDITION if self._conditions else [])]

    def of_candidate(self, name: str, candidate: int) -> Any:
        """Returns what a candidate has in one of its columns."""
        return self._of_candidates[name][candidate]

    def column(self, name: str, rows: np.ndarray) -> np.ndarray:
        """Returns the values of a column in some rows."""
        candidates, conditions = np.divmod(rows, self._condition_count)
        if name == "candidate":
            return candidates
        if name == "condition":
            return conditions
        if name in self._of_candidates:
            return self._of_candidates[name][candidates]
        default = _DEFAULTS.get(name)
        values = [
            default if default is not None and not each.HasField(name) else getattr(each, name)
            for each in self._conditions
        ]
        return np.array(values)[conditions]


async def add_candidates(
    transport: Transport,
    campaign: pb.Campaign,
    candidates: Sequence[Mapping[str, float]],
    paths: Sequence[str] = (),
) -> None:
    """Adds a column for each parameter, `paths` among them; a candidate that states none has that of
    the base."""
    for path in dict.fromkeys([*paths, *(path for each in candidates for path in each)]):
        values = [each.get(path) for each in candidates]
        if None in values:
            owner, _, field = path.partition(".")
            name = getattr(campaign, owner)
            if not name:
                raise invalid_fields(
                    [Violation(path, f"is missing in some rows, and no {owner} is stated")]
                )
            service, method, kind = _GETTERS[owner]
            resource = await transport.call(service, method, kind(name=name))
            usual = getattr(resource, field)
            if (
                resource.DESCRIPTOR.fields_by_name[field].has_presence
                and not resource.HasField(field)
            ):
                raise invalid_fields(
                    [Violation(path, f"is missing in some rows, and {name} has none")]
                )
            values = [usual if each is None else each for each in values]
        campaign.candidate_columns.add(path=path, values=values)


def add_attributes(
    campaign: pb.Campaign, rows: Sequence[Mapping[str, Any]], texts: Container[str] = ()
) -> None:
    """Adds the columns of the table that are no parameters; those in `texts` hold texts."""
    columns = dict.fromkeys(name for row in rows for name in row)
    for name in columns:
        if is_parameter(name):
            continue
        attribute = campaign.candidate_attributes.add(name=re.sub(r"[^A-Za-z0-9._-]", "_", name))
        values = [row.get(name) for row in rows]
        is_number = all(isinstance(each, (int, float)) and np.isfinite(each) for each in values)
        if is_number and attribute.name not in texts:
            attribute.values.extend(float(each) for each in values if each is not None)
        else:
            attribute.texts.extend("" if each is None else str(each) for each in values)
