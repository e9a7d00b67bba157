import os
import re
import subprocess
import sys

from conftest import TREE

PYTHON = TREE / "client/python"


def run(server, folder, *command):
    done = subprocess.run(
        [sys.executable, *command],
        capture_output=True,
        text=True,
        cwd=folder,
        env={**os.environ, "TRIBODYN_SERVER": server.address},
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_code_of_the_readme_runs(server, tmp_path):
    code = "\n".join(re.findall(r"```python\n(.*?)```", (PYTHON / "README.md").read_text(), re.S))
    out = run(server, tmp_path, "-c", code)
    assert "too fast" in out and "('simulation.sump_temperature_celsius', '900 C'" in out


def test_two_oils_are_compared_with_a_plot(server, tmp_path):
    out = run(server, tmp_path, PYTHON / "examples/compare_two_oils.py", "oils.svg")
    assert "saved_watts" in out and (tmp_path / "oils.svg").stat().st_size > 10_000


def test_variants_are_screened_and_ranked(server, tmp_path):
    for _ in range(2):  # the second run finds the campaign of the first
        out = run(server, tmp_path, PYTHON / "examples/screen_variants.py")
        assert re.search(r"^0 +B-2.0 +16.00? +[\d.]+ +OK$", out, re.M) and "B: W of mesh loss" in out


def test_the_loop_of_optimisation_ends_inside_its_bounds(server, tmp_path):
    out = run(server, tmp_path, PYTHON / "examples/find_best_viscosity.py")
    found = re.search(r"([\d.]+) W at ([\d.]+) times .* after (\d+) .*; ([\d.]+) W as it is", out)
    assert float(found[1]) < 0.97 * float(found[4]) and 1 < float(found[2]) < 6
    assert int(found[3]) < 30


def test_the_loop_with_gradients_finds_the_best_oil_within_twenty_evaluations(server, tmp_path):
    out = run(server, tmp_path, PYTHON / "examples/find_best_oil.py")
    found = re.search(
        r"inefficiency: ([\d.]+) % after (\d+) evaluations, with a film\nof ([\d.]+)", out
    )
    assert float(found[1]) < 1.037 and int(found[2]) <= 20 and float(found[3]) >= 0.979


def test_type_hints_hold():
    done = subprocess.run(
        [
            "/usr/bin/mypy",
            "--config-file",
            PYTHON / "pyproject.toml",
            "--python-executable",
            sys.executable,
            "--cache-dir",
            os.path.join(os.environ["TRIBODYN_FOLDER"], "mypy"),
            "-p",
            "tribodyn",
        ],
        capture_output=True,
        text=True,
        cwd=os.environ["TRIBODYN_FOLDER"],
    )
    assert done.returncode == 0, done.stdout + done.stderr
