import asyncio
import os
import re
import resource
import warnings
from pathlib import Path

import numpy as np
import pandas
import pytest

import tribodyn
from test_connection import InThread, wait_until
from tribodyn import _decisions, aio
from tribodyn._columns import read_columns
from tribodyn._stored_campaign import MOST_BYTES
from tribodyn.v1.campaigns_pb2 import ReadCampaignRequest

FLUID = "paper-fluid-1"
FIGURE = "inefficiency_energy_mean_percent"


def variants(count):
    return pandas.DataFrame(
        {
            "name": [f"v{i}" for i in range(count)],
            "treat rate": np.linspace(0, 2, count),
            "lubricant.relaxation_time": [f"{100 + i} ns" for i in range(count)],
            "surface.asperity_friction_coefficient": [0.1] * (count - 1) + [np.nan],
        }
    )


def test_a_campaign_is_a_table_of_candidates_at_conditions(client):
    campaign = client.screen(
        variants(40),
        FLUID,
        speeds_kilometres_per_hour=[40, "20 m/s"],
        sump_temperatures_celsius=[90],
        speed_weights=[3, 1],
        display_name="variants",
    )
    campaign.wait()
    assert campaign.state == "succeeded" and campaign.message.display_name == "variants"
    points = campaign.frame()
    assert list(points["name"][:4]) == ["v0", "v0", "v1", "v1"]
    assert list(points["speed_kilometres_per_hour"][:3]) == [40, 72, 40]
    assert set(points["status"]) == {"OK"} and set(points["model"]) == {"full"}
    assert set(points["inlet_temperature_rise_kelvin"]) == {20}
    assert points["treat_rate"].iloc[-1] == 2 and points["settled"].dtype == bool
    usual = client.surfaces.get("run-in").asperity_friction_coefficient
    assert points["surface.asperity_friction_coefficient"].iloc[-1] == usual
    one = client.evaluate(
        {"speed_kilometres_per_hour": [40, 72]},
        lubricant=FLUID,
        sump_temperature_celsius=90,
        **{"lubricant.relaxation_time": "107 ns", "surface.asperity_friction_coefficient": 0.1},
    )
    losses = points["mesh_loss_power_watts"]
    assert list(losses[14:16]) == pytest.approx(list(one["mesh_loss_power_watts"]), rel=2e-3)
    part = campaign.frame(["candidate", "mesh_loss_power_watts"], start_row=5, row_count=3)
    assert list(part["candidate"]) == [2, 3, 3] and part.attrs["start_row"] == 5
    assert list(part["mesh_loss_power_watts"]) == list(losses[5:8])
    ranking = campaign.ranking()
    means = ranking["inefficiency_energy_mean_percent"]
    assert len(ranking) == 40 and (np.diff(means) >= 0).all()
    best = points[points["name"] == ranking["name"][0]]["inefficiency_energy_mean_percent"]
    assert means[0] == pytest.approx(0.75 * best.iloc[0] + 0.25 * best.iloc[1], rel=1e-12)
    with pytest.raises(tribodyn.TribodynError, match="mesh_loss"):
        campaign.frame(["mesh_loss"])


def test_a_ranking_in_pages_is_the_ranking_at_once(client, monkeypatch):
    campaign = client.screen(variants(40), FLUID)
    campaign.wait()
    at_once = campaign.ranking(count=None)
    assert len(at_once) == 40 and sorted(at_once["candidate"]) == list(range(40))
    monkeypatch.setattr(_decisions, "_LARGEST_PAGE", 7)
    for count in (None, 7, 20):
        in_pages = campaign.ranking(count=count)
        assert len(in_pages) == (count or 40)
        pandas.testing.assert_frame_equal(in_pages, at_once.head(len(in_pages)))


def test_candidates_that_do_not_fit_one_campaign_are_refused_before_they_are_sent(client):
    campaign = client.screen(variants(2), FLUID)
    long = pandas.DataFrame({"name": ["v"], "treat rate": [1.0], "remark": ["x" * (33 << 20)]})
    with pytest.raises(tribodyn.TribodynError) as refused:
        campaign.append(long)
    assert [each.field for each in refused.value.violations] == ["table"]
    assert refused.value.code == "", "nothing was sent"
    contract = Path(os.environ["TRIBODYN_TREE"], "proto/tribodyn/v1/campaigns.proto").read_text()
    assert set(re.findall(r"\(max_request_bytes\) = (\d+);", contract)) == {str(MOST_BYTES)}


