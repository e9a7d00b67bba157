"""Decisions between the candidates of a campaign: the best ones, Pareto fronts, main effects."""

from __future__ import annotations

from typing import Any, Mapping, Sequence

import numpy as np

from tribodyn._arguments import Arguments, full_name
from tribodyn._candidate_columns import CandidateColumns
from tribodyn._figures import USUAL_FIGURE, USUAL_RIG_FIGURE
from tribodyn._frames import Frame, frame, in_columns
from tribodyn._parameters import parameter_path, read_parameters
from tribodyn._stored_campaign import StoredCampaign
from tribodyn._warnings import level_word
from tribodyn.units import Quantity
from tribodyn.v1 import campaigns_pb2 as pb

_MOST_CANDIDATES = 100_000  # of a campaign
_LARGEST_PAGE = 10_000


class Decisions(StoredCampaign):
    """Methods of a campaign that decide between its candidates."""

    async def ranking(
        self,
        by: str | None = None,
        *,
        most: bool = False,
        where: Mapping[str, tuple[float | None, float | None]] | None = None,
        condition_weights: Sequence[float] = (),
        uncertainties: Mapping[str, Quantity] | None = None,
        stated_uncertainties: bool = True,
        confidence: float = 0.95,
        estimate_correlation: float | None = None,
        draws: int = 0,
        count: int | None = 1000,
    ) -> Frame:
        """Returns a table of the ``count`` best candidates (None: all), one a row, finished or not:
        those with least of the figure ``by`` first, or with most of it if ``most``. None: the mean
        inefficiency, of a rig the traction coefficient. More than 10,000 candidates are ranked in
        pages: raises TribodynError RANKING_CHANGED if candidates are added or computed meanwhile.

        A figure is a column with values, alone for its mean over the conditions with their weights,
        or with ":min" or ":max": "film_ratio_minimum:min"; of another campaign with the same
        candidates, "12/traction_coefficient:max". ``where`` maps figures to (minimum,
        maximum), each a number in the unit of the column or None; candidates outside are left out.
        ``uncertainties`` maps parameters to standard uncertainties: "3%" of the value, or a quantity;
        of a parameter in the table each candidate's own, of another one common to all. Those that
        lubricant and surface state count too unless ``stated_uncertainties`` is False.

        Candidates that are lubricants have the errors of compare_points(), with its
        ``estimate_correlation`` and ``draws`` (0: 199).

        Columns: what the candidates were created with, "candidate" (numbers from 0), the figures,
        "solver_error" (a bound), "verdict_withheld", "standard_uncertainty" (by the inputs),
        "worse_probability" (than the best one) and "tied": the interval of the difference that has
        the probability ``confidence`` holds 0. The last three are NaN and None beyond
        ``attrs["compared"]`` candidates, where no uncertainty is stated, and where a warning withholds
        the verdict: these candidates stand last.

        ``attrs["warnings"]`` holds, by code, level, summary, the numbers of the candidates concerned
        and "where", the range of conditions; ``attrs["refused_candidates"]`` is a table of those
        without a figure, with the reason; ``attrs["not_included"]`` says what the figures leave out.
        ``attrs`` counts the others as "excluded", "refused" and "missing" (not computed yet), and those "withheld".
        """
        arguments = Arguments()
        by = by or self._usual_figure()
        request = pb.RankCandidatesRequest(
            name=self.name,
            objective=_objective(arguments, "by", by, most),
            constraints=_constraints(arguments, where),
            condition_weights=condition_weights,
            confidence=confidence,
            ignore_stated_uncertainties=not stated_uncertainties,
            estimate_correlation=estimate_correlation,
            draws=draws,
        )
        for name, value in (uncertainties or {}).items():
            _add_uncertainty(arguments, name, value, request)
        arguments.check()
        pages = await self._ranking_pages(request, _MOST_CANDIDATES if count is None else count)
        answer = pages[-1]
        found = [each for page in pages for each in page.candidates]
        cells: dict[str, Any] = {by: [each.value for each in found]}
        cells["solver_error"] = [
            each.solver_error if each.HasField("solver_error") else np.nan for each in found
        ]
        for i, constraint in enumerate(where or {}):
            cells.setdefault(constraint, [each.constraint_values[i] for each in found])
        cells["verdict_withheld"] = [each.verdict_withheld for each in found]
        compared = [each.comparison if each.HasField("comparison") else None for each in found]
        for name in ("standard_uncertainty", "worse_probability"):
            cells[name] = [getattr(each, name) if each else np.nan for each in compared]
        cells["tied"] = np.array([each.tied if each else None for each in compared], dtype=object)
        attrs = {
            **_counts(answer),
            "ranked": answer.ranked,
            "compared": answer.compared,
            "own_uncertain_parameters": list(answer.own_uncertain_parameters),
            "shared_uncertain_parameters": list(answer.shared_uncertain_parameters),
            "withheld": answer.withheld,
            "draws": answer.draws,
            "warnings": _joined_warnings(pages),
            "refused_candidates": frame(
                in_columns(
                    {
                        "candidate": each.candidate,
                        "label": each.label,
                        "status": each.refusal.reason,
                        "status_message": each.refusal.message,
                    }
                    for each in answer.refused_candidates
                ),
                {},
            ),
            "not_included": answer.not_included,
        }
        return await self._of_candidates([each.candidate for each in found], cells, attrs)

    async def _ranking_pages(
        self, request: pb.RankCandidatesRequest, count: int
    ) -> list[pb.RankCandidatesResponse]:
        """Returns the pages of a ranking that hold the `count` best candidates."""
        pages: list[pb.RankCandidatesResponse] = []
        missing = count
        while True:
            request.count = min(missing, _LARGEST_PAGE)
            pages.append(await self._call("RankCandidates", request, patient=True))
            missing -= len(pages[-1].candidates)
            request.page_token = pages[-1].next_page_token
            if not request.page_token or missing <= 0:
                return pages

    async def pareto(
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
        by the first one first. Figures and ``where`` as of ranking(), whose warnings hold here too.
        ``attrs`` counts the others as "beaten", "excluded", "refused" and "missing"."""
        arguments = Arguments()
        first = first or self._usual_figure()
        request = pb.FindParetoCandidatesRequest(
            name=self.name,
            first=_objective(arguments, "first", first, first_most),
            second=_objective(arguments, "second", second, second_most),
            constraints=_constraints(arguments, where),
            condition_weights=condition_weights,
        )
        arguments.check()
        answer = await self._call("FindParetoCandidates", request, patient=True)
        cells = {
            first: [each.first_value for each in answer.candidates],
            second: [each.second_value for each in answer.candidates],
        }
        attrs = {**_counts(answer), "beaten": answer.beaten, "total_size": answer.total_size}
        return await self._of_candidates(
            [each.candidate for each in answer.candidates], cells, attrs
        )

    async def effects(
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
        the probability ``coverage``. ``columns``: empty means all parameters, which the model uses;
        what rides along need not be a cause. "collinear_columns" names those whose effects cannot be
        separated from that of a column; ``attrs["left_out"]`` says which have no effect and why.
        Figures and ``where`` as of ranking(), whose warnings hold here too."""
        arguments = Arguments()
        figure = figure or self._usual_figure()
        request = pb.EstimateCandidateEffectsRequest(
            name=self.name,
            figure=_figure(arguments, "figure", figure),
            columns=[columns] if isinstance(columns, str) else columns,
            constraints=_constraints(arguments, where),
            condition_weights=condition_weights,
            coverage=coverage,
        )
        arguments.check()
        answer = await self._call("EstimateCandidateEffects", request, patient=True)
        own = CandidateColumns(await self._full())
        found = answer.effects
        cells: dict[str, Any] = {"column": [each.column for each in found]}
        cells["from"] = np.array(
            [own.of_candidate(each.column, each.from_candidate) for each in found], dtype=object
        )
        cells["to"] = np.array(
            [own.of_candidate(each.column, each.to_candidate) for each in found], dtype=object
        )
        for name in ("effect", "effect_minimum", "effect_maximum"):
            cells[name] = [getattr(each, name) for each in found]
        cells["collinear_columns"] = [" ".join(each.collinear_columns) for each in found]
        reasons = pb.ColumnWithoutEffect.Reason
        attrs = {
            **_counts(answer),
            "left_out": {
                each.column: reasons.Name(each.reason).lower().replace("_", " ")
                for each in answer.left_out
            },
            "candidates": answer.candidates,
            "degrees_of_freedom": answer.degrees_of_freedom,
            "residual_standard_deviation": answer.residual_standard_deviation_value,
            "explained_share": answer.explained_share,
        }
        return frame(cells, {**self._attrs(), **attrs})

    def _usual_figure(self) -> str:
        return USUAL_RIG_FIGURE if self.message.HasField("rig") else USUAL_FIGURE


def _figure(arguments: Arguments, argument: str, text: str) -> pb.CandidateFigure:
    """Reads "COLUMN", "COLUMN:min", "COLUMN:max" or "COLUMN:mean", each also of another campaign:
    "12/COLUMN"."""
    stated, _, word = text.partition(":")
    campaign, _, column = stated.rpartition("/")
    kinds = {
        "": pb.CandidateFigure.MEAN,
        "mean": pb.CandidateFigure.MEAN,
        "min": pb.CandidateFigure.MINIMUM,
        "max": pb.CandidateFigure.MAXIMUM,
    }
    if word not in kinds or not column:
        arguments.wrong(argument, f"{text} is not COLUMN, COLUMN:min, COLUMN:max or COLUMN:mean")
    return pb.CandidateFigure(
        column=column,
        aggregate=kinds.get(word, pb.CandidateFigure.MEAN),
        campaign=full_name("campaigns", campaign),
    )


def _objective(
    arguments: Arguments, argument: str, text: str, most: bool
) -> pb.CandidateObjective:
    return pb.CandidateObjective(figure=_figure(arguments, argument, text), wants_most=most)


def _constraints(
    arguments: Arguments, where: Mapping[str, tuple[float | None, float | None]] | None
) -> list[pb.CandidateConstraint]:
    out = []
    for text, limits in (where or {}).items():
        if not isinstance(limits, (tuple, list)) or len(limits) != 2:
            arguments.wrong("where", f"{text}: {limits!r} is not (minimum or None, maximum or None)")
            continue
        constraint = pb.CandidateConstraint(figure=_figure(arguments, "where", text))
        if limits[0] is not None:
            constraint.minimum = limits[0]
        if limits[1] is not None:
            constraint.maximum = limits[1]
        out.append(constraint)
    return out


def _add_uncertainty(
    arguments: Arguments, name: str, value: Quantity, request: pb.RankCandidatesRequest
) -> None:
    """Adds a standard uncertainty: "3%" of the value, or a quantity in the parameter's unit."""
    share = value.strip() if isinstance(value, str) else ""
    if share.endswith("%"):
        try:
            relative = float(share.removesuffix("%")) / 100
        except ValueError:
            arguments.wrong("uncertainties", f"{name}: {value!r} is no share")
            return
        path = parameter_path(arguments, "uncertainties", name)
        request.uncertainties.add(parameter=path, relative_uncertainty=relative)
        return
    for path, absolute in read_parameters(arguments, {name: value}).items():
        request.uncertainties.add(parameter=path, absolute_uncertainty=absolute)


def _joined_warnings(pages: Sequence[pb.RankCandidatesResponse]) -> dict[str, dict[str, Any]]:
    """Returns the warnings of all pages by code."""
    out: dict[str, dict[str, Any]] = {}
    for each in (warning for page in pages for warning in page.warnings):
        joined = out.setdefault(
            each.code,
            {
                "level": level_word(each.level),
                "summary": each.summary,
                "candidates": [],
                "where": each.where,
            },
        )
        joined["candidates"] += each.candidates
        if not each.where or not joined["where"]:
            joined["where"] = ""  # at all conditions
        elif each.where not in joined["where"]:
            joined["where"] += f"; {each.where}"
    return out


def _counts(answer: Any) -> dict[str, int]:
    return {name: getattr(answer, name) for name in ("excluded", "refused", "missing")}
