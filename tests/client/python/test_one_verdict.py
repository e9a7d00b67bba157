"""Four oils known by their data sheets get one verdict from every method and client."""

import json
import os
import subprocess
import urllib.request

import numpy as np
import pytest

import tribodyn
from conftest import SECRET, Server

OILS = {  # KV40, KV100, density, base oil
    "75w-90": (103, 15.1, 868, "polyalphaolefin"),
    "another-75w-90": (100, 14.9, 866, "polyalphaolefin"),
    "75w-85": (66.5, 11.4, 857, "polyalphaolefin"),
    "80w-90": (138, 14.3, 892, "group-i"),
}
SPEEDS, SUMP, DRAWS = (50, 70), 80, 199


@pytest.fixture(scope="module")
def rest_server(tmp_path_factory):
    server = Server(tmp_path_factory.mktemp("rest"), "--http-listen", "127.0.0.1:0")
    yield server
    server.kill()


def _verdict(comparison):
    """Of a lubricant as ComparePoints answers, over REST or by the command line: the probability
    that it loses more than the best one, and whether the two can be told apart."""
    difference = comparison["mean_difference"]
    return (
        1 - difference["lower_probability"],
        difference["verdict"] == "CANNOT_BE_TOLD_APART",
    )


def test_four_oils_get_one_verdict_from_every_method(rest_server):
    client = tribodyn.Client(rest_server.address)
    for name, (kv40, kv100, density, base_oil) in OILS.items():
        client.lubricants.create(
            name,
            base_oil_class=base_oil,
            kv40=kv40,
            kv100=kv100,
            density15=density,
        )

    campaign = client.screen(
        tribodyn.Lubricants(list(OILS)),
        speeds_kilometres_per_hour=list(SPEEDS),
        sump_temperatures_celsius=[SUMP],
    )
    campaign.wait()
    ranking = campaign.ranking()
    order = list(ranking["name"])
    verdicts = {"campaign": list(zip(ranking["worse_probability"], ranking["tied"]))[1:]}
    means = {"campaign": list(ranking["inefficiency_energy_mean_percent"])}

    mean = client.compare_points(
        order,
        speeds_kilometres_per_hour=list(SPEEDS),
        sump_temperatures_celsius=[SUMP],
        draws=DRAWS,
    ).attrs["mean"]
    verdicts["Python"] = [
        (1 - p, verdict == "cannot-be-told-apart")
        for p, verdict in zip(mean["lower_probability"][1:], mean["verdict"][1:])
    ]
    means["Python"] = list(mean["mean_inefficiency_percent_value"])

    log = (rest_server.folder / "log").read_text("utf-8")
    address = log.split("REST at ")[1].split()[0]
    body = {
        "lubricants": [f"lubricants/{name}" for name in order],
        "conditions": [
            {"speed_kilometres_per_hour": speed, "sump_temperature_celsius": SUMP}
            for speed in SPEEDS
        ],
    }
    request = urllib.request.Request(
        f"{address}/v1/points:compare",
        json.dumps(body).encode(),
        {"Authorization": f"Bearer {SECRET}", "Content-Type": "application/json"},
    )
    with urllib.request.urlopen(request) as answer:
        rest = json.load(answer)["lubricants"]
    verdicts["REST"] = [_verdict(each) for each in rest[1:]]
    means["REST"] = [each["mean_inefficiency_percent"]["value"] for each in rest]

    def run(*arguments):
        speeds = ",".join(str(each) for each in SPEEDS)
        command = [os.environ["TRIBODYN"], "--server", rest_server.address, *arguments]
        options = ["--speeds", speeds, "--sumps", str(SUMP), "--output", "json"]
        return json.loads(subprocess.run(command + options, check=True, capture_output=True).stdout)

    compared = run("compare", *order)["lubricants"]
    verdicts["compare"] = [_verdict(each) for each in compared[1:]]
    means["compare"] = [each["mean_inefficiency_percent"]["value"] for each in compared]
    screened = run("screen", "--lubricants", ",".join(order))["candidates"]
    assert [each["candidate"].split("@")[0] for each in screened] == order
    verdicts["screen"] = [
        (each["higher_probability"], each["is_tied_with_best"]) for each in screened[1:]
    ]
    means["screen"] = [each["inefficiency_energy_mean_percent"] for each in screened]

    for method, values in means.items():
        assert values == pytest.approx(means["campaign"], rel=2e-3), method
    p = np.array([[each for each, _ in verdict] for verdict in verdicts.values()])
    usual = p.mean(axis=0)
    # The difference of two shares of independent draws; fails once in a thousand runs.
    sampling = 3.3 * np.sqrt(2 * usual * (1 - usual) / DRAWS) + 1 / DRAWS
    assert np.all(np.abs(p - usual) < sampling), verdicts
    is_told = np.array([[tied for _, tied in verdict] for verdict in verdicts.values()])
    near_threshold = np.abs(usual - 0.975) < 3.3 * np.sqrt(0.975 * 0.025 / DRAWS)
    assert np.all((is_told == is_told[0]) | near_threshold), verdicts
    assert is_told[0].any() and not is_told[0].all()