def test_a_campaign_has_contact_figures_and_elasticities_on_request(client):
    campaign = client.screen(
        variants(4),
        FLUID,
        speeds_kilometres_per_hour=[30],
        contact_figures=True,
        elasticities=["lubricant.relaxation_time"],
        elasticity_figures=["inefficiency_energy_mean_percent", "film_ratio_mean"],
    )
    campaign.wait()
    points = campaign.frame()
    assert (points["film_ratio_minimum"] < points["film_ratio_mean"]).all()
    name = "elasticity.inefficiency_energy_mean_percent.lubricant.relaxation_time_seconds"
    times, losses = 100 + np.arange(3), np.log(points["inefficiency_energy_mean_percent"][:3])
    exponents = np.diff(losses) / np.diff(np.log(times))
    assert list(points[name][:2]) == pytest.approx(list(exponents), abs=2e-3)
    assert points["elasticities_one_sided"].dtype == bool
    only = campaign.frame(["elasticity.film_ratio_mean.lubricant.relaxation_time_seconds"])
    assert len(only) == 4


def test_the_client_has_the_columns_that_the_server_keeps(client):
    """Those of a campaign of the axle with all that it may have, and those of one of a rig."""
    table = variants(2).drop(columns="surface.asperity_friction_coefficient")
    rig = tribodyn.Rig("12.7mm", entrainment_speeds_metres_per_second=2, loads_newtons=35)
    of_axle = client.screen(
        table, FLUID, contact_figures=True, elasticities=["lubricant.relaxation_time_seconds"]
    )
    for campaign in (of_axle, client.screen(table, FLUID, rig=rig)):
        campaign.wait()
        names = list(campaign.frame())
        kept = asyncio.run(kept_columns(client.server, campaign.name))
        assert kept[0] == "refusal_number" and names[-2:] == ["status", "status_message"]
        first = min(names.index(name) for name in kept[1:])
        assert sorted(names[first:-2]) == sorted(kept[1:])


def test_cells_of_a_surface_are_all_stated_if_a_rig_has_smooth_specimens(client):
    rig = tribodyn.Rig("12.7mm", entrainment_speeds_metres_per_second=2, loads_newtons=35)
    with pytest.raises(tribodyn.TribodynError) as caught:
        client.screen(variants(2), FLUID, rig=rig)  # the last row has no friction coefficient
    (violation,) = caught.value.violations
    assert violation.field == "surface.asperity_friction_coefficient"


def test_cells_of_a_parameter_are_all_stated_if_the_base_has_none(client):
    with pytest.raises(tribodyn.TribodynError) as caught:
        client.screen({"lubricant.asperity_friction_coefficient": [0.1, None]}, FLUID)
    (violation,) = caught.value.violations
    assert violation.field == "lubricant.asperity_friction_coefficient"


async def kept_columns(server, campaign):
    async with aio.Client(server) as client:
        schema, _ = await read_columns(
            client._transport,
            "CampaignService",
            "ReadCampaign",
            ReadCampaignRequest(name=campaign),
        )
        return [each.name for each in schema.columns]


def test_the_same_call_again_finds_its_campaign(client):
    first = client.screen(variants(3), FLUID)
    again = client.screen(variants(3), FLUID, budget_points=0)
    other = client.screen(variants(3), FLUID, sump_temperatures_celsius=[41])
    assert first.name == again.name != other.name
    assert client.campaign(first.name).message.request_id.startswith("screen-")
    names = [each.name for each in client.campaigns(limit=2)]
    assert names == [other.name, first.name]
    for each in (first, other):
        each.delete()
    with pytest.raises(tribodyn.TribodynError) as caught:
        client.campaign(first.name)
    assert caught.value.reason == "NOT_FOUND"


