"""Progress of jobs: a bar of tqdm in a notebook or terminal, lines without tqdm or for a log."""

from __future__ import annotations

import sys
import time
from typing import Any

_SECONDS_BETWEEN_LINES = 2.0
_SECONDS_BETWEEN_BARS = 0.1


class Progress:
    """Shows how much of ``total`` jobs is done, on standard error. Form: "auto" (a bar, or lines
    without tqdm, and only in a notebook or terminal), "lines" or "none"."""

    def __init__(self, form: str, total: int, title: str) -> None:
        self._fractions: dict[str, float] = {}
        self._done = 0.0  # sum of the fractions
        self._total = total
        self._title = title
        self._bar: Any = None
        self._shows_lines = form == "lines"
        self._latest = time.monotonic()  # time of the latest line or bar
        if form == "auto" and (sys.stderr.isatty() or "ipykernel" in sys.modules):
            self._bar = _bar(total, title)
            self._shows_lines = self._bar is None

    def update(self, job: str, fraction: float) -> None:
        """Sets the share of one job that is done, 0 to 1."""
        self._done += fraction - self._fractions.get(job, 0.0)
        self._fractions[job] = fraction
        now = time.monotonic()
        if self._bar is not None and now - self._latest >= _SECONDS_BETWEEN_BARS:
            self._latest = now
            self._show_bar()
        if self._shows_lines and now - self._latest >= _SECONDS_BETWEEN_LINES:
            self._latest = now
            share = 100 * self._done / self._total
            print(f"{self._title}: {share:.0f} % of {self._total}", file=sys.stderr)

    def close(self) -> None:
        if self._bar is not None:
            self._show_bar()
            self._bar.close()

    def _show_bar(self) -> None:
        self._bar.n = min(round(self._done, 2), self._total)
        self._bar.refresh()


def _bar(total: int, title: str) -> Any:
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return None
    return tqdm(
        total=total,
        desc=title,
        leave=False,
        bar_format="{desc}: {percentage:3.0f}%|{bar}| {elapsed}, {remaining} left",
    )
