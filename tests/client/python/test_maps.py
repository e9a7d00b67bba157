"""Maps of a fluid and spectra of histories."""

import numpy as np
import pytest
import tribodyn

FLUID = "paper-fluid-1"


def test_viscosities_are_rows_of_temperature_and_pressure(client):
    table = client.viscosity(
        FLUID, temperatures_celsius=[40, "373.15 K"], pressures_pascals=[0, "1 GPa"]
    )
    assert list(table["temperature_celsius"]) == pytest.approx([40, 40, 100, 100])
    assert list(table["pressure_pascals"]) == [0, 1e9, 0, 1e9]
    viscosity = table["dynamic_viscosity_pascal_seconds"]
    assert viscosity[0] == table["ambient_dynamic_viscosity_pascal_seconds"][0]
    assert viscosity[1] > 1000 * viscosity[0] and viscosity[2] < viscosity[0]
    assert table["pressure_viscosity_coefficient_per_pascal"][0] == pytest.approx(1.609e-8)
    assert set(table["status"]) == {"OK"}
    assert table.attrs["lubricant_revision"] == "lubricants/paper-fluid-1@1"


def test_a_rig_answers_every_combination_of_its_settings(client):
    table = client.rig(
        FLUID,
        radius_x_metres="12.7 mm",
        mean_pressures_pascals=["0.6 GPa", "0.9 GPa"],
        entrainment_speeds_metres_per_second=2,
        slide_roll_ratios_percent=[0, 10, 50],
        supply_temperatures_celsius=[40, 90],
    )
    assert len(table) == 12
    assert list(table["slide_roll_ratio_percent"][:4]) == [0, 10, 50, 0]
    assert list(table["supply_temperature_celsius"][5:7]) == [40, 90]
    assert list(table["mean_pressure_pascals"][:4]) == pytest.approx([6e8, 6e8, 6e8, 9e8])
    assert table["traction_coefficient"][0] == 0 and table["traction_coefficient"][1] > 0.01


def test_the_warnings_of_a_rig_name_their_rows(client):
    table = client.rig(
        FLUID,
        radius_x_metres="9.525 mm",
        loads_newtons=35,
        entrainment_speeds_metres_per_second=[0.003, 3],
        slide_roll_ratios_percent=50,
        surface="run-in",
        composite_rms_height_metres="20 nm",
    )
    assert table["film_ratio"][0] < 1 < table["film_ratio"][1]
    warning = table.attrs["warnings"]["FILM_RATIO"]
    assert warning["rows"] == [0] and warning["level"] == "caution" and warning["summary"]


def test_draws_give_the_figures_of_a_rig_their_uncertainty(client):
    client.lubricants.create(
        "drawn-oil", FLUID, **{"relaxation_time.standard_uncertainty": "100 ns"}
    )
    settings = {
        "radius_x_metres": "9.525 mm",
        "loads_newtons": 35,
        "entrainment_speeds_metres_per_second": [0.5, 2],
        "slide_roll_ratios_percent": 2,
    }
    assert not any("interval" in name for name in client.rig("drawn-oil", **settings))
    table = client.rig("drawn-oil", draws=99, **settings)
    traction = table["traction_coefficient"]
    assert np.all(table["traction_coefficient_standard_uncertainty"] > 0)
    assert np.all(table["traction_coefficient_interval_minimum"] < traction)
    assert np.all(table["traction_coefficient_interval_maximum"] > traction)
    assert list(table["refused_draws"]) == [0, 0]
    exact = table.attrs["inputs_without_uncertainty"]
    assert exact and not any("relaxation_time" in name for name in exact)


def test_a_spectrum_is_that_of_its_history(client):
    history = client.histories(
        FLUID, ["mesh_force_newtons"], samples_per_mesh_cycle=96, speed_kilometres_per_hour=60
    )
    spectrum = client.read_spectrum(history.attrs["simulation"], maximum_order=48)
    force = np.asarray(history["mesh_force_newtons"])
    transform = np.abs(np.fft.rfft(force))[1:] * 2 / 96
    transform[-1] /= 2
    assert list(spectrum["order"]) == list(range(1, 49))
    assert np.allclose(spectrum["mesh_force_newtons"], transform, atol=1e-9 * force.mean())
    assert spectrum.attrs["means"]["mesh_force_newtons"] == pytest.approx(force.mean())
    assert spectrum.attrs["units"] == {"mesh_force_newtons": "N"}


def test_what_is_wrong_with_a_rig_is_named(client):
    with pytest.raises(tribodyn.TribodynError) as caught:
        client.rig(FLUID, radius_x_metres="1 s", entrainment_speeds_metres_per_second=2)
    assert [each.field for each in caught.value.violations] == ["radius_x_metres"]
    with pytest.raises(tribodyn.TribodynError) as caught:
        client.rig(FLUID, radius_x_metres=0.01, entrainment_speeds_metres_per_second=2)
    assert caught.value.violations[0].field == "grid.loads_newtons"
