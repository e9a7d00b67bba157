"""Numbers with units, as the command line takes them.

A quantity is a plain number in the unit that its name ends in (``sump_temperature_celsius=90``), or
a text with a unit of its own (``"363.15 K"``, ``"20/GPa"``, ``"5.4 mPa s"``). A unit is a product
of powers of ``m g s K Pa N J W rad deg rpm St P bar l t h min %`` with ``G M k d c m u n p`` before
them. Temperatures are in C, K or F; a slope in degrees may be in percent.
"""

from __future__ import annotations

import math
import re
from fractions import Fraction
from typing import Union

Quantity = Union[float, int, str]

# Unit words at the end of a field's name, with the symbol of the unit.
_UNIT_WORDS = {
    "per_pascal": "1/Pa",
    "per_second": "1/s",
    "per_square_metre": "1/m2",
    "percent": "%",
    "square_millimetres_per_second": "mm2/s",
    "millipascal_seconds": "mPa s",
    "pascal_seconds": "Pa s",
    "pascals": "Pa",
    "kilograms_per_cubic_metre_kelvin": "kg/(m3 K)",
    "kilograms_per_cubic_metre": "kg/m3",
    "kilogram_square_metres": "kg m2",
    "kilograms": "kg",
    "watts_per_metre_kelvin": "W/(m K)",
    "joules_per_kilogram_kelvin": "J/(kg K)",
    "kelvin_per_watt": "K/W",
    "watts": "W",
    "joules": "J",
    "newton_metres_per_radian": "N m/rad",
    "newton_metre_seconds_per_radian": "N m s/rad",
    "newton_seconds_per_metre": "N s/m",
    "newtons_per_metre": "N/m",
    "newton_metres": "N m",
    "newtons": "N",
    "metres_per_second_squared": "m/s2",
    "metres_per_second": "m/s",
    "kilometres_per_hour": "km/h",
    "radians_per_second": "rad/s",
    "square_metres": "m2",
    "millimetres": "mm",
    "micrometres": "um",
    "nanometres": "nm",
    "metres": "m",
    "degrees": "deg",
    "radians": "rad",
    "celsius": "C",
    "kelvin": "K",
    "seconds": "s",
}

_ZERO_CELSIUS = 273.15  # in kelvin

# Factor to SI, then the powers of kilogram, metre, second, kelvin and radian. Factors are exact
# fractions, so that a conversion rounds once.
_Unit = tuple[Fraction, tuple[int, int, int, int, int]]
_ATOMS: dict[str, _Unit] = {
    "m": (Fraction(1), (0, 1, 0, 0, 0)),
    "g": (Fraction(1, 1000), (1, 0, 0, 0, 0)),
    "s": (Fraction(1), (0, 0, 1, 0, 0)),
    "K": (Fraction(1), (0, 0, 0, 1, 0)),
    "rad": (Fraction(1), (0, 0, 0, 0, 1)),
    "N": (Fraction(1), (1, 1, -2, 0, 0)),
    "Pa": (Fraction(1), (1, -1, -2, 0, 0)),
    "J": (Fraction(1), (1, 2, -2, 0, 0)),
    "W": (Fraction(1), (1, 2, -3, 0, 0)),
    "St": (Fraction(1, 10**4), (0, 2, -1, 0, 0)),
    "P": (Fraction(1, 10), (1, -1, -1, 0, 0)),
    "bar": (Fraction(10**5), (1, -1, -2, 0, 0)),
    "l": (Fraction(1, 1000), (0, 3, 0, 0, 0)),
    "L": (Fraction(1, 1000), (0, 3, 0, 0, 0)),
    "t": (Fraction(1000), (1, 0, 0, 0, 0)),
    "h": (Fraction(3600), (0, 0, 1, 0, 0)),
    "min": (Fraction(60), (0, 0, 1, 0, 0)),
    "%": (Fraction(1, 100), (0, 0, 0, 0, 0)),
    "deg": (Fraction(math.pi / 180), (0, 0, 0, 0, 1)),
    "degrees": (Fraction(math.pi / 180), (0, 0, 0, 0, 1)),
    "rpm": (Fraction(math.pi / 30), (0, 0, -1, 0, 1)),
}
_PREFIXES = {"G": 9, "M": 6, "k": 3, "d": -1, "c": -2, "m": -3, "u": -6, "n": -9, "p": -12}

_PLAIN_SIGNS = str.maketrans(
    {
        "\u00b2": "2",
        "\u00b3": "3",
        "\u207b": "-",
        "\u00b9": "1",
        "\u00b7": " ",
        "\u22c5": " ",
        "*": " ",
        "^": "",
        "\u00b5": "u",
        "\u03bc": "u",
        "\u00b0": "",
        "\u00a0": " ",
    }
)
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?")
_TOKEN = re.compile(r"\s*(?:(/)|(\()|(\))|(1(?![\d.]))|([A-Za-z%]+)(-?\d{1,2})?)\s*")


class QuantityError(ValueError):
    """A text that is no number in the expected unit. The message completes "NAME TEXT ..."."""


