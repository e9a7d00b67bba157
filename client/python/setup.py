"""Builds the package: protoc generates the messages from ../../proto. Needs no network.

TRIBODYN_GOOGLEAPIS_DIR names the folder that holds google/rpc/status.proto; the default is the one
of Debian's golang-github-gogo-googleapis-dev.
"""

import atexit
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

from google.protobuf import descriptor_pb2
from setuptools import setup
from setuptools.command.build_py import build_py

CONTRACT = Path(__file__).resolve().parents[2] / "proto"
GOOGLEAPIS = os.environ.get(
    "TRIBODYN_GOOGLEAPIS_DIR", "/usr/share/gocode/src/github.com/gogo/googleapis"
)
RPC_FILES = ["google/rpc/status.proto", "google/rpc/error_details.proto"]


def contract_files() -> list[str]:
    return sorted(str(each.relative_to(CONTRACT)) for each in CONTRACT.glob("tribodyn/v1/*.proto"))


def own_name(name: str) -> str:
    """Returns the name under which the package holds a file or a type of google.rpc.

    Under its own name it would clash with googleapis-common-protos, if that is installed:
    protobuf refuses two files of one name that differ in anything.
    """
    return name.replace("google/rpc/", "tribodyn/rpc/").replace("google.rpc", "tribodyn.rpc")


def without_annotations(
    files: descriptor_pb2.FileDescriptorSet,
) -> descriptor_pb2.FileDescriptorSet:
    """Removes google.api, which only servers and documentation need, and renames google.rpc."""
    kept = descriptor_pb2.FileDescriptorSet()
    for file in files.file:
        if file.name.startswith("google/api/"):
            continue
        file.name = own_name(file.name)
        file.package = own_name(file.package)
        imports = [own_name(each) for each in file.dependency if not each.startswith("google/api/")]
        del file.dependency[:]
        file.dependency.extend(imports)
        file.DiscardUnknownFields()  # values of the options that google.api and limits.proto define
        rename_types(file)
        kept.file.append(file)
    return kept


def rename_types(message) -> None:
    """Renames the types of google.rpc in every field of a file."""
    for field, value in message.ListFields():
        if field.name == "type_name":
            message.type_name = own_name(value)
        elif field.type == field.TYPE_MESSAGE:
            for each in value if field.label == field.LABEL_REPEATED else [value]:
                rename_types(each)


def generate(out: Path) -> None:
    """Writes the modules of the messages below `out`."""
    protoc = shutil.which("protoc")
    if protoc is None:
        raise SystemExit("protoc is missing: install protobuf-compiler")
    if not contract_files():
        raise SystemExit(f"no protos below {CONTRACT}: install from the source tree")
    with tempfile.TemporaryDirectory() as folder:
        described = Path(folder) / "described"
        subprocess.run(
            [
                protoc,
                f"-I{CONTRACT}",
                f"-I{GOOGLEAPIS}",
                "-I/usr/include",
                "--include_imports",
                "--include_source_info",
                f"--descriptor_set_out={described}",
                *contract_files(),
                *RPC_FILES,
            ],
            check=True,
        )
        files = descriptor_pb2.FileDescriptorSet.FromString(described.read_bytes())
        described.write_bytes(without_annotations(files).SerializeToString())
        names = [*contract_files(), *map(own_name, RPC_FILES)]
        out.mkdir(parents=True, exist_ok=True)
        subprocess.run(
            [
                protoc,
                f"--descriptor_set_in={described}",
                f"--python_out={out}",
                f"--pyi_out={out}",
                *names,
            ],
            check=True,
        )
    for package in ("v1", "rpc"):
        (out / "tribodyn" / package / "__init__.py").write_text("")


class BuildWithMessages(build_py):
    """Builds the package with the generated messages."""

    def run(self) -> None:
        super().run()
        generate(Path(self.build_lib))


# The build leaves nothing in the source tree.
scratch = tempfile.mkdtemp(prefix="tribodyn-python-")
atexit.register(shutil.rmtree, scratch, ignore_errors=True)
setup(
    cmdclass={"build_py": BuildWithMessages},
    options={"build": {"build_base": scratch}, "egg_info": {"egg_base": scratch}},
)