def test_what_decides_no_figure_makes_no_new_campaign(client):
    table = {"name": ["a", "b"], "cost": [2.0, 3.0], "lubricant.relaxation_time": ["91 ns", "92 ns"]}
    first = client.screen(table, FLUID, speeds_kilometres_per_hour=[40, 60], labels={"a": "1"})
    first.wait()
    other = {**table, "name": ["c", "d"], "cost": [5.0, 4.0], "additive": ["x", "y"]}
    again = client.screen(
        other,
        FLUID,
        speeds_kilometres_per_hour=[40, 60],
        speed_weights=[3, 1],
        display_name="again",
        labels={"b": "2"},
    )
    assert again.name == first.name and again.message.points_done == first.message.points
    assert again.message.display_name == "again" and again.message.labels[0].key == "b"
    assert list(again.message.condition_weights) == [3, 1]
    ranking = again.ranking()
    assert sorted(ranking["name"]) == ["c", "d"] and set(ranking["additive"]) == {"x", "y"}
    changed = {**table, "lubricant.relaxation_time": ["91 ns", "93 ns"]}
    assert client.screen(changed, FLUID, speeds_kilometres_per_hour=[40, 60]).name != first.name


def test_columns_that_look_like_inputs_are_refused_unless_they_are_carried(client):
    def refused(call, column, **more):
        with pytest.raises(tribodyn.TribodynError) as caught:
            call({**more, column: [60, 200]})
        return caught.value.reason == "INVALID_FIELDS" and caught.value.violations[0].field == column

    def screen(table, **more):
        return client.screen(table, FLUID, **more)

    def evaluate(table, **more):
        return client.evaluate(table, lubricant=FLUID, speed_kilometres_per_hour=50, **more)

    def points(table, **more):
        return client.points(table, lubricant=FLUID, speed_kilometres_per_hour=50, **more)

    for column in (
        "kv40",
        "KV 100 (mm2/s)",
        "pressure_viscosity_coefficient",
        "pressure-viscosity (1/GPa)",
        "relaxation_tmie_seconds",
        "gear_sets",
    ):
        for call in (screen, evaluate, points):
            assert refused(call, column), column
    assert refused(evaluate, "sump_temperature") and refused(points, "sump_temperature")
    assert refused(screen, "sump_temperature_celsius") and refused(screen, "lubricant")
    assert refused(points, "lubricant.relaxation_time_seconds")
    for call in (screen, evaluate, points):
        call({"name": ["a", "b"], "additive": ["x", "y"], "treat rate": [1, 2], "cost": [3, 4]})
    carried = evaluate({"kv40": [60, 200]}, carry="kv40")
    assert list(carried["kv40"]) == [60, 200] and set(carried["status"]) == {"OK"}
    with pytest.raises(tribodyn.TribodynError):
        evaluate({"additive": ["x", "y"]}, carry=["kv40"])


def test_what_is_wrong_with_a_screening_is_reported_together(client):
    with pytest.raises(tribodyn.TribodynError) as caught:
        client.screen(
            {"lubricant.relaxation_time": ["3 m", "400 ns"], "surface.nothing": [1, 2]},
            FLUID,
            speeds_kilometres_per_hour=["fast"],
            sump_weights=[1, 2],
        )
    assert len(caught.value.violations) == 5
    with pytest.raises(tribodyn.TribodynError) as caught:
        client.screen({"surface.asperity_friction_coefficient": [0.1, 50]}, FLUID)
    assert "values[1]" in caught.value.violations[0].field


def test_rows_are_followed_over_a_pause_and_the_death_of_the_server(new_server):
    server = new_server("--threads", "1")
    client = tribodyn.Client(server.address)
    speeds = range(20, 100)
    campaign = client.screen(
        variants(500), FLUID, speeds_kilometres_per_hour=speeds, budget_points=200
    )
    campaign.wait()
    assert campaign.state == "paused" and campaign.message.stop.reason == "BUDGET_SPENT"
    assert "NOT_COMPUTED" in set(campaign.frame(["status"])["status"])
    campaign.resume(budget_points=0)
    campaign.pause()
    assert campaign.state == "paused"
    # The same call goes on.
    again = client.screen(variants(500), FLUID, speeds_kilometres_per_hour=speeds)
    assert again.name == campaign.name and again.state == "running"
    rows = []

    def follow():
        for part in again.follow(["candidate", "mesh_loss_power_watts"]):
            rows.append(part)

    following = InThread(follow)
    wait_until(lambda: rows)
    server.restart_when_missed()
    following.result()
    assert again.state == "succeeded"
    assert sum(map(len, rows)) == 40000
    assert not np.isnan(pandas.concat(rows)["mesh_loss_power_watts"]).any()
    assert [each.attrs["start_row"] for each in rows[1:]] == list(
        np.cumsum([len(each) for each in rows])[:-1]
    )
    late = list(again.follow(["candidate"], start_row=39990))
    assert [len(each) for each in late] == [10]


