import asyncio
import json
import os
import subprocess
import sys

import numpy as np
import pandas
import pytest

import tribodyn
from tribodyn import aio

FLUID = "paper-fluid-1"


def test_a_point_is_a_row_with_what_it_rests_on(client):
    point = client.point(FLUID, speed_kilometres_per_hour="20 m/s", sump_temperature_celsius="90 C")
    assert len(point) == 1 and point["status"][0] == "OK"
    assert point["vehicle_speed_kilometres_per_hour"][0] == pytest.approx(72)
    assert 0.5 < point["inefficiency_energy_mean_percent"][0] < 3
    assert len(point.attrs["input_hash"]) == 64
    assert point.attrs["model_version"].startswith("tribodyn-model-")
    assert point.attrs["lubricant"] == "lubricants/paper-fluid-1@1"
    assert 0 < point.attrs["estimated_relative_error"] <= 1e-3
    again = client.point(FLUID, speed_kilometres_per_hour=72, sump_temperature_celsius=90)
    assert again.attrs["cache_hit"] and again.attrs["input_hash"] == point.attrs["input_hash"]


def test_what_a_result_does_not_have_is_nan_and_not_zero(client):
    point = client.point(FLUID, speed_kilometres_per_hour=60)
    assert np.isnan(point["coexisting_response_inefficiency_rms_percent"][0])


def test_sensitivities_are_the_slopes_between_neighbouring_points(client):
    found = client.sensitivities(FLUID, speed_kilometres_per_hour=100)
    rows = {name: i for i, name in enumerate(found["parameter"])}
    figure = "inefficiency_energy_mean_percent"
    slope = found[f"derivative.{figure}"][rows["lubricant.relaxation_time"]]
    times = np.array([4.4e-7, 4.6e-7])
    near = client.evaluate(
        {"lubricant.relaxation_time_seconds": times},
        lubricant=FLUID,
        speed_kilometres_per_hour=100,
        tolerance=1e-5,
    )
    assert slope == pytest.approx(np.diff(near[figure])[0] / 2e-8, rel=0.02)
    assert found.attrs["figures"]["film_ratio.mean"] > 1 and not found.attrs["one_sided"]
    # Derivatives exist where flanks part, too.
    assert len(client.sensitivities(FLUID, speed_kilometres_per_hour=75)) == len(found)


def test_a_curve_has_the_sensitivities_of_its_points(client):
    speeds = [60, 100]
    plain = client.curve(FLUID, speeds_kilometres_per_hour=speeds, independent_points=True)
    curve = client.curve(
        FLUID, speeds_kilometres_per_hour=speeds, independent_points=True, sensitivities=True
    )
    assert len(curve.columns) == len(plain.columns) + 2 * 9 * 28
    point = client.sensitivities(FLUID, speed_kilometres_per_hour=100)
    for i, parameter in enumerate(point["parameter"]):
        for name in ("derivative.mesh_loss_power_watts", "elasticity.film_ratio.mean"):
            assert curve[f"{name}.{parameter}"][1] == point[name][i]
    without = client.curve(
        FLUID, speeds_kilometres_per_hour=[100], model="quasi-static", sensitivities=True
    )
    assert "NO_SENSITIVITIES" in without["warnings"][0]
    assert len(without.columns) == len(plain.columns)


def test_a_torque_and_model_options_are_taken(client):
    coast = client.point(
        FLUID,
        pinion_torque_newton_metres=-60,
        pinion_speed_radians_per_second="2000 rpm",
        model="quasi-static",
        options=tribodyn.Options(
            model_options={
                "isothermal": True,
                "pressure_viscosity_index": "houpert",
                "as_published": {"eq17_atan": True},
            }
        ),
    )
    assert coast["model"][0] == "quasi-static" and coast["pinion_torque_newton_metres"][0] == -60


def test_a_comparison_is_one_table_with_the_same_bits_as_curves(client):
    speeds = [20, 60, 100]
    both = client.compare(
        [FLUID, "paper-fluid-2"], speeds_kilometres_per_hour=speeds, direction="down"
    )
    assert list(both["lubricant"]) == [FLUID] * 3 + ["paper-fluid-2"] * 3
    one = client.curve(
        "paper-fluid-2", speeds_kilometres_per_hour=np.array(speeds), direction="down"
    )
    assert list(both["mesh_loss_power_watts"][3:]) == list(one["mesh_loss_power_watts"])
    assert both.attrs["results"]["paper-fluid-2"]["input_hash"] == one.attrs["input_hash"]


