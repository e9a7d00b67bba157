"""A real tribodynd for the tests, on a free port of loopback."""

import os
import socket
import subprocess
import tempfile
import time
from pathlib import Path

import pytest

import tribodyn

TREE = Path(os.environ["TRIBODYN_TREE"])


# The token of every server of the tests: a server takes over the one beside its database.
SECRET = "tribodyn_" + 64 * "7"


def write_token(path):
    path.touch(mode=0o600)
    path.write_text(SECRET + "\n", "utf-8")


@pytest.fixture(scope="session", autouse=True)
def token_file(tmp_path_factory):
    path = tmp_path_factory.mktemp("token") / "token"
    write_token(path)
    os.environ["TRIBODYN_TOKEN_FILE"] = str(path)


class Server:
    """A tribodynd with a database of its own, which may be killed and started again."""

    def __init__(self, folder, *options, address="127.0.0.1:0"):
        self.folder = Path(folder)
        self.options = options
        self.address = address
        write_token(self.folder / "db.sqlite.token")
        self.start()

    def start(self):
        """Starts it, again on the port that it had."""
        port = self.folder / "port"
        port.unlink(missing_ok=True)
        with open(self.folder / "log", "ab") as log:
            self.process = subprocess.Popen(
                [
                    os.environ["TRIBODYND"],
                    "--listen",
                    self.address,
                    "--database",
                    self.folder / "db.sqlite",
                    "--port-file",
                    port,
                    *self.options,
                ],
                stdout=log,
                stderr=log,
            )
        for _ in range(3000):
            if port.exists() and port.read_text():
                self.address = port.read_text().strip()
                return
            assert self.process.poll() is None, (self.folder / "log").read_text()
            time.sleep(0.01)
        raise AssertionError("the server did not start")

    def restart_when_missed(self):
        """Kills it if it runs, and starts it again after a client has tried to connect."""
        self.kill()
        host, port = self.address.rsplit(":", 1)
        with socket.create_server((host, int(port))) as listener:
            listener.settimeout(60)
            listener.accept()[0].close()
        self.start()

    def kill(self):
        self.process.kill()
        self.process.wait()

    def stop(self):
        self.process.terminate()
        try:
            self.process.wait(30)
        except subprocess.TimeoutExpired:
            self.kill()


@pytest.fixture
def new_server():
    """Starts servers that end with the test: new_server(option...)."""
    servers = []
    with tempfile.TemporaryDirectory() as folder:

        def start(*options, **named):
            own = Path(folder) / str(len(servers))
            own.mkdir()
            servers.append(Server(own, *options, **named))
            return servers[-1]

        yield start
        for server in servers:
            server.stop()


@pytest.fixture(scope="session")
def server():
    """A server for all tests that leave it running."""
    with tempfile.TemporaryDirectory() as folder:
        server = Server(folder, "--projects", "axles")
        yield server
        server.stop()


@pytest.fixture(scope="session")
def client(server):
    with tribodyn.Client(server.address) as client:
        yield client
