"""Drive cycles, and surfaces of measured profiles."""

import asyncio

import numpy as np
import pytest
import tribodyn

FLUID = "paper-fluid-1"
PLACES = {
    "time_seconds": [0, 8, "0.25 min", 20],
    "speed_kilometres_per_hour": [0, "50 km/h", 50, 0],
}


def test_a_cycle_has_energies_by_part_and_columns_of_its_pieces(client):
    table = client.cycle([FLUID, "paper-fluid-2"])
    assert table.attrs["distance_metres"] == pytest.approx(11028, abs=1)
    assert table.attrs["standstill_seconds"] == pytest.approx(280)
    whole, pieces = table.attrs["whole"], table.attrs["pieces"]
    assert list(whole["lubricant"]) == [f"lubricants/{FLUID}@1", "lubricants/paper-fluid-2@1"]
    for i, name in enumerate(whole["lubricant"]):
        power = np.asarray(pieces[f"mesh_loss_power_watts.{name}"])
        energy = float(np.sum(power * np.asarray(pieces["piece_seconds"])))
        assert energy == pytest.approx(whole["loss_joules"][i])
        assert whole["map_error_joules"][i] == 0  # its pieces repeat: each is solved
        assert 0 < whole["solver_error_joules"][i] <= 1e-3 * energy
    first = [i for i, name in enumerate(table["lubricant"]) if name == whole["lubricant"][0]]
    energies = {table["part"][i]: table["loss_joules"][i] for i in first}
    assert energies["all"] == pytest.approx(energies["drive"] + energies["coast"])
    assert np.isnan(table["inefficiency_percent"][1])  # standstill
    assert set(table["status"]) == {"OK"} and table.attrs["not_included"]
    rows = set(range(len(table)))
    assert all(rows.issuperset(each["rows"]) for each in table.attrs["warnings"].values())


def test_a_cycle_of_a_table_equals_that_of_its_file_and_of_the_coroutine(client, server, tmp_path):
    by_piece = client.cycle(FLUID, cycle=PLACES, point_by_point=True)
    path = tmp_path / "own.csv"
    path.write_text("time_seconds;speed_kilometres_per_hour\n0;0\n8;50\n15;50\n20;0\n")

    async def of_file():
        async with tribodyn.aio.Client(server.address) as other:
            return await other.cycle(FLUID, cycle=path, point_by_point=True)

    energy = by_piece.attrs["whole"]["loss_joules"][0]
    assert asyncio.run(of_file()).attrs["whole"]["loss_joules"][0] == energy > 0
    by_map = client.cycle(FLUID, cycle=PLACES).attrs["whole"]
    assert abs(by_map["loss_joules"][0] - energy) <= by_map["map_error_joules"][0]


def test_what_is_wrong_with_a_cycle_is_named_with_its_row(client):
    with pytest.raises(tribodyn.TribodynError) as caught:
        client.cycle(FLUID, cycle={"time_seconds": [0, "5 m"], "gear": [1, 2]})
    assert [each.field for each in caught.value.violations] == ["places[1].time_seconds", "cycle"]
    falling = {"time_seconds": [0, 5, 4], "speed_kilometres_per_hour": [0, 5, -1]}
    with pytest.raises(tribodyn.TribodynError) as caught:
        client.cycle(FLUID, cycle=falling)
    fields = {each.field for each in caught.value.violations}
    assert fields == {"places[2].time_seconds", "places[2].speed_kilometres_per_hour"}


def rough_profile(seed, **flank):
    heights = [0.0]
    for step in np.random.default_rng(seed).normal(size=1999):
        heights.append(0.99 * heights[-1] + 3e-8 * step)
    return tribodyn.Profile(heights, 1e-6, **flank)


def test_six_profiles_are_one_surface_whose_parameters_move_with_the_sampling_interval(client):
    profiles = [
        rough_profile(3 * i + k, member=member, direction="axial")
        for i, member in enumerate(("pinion", "gear"))
        for k in range(3)
    ]
    table = client.roughness(profiles, sampling_steps=[1, 4, 16])
    assert list(table["sampling_step"]) == [1, 4, 16]
    assert list(table["spacing_metres"]) == pytest.approx([1e-6, 4e-6, 16e-6])
    density = np.asarray(table["asperity_density_per_square_metre"])
    assert np.all(np.diff(density) < 0)
    product = density * np.asarray(table["asperity_radius_metres"])
    product *= np.asarray(table["composite_rms_height_metres"])
    assert list(table["roughness_product"]) == pytest.approx(list(product))
    assert np.all(np.asarray(table["standard_uncertainty.composite_rms_height_metres"]) > 0)
    groups = table.attrs["groups"]
    assert list(groups["member"]) == ["pinion", "gear"] and list(groups["profiles"]) == [3, 3]
    assert len(table.attrs["measurements"]["samples"]) == 6


def test_profiles_of_files_state_their_flank(client, tmp_path):
    path = tmp_path / "heel.csv"
    path.write_bytes(rough_profile(1).csv())
    table = client.roughness(f"pinion,axial,{path}")
    assert table.attrs["measurements"]["direction"][0] == "axial"
    assert "SURFACE_PARTLY_MEASURED" in table.attrs["warnings"]
    assert np.isnan(table["standard_uncertainty.roughness_product"][0])
    with pytest.raises(tribodyn.TribodynError) as caught:
        client.roughness(f"pinion,axial,{path}", sampling_steps=[0])
    assert caught.value.violations[0].field == "sampling_steps[0]"
