import numpy as np
import pandas
import pytest

import tribodyn


def test_a_lubricant_is_made_from_its_data_sheet(client):
    oil = client.lubricants.create(
        "sheet-oil",
        kv40=103,
        kv100="15.1 cSt",
        density15="0.868 g/cm3",
        base_oil_class="PAO",
        title="An oil",
        **{"brookfield_-40_C": 98000, "labels.project": "axle"},
    )
    assert oil.name == "lubricants/sheet-oil" and oil.display_name == "An oil"
    assert oil.characterisation.sae_j306_grade == "75W-90"
    assert oil.measurements.density_15_celsius_kilograms_per_cubic_metre == 868
    assert client.lubricants.get("sheet-oil") == oil


def test_measurements_are_texts_with_units(client):
    oil = client.lubricants.create(
        "table-oil",
        viscosities="205 mm2/s at 20 C +- 0.01; 60 mPa s at 40 C; 8.86 cSt at 100 C",
        densities="0.87 g/cm3 at 15 C",
        base_oil_class="group III",
        **{
            "relaxation_time_seconds": "450 ns",
            "relaxation_time.standard_uncertainty": "10 ns",
            "relaxation_time_seconds.provenance": "measured",
        },
    )
    first, second, _ = oil.measurements.viscosities
    assert first.relative_standard_uncertainty == 0.01
    assert second.dynamic_viscosity_millipascal_seconds == 60
    (origin,) = [each for each in oil.provenance if each.field == "relaxation_time_seconds"]
    assert origin.standard_uncertainty == pytest.approx(1e-8) and origin.provenance == 4


def test_an_update_changes_the_stated_fields_only(client):
    before = client.lubricants.create("update-oil", "paper-fluid-1", **{"labels.a": "1"})
    after = client.lubricants.update("update-oil", relaxation_time="400 ns", **{"labels.b": "2"})
    assert after.revision == 2 and after.relaxation_time_seconds == 4e-7
    assert {each.key: each.value for each in after.labels} == {"a": "1", "b": "2"}
    assert after.limiting_shear_stress_coefficient == before.limiting_shear_stress_coefficient
    assert {each.field for each in before.provenance} == {each.field for each in after.provenance}
    cleared = client.lubricants.update("update-oil", display_name=None, **{"labels.a": None})
    assert [each.key for each in cleared.labels] == ["b"] and cleared.display_name == ""
    assert client.lubricants.get("update-oil@2").revision == 2


def test_a_deleted_resource_is_not_listed_until_it_is_undeleted(client):
    client.surfaces.create("gone", "run-in", composite_rms_height="0.5 um")
    client.surfaces.delete("gone")
    assert "surfaces/gone" not in [each.name for each in client.surfaces.list()]
    assert "surfaces/gone" in [each.name for each in client.surfaces.list(show_deleted=True)]
    client.surfaces.undelete("gone")
    assert client.surfaces.get("gone").composite_rms_height_metres == 5e-7


def test_a_table_of_data_sheets_is_imported_from_a_file_or_a_data_frame(client, tmp_path):
    file = tmp_path / "oils.csv"
    file.write_text(
        "# from the laboratory\n"
        "name;KV40;kv100;Density15 (g/cm3);base_oil_class;labels.project\n"
        "file-1;73,3;8,86;0,87;Gr. III;axle\n"
        "file-2;103;15,1;;ester;\n"
    )
    assert client.lubricants.import_table(file) == ["lubricants/file-1", "lubricants/file-2"]
    first = client.lubricants.get("file-1")
    assert first.measurements.density_15_celsius_kilograms_per_cubic_metre == 870
    table = pandas.DataFrame(
        {
            "name": ["file-1", "file-3"],
            "kv40": [75.0, 60.0],
            "kv100": [9.0, 8.0],
            "density15": [np.nan, 860.0],
        }
    )
    with pytest.raises(tribodyn.TribodynError, match="file-1"):
        client.lubricants.import_table(table)
    client.lubricants.import_table(table, replace=True)
    changed = client.lubricants.get("file-1")
    assert changed.measurements.density_15_celsius_kilograms_per_cubic_metre == 870
    assert changed.measurements.kinematic_viscosity_40_celsius_square_millimetres_per_second == 75
    found = client.lubricants.frame('labels.project = "axle"')
    assert "lubricants/file-1" in list(found["name"])


def test_an_import_reports_everything_that_is_wrong_and_writes_nothing(client):
    rows = [{"name": "wrong-1", "kv40": 73.3, "kv1000": 8.86}, {"name": "wrong-2", "kv40": "7x"}]
    with pytest.raises(tribodyn.TribodynError) as caught:
        client.lubricants.import_table(rows)
    assert [each.field for each in caught.value.violations] == [
        "column kv1000",
        "row 2 (wrong-2), kv40",
    ]
    assert "kv100 " in str(caught.value)
    with pytest.raises(tribodyn.TribodynError) as caught:
        client.lubricants.import_table(
            [
                {"name": "fine", "kv40": 73.3, "kv100": 8.86},
                {"name": "light", "kv40": 73.3, "kv100": 8.86, "density15": "8.7 kg/m3"},
            ]
        )
    (wrong,) = caught.value.violations
    assert wrong.field.startswith("row 2 (light), ") and "8.7 kg/m3" in wrong.description
    assert "lubricants/fine" not in [each.name for each in client.lubricants.list()]


def test_a_gear_set_takes_nested_messages_in_the_form_of_json(client):
    base = client.gear_sets.get("reference-axle")
    copy = client.gear_sets.create(
        "copied-axle", "reference-axle", dynamics=base.dynamics, description="as the reference"
    )
    assert copy.dynamics == base.dynamics and copy.series == base.series


def test_lists_hide_their_pages(client):
    car = client.vehicles.get("passenger-car")
    stated = {
        field.name: value
        for field, value in car.ListFields()
        if field.cpp_type == field.CPPTYPE_DOUBLE
    }
    client.vehicles.import_table([{**stated, "name": f"car-{i}"} for i in range(1100)])
    names = {each.name for each in client.vehicles.list()}
    assert {f"vehicles/car-{i}" for i in range(1100)} <= names
    assert len(client.vehicles.list(limit=7)) == 7


def test_a_project_has_its_own_resources_under_short_names(server, client):
    with tribodyn.Client(server.address, project="axles") as axles:
        axles.lubricants.create("axle-oil", "paper-fluid-1", relaxation_time="300 ns")
        assert axles.lubricants.get("axle-oil").name == "lubricants/axle-oil"
        assert "lubricants/axle-oil" in [each.name for each in axles.lubricants.list()]
        point = axles.point("axle-oil", speed_kilometres_per_hour=60)
        assert point.attrs["lubricant"] == "lubricants/axle-oil@1"
        axles.histories("axle-oil", ["time_seconds"], speed_kilometres_per_hour=60)
    with pytest.raises(tribodyn.TribodynError) as caught:
        client.lubricants.get("axle-oil")
    assert caught.value.reason == "NOT_FOUND" and caught.value.code == "NOT_FOUND"