def test_a_refused_lubricant_refuses_a_comparison(client):
    with pytest.raises(tribodyn.TribodynError) as caught:
        client.compare([FLUID, "nothing"], speeds_kilometres_per_hour=[33, 34])
    assert caught.value.violations[0].field == "simulation.lubricant"


def test_lubricants_are_compared_with_the_uncertainty_of_their_inputs(client):
    client.lubricants.create("sheet", kv40=103, kv100=15.1, density15=868, base_oil_class="pao")
    client.lubricants.create("other", kv40=95, kv100=14.1, density15=862, base_oil_class="pao")
    found = client.compare_points(
        ["sheet", "other"],
        speeds_kilometres_per_hour=[40, "20 m/s"],
        sump_temperatures_celsius=[40, 90],
        speed_weights=[3, 1],
        draws=39,
        contact_figures=True,
    )
    assert list(found["lubricant"]) == ["lubricants/sheet@1"] * 4 + ["lubricants/other@1"] * 4
    assert list(found["speed_kilometres_per_hour"][:4]) == [40, 72, 40, 72]
    assert list(found["sump_temperature_celsius"][:4]) == [40, 40, 90, 90]
    assert set(found["status"]) == {"OK"} and list(found["verdict"][:4]) == [""] * 4
    figure = "inefficiency_energy_mean_percent"
    assert found["uncertainty_stated"].all() and (found[f"{figure}_standard_uncertainty"] > 0).all()
    assert (found["mesh_friction_coefficient_value"] > 0).all()
    assert set(found["verdict"][4:]) <= {"lower", "higher", "cannot-be-told-apart"}
    values = found[f"{figure}_value"]
    difference = found["difference_percent_value"]
    assert difference[4] == pytest.approx(values[4] - values[0], rel=1e-9)
    mean = found.attrs["mean"]
    weighted = [(3 * v[0] + v[1] + 3 * v[2] + v[3]) / 8 for v in (values[:4], list(values[4:]))]
    assert list(mean["mean_inefficiency_percent_value"]) == pytest.approx(weighted, rel=1e-9)
    assert "pressure_viscosity_coefficient" in mean["measure_first"][1]
    assert all(set(each["rows"]) <= set(range(8)) for each in found.attrs["warnings"].values())
    assert found.attrs["not_included"]
    with pytest.raises(tribodyn.TribodynError) as caught:
        client.compare_points([FLUID], speeds_kilometres_per_hour=["fast"], speed_weights=[1, 2])
    assert len(caught.value.violations) == 2


def test_without_a_stated_uncertainty_there_is_a_difference_and_no_verdict(client):
    oils = {"certain-1": "paper-fluid-1", "certain-2": "paper-fluid-2"}
    for name, like in oils.items():
        oil = client.lubricants.get(like)
        oil.ClearField("provenance")
        client.lubricants.create(name, oil)
    found = client.compare_points(list(oils), draws=39)
    assert list(found["verdict"]) == ["", "uncertainty-not-stated"]
    assert not found["uncertainty_stated"].any() and found["difference_percent_value"][1] != 0
    for name in ("difference_percent_interval_minimum", "lower_probability"):
        assert np.isnan(found[name][1])
    assert np.isnan(found.attrs["mean"]["best_probability"]).all()


def test_a_warning_that_withholds_the_verdict_names_its_rows(client):
    code, paper = "INLET_HEATING_LEFT_OUT", {"preset": "paper"}
    cold = {"speed_kilometres_per_hour": 110, "sump_temperature_celsius": -20}
    table = [{**cold, "lubricant": "nothing"}, {**cold, "lubricant": FLUID}]
    by_jobs = client.points(table, options=tribodyn.Options(model_options=paper))
    screened = client.evaluate(table, model_options=paper)
    for found in (by_jobs, screened):
        warning = found.attrs["warnings"][code]
        assert warning["level"] == "withholds-verdict" and warning["rows"] == [1]
        assert warning["summary"] and warning["message"] and found["verdict_withheld"][1]
    assert screened.attrs["not_included"]
    compared = client.compare_points(
        [FLUID, "paper-fluid-2"],
        speeds_kilometres_per_hour=[110],
        sump_temperatures_celsius=[-20],
        model_options=paper,
        draws=39,
    )
    assert compared.attrs["warnings"][code]["rows"] == [0, 1]
    recommended = client.evaluate(table)
    assert code not in recommended.attrs["warnings"]
    figure = "inefficiency_energy_mean_percent"
    assert recommended[figure][1] > screened[figure][1]


