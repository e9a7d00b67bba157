import asyncio
import inspect
import os
import subprocess
import sys
import threading
import time

import grpc
import numpy as np
import pytest

import tribodyn
from conftest import SECRET, TREE
from tribodyn import aio
from tribodyn.settings import read_settings
from tribodyn.v1 import simulations_pb2 as pb

FLUID = "paper-fluid-1"
OWNER = (("authorization", f"Bearer {SECRET}"),)


def list_simulations(server):
    """Returns the simulations of a server, newest first."""
    with grpc.insecure_channel(server.address) as channel:
        call = channel.unary_unary(
            "/tribodyn.v1.SimulationService/ListSimulations",
            pb.ListSimulationsRequest.SerializeToString,
            pb.ListSimulationsResponse.FromString,
        )
        return list(call(pb.ListSimulationsRequest(), metadata=OWNER).simulations)


def wait_until(is_true):
    for _ in range(1000):
        if is_true():
            return
        time.sleep(0.01)
    raise AssertionError("timed out")


class InThread:
    """Runs a call in a thread."""

    def __init__(self, call):
        self.outcome = None
        self._thread = threading.Thread(target=self._run, args=[call])
        self._thread.start()

    def _run(self, call):
        try:
            self.outcome = call()
        except Exception as error:
            self.outcome = error

    def result(self):
        self._thread.join(60)
        assert not isinstance(self.outcome, Exception), self.outcome
        return self.outcome


def test_a_job_survives_the_death_of_its_server(new_server):
    server = new_server("--threads", "1")
    client = tribodyn.Client(server.address)
    # Marched: a curve that takes seconds.
    study = dict(
        speeds_kilometres_per_hour=[40, 60],
        tolerance=1e-5,
        options=tribodyn.Options(method="march"),
    )
    running = InThread(lambda: client.compare([FLUID, "paper-fluid-2"], **study))
    wait_until(
        lambda: any(each.state == pb.Simulation.RUNNING for each in list_simulations(server))
    )
    server.restart_when_missed()
    curves = running.result()
    assert list(curves["status"]) == ["OK"] * 4
    jobs = list_simulations(server)
    assert len(jobs) == 2 and max(each.attempt for each in jobs) == 2


def test_calls_wait_for_a_server_that_restarts(new_server):
    server = new_server()
    client = tribodyn.Client(server.address)
    client.lubricants.get(FLUID)
    server.kill()
    waiting = InThread(
        lambda: client.points({"speed_kilometres_per_hour": [20, 30, 40]}, lubricant=FLUID)
    )
    server.restart_when_missed()
    assert list(waiting.result()["status"]) == ["OK"] * 3


def test_jobs_that_a_full_queue_turns_away_are_submitted_again(new_server):
    server = new_server("--threads", "1", "--waiting-simulations", "4")
    client = tribodyn.Client(server.address)
    temperatures = np.linspace(20, 100, 40)
    points = client.points(
        {"sump_temperature_celsius": temperatures},
        lubricant=FLUID,
        speed_kilometres_per_hour=80,
        tolerance=1e-6,
    )
    assert list(points["status"]) == ["OK"] * 40
    assert len(list_simulations(server)) == 40


def test_a_repeated_request_id_finds_the_job(client, server):
    options = tribodyn.Options(request_id="once", force=True)
    first = client.point(FLUID, speed_kilometres_per_hour=61, options=options)
    again = client.point(FLUID, speed_kilometres_per_hour=61, options=options)
    assert first.attrs["simulation"] == again.attrs["simulation"]
    with pytest.raises(tribodyn.TribodynError) as caught:
        client.point(FLUID, speed_kilometres_per_hour=62, options=options)
    assert caught.value.reason == "REQUEST_ID_REUSED"


def test_every_option_reaches_the_server(client, server):
    options = tribodyn.Options(
        model_options={"isothermal": True},
        start="large-vibration",
        method="march",
        march_step_tolerance=1e-6,
        march_settling_tolerance=1e-5,
        maximum_mesh_cycles=3000,
        recorded_mesh_cycles=40,
        display_name="a title",
        labels={"project": "axle"},
        force=True,
        scheduling_class="interactive",
        deadline_seconds=600,
        request_id="of-all-options",
    )
    client.point(FLUID, speed_kilometres_per_hour=40, model="full", options=options)
    job = list_simulations(server)[0]
    solver = job.solver_options
    assert job.model_options.isothermal and solver.method and job.operating_point.start
    assert (solver.march_step_tolerance, solver.march_settling_tolerance) == (1e-6, 1e-5)
    assert (solver.maximum_mesh_cycles, solver.recorded_mesh_cycles) == (3000, 40)
    assert (job.display_name, job.labels[0].value) == ("a title", "axle")
    assert (job.deadline_seconds, job.request_id) == (600, "of-all-options")


