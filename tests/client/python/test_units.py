import re

import pytest
from conftest import TREE

from tribodyn import QuantityError, quantity, units


@pytest.mark.parametrize(
    "text, name, value",
    [
        ("90 C", "sump_temperature_celsius", 90),
        ("363.15 K", "sump_temperature_celsius", 90),
        ("194 F", "sump_temperature_celsius", 90),
        ("70C", "rheology_reference_temperature_kelvin", 343.15),
        ("20", "inlet_temperature_rise_kelvin", 20),
        ("5.4 mPa s", "viscosity_pascal_seconds", 5.4e-3),
        ("5.4 mPas", "viscosity_millipascal_seconds", 5.4),
        ("98Pas", "viscosity_millipascal_seconds", 98000),
        ("73.3 cSt", "viscosity_square_millimetres_per_second", 73.3),
        ("20/GPa", "pressure_viscosity_coefficient_per_pascal", 2e-8),
        ("20 GPa^-1", "pressure_viscosity_coefficient_per_pascal", 2e-8),
        ("0.868g/cm3", "density_kilograms_per_cubic_metre", 868),
        ("20 m/s", "speed_kilometres_per_hour", 72),
        ("6%", "ascent_angle_degrees", 3.433630362450522),
        ("0.14 W/mK", "thermal_conductivity_watts_per_metre_kelvin", 0.14),
        ("2500/mm2", "asperity_density_per_square_metre", 2.5e9),
        ("450 ns", "relaxation_time_seconds", 4.5e-7),
        (72.5, "speed_kilometres_per_hour", 72.5),
    ],
)
def test_a_text_has_its_own_unit_and_a_number_that_of_the_name(text, name, value):
    assert quantity(text, name) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    "text, name",
    [
        ("fast", "speed_kilometres_per_hour"),
        ("3 kg", "speed_kilometres_per_hour"),
        ("90 m", "sump_temperature_celsius"),
        ("3 Pa", "havriliak_negami_alpha"),
        ("1 ((((((((((((m", "radius_metres"),
        (True, "speed_kilometres_per_hour"),
    ],
)
def test_a_wrong_quantity_is_refused(text, name):
    with pytest.raises(QuantityError):
        quantity(text, name)
    with pytest.raises(QuantityError, match="7.3$"):
        quantity("7,3", "speed_kilometres_per_hour")


def test_unit_words_are_those_of_the_command_line():
    source = (TREE / "client/cpp/text/units.cpp").read_text()
    table = source[source.index("kUnitWords = {{") : source.index("}};")]
    assert dict(re.findall(r'\{"(\w+)", "([^"]+)"\}', table)) == units._UNIT_WORDS