def test_a_difference_is_explained_by_groups_of_parameters(client):
    speeds = [40, 100]
    why = client.explain("paper-fluid-1", "paper-fluid-2", speeds_kilometres_per_hour=speeds)
    assert len(why) == 12 and set(why["status"]) == {"OK"}
    assert list(why["group"][:6]) == [
        "viscosity",
        "pressure-response",
        "shear-thinning",
        "limiting-stress",
        "thermal-properties",
        "boundary-film",
    ]
    share = "inefficiency_percent_shapley_value_value"
    near = client.evaluate(
        {"lubricant": ["paper-fluid-1", "paper-fluid-2"]}, speed_kilometres_per_hour=40
    )
    values = near["inefficiency_energy_mean_percent"]
    assert sum(why[share][:6]) == pytest.approx(values[1] - values[0], abs=1e-3)
    mean = why.attrs["mean"]
    assert sum(mean[share]) == pytest.approx(why.attrs["inefficiency_difference_percent"], abs=1e-9)
    assert len(why.attrs["interactions"]) == 15 and why.attrs["model_version"]
    with pytest.raises(tribodyn.TribodynError) as caught:
        client.explain(FLUID, "nothing")
    assert caught.value.violations[0].field.startswith("other_lubricant")


def test_a_difference_is_explained_asynchronously(server):
    async def why():
        async with aio.Client(server.address) as client:
            return await client.explain("paper-fluid-1", "paper-fluid-2")

    assert len(asyncio.run(why())) == 6


def test_histories_have_units_in_their_columns(client):
    history = client.histories(
        FLUID,
        ["time_seconds", "mesh_force_newtons"],
        mesh_cycles=2,
        samples_per_mesh_cycle=96,
        speed_kilometres_per_hour=60,
    )
    assert list(history.columns) == ["time_seconds", "mesh_force_newtons"] and len(history) == 192
    assert history.attrs["units"]["mesh_force_newtons"] == "N" and history.attrs["input_hash"]
    name = history.attrs["simulation"]
    part = client.read_history(name, columns=["mesh_force_newtons"], start_row=100, row_count=5)
    assert list(part["mesh_force_newtons"]) == list(history["mesh_force_newtons"][100:105])
    envelope = client.read_history(name, max_points=10)
    assert envelope.attrs["rows_per_pair"] > 0 and len(envelope) <= 10


def test_all_wrong_arguments_are_reported_together(client):
    with pytest.raises(tribodyn.TribodynError) as caught:
        client.point(
            FLUID,
            speed_kilometres_per_hour="5,4",
            model="best",
            options=tribodyn.Options(model_options={"isothermic": True}),
        )
    assert caught.value.reason == "INVALID_FIELDS"
    assert [each.field for each in caught.value.violations] == [
        "model_options.isothermic",
        "speed_kilometres_per_hour",
        "model",
    ]
    with pytest.raises(tribodyn.TribodynError) as caught:
        client.point(FLUID, speed_kilometres_per_hour=5000, sump_temperature_celsius=900)
    assert [(each.value, each.allowed) for each in caught.value.violations] == [
        ("900 C", "-70 to 200 C"),
        ("5000 km/h", "0.1 to 400 km/h"),
    ]


def test_rows_of_points_have_the_bits_of_single_points(client):
    table = pandas.DataFrame(
        {
            "speed_kilometres_per_hour": [90, 30, "25 m/s", 30],
            "sump_temperature_celsius": [90, 90, 90, np.nan],
            "note": list("abcd"),
        },
        index=[7, 5, 3, 1],
    )
    points = client.points(table, lubricant=FLUID, sump_temperature_celsius="50 C")
    assert list(points.index) == [7, 5, 3, 1] and list(points["note"]) == list("abcd")
    losses = list(points["mesh_loss_power_watts"])
    assert losses[0] == losses[2] and losses[1] != losses[3]
    single = client.point(FLUID, speed_kilometres_per_hour=30, sump_temperature_celsius=50)
    assert losses[3] == single["mesh_loss_power_watts"][0]
    alone = client.point(FLUID, speed_kilometres_per_hour=90, sump_temperature_celsius=90)
    assert losses[0] == alone["mesh_loss_power_watts"][0]