def test_a_cancelled_job_is_an_error_with_that_reason(new_server):
    server = new_server("--threads", "1")
    client = tribodyn.Client(server.address)
    running = InThread(
        lambda: client.curve(FLUID, tolerance=1e-7, options=tribodyn.Options(method="march"))
    )
    wait_until(lambda: list_simulations(server))
    with grpc.insecure_channel(server.address) as channel:
        channel.unary_unary(
            "/tribodyn.v1.SimulationService/CancelSimulation",
            pb.CancelSimulationRequest.SerializeToString,
            pb.Simulation.FromString,
        )(pb.CancelSimulationRequest(name=list_simulations(server)[0].name), metadata=OWNER)
    with pytest.raises(AssertionError):
        running.result()
    assert isinstance(running.outcome, tribodyn.TribodynError)
    assert running.outcome.reason == "CANCELLED"


def test_no_server_is_an_error_at_once():
    started = time.monotonic()
    with pytest.raises(tribodyn.TribodynError) as caught:
        tribodyn.Client("127.0.0.1:1").point(FLUID, speed_kilometres_per_hour=60)
    assert caught.value.reason == "CANNOT_CONNECT" and "127.0.0.1:1" in str(caught.value)
    assert time.monotonic() - started < 5


def test_settings_come_from_arguments_then_environment_then_file(monkeypatch, tmp_path):
    file = tmp_path / "config"
    file.write_text(
        "# the plant's server\nserver = 10.0.0.1:1\nproject = 'axles'\ncolor = auto\n"
        "timeout-seconds = 60\n"
    )
    monkeypatch.setenv("TRIBODYN_CONFIG", str(file))
    monkeypatch.setenv("TRIBODYN_PROJECT", "gearboxes")
    found = read_settings(timeout_seconds=5)
    assert (found.server, found.project, found.timeout_seconds) == ("10.0.0.1:1", "gearboxes", 5)
    monkeypatch.setenv("TRIBODYN_TIMEOUT_SECONDS", "soon")
    with pytest.raises(tribodyn.TribodynError, match="timeout_seconds = soon"):
        read_settings()
    monkeypatch.setenv("TRIBODYN_CONFIG", str(tmp_path / "missing"))
    with pytest.raises(tribodyn.TribodynError, match="missing"):
        read_settings()


def test_coroutines_have_the_names_arguments_and_descriptions_of_the_blocking_client():
    from tribodyn._campaigns import AsyncCampaign
    from tribodyn._resources import AsyncResources

    def members(kind):
        return {name: getattr(kind, name) for name in dir(kind) if not name.startswith("_")}

    def signatures(kind):
        return {
            name: list(inspect.signature(member).parameters.values())
            for name, member in members(kind).items()
            if callable(member)
        }

    for awaited, blocking in (
        (aio.Client, tribodyn.Client),
        (AsyncResources, tribodyn.Resources),
        (AsyncCampaign, tribodyn.Campaign),
    ):
        assert len(signatures(blocking)) > 6
        assert signatures(awaited) == signatures(blocking)
        for name, member in members(blocking).items():
            assert member.__doc__, name
            assert not inspect.iscoroutinefunction(member), name


def test_help_states_what_a_blocking_method_returns():
    returned = {
        name: inspect.signature(getattr(tribodyn.Client, name)).return_annotation
        for name in ("point", "screen", "campaigns")
    }
    assert returned == {"point": "Frame", "screen": "Campaign", "campaigns": "List[Campaign]"}
    assert inspect.signature(tribodyn.Campaign.follow).return_annotation == "Iterator[Frame]"


def mypy(*arguments):
    """Checks with the settings of the package; all checks share a cache."""
    command = ["/usr/bin/mypy", "--python-executable", sys.executable]
    command += ["--config-file", TREE / "client/python/pyproject.toml", "--cache-dir", "mypy"]
    folder = os.environ["TRIBODYN_FOLDER"]
    return subprocess.run([*command, *arguments], capture_output=True, text=True, cwd=folder)


def test_type_hints_hold():
    done = mypy("-p", "tribodyn")
    assert done.returncode == 0, done.stdout + done.stderr


def test_type_checkers_find_the_results_of_blocking_methods(tmp_path):
    program = tmp_path / "program.py"
    program.write_text(
        "import tribodyn\n"
        "client = tribodyn.Client()\n"
        "reveal_type(client.campaigns(3))\n"
        "reveal_type(client.campaign('12').name)\n"
        "reveal_type(client.lubricants.get('my-oil').name)\n"
        "client.point(speed='60')\n"
    )
    done = mypy(program)
    assert '"builtins.list[tribodyn.client.Campaign]"' in done.stdout, done.stdout
    assert done.stdout.count('"builtins.str"') == 2, done.stdout
    assert '"speed"' in done.stdout, done.stdout


