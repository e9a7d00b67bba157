"""Measured profiles of flanks: the surface that they make, by the sampling interval."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Sequence

import numpy as np

from tribodyn._arguments import Arguments
from tribodyn._enums import enum_word
from tribodyn._frames import Frame, frame, in_columns
from tribodyn._session import Session
from tribodyn._warnings import of_inputs
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


class Profiles(Session):
    """The method of a client for measured profiles."""

    async def roughness(
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
        arguments.set_numbers(
            request,
            {
                "short_wave_cut_off_metres": short_wave_cut_off_metres,
                "long_wave_cut_off_metres": long_wave_cut_off_metres,
            },
        )
        arguments.check()
        answer = await self._call("ProfileService", "EvaluateProfiles", request)
        attrs = {
            "measurements": frame(
                in_columns([_measurement(each) for each in answer.measurements]), {}
            ),
            "groups": frame(in_columns([_group(each) for each in answer.groups]), {}),
            "warnings": of_inputs(answer.warnings),
        }
        return frame(in_columns([_surface(each) for each in answer.surfaces]), attrs)


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


def _surface(of: Any) -> dict[str, Any]:
    parameters = [each.name for each in pb.ProfileRoughness.DESCRIPTOR.fields]
    out: dict[str, Any] = {
        "sampling_step": of.sampling_step,
        "spacing_metres": of.spacing_metres,
    }
    out.update({name: getattr(of.roughness, name) for name in parameters})
    known = of.HasField("standard_uncertainty")
    for name in parameters:
        uncertainty = getattr(of.standard_uncertainty, name) if known else np.nan
        out[f"standard_uncertainty.{name}"] = uncertainty
    out["wave_length_ratio"] = of.wave_length_ratio
    return out


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