def test_a_row_that_fails_has_nan_and_its_reason(client):
    points = client.points(
        [
            {"speed_kilometres_per_hour": 40},
            {"speed_kilometres_per_hour": -4},
            {"speed_kilometres_per_hour": 50, "lubricant": "nothing"},
            {"speed_kilometres_per_hour": "fast"},
            {"speed_kilometres_per_hour": 60},
            {"pinion_torque_newton_metres": 50, "pinion_speed_radians_per_second": 200},
            {},
        ],
        lubricant=FLUID,
    )
    assert list(points["status"]) == [
        "OK",
        "INVALID_FIELDS",
        "INVALID_FIELDS",
        "INVALID_FIELDS",
        "OK",
        "OK",
        "INVALID_FIELDS",
    ]
    assert list(np.isnan(points["mesh_loss_power_watts"])) == [
        False,
        True,
        True,
        True,
        False,
        False,
        True,
    ]
    assert "0.1 to 400 km/h" in points["status_message"][1]
    assert "lubricants/nothing" in points["status_message"][2]


def test_variants_are_screened_without_jobs(client):
    before = client.point(FLUID, speed_kilometres_per_hour=40)
    table = pandas.DataFrame(
        {
            "lubricant.alpha": ["15/GPa", "18/GPa", None, "18/GPa"],
            "surface.asperity_friction_coefficient": [0.1, 0.12, np.nan, 0.12],
            "speed_kilometres_per_hour": [40, 40, 40, "20 m/s"],
            "cost": [1, 2, 3, 4],
        },
        index=[4, 3, 2, 1],
    )
    found = client.evaluate(table, lubricant=FLUID, surface="run-in")
    assert list(found.index) == [4, 3, 2, 1] and list(found["cost"]) == [1, 2, 3, 4]
    assert list(found["status"]) == ["OK"] * 4 and list(found["model"]) == ["full"] * 4
    losses = found["mesh_loss_power_watts"]
    assert len(set(losses)) == 4
    base = client.point(FLUID, speed_kilometres_per_hour=40)
    jobs = [int(each.attrs["simulation"].split("/")[1]) for each in (before, base)]
    assert jobs[1] == jobs[0] + 1
    error = base["estimated_relative_error"][0] + found["estimated_relative_error"][2]
    assert losses[2] == pytest.approx(base["mesh_loss_power_watts"][0], rel=error)
    assert "lubricants/paper-fluid-1@1" in found.attrs["revisions"]
    assert found.attrs["model_version"] == base.attrs["model_version"]


def test_a_variant_is_the_lubricant_with_that_parameter(client):
    client.lubricants.create("variant", FLUID, relaxation_time="300 ns")
    speeds = {"speed_kilometres_per_hour": [40, 90]}
    found = client.evaluate(speeds, lubricant=FLUID, **{"lubricant.relaxation_time": "300 ns"})
    kept = client.evaluate(speeds, lubricant="variant")
    assert list(found["mesh_loss_power_watts"]) == list(kept["mesh_loss_power_watts"])


def test_variants_have_contact_figures_and_gradients_on_request(client):
    alpha = "lubricant.pressure_viscosity_coefficient_per_pascal"
    table = {"speed_kilometres_per_hour": [30, 30, -30], "lubricant.alpha": ["15/GPa", "18/GPa", None]}
    found = client.evaluate(
        table,
        lubricant=FLUID,
        contact_figures=True,
        elasticities=["lubricant.alpha", "surface.asperity_friction_coefficient"],
        elasticity_figures=["film_ratio_mean", "mesh_loss_power_watts"],
    )
    films = np.asarray(found["film_ratio_mean"])
    assert 0 < found["film_ratio_minimum"][0] < films[0] < films[1] and np.isnan(films[2])
    losses = found["viscous_loss_power_watts"] + found["boundary_loss_power_watts"]
    assert losses[0] == pytest.approx(found["mesh_loss_power_watts"][0], rel=3e-3)
    assert 300 < found["contact_temperature_mean_kelvin"][0] < 500
    assert 0.005 < found["mean_friction_coefficient"][1] < 0.1
    exponent = np.log(films[1] / films[0]) / np.log(18 / 15)
    slopes = np.asarray(found[f"elasticity.film_ratio_mean.{alpha}"])
    assert min(slopes[:2]) - 0.01 < exponent < max(slopes[:2]) + 0.01
    assert not found["elasticities_one_sided"][0]
    friction = "elasticity.mesh_loss_power_watts.surface.asperity_friction_coefficient"
    assert 0 < found[friction][0] < 1
    with pytest.raises(tribodyn.TribodynError, match="lubricant.alfa"):
        client.evaluate(table, lubricant=FLUID, elasticities="lubricant.alfa")
    shared = [
        "gear_set.youngs_modulus_pascals",
        "sump_temperature_celsius",
        "speed_kilometres_per_hour",
        "wheel_torque_newton_metres",
        "inlet_temperature_rise_kelvin",
    ]
    found = client.evaluate(
        {"speed_kilometres_per_hour": [100]},
        lubricant=FLUID,
        elasticities=shared,
        elasticity_figures="pinion_friction_torque_mean_newton_metres",
    )
    for name in shared:
        assert found[f"elasticity.pinion_friction_torque_mean_newton_metres.{name}"][0] != 0