def test_a_stalled_campaign_says_so_and_ends_when_there_is_room(new_server):
    server = new_server()
    client = tribodyn.Client(server.address)
    campaign = client.screen(variants(2000), FLUID, speeds_kilometres_per_hour=range(20, 60))
    log = (server.folder / "db.sqlite-wal").stat().st_size
    # Writes beyond the limit fail as on a full disk.
    resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE, (log, resource.RLIM_INFINITY))
    wait_until(lambda: campaign.refresh().HasField("stalled"))
    assert campaign.state == "stalled" and campaign.reason and campaign.reason in repr(campaign)
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        waiting = InThread(campaign.wait)
        wait_until(lambda: any(campaign.reason in str(each.message) for each in heard))
    resource.prlimit(
        server.process.pid, resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY)
    )
    waiting.result()
    assert campaign.state == "succeeded" and campaign.message.points_done == 80000


def test_a_cancelled_campaign_is_an_error_with_that_reason(client):
    campaign = client.screen(variants(3000), FLUID, speeds_kilometres_per_hour=range(20, 140))
    campaign.cancel()
    with pytest.raises(tribodyn.TribodynError) as caught:
        campaign.wait()
    assert caught.value.reason == "CANCELLED" and len(campaign.frame(["status"])) == 360000
    campaign.delete()


def test_coroutines_screen_together(server):
    async def run():
        async with aio.Client(server.address) as client:
            campaigns = await asyncio.gather(
                client.screen(variants(10), FLUID, speeds_kilometres_per_hour=[33]),
                client.screen(variants(10), FLUID, speeds_kilometres_per_hour=[34]),
            )
            await asyncio.gather(*(each.wait() for each in campaigns))
            rows = [len(part) async for part in campaigns[0].follow()]
            return [each.state for each in campaigns], rows, await campaigns[1].ranking()

    states, rows, ranking = asyncio.run(run())
    assert states == ["succeeded"] * 2 and rows == [10] and len(ranking) == 10


def test_a_campaign_decides_between_its_candidates(client):
    share = np.arange(8) / 8
    table = {
        "name": [f"v{i}" for i in range(8)],
        "lubricant.alpha": [f"{15 + i}/GPa" for i in range(8)],
        "surface.asperity_friction_coefficient": list(0.08 + 0.01 * (np.arange(8) % 3)),
        "treat_rate": list(share),
        "cost": list(4 - share),
    }
    campaign = client.screen(table, FLUID, speeds_kilometres_per_hour=[30], contact_figures=True)
    campaign.wait()
    exact = campaign.ranking(stated_uncertainties=False)
    assert list(exact["candidate"][:1]) == [0] and not exact["tied"].iloc[1]
    ranking = campaign.ranking(uncertainties={"lubricant.alpha": "5%"}, count=5)
    assert len(ranking) == 5 and ranking.attrs["ranked"] == 8
    assert ranking["tied"].iloc[1] and 0.5 < ranking["worse_probability"].iloc[1] < 0.95
    assert ranking["standard_uncertainty"].iloc[0] > 0.03 * ranking.iloc[0][FIGURE]
    assert "lubricant.pressure_viscosity_coefficient_per_pascal" in ranking.attrs[
        "own_uncertain_parameters"
    ]
    cheap = campaign.ranking(where={"cost": (None, 3.5), "film_ratio_minimum:min": (0.0, None)})
    assert cheap.attrs["excluded"] == 4 and (cheap["cost"] <= 3.5).all()
    assert (cheap["film_ratio_minimum:min"] > 0).all()
    front = campaign.pareto("cost")
    assert front["candidate"].iloc[0] == 0 and (np.diff(front["cost"]) < 0).all()
    assert len(front) + front.attrs["beaten"] == 8
    effects = campaign.effects("cost", columns=["treat_rate"])
    assert effects["effect"][0] == pytest.approx(-7 / 8) and effects["to"][0] == 7 / 8
    parameters = [
        "lubricant.pressure_viscosity_coefficient_per_pascal",
        "surface.asperity_friction_coefficient",
    ]
    assert set(campaign.effects()["column"]) == set(parameters)
    assert campaign.effects(columns=[*parameters, "treat_rate", "cost"]).attrs["left_out"] == {
        "treat_rate": "follows from others",
        "cost": "follows from others",
    }
    made = campaign.promote(ranking["candidate"].iloc[0], "promoted", surface="promoted")
    assert made.lubricant.display_name == "v0"
    assert "candidate 0 (v0) of campaigns/" in str(made.lubricant.provenance)
    alone = client.point("promoted", surface="promoted", speed_kilometres_per_hour=30)
    assert alone[FIGURE].iloc[0] == pytest.approx(exact[FIGURE].iloc[0], rel=2e-3)
    with pytest.raises(tribodyn.TribodynError) as caught:
        campaign.promote(1, "promoted", surface="other")
    assert caught.value.reason == "ALREADY_EXISTS"
    with pytest.raises(tribodyn.TribodynError, match="mesh_loss_power_watts"):
        campaign.ranking("mesh_loss_power_watt")
    with pytest.raises(tribodyn.TribodynError, match="median"):
        campaign.ranking("mesh_loss_power_watts:median")