def unit_of(name: str) -> str:
    """Returns the symbol of the unit that a name ends in; "" for a pure number.

    >>> unit_of("sump_temperature_celsius"), unit_of("havriliak_negami_alpha")
    ('C', '')
    """
    return _UNIT_WORDS.get(_unit_words(name), "")


def without_unit(name: str) -> str:
    """Returns a name without its unit: "speed" for "speed_kilometres_per_hour"."""
    words = _unit_words(name)
    return name[: -len(words) - 1] if words else name


def is_temperature(name: str) -> bool:
    """Whether a name means a temperature, not a difference of temperatures."""
    return unit_of(name) in ("C", "K") and without_unit(name).endswith(
        ("temperature", "temperatures")
    )


def quantity(value: Quantity, name: str, *, unit: str | None = None) -> float:
    """Returns a quantity in the unit that its name ends in.

    A plain number, or a text without a unit, is in ``unit``; None means the unit of the name, and
    "" that a text must bring its unit. Raises QuantityError.

    >>> quantity("72 km/h", "speed_metres_per_second")
    20.0
    """
    own = unit_of(name)
    bare = own if unit is None else unit
    if isinstance(value, bool):
        raise QuantityError("is not a number")
    if not isinstance(value, str):
        try:
            number = float(value)
        except (TypeError, ValueError):
            raise QuantityError("is not a number") from None
        if unit is None or unit == own:
            return number
        value = repr(number)
    text = value.strip()
    if re.fullmatch(r"[+-]?\d+,\d+.*", text):
        raise QuantityError(
            f"has a decimal comma; write a decimal point: {text.replace(',', '.', 1)}"
        )
    found = _NUMBER.match(text)
    if found is None:
        raise QuantityError("is not a number" + (f" in {own}" if own else ""))
    given = text[found.end() :].strip()
    if not given and own and not bare:
        raise QuantityError(
            f"needs its unit, e.g. {found[0]} {'C' if is_temperature(name) else own}"
        )
    given = given or bare
    if is_temperature(name):
        return _temperature(float(found[0]), given, own)
    if given == own:
        return float(found[0])
    if given == "%" and own == "deg":
        return math.degrees(math.atan(float(found[0]) / 100))
    source, target = _parse(given), _parse(own)
    if source is None or target is None or source[1] != target[1]:
        raise QuantityError(
            f"must be in {own} or a multiple of it" if own else "must be a number without a unit"
        )
    try:
        return float(Fraction(found[0]) * source[0] / target[0])
    except OverflowError:
        raise QuantityError("is too large") from None


def _unit_words(name: str) -> str:
    """Returns the longest words of a unit at the end of a name."""
    name = name.rsplit(".", 1)[-1]
    parts = name.split("_")
    for first in range(1, len(parts)):
        words = "_".join(parts[first:])
        if words in _UNIT_WORDS:
            return words
    return ""


def _temperature(number: float, given: str, own: str) -> float:
    given = given.translate(_PLAIN_SIGNS)
    if given in ("F", "degF"):
        number, given = (number - 32) / 1.8, "C"
    if given in ("degC", "celsius", "Celsius"):
        given = "C"
    if given not in ("C", "K"):
        raise QuantityError("is not a temperature in C, F or K")
    if given == own:
        return number
    return number + _ZERO_CELSIUS if own == "K" else number - _ZERO_CELSIUS


def _parse(text: str) -> _Unit | None:
    """Returns the unit of a text such as "W/(m K)"; a slash inverts the factor or bracket behind
    it."""
    plain = text.translate(_PLAIN_SIGNS).strip()
    # Data sheets write mPas, Nm and W/mK; W/mK never means a watt per millikelvin.
    plain = plain.replace("Pas", "Pa s").replace("Nm", "N m")
    if plain.endswith("W/mK"):
        plain = plain[:-2] + "(m K)"
    factor, powers = Fraction(1), [0] * 5
    signs, sign = [1], 1  # of the open brackets; of the next factor
    at = 0
    while at < len(plain):
        token = _TOKEN.match(plain, at)
        if token is None or token.end() == at or len(signs) > 10:
            return None
        at = token.end()
        slash, opened, closed, one, symbol, power = token.groups()
        if slash:
            sign = -signs[-1]
        elif opened:
            signs.append(sign)
        elif closed:
            if len(signs) == 1:
                return None
            signs.pop()
            sign = signs[-1]
        elif one:
            sign = signs[-1]
        else:
            atom = _atom(symbol)
            if atom is None:
                return None
            times = sign * int(power or 1)
            factor *= atom[0] ** times
            powers = [sum_ + times * each for sum_, each in zip(powers, atom[1])]
            sign = signs[-1]
    if len(signs) > 1:
        return None
    return factor, (powers[0], powers[1], powers[2], powers[3], powers[4])


def _atom(symbol: str) -> _Unit | None:
    if symbol in _ATOMS:
        return _ATOMS[symbol]
    prefix, rest = symbol[:1], symbol[1:]
    if prefix in _PREFIXES and rest in _ATOMS:
        factor, powers = _ATOMS[rest]
        return factor * Fraction(10) ** _PREFIXES[prefix], powers
    return None
