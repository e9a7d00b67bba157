"""Reads columns of histories and campaigns, resumed after a broken connection."""

from __future__ import annotations

import asyncio
from typing import Any

import grpc
import numpy as np

from tribodyn._transport import Backoff, Transport, requested_pause
from tribodyn.errors import service_error
from tribodyn.v1 import simulations_pb2 as pb

_READ_RETRIES = 20  # about 40 s in all: long enough for a server that restarts


async def read_columns(
    transport: Transport, service: str, method: str, request: Any
) -> tuple[pb.HistorySchema, list[np.ndarray]]:
    """Returns the schema of a stream of columns, and the columns."""
    start_row, row_count = request.start_row, request.row_count
    schema: pb.HistorySchema | None = None
    parts: list[list[np.ndarray]] = []
    backoff, tries_left = Backoff(), _READ_RETRIES
    is_filtered = getattr(request, "filter", "") != ""
    while True:
        # Whole columns arrive in turns; a resumed stream begins at the first row that is missing in
        # any of them. The buckets of an envelope depend on its first row, and what a filter leaves
        # has no numbers: either is read again.
        done = min((sum(map(len, part)) for part in parts), default=0)
        if schema is None or schema.rows_per_pair > 0 or is_filtered:
            schema, done = None, 0
        parts = [_first(part, done) for part in parts] if schema else []
        request.start_row = start_row + done
        request.row_count = row_count - done if row_count else 0
        if schema is not None and done == schema.row_count:
            break
        try:
            async for answer in transport.stream(service, method, request):
                backoff.reset()
                if answer.HasField("schema"):
                    if schema is None:
                        schema = answer.schema
                        parts = [[] for _ in schema.columns]
                else:
                    tries_left = _READ_RETRIES
                    parts[answer.chunk.column].append(np.frombuffer(answer.chunk.values, "<f8"))
            break
        except grpc.aio.AioRpcError as error:
            broken = error.code() in (
                grpc.StatusCode.UNAVAILABLE,
                grpc.StatusCode.DEADLINE_EXCEEDED,
            )
            requested = requested_pause(error)
            tries_left -= requested is None
            if not broken and requested is None or tries_left == 0:
                raise service_error(error, transport.settings.server) from None
            await asyncio.sleep(backoff.next(requested or 0.25))
    assert schema is not None
    return schema, [np.concatenate(part) if part else np.empty(0) for part in parts]


def _first(arrays: list[np.ndarray], count: int) -> list[np.ndarray]:
    """Returns the first values of a column."""
    return [np.concatenate(arrays)[:count]] if arrays else []