def test_a_ranking_marks_what_a_warning_withholds_and_names_refused_candidates(client):
    client.lubricants.create(
        "stiff", kv40=184, kv100=17, density15=900, base_oil_class="group-i", pour_point_celsius=-10
    )
    campaign = client.screen(
        tribodyn.Lubricants(["paper-fluid-1", "paper-fluid-2", "stiff"]),
        speeds_kilometres_per_hour=[110],
        sump_temperatures_celsius=[-20],
        model_options={"preset": "paper"},
    )
    campaign.wait()
    ranking = campaign.ranking()
    assert list(ranking["verdict_withheld"]) == [True, True] and ranking.attrs["withheld"] == 2
    assert list(ranking["tied"]) == [None, None] and ranking.attrs["not_included"]
    warning = ranking.attrs["warnings"]["INLET_HEATING_LEFT_OUT"]
    assert warning["level"] == "withholds-verdict" and sorted(warning["candidates"]) == [0, 1]
    refused = ranking.attrs["refused_candidates"]
    assert list(refused["candidate"]) == [2] and list(refused["status"]) == ["BELOW_POUR_POINT"]
    assert list(campaign.frame(["verdict_withheld"])["verdict_withheld"][:2]) == [1, 1]


def test_the_server_makes_candidates_and_finds_lubricants(client):
    design = tribodyn.Design(
        "latin-hypercube",
        count=16,
        seed=4,
        ranges={"surface.asperity_friction_coefficient": (0.05, 0.12)},
        logarithmic_ranges={"lubricant.relaxation_time": ("100 ns", "400 ns")},
    )
    campaign = client.screen(design, FLUID, labels={"series": "design"})
    campaign.wait()
    points = campaign.frame()
    friction = points["surface.asperity_friction_coefficient"]
    assert len(points) == 16 and friction.min() >= 0.05 and friction.max() <= 0.12
    assert points["lubricant.relaxation_time_seconds"].between(1e-7, 4e-7).all()
    assert campaign.message.candidate_design.algorithm_version == 1
    assert client.screen(design, FLUID, labels={"series": "design"}).name == campaign.name
    oils = client.screen(tribodyn.Lubricants(["paper-fluid-2", "paper-fluid-3"]))
    oils.wait()
    assert oils.message.lubricant_revision == "lubricants/paper-fluid-2@1"
    before = oils.frame()["mesh_loss_power_watts"]
    alone = client.evaluate(
        {"lubricant": ["paper-fluid-2", "paper-fluid-3"]}, speed_kilometres_per_hour=60
    )
    assert list(before) == list(alone["mesh_loss_power_watts"])
    oils.append(lubricants=["paper-fluid-1"])
    oils.wait()
    after = oils.frame(["candidate", "mesh_loss_power_watts", "name"])
    assert list(after["candidate"]) == [0, 1, 2]
    assert list(after["mesh_loss_power_watts"][:2]) == list(before)
    found = client.screen(tribodyn.Lubricants(filter="name = paper-fluid-3"))
    found.wait()
    assert list(found.frame()["mesh_loss_power_watts"]) == list(before[1:])
    with pytest.raises(tribodyn.TribodynError, match="lubricant"):
        client.screen(design)


