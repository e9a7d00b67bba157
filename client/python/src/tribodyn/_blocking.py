"""Blocking methods made of coroutines: the one way in which the two clients differ."""

from __future__ import annotations

import asyncio
import atexit
import functools
import inspect
import os
import threading
from typing import (
    Any,
    AsyncGenerator,
    Callable,
    Concatenate,
    Coroutine,
    Iterator,
    ParamSpec,
    TypeVar,
)

from tribodyn.errors import TribodynError

P = ParamSpec("P")
S = TypeVar("S")
T = TypeVar("T")
F = TypeVar("F", bound=Callable[..., Any])


class _Loop:
    """The event loop of all blocking clients, in a thread of its own: so they also work in
    notebooks, where another loop runs already."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._process = 0  # number of the process that started the thread

    def run(self, work: Coroutine[Any, Any, T]) -> T:
        """Runs the work to its end; an interruption (Ctrl-C) cancels it. Raises in a process that was
        forked from one that used a client: it has neither the thread nor gRPC's."""
        if self._loop is not None and self._process != os.getpid():
            work.close()
            raise TribodynError(
                "this process was forked after its parent used a client, and gRPC does not survive a "
                'fork; start processes by multiprocessing.get_context("spawn"), or make the first '
                "call after the fork",
                reason="FORKED",
            )
        future = asyncio.run_coroutine_threadsafe(work, self._started())
        try:
            return future.result()
        except BaseException:
            future.cancel()
            raise

    def _started(self) -> asyncio.AbstractEventLoop:
        with self._lock:
            if self._loop is None:
                self._loop, self._process = asyncio.new_event_loop(), os.getpid()
                # gRPC's poller reports a wake-up that another loop of the process has consumed.
                self._loop.set_exception_handler(_report)
                thread = threading.Thread(
                    target=self._loop.run_forever, name="tribodyn", daemon=True
                )
                thread.start()
                atexit.register(self._stop, self._loop, thread)
            return self._loop

    @staticmethod
    def _stop(loop: asyncio.AbstractEventLoop, thread: threading.Thread) -> None:
        loop.call_soon_threadsafe(loop.stop)
        thread.join(1.0)


def _report(loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
    if not isinstance(context.get("exception"), BlockingIOError):
        loop.default_exception_handler(context)


_LOOP = _Loop()


class Blocking:
    """The base of classes whose methods block until a coroutine of ``awaited`` has ended."""

    def __init__(self, awaited: Any) -> None:
        self._awaited = awaited


def run(work: Coroutine[Any, Any, T]) -> T:
    """Runs a coroutine to its end in the event loop of the blocking clients."""
    return _LOOP.run(work)


def blocking(
    method: Callable[Concatenate[Any, P], Coroutine[Any, Any, T]]
) -> Callable[Concatenate[Any, P], T]:
    """Returns a method of a class derived from Blocking with the arguments, the description and the
    result of a coroutine."""

    @functools.wraps(method)
    def call(self: Any, /, *args: P.args, **kwargs: P.kwargs) -> T:
        return _LOOP.run(method(self._awaited, *args, **kwargs))

    return call


def blocking_as(
    kind: str,
    made_of: Callable[[S], T],
    method: Callable[Concatenate[Any, P], Coroutine[Any, Any, S]],
) -> Callable[Concatenate[Any, P], T]:
    """As blocking(), where the result is made of that of the coroutine. ``kind``: the type of the
    result, as help() shows it."""
    waited = blocking(method)

    @functools.wraps(method)
    def call(self: Any, /, *args: P.args, **kwargs: P.kwargs) -> T:
        return made_of(waited(self, *args, **kwargs))

    return _returning(kind, call)


def blocking_iterator(
    method: Callable[Concatenate[Any, P], AsyncGenerator[T, None]]
) -> Callable[Concatenate[Any, P], Iterator[T]]:
    """As blocking(), of an asynchronous generator."""

    @functools.wraps(method)
    def call(self: Any, /, *args: P.args, **kwargs: P.kwargs) -> Iterator[T]:
        found = method(self._awaited, *args, **kwargs)

        async def following() -> T:
            return await found.__anext__()

        async def close() -> None:
            await found.aclose()

        try:
            while True:
                try:
                    each = _LOOP.run(following())
                except StopAsyncIteration:
                    return
                yield each
        finally:
            _LOOP.run(close())

    return _returning("Iterator[Frame]", call)


def _returning(kind: str, call: F) -> F:
    """Sets what a wrapper is said to return."""
    call.__annotations__ = {**call.__annotations__, "return": kind}
    call.__signature__ = inspect.signature(call).replace(  # type: ignore[attr-defined]
        return_annotation=kind
    )
    return call
