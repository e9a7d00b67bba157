"""The one error that every call raises."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any, Sequence

import grpc

from tribodyn.rpc import error_details_pb2, status_pb2

# The server's sentence: "sump_temperature_celsius = 900 C; allowed: -70 to 200 C (eq 14)".
_SENTENCE = re.compile(
    r"(?P<field>\S+) = (?P<value>.+?); allowed: (?P<allowed>.+?)(?=$| \(|[;,.] )"
)


@dataclass(frozen=True)
class Violation:
    """One wrong value of a request."""

    field: str  #: as typed, or its path in the request, e.g. "simulation.sump_temperature_celsius"
    description: str  #: sentence with value, unit, allowed range and the likely slip
    value: str | None = None  #: value with its unit, e.g. "900 C"; None if the sentence has none
    allowed: str | None = None  #: allowed range with its unit, e.g. "-70 to 200 C"; or None


class TribodynError(Exception):
    """The failure of a call or of a simulation. ``str()`` is the whole text, one line a violation.

    ``reason`` is stable, for programs: a value of ErrorReason without its prefix, e.g.
    "INVALID_FIELDS" or "NOT_FOUND"; "CANNOT_CONNECT" if nothing listens at the address or the
    connection was lost; "NO_ANSWER" if the time limit passed without an answer; "CANCELLED" for a
    simulation that was cancelled, "SIMULATION_DELETED" for one that was deleted meanwhile;
    "FORKED" in a process that was forked after its parent used a client.
    """

    def __init__(
        self,
        message: str,
        *,
        reason: str = "",
        code: str = "",
        violations: Sequence[Violation] = (),
        retry_delay_seconds: float | None = None,
        resource: str = "",
    ) -> None:
        self.message = message  #: without the violations
        self.reason = reason
        self.code = code  #: status code of gRPC, e.g. "INVALID_ARGUMENT"; "" if nothing was sent
        self.violations = tuple(violations)  #: all of them
        #: pause before a retry that the server requests, in seconds; None if it requests none
        self.retry_delay_seconds = retry_delay_seconds
        self.resource = resource  #: the name of the resource that the error is about; or ""
        text = message + (f" [{reason or code}]" if reason or code else "")
        for each in self.violations:
            text += "\n  " + _violation_text(each)
        if retry_delay_seconds is not None:
            text += f"\n  try again in {retry_delay_seconds:g} s"
        super().__init__(text)


def violation(field: str, description: str) -> Violation:
    """Returns a violation with value and range as the server's sentence states them."""
    found = _SENTENCE.search(description)
    if found is None:
        return Violation(field, description)
    return Violation(field, description, found["value"], found["allowed"])


def invalid_fields(
    violations: Sequence[Violation],
    code: str = "",
    reason: str = "INVALID_FIELDS",
    resource: str = "",
) -> TribodynError:
    """Returns the error of a request with these violations."""
    count = len(violations)
    return TribodynError(
        f"{count} invalid value" + ("" if count == 1 else "s"),
        reason=reason,
        code=code,
        violations=violations,
        resource=resource,
    )


def is_about_the_request(error: TribodynError) -> bool:
    """Whether other requests may succeed where this one failed: not if the server is lost, refuses
    the caller, or has a defect."""
    return error.code in (
        "INVALID_ARGUMENT",
        "NOT_FOUND",
        "ALREADY_EXISTS",
        "FAILED_PRECONDITION",
        "OUT_OF_RANGE",
    )


def service_error(error: grpc.aio.AioRpcError, address: str) -> TribodynError:
    """Returns what the server answered, or why it did not."""
    status = details_of(error)
    code = error.code().name
    if status is None:
        cause = (error.details() or "").rpartition(": ")[2]
        if error.code() is grpc.StatusCode.UNAVAILABLE:
            return TribodynError(
                f"cannot connect to the server at {address}: {_lower(cause) or 'no connection'}",
                reason="CANNOT_CONNECT",
                code=code,
            )
        if error.code() is grpc.StatusCode.DEADLINE_EXCEEDED:
            return TribodynError(
                f"no answer in time from the server at {address}", reason="NO_ANSWER", code=code
            )
        return TribodynError(error.details() or "the server sent no message", code=code)
    reason, violations = reason_of(status), []
    for detail in _all(status, error_details_pb2.BadRequest):
        violations += [violation(each.field, each.description) for each in detail.field_violations]
    names = [each.resource_name for each in _all(status, error_details_pb2.ResourceInfo)]
    resource = names[0] if names else ""
    if violations:
        return invalid_fields(violations, code, reason, resource)
    return TribodynError(
        error.details() or "the server sent no message",
        reason=reason,
        code=code,
        retry_delay_seconds=retry_delay_of(status),
        resource=resource,
    )


def details_of(error: grpc.aio.AioRpcError) -> status_pb2.Status | None:
    """Returns the details that the server sent; None if it sent none, or never answered."""
    for key, value in error.trailing_metadata() or ():
        if key == "grpc-status-details-bin" and isinstance(value, bytes):
            return status_pb2.Status.FromString(value)
    return None


def reason_of(status: status_pb2.Status) -> str:
    """Returns the stable reason, e.g. "NOT_FOUND"; "" if there is none."""
    for info in _all(status, error_details_pb2.ErrorInfo):
        return info.reason
    return ""


def retry_delay_of(status: status_pb2.Status) -> float | None:
    """Returns the pause that the server requests, in seconds; None if it requests none."""
    for info in _all(status, error_details_pb2.RetryInfo):
        return info.retry_delay.seconds + 1e-9 * info.retry_delay.nanos
    return None


def _all(status: status_pb2.Status, kind: Any) -> list:
    name = kind.__name__
    return [
        kind.FromString(each.value)
        for each in status.details
        if each.type_url.endswith("/google.rpc." + name)
    ]


def _violation_text(each: Violation) -> str:
    leaf = each.field.rsplit(".", 1)[-1]
    if "[" not in each.field and each.description.startswith(leaf + " "):
        return each.description
    return f"{each.field}: {each.description}"


def _lower(text: str) -> str:
    return text[:1].lower() + text[1:]
