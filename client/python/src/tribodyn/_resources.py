"""Lubricants, gear sets, surfaces and vehicles."""

from __future__ import annotations

import re
import sys
from typing import Any, Generic, List, Mapping, Type, TypeVar

from google.protobuf.message import Message

from tribodyn._csv import rows_of
from tribodyn._enums import enum_word
from tribodyn._frames import Frame, frame, in_columns
from tribodyn._rows import fill, find_column, unknown
from tribodyn._arguments import full_name
from tribodyn._transport import Transport
from tribodyn.errors import TribodynError, Violation, invalid_fields

R = TypeVar("R", bound=Message)

_LARGEST_PAGE = 1000
_LARGEST_BATCH = 20_000
# What the server sets, and what a copy does not take over.
_OUTPUT_ONLY = (
    "name",
    "etag",
    "revision",
    "create_time",
    "revision_create_time",
    "delete_time",
    "characterisation",
)


class AsyncResources(Generic[R]):
    """The resources of one kind in a project. As Resources, with coroutines."""

    def __init__(self, transport: Transport, kind: Type[R], collection: str) -> None:
        self._transport = transport
        self._kind = kind
        self._word = kind.DESCRIPTOR.name
        self._collection = collection
        self._field = re.sub(r"(?<!^)(?=[A-Z])", "_", self._word).lower()

    async def list(
        self,
        filter: str = "",
        *,
        order_by: str = "",
        show_deleted: bool = False,
        limit: int | None = None,
    ) -> List[R]:
        request = self._request(
            "List{}sRequest", filter=filter, order_by=order_by, show_deleted=show_deleted
        )
        found: List[R] = []
        while limit is None or len(found) < limit:
            missing = _LARGEST_PAGE if limit is None else limit - len(found)
            request.page_size = min(missing, _LARGEST_PAGE)
            page = await self._call("List{}s", request)
            found += getattr(page, self._field + "s")
            request.page_token = page.next_page_token
            if not page.next_page_token:
                break
        return found

    async def frame(
        self, filter: str = "", *, order_by: str = "", limit: int | None = None
    ) -> Frame:
        return _resource_frame(await self.list(filter, order_by=order_by, limit=limit))

    async def get(self, name: str) -> R:
        return await self._call("Get{}", self._request("Get{}Request", name=self._name(name)))

    async def create(
        self, name: str, like: R | str | None = None, *, validate_only: bool = False, **fields: Any
    ) -> R:
        resource = self._kind()
        if isinstance(like, str):
            like = await self.get(like)
        if like is not None:
            resource.CopyFrom(like)
            for each in _OUTPUT_ONLY:
                if each in resource.DESCRIPTOR.fields_by_name:
                    resource.ClearField(each)
        self._fill(resource, fields)
        request = self._request("Create{}Request", validate_only=validate_only)
        setattr(request, self._field + "_id", name.removeprefix(self._collection + "/"))
        getattr(request, self._field).CopyFrom(resource)
        return await self._call("Create{}", request)

    async def update(self, name: str, *, validate_only: bool = False, **fields: Any) -> R:
        resource = await self.get(name)
        paths = self._fill(resource, fields, clears=True)
        request = self._request("Update{}Request", validate_only=validate_only)
        getattr(request, self._field).CopyFrom(resource)
        request.update_mask.paths[:] = paths
        return await self._call("Update{}", request)

    async def delete(self, name: str) -> R:
        return await self._call("Delete{}", self._request("Delete{}Request", name=self._name(name)))

    async def undelete(self, name: str) -> R:
        return await self._call(
            "Undelete{}", self._request("Undelete{}Request", name=self._name(name))
        )

    async def import_table(
        self, table: Any, *, replace: bool = False, validate_only: bool = False
    ) -> List[str]:
        rows = rows_of(table)
        violations: list[Violation] = []
        if not 0 < len(rows) <= _LARGEST_BATCH:
            raise TribodynError(f"the table has {len(rows)} rows; allowed: 1 to {_LARGEST_BATCH}")
        batch = self._request(
            "BatchUpdate{}sRequest" if replace else "BatchCreate{}sRequest",
            validate_only=validate_only,
        )
        batch.read_mask.paths.append("name")
        headers = list(dict.fromkeys(header for row in rows for header in row))
        wrong = [each for each in headers if each != "name" and not find_column(self._kind, each)]
        violations += [Violation(f"column {each}", unknown(self._kind, each)) for each in wrong]
        for number, row in enumerate(rows, 1):
            cells = {header: cell for header, cell in row.items() if header not in wrong}
            name = str(cells.pop("name", None) or "")
            if not name:
                violations.append(Violation(f"row {number}, name", "is missing"))
            request = batch.requests.add()
            resource = getattr(request, self._field)
            resource.name = self._name(name)
            paths = fill(resource, cells, violations, f"row {number} ({name}), ")
            if replace:
                request.allow_missing = True
                states_origin = any(
                    key.endswith((".provenance", ".source", ".warning", ".standard_uncertainty"))
                    for key in cells
                )
                request.update_mask.paths[:] = [
                    path for path in paths if path != "provenance" or states_origin
                ]
        if violations:
            raise invalid_fields(violations)
        try:
            answer = await self._call("BatchUpdate{}s" if replace else "BatchCreate{}s", batch)
        except TribodynError as error:
            raise _with_rows(error, rows) from None
        return [each.name for each in getattr(answer, self._field + "s")]

    def _name(self, name: str) -> str:
        return full_name(self._collection, name)

    def _fill(self, resource: R, fields: Mapping[str, Any], clears: bool = False) -> List[str]:
        violations: list[Violation] = []
        paths = fill(resource, fields, violations, clears=clears)
        if violations:
            raise invalid_fields(violations)
        return paths

    def _request(self, message: str, /, **fields: Any) -> Any:
        return getattr(sys.modules[self._kind.__module__], message.format(self._word))(**fields)

    async def _call(self, method: str, request: Any) -> Any:
        return await self._transport.call(
            self._word + "Service", method.format(self._word), request
        )


def _with_rows(error: TribodynError, rows: list[dict[str, Any]]) -> TribodynError:
    """Returns the error with the rows of the table in place of the elements of the request."""
    if not error.violations:
        return error

    def renamed(each: Violation) -> Violation:
        found = re.match(r"requests\[(\d+)\]\.(?:\w+\.)?(.*)", each.field)
        if found is None:
            return each
        index = int(found[1])
        return Violation(
            f"row {index + 1} ({rows[index].get('name')}), {found[2]}",
            each.description,
            each.value,
            each.allowed,
        )

    return invalid_fields([renamed(each) for each in error.violations], error.code, error.reason)


def _resource_frame(resources: list[Any]) -> Frame:
    rows = [_cells(each, "") for each in resources]
    names = dict.fromkeys(name for row in rows for name in row)
    return frame(
        in_columns({name: row.get(name, float("nan")) for name in names} for row in rows), {}
    )


def _cells(message: Message, prefix: str) -> dict[str, Any]:
    """Returns the scalars that a resource states, with labels in columns "labels.KEY"."""
    row: dict[str, Any] = {}
    for field, value in message.ListFields():
        name = prefix + field.name
        if field.name == "labels":
            row.update({f"labels.{label.key}": label.value for label in value})
        elif field.label == field.LABEL_REPEATED:
            continue
        elif field.message_type is None:
            row[name] = enum_word(field.enum_type, value) if field.enum_type else value
        elif field.message_type.full_name == "google.protobuf.Timestamp":
            row[name] = value.ToJsonString()
        else:
            row.update(_cells(value, name + "_"))
    return row