def test_coroutines_run_together(server):
    async def run():
        async with aio.Client(server.address) as client:
            return await asyncio.gather(
                client.point(FLUID, speed_kilometres_per_hour=63),
                client.curve(FLUID, speeds_kilometres_per_hour=[20, 64]),
                client.lubricants.get(FLUID),
                client.points({"speed_kilometres_per_hour": [65]}, lubricant=FLUID),
            )

    point, curve, lubricant, points = asyncio.run(run())
    assert len(point) == 1 and len(curve) == 2 and lubricant.revision == 1
    assert points["status"][0] == "OK"


def test_a_terminal_has_a_bar_and_a_program_without_one_is_silent(server):
    code = (
        "import tribodyn; tribodyn.Client(progress='auto').point('paper-fluid-3', "
        "speed_kilometres_per_hour=60, tolerance=1e-5)"
    )
    environment = {**os.environ, "TRIBODYN_SERVER": server.address}
    terminal = ["script", "-qec", f'{sys.executable} -c "{code}"', "/dev/null"]
    bar = subprocess.run(terminal, capture_output=True, text=True, check=True, env=environment)
    assert "point: " in bar.stdout and "100%" in bar.stdout
    silent = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment
    )
    assert silent.stderr == "" and silent.stdout == ""


def test_a_token_of_nobody_and_a_missing_token_file_are_errors(server, tmp_path, monkeypatch):
    token = tmp_path / "token"
    token.write_text("tribodyn_unknown\n", "utf-8")
    monkeypatch.setenv("TRIBODYN_TOKEN_FILE", str(token))
    with pytest.raises(tribodyn.TribodynError) as caught:
        tribodyn.Client(server.address).point(FLUID, speed_kilometres_per_hour=60)
    assert caught.value.reason == "UNAUTHENTICATED"
    token.unlink()
    with pytest.raises(tribodyn.TribodynError, match=str(token)):
        tribodyn.Client(server.address)


def test_a_token_file_may_be_an_argument(server, tmp_path):
    token = tmp_path / "token"
    token.write_text("tribodyn_unknown\n", "utf-8")
    with pytest.raises(tribodyn.TribodynError) as caught:
        tribodyn.Client(server.address, token_file=str(token)).evaluate(
            {"lubricant": [FLUID], "speed_kilometres_per_hour": [60]}
        )
    assert caught.value.reason == "UNAUTHENTICATED"


def test_a_server_on_another_machine_is_reached_by_tls(new_server, tmp_path, monkeypatch):
    certificates = tmp_path / "certificates"
    make = TREE / "deploy/make-certificates"
    subprocess.run([make, certificates, "localhost"], check=True, capture_output=True)
    key = [
        "--tls-certificate",
        certificates / "server.pem",
        "--tls-key",
        certificates / "server.key",
    ]
    server = new_server(*key, address="0.0.0.0:0")
    address = "localhost:" + server.address.rpartition(":")[2]
    monkeypatch.setenv("TRIBODYN_CA_FILE", str(certificates / "ca.pem"))
    assert tribodyn.Client(address).lubricants.get(FLUID).revision == 1
    monkeypatch.delenv("TRIBODYN_CA_FILE")
    with pytest.raises(tribodyn.TribodynError) as caught:
        tribodyn.Client(address).lubricants.get(FLUID)
    assert caught.value.reason == "CANNOT_CONNECT"


def guest_of(server, name, calls_per_second):
    """Returns a client with a new token that may make so many calls a second."""
    token = subprocess.run(
        [
            os.environ["TRIBODYND"],
            "tokens",
            "create",
            name,
            "--database",
            server.folder / "db.sqlite",
            "--calls-per-second",
            str(calls_per_second),
        ],
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    path = server.folder / f"{name}.token"
    path.touch(mode=0o600)
    path.write_text(token, "utf-8")
    return aio.Client(server.address, token_file=path)


def test_a_guest_with_a_small_quota_of_calls_is_served_slower_and_whole(server):
    async def run():
        async with guest_of(server, "guest", 5) as client:
            point = {"lubricant": FLUID, "speed_kilometres_per_hour": 55}
            table = {"sump_temperature_celsius": np.linspace(30, 90, 60)}
            evaluated = await asyncio.gather(
                *(client.evaluate({"sump_temperature_celsius": [40 + i]}, **point) for i in range(50))
            )
            return await client.points(table, **point), evaluated

    points, evaluated = asyncio.run(run())
    assert set(points["status"]) == {"OK"} and len(points) == 60
    assert all(set(each["status"]) == {"OK"} for each in evaluated)


def test_a_call_after_a_fork_says_what_to_do(client):
    client.lubricants.get(FLUID)
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            client.lubricants.get(FLUID)
            os.write(writer, b"answered")
        except tribodyn.TribodynError as error:
            os.write(writer, error.reason.encode() + b" " + str(error).encode())
        os._exit(0)
    os.close(writer)
    os.waitpid(child, 0)
    said = os.read(reader, 1000).decode()
    os.close(reader)
    assert said.startswith("FORKED") and "spawn" in said
