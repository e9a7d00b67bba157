"""Streams of columns that break, from a scripted server."""

import asyncio
from types import SimpleNamespace

import grpc
import numpy as np

from tribodyn._columns import read_columns
from tribodyn.v1 import simulations_pb2 as pb

ROWS = 10


class BreakingServer:
    """Sends two columns in chunks of three rows, and breaks after some messages of each stream."""

    settings = SimpleNamespace(server="scripted")

    def __init__(self, messages, rows_per_pair=0):
        self.messages = messages
        self.rows_per_pair = rows_per_pair
        self.first_rows = []

    async def stream(self, service, method, request):
        self.first_rows.append(request.start_row)
        columns = [pb.HistorySchema.Column(name=name) for name in ("time_seconds", "force_newtons")]
        count = ROWS - request.start_row
        schema = pb.HistorySchema(
            columns=columns, row_count=count, rows_per_pair=self.rows_per_pair
        )
        sent = [pb.ReadHistoryResponse(schema=schema)]
        for first in range(0, count, 3):
            for column in range(2):
                rows = np.arange(request.start_row + first, request.start_row + count)[:3]
                chunk = pb.HistoryChunk(
                    column=column,
                    first_row=first,
                    values=(rows + 100.0 * column).astype("<f8").tobytes(),
                )
                sent.append(pb.ReadHistoryResponse(chunk=chunk))
        for message in sent[: self.messages]:
            yield message
        if len(sent) > self.messages:
            # The next stream gets further, as one of a server that has restarted.
            self.messages += 1 if self.rows_per_pair == 0 else 100
            raise grpc.aio.AioRpcError(
                grpc.StatusCode.UNAVAILABLE, grpc.aio.Metadata(), grpc.aio.Metadata(), "lost"
            )


def read(server):
    request = pb.ReadHistoryRequest(name="simulations/1")
    return asyncio.run(read_columns(server, "SimulationService", "ReadHistory", request))


def test_a_broken_stream_goes_on_at_the_first_row_that_a_column_misses():
    server = BreakingServer(4)  # the schema, a chunk of each column and another of the first
    schema, (time, force) = read(server)
    assert list(time) == list(range(ROWS)) and list(force) == [100 + i for i in range(ROWS)]
    assert server.first_rows[:2] == [0, 3] and schema.row_count == ROWS


def test_a_broken_envelope_is_read_again_from_its_first_row():
    server = BreakingServer(4, rows_per_pair=2)
    _, (time, _) = read(server)
    assert list(time) == list(range(ROWS)) and server.first_rows == [0, 0]