def test_a_refused_variant_leaves_the_others(client):
    alpha = "lubricant.havriliak_negami_alpha"
    found = client.evaluate(
        [
            {"speed_kilometres_per_hour": 40},
            {"speed_kilometres_per_hour": -40},
            {"speed_kilometres_per_hour": 50, alpha: 0.5},
            {"speed_kilometres_per_hour": 50, alpha: 50},
            {"speed_kilometres_per_hour": 500, alpha: 0.5},
            {"speed_kilometres_per_hour": 50, "lubricant": "nothing"},
            {"speed_kilometres_per_hour": 50, "lubricant.kv40": 5},
            {"speed_kilometres_per_hour": 50, "lubricant.vogel_reference_temperature": "350 K"},
            {"speed_kilometres_per_hour": "fast"},
        ],
        lubricant=FLUID,
    )
    assert list(found["status"] == "OK") == [True, False, True] + [False] * 6
    assert list(np.isnan(found["mesh_loss_power_watts"])) == [False, True, False] + [True] * 6
    messages = found["status_message"]
    for row, part in {1: "-40 km/h", 3: "havriliak_negami_alpha = 50", 5: "lubricants/nothing"}.items():
        assert part in messages[row]
    assert "kv40" in messages[6] and "350 K" in messages[7] and "fast" in messages[8]


def test_a_thousand_variants_are_screened_in_their_order(client):
    count = 1200
    friction = 0.05 + 1e-4 * np.arange(count)
    table = {
        "surface.asperity_friction_coefficient": friction,
        "speed_kilometres_per_hour": [60, 80] * (count // 2),
    }
    found = client.evaluate(table, lubricant=FLUID, model_options={"isothermal": True})
    losses = np.asarray(found["mesh_loss_power_watts"])
    assert (np.diff(losses[0::2]) > 0).all() and (np.diff(losses[1::2]) > 0).all()
    with pytest.raises(TypeError, match="speed"):
        client.evaluate(table, speed=3)


def test_a_server_that_is_not_there_is_an_error_and_not_a_status_of_rows():
    nobody = tribodyn.Client("127.0.0.1:1")
    rows = {"lubricant": [FLUID] * 2, "speed_kilometres_per_hour": [40, 60]}
    for call in (nobody.points, nobody.evaluate):
        with pytest.raises(tribodyn.TribodynError) as caught:
            call(rows)
        assert caught.value.reason == "CANNOT_CONNECT"


def test_results_are_structured_arrays_without_pandas(server):
    code = """
import sys
sys.modules["pandas"] = sys.modules["tqdm"] = sys.modules["tqdm.auto"] = None
import json, tribodyn
client = tribodyn.Client(progress="auto")
table = client.compare(["paper-fluid-1"], speeds_kilometres_per_hour=[20, 60])
rows = client.evaluate({"speed_kilometres_per_hour": [20, -1]}, lubricant="paper-fluid-1")
campaign = client.screen({"lubricant.relaxation_time": ["1 ns", "2 ns"], "additive": ["x", "y"]},
                         "paper-fluid-1")
campaign.wait()
kept = campaign.frame()
print(json.dumps([type(table).__name__, list(table["speed_kilometres_per_hour"]),
                  list(table.attrs["results"]), list(rows["status"]), list(kept["additive"]),
                  list(kept["status"]), len(campaign.ranking())]))
"""
    found = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "TRIBODYN_SERVER": server.address},
    )
    assert json.loads(found.stdout) == [
        "Table",
        [20, 60],
        ["paper-fluid-1"],
        ["OK", "INVALID_FIELDS"],
        ["x", "y"],
        ["OK", "OK"],
        2,
    ]
    assert found.stderr == ""
