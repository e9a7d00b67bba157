"""Address, project and time limit, from arguments, the environment and the configuration file."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from tribodyn.errors import TribodynError

DEFAULT_SERVER = "127.0.0.1:50651"
DEFAULT_PROJECT = "default"
DEFAULT_TIMEOUT_SECONDS = 30.0
PROGRESS_FORMS = ("auto", "lines", "none")


@dataclass(frozen=True)
class Settings:
    """What a connection needs to be made."""

    server: str  #: "HOST:PORT", or "unix:PATH" for a Unix socket
    project: str
    timeout_seconds: float  #: time limit of one call
    progress: str  #: "auto", "lines" or "none"
    token: str  #: goes with every call; empty for a Unix socket of the same user's server
    authorities: bytes | None  #: PEM: who signs servers' certificates; None: the list of gRPC
    certificate: bytes | None  #: PEM: of the client, for servers that require one
    key: bytes | None  #: PEM: private key of the certificate

    @property
    def uses_tls(self) -> bool:
        """Whether what is sent may leave this machine, or an authority is named."""
        local = ("unix:", "127.", "[::1]", "localhost:")
        return self.authorities is not None or not self.server.startswith(local)


def settings_path() -> Path | None:
    """Returns the configuration file of the command line; None if nothing tells where it is."""
    named = os.environ.get("TRIBODYN_CONFIG")
    if named:
        return Path(named)
    folder = os.environ.get("XDG_CONFIG_HOME")
    if folder:
        return Path(folder) / "tribodyn" / "config"
    home = os.environ.get("HOME")
    return Path(home) / ".config" / "tribodyn" / "config" if home else None


def read_settings(
    server: str | None = None,
    project: str | None = None,
    timeout_seconds: float | None = None,
    progress: str | None = None,
    token_file: str | None = None,
) -> Settings:
    """Returns the settings. An argument overrides the environment, which overrides the file."""
    file = _read_file()

    def text(argument: object, key: str, standard: str) -> str:
        if argument is not None:
            return str(argument)
        variable = "TRIBODYN_" + key.upper().replace("-", "_")
        return os.environ.get(variable) or file.get(key) or standard

    limit = text(timeout_seconds, "timeout-seconds", str(DEFAULT_TIMEOUT_SECONDS))
    try:
        seconds = float(limit)
    except ValueError:
        seconds = -1.0
    if not 0.001 <= seconds <= 86400:
        raise TribodynError(f"timeout_seconds = {limit}; allowed: 0.001 to 86400 s")
    form = text(progress, "progress", "auto")
    if form not in PROGRESS_FORMS:
        raise TribodynError(f"progress = {form}; allowed: {', '.join(PROGRESS_FORMS)}")
    return Settings(
        text(server, "server", _own_server()),
        text(project, "project", DEFAULT_PROJECT),
        seconds,
        form,
        _read_token(text(token_file, "token-file", "")),
        _read_bytes(text(None, "ca-file", "")),
        _read_bytes(text(None, "certificate-file", "")),
        _read_bytes(text(None, "key-file", "")),
    )


def _own_server() -> str:
    """Returns the address at which tribodynd of this user listens by default."""
    runtime, home = os.environ.get("XDG_RUNTIME_DIR"), os.environ.get("HOME")
    socket = f"{runtime}/tribodyn/socket" if runtime else f"{home or ''}/.tribodyn/socket"
    if (runtime or home) and Path(socket).is_socket():
        return f"unix:{socket}"
    return DEFAULT_SERVER


def _read_bytes(path: str) -> bytes | None:
    """Returns the contents of the file; None if there is no path."""
    try:
        return Path(path).read_bytes() if path else None
    except OSError as error:
        raise TribodynError(f"cannot read {path}: {error.strerror}") from None


def _read_token(path: str) -> str:
    """Returns the first word of the file; empty if there is no path."""
    if not path:
        return ""
    try:
        words = Path(path).read_text("utf-8").split()
    except OSError as error:
        raise TribodynError(f"cannot read the token file {path}: {error.strerror}") from None
    if not words:
        raise TribodynError(f"the file {path} holds no token")
    return words[0]


def _read_file() -> dict[str, str]:
    """Returns the entries of the configuration file: "key = value", one a line."""
    path = settings_path()
    try:
        lines = path.read_text("utf-8").splitlines() if path else []
    except OSError as error:
        if os.environ.get("TRIBODYN_CONFIG"):
            raise TribodynError(f"cannot read {path}: {error.strerror}") from None
        return {}
    entries = {}
    for line in lines:
        key, equals, value = line.partition("=")
        if equals and not line.lstrip().startswith(("#", ";")):
            entries[key.strip()] = value.strip().strip("\"'")
    return entries
