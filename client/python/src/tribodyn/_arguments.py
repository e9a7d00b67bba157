"""Arguments of methods. All wrong ones are reported together."""

from __future__ import annotations

from typing import Any, Mapping, Sequence

from tribodyn.errors import Violation, invalid_fields
from tribodyn.units import Quantity, QuantityError, quantity


class Arguments:
    """Reads arguments and collects what is wrong with them."""

    def __init__(self) -> None:
        self.violations: list[Violation] = []

    def number(self, name: str, value: Quantity) -> float:
        try:
            return quantity(value, name)
        except QuantityError as error:
            self.violations.append(Violation(name, f"{value!r} {error}", repr(value)))
            return float("nan")

    def word(self, name: str, value: str, kind: Any, prefix: str) -> Any:
        """Returns the number of an enum's value for a word such as "quasi-static"."""
        words = {
            each.name.removeprefix(prefix).lower().replace("_", "-"): each.number
            for each in kind.DESCRIPTOR.values
            if each.number
        }
        plain = str(value).lower().replace("_", "-").replace(" ", "-")
        if plain not in words:
            allowed = ", ".join(words)
            self.violations.append(
                Violation(name, f"{name} = {value}; allowed: {allowed}", str(value), allowed)
            )
        return words.get(plain, 0)

    def wrong(self, name: str, description: str) -> None:
        self.violations.append(Violation(name, description))

    def check(self) -> None:
        """Raises TribodynError if an argument is wrong."""
        if self.violations:
            raise invalid_fields(self.violations)

    def numbers(self, name: str, values: Quantity | Sequence[Quantity]) -> list[float]:
        """Reads one value or several."""
        listed = [values] if isinstance(values, (str, float, int)) else values
        return [self.number(name, each) for each in listed]

    def set_numbers(self, out: Any, values: Mapping[str, Quantity | None]) -> None:
        """Sets the fields of a message to the values that are stated."""
        for name, value in values.items():
            if value is not None:
                setattr(out, name, self.number(name, value))


def full_name(collection: str, name: str) -> str:
    """Returns "lubricants/my-oil" for "my-oil"; other names as they are."""
    return name if "/" in name or not name else f"{collection}/{name}"


def full_names(collection: str, names: str | Sequence[str]) -> list[str]:
    """Returns the full names of one resource or several."""
    listed = [names] if isinstance(names, str) else names
    return [full_name(collection, each) for each in listed]


def set_switches(arguments: Arguments, path: str, switches: Mapping[str, Any], out: Any) -> None:
    """Sets the fields of a message that are stated; None leaves the server's default."""
    fields = out.DESCRIPTOR.fields_by_name
    for name, value in switches.items():
        described = fields.get(name)
        if described is None:
            arguments.wrong(f"{path}.{name}", f"{name} is unknown; allowed: {', '.join(fields)}")
        elif value is None:
            continue
        elif described.message_type is not None:
            set_switches(arguments, f"{path}.{name}", value, getattr(out, name))
        elif described.enum_type is not None:
            kind = getattr(type(out), described.enum_type.name)
            setattr(out, name, arguments.word(f"{path}.{name}", value, kind, name.upper() + "_"))
        else:
            setattr(out, name, bool(value))