def test_candidates_are_added_and_rows_are_filtered(client):
    campaign = client.screen(variants(10), FLUID, speeds_kilometres_per_hour=[40, 80])
    campaign.wait()
    before = campaign.frame()
    campaign.append(variants(6).assign(name=[f"w{i}" for i in range(6)]), request_id="more")
    campaign.append(variants(6).assign(name=[f"w{i}" for i in range(6)]), request_id="more")
    campaign.wait()
    after = campaign.frame()
    assert len(after) == 32 and list(after["name"][20::2]) == [f"w{i}" for i in range(6)]
    assert list(after[FIGURE][:20]) == list(before[FIGURE])
    limit = float(np.median(after[FIGURE]))
    few = campaign.frame(["row", "name", FIGURE], filter=f"{FIGURE} < {limit!r} AND condition = 1")
    expected = after[(after[FIGURE] < limit) & (after["speed_kilometres_per_hour"] == 80)]
    assert list(few["row"]) == list(expected.index) and list(few["name"]) == list(expected["name"])
    assert list(few[FIGURE]) == list(expected[FIGURE])
    assert len(campaign.frame(filter="refusal_number > 0")) == 0
    with pytest.raises(tribodyn.TribodynError, match="havriliak_negami_alpha"):
        campaign.append({"lubricant.havriliak_negami_alpha": [0.8]})


def test_campaigns_are_found_by_label(client):
    campaign = client.screen(variants(2), FLUID, labels={"series": "found by label"})
    campaign.update(display_name="Labelled")
    assert campaign.message.display_name == "Labelled"
    names = [each.name for each in client.campaigns(filter='labels.series = "found by label"')]
    assert names == [campaign.name]
    campaign.update(labels={})
    assert client.campaigns(filter='labels.series = "found by label"') == []


def test_candidates_run_on_a_rig_beside_the_axle(client):
    rig = tribodyn.Rig(
        "12.7mm",
        entrainment_speeds_metres_per_second=2,
        mean_pressures_pascals=["0.6 GPa", "0.9 GPa"],
        slide_roll_ratios_percent=[2, 10, 50],
    )
    table = variants(12)[["name", "treat rate", "lubricant.relaxation_time"]]
    on_rig = client.screen(table, FLUID, rig=rig)
    on_rig.wait()
    rows = on_rig.frame()
    assert list(rows["slide_roll_ratio_percent"][:6]) == [2, 10, 50, 2, 10, 50]
    assert set(rows["status"]) == {"OK"} and rows["film_ratio"].isna().all()
    one = client.rig(
        FLUID,
        radius_x_metres="12.7mm",
        mean_pressures_pascals=["0.6 GPa", "0.9 GPa"],
        entrainment_speeds_metres_per_second=2,
        slide_roll_ratios_percent=[2, 10, 50],
    )
    assert list(rows["load_newtons"][:6]) == list(one["load_newtons"])
    films = rows["central_film_thickness_metres"]  # the relaxation time has no effect on them
    assert list(films[-6:]) == list(one["central_film_thickness_metres"])
    best = on_rig.ranking()
    assert list(best["traction_coefficient"]) == sorted(best["traction_coefficient"])
    assert best["traction_coefficient"].iloc[0] == pytest.approx(
        rows.groupby("name")["traction_coefficient"].mean().min(), rel=1e-12
    )
    assert best.attrs["gear_set"] == ""
    assert on_rig.effects().attrs["candidates"] == 12
    again = client.screen(table, FLUID, rig=rig)
    assert again.name == on_rig.name

    on_axle = client.screen(table, FLUID)
    on_axle.wait()
    figure = f"{on_rig.name}/traction_coefficient:max"
    front = on_axle.pareto(figure)
    assert set(front[figure]) <= set(rows.groupby("name")["traction_coefficient"].max())

    with pytest.raises(tribodyn.TribodynError) as error:
        client.screen(table, FLUID, rig=rig, speeds_kilometres_per_hour=[50], gear_set="x")
    assert {each.field for each in error.value.violations} == {
        "speeds_kilometres_per_hour",
        "gear_set",
    }
