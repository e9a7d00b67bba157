"""Measured profiles of flanks: the surface that they make, by the sampling interval."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Sequence

import numpy as np

from tribodyn._frames import Frame, enum_word, frame, in_columns
from tribodyn._studies import Arguments
from tribodyn._transport import Transport
from tribodyn.units import Quantity
from tribodyn.v1 import profiles_pb2 as pb
from tribodyn.v1 import surfaces_pb2

_MEMBERS = ("pinion", "gear")
_DIRECTIONS = ("axial", "radial")


@dataclass(frozen=True)
class Profile:
    """A measured profile of a flank."""

    heights_metres: Sequence[float] | np.ndarray  #: at equal spacing
    spacing_metres: float  #: distance between two heights
    member: str | None = None  #: "pinion", "gear"; None: both flanks are like it
    direction: str | None = None  #: "axial", "radial"; None: the surface is isotropic

    def csv(self) -> bytes:
        heights = np.asarray(self.heights_metres, dtype=float)
        lines = [
            f"{i * self.spacing_metres!r},{float(height)!r}\n" for i, height in enumerate(heights)
        ]
        return ("position_metres,height_metres\n" + "".join(lines)).encode()


def _add_profile(
    arguments: Arguments, name: str, profile: Profile | str | Path, out: Any
) -> None:
    if isinstance(profile, Profile):
        member, direction = profile.member, profile.direction
        out.csv = profile.csv()
    else:
        words = str(profile).split(",")
        known = [each for each in words[:-1] if each in _MEMBERS + _DIRECTIONS]
        member = next((each for each in known if each in _MEMBERS), None)
        direction = next((each for each in known if each in _DIRECTIONS), None)
        out.csv = Path(",".join(words[len(known) :])).read_bytes()
    if member is not None:
        out.member = arguments.word(
            f"{name}.member", member, surfaces_pb2.FlankMember, "FLANK_MEMBER_"
        )
    if direction is not None:
        out.direction = arguments.word(
            f"{name}.direction", direction, surfaces_pb2.ProfileDirection, "PROFILE_DIRECTION_"
        )


async def evaluated(
    transport: Transport,
    profiles: Profile | str | Path | Sequence[Profile | str | Path],
    *,
    levelling: str | None,
    short_wave_cut_off_metres: Quantity | None,
    long_wave_cut_off_metres: Quantity | None,
    eq46_square_root_of_sum: bool,
    sampling_steps: Sequence[int],
) -> Frame:
    """Returns one row for each sampling interval."""
    arguments = Arguments()
    request = pb.EvaluateProfilesRequest(
        eq46_square_root_of_sum=eq46_square_root_of_sum, sampling_steps=sampling_steps
    )
    listed = [profiles] if isinstance(profiles, (str, Path, Profile)) else profiles
    for i, profile in enumerate(listed):
        _add_profile(arguments, f"profiles[{i}]", profile, request.profiles.add())
    if levelling is not None:
        request.levelling = arguments.word(
            "levelling", levelling, surfaces_pb2.Levelling, "LEVELLING_"
        )
    cut_offs = {
        "short_wave_cut_off_metres": short_wave_cut_off_metres,
        "long_wave_cut_off_metres": long_wave_cut_off_metres,
    }
    for name, value in cut_offs.items():
        if value is not None:
            setattr(request, name, arguments.number(name, value))
    arguments.check()
    answer = await transport.call("ProfileService", "EvaluateProfiles", request)
    parameters = [each.name for each in pb.ProfileRoughness.DESCRIPTOR.fields]
    rows = []
    for each in answer.surfaces:
        row: dict[str, Any] = {
            "sampling_step": each.sampling_step,
            "spacing_metres": each.spacing_metres,
        }
        row.update({name: getattr(each.roughness, name) for name in parameters})
        known = each.HasField("standard_uncertainty")
        for name in parameters:
            uncertainty = getattr(each.standard_uncertainty, name) if known else np.nan
            row[f"standard_uncertainty.{name}"] = uncertainty
        row["wave_length_ratio"] = each.wave_length_ratio
        rows.append(row)
    attrs = {
        "measurements": frame(in_columns([_measurement(each) for each in answer.measurements]), {}),
        "groups": frame(in_columns([_group(each) for each in answer.groups]), {}),
        "warnings": {each.code: each.message for each in answer.warnings},
    }
    return frame(in_columns(rows), attrs)


def _flank(of: Any) -> dict[str, Any]:
    return {
        "member": enum_word(surfaces_pb2.FlankMember.DESCRIPTOR, of.member),
        "direction": enum_word(surfaces_pb2.ProfileDirection.DESCRIPTOR, of.direction),
    }


def _measurement(of: Any) -> dict[str, Any]:
    out = _flank(of)
    for each in of.DESCRIPTOR.fields:
        if each.cpp_type in (each.CPPTYPE_DOUBLE, each.CPPTYPE_INT32):
            out[each.name] = getattr(of, each.name)
    return out


def _group(of: pb.ProfileGroup) -> dict[str, Any]:
    out = _flank(of)
    out["profiles"] = of.profiles
    has_spread = of.HasField("standard_deviation")
    for each in pb.ProfileMoments.DESCRIPTOR.fields:
        out[each.name] = getattr(of.mean, each.name)
        deviation = getattr(of.standard_deviation, each.name) if has_spread else np.nan
        out[f"standard_deviation.{each.name}"] = deviation
    return out
