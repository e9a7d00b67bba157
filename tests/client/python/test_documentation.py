import os
import pathlib
import re
import subprocess
import sys

import nbformat
import pytest
from nbclient import NotebookClient

from conftest import TREE

PYTHON = TREE / "client/python"


def test_the_code_of_the_readme_runs(server, tmp_path):
    code = "\n".join(re.findall(r"```python\n(.*?)```", (PYTHON / "README.md").read_text(), re.S))
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env={**os.environ, "TRIBODYN_SERVER": server.address},
    )
    assert done.returncode == 0, done.stderr
    out = done.stdout
    assert "too fast" in out and "('simulation.sump_temperature_celsius', '900 C'" in out


@pytest.fixture(scope="session")
def kernels():
    """The folder of a kernel of this interpreter, installed as the README says."""
    folder = pathlib.Path(os.environ["TRIBODYN_FOLDER"]) / "jupyter"
    install = [sys.executable, "-m", "ipykernel", "install", "--name", "tribodyn"]
    subprocess.run([*install, "--prefix", folder], check=True, capture_output=True)
    return folder / "share/jupyter"


@pytest.fixture
def run_notebook(server, kernels, monkeypatch):
    """Runs all cells of a notebook. Returns the texts and the kinds of what the cells put out."""
    monkeypatch.setenv("JUPYTER_PATH", str(kernels))
    monkeypatch.setenv("TRIBODYN_SERVER", server.address)
    monkeypatch.setenv("MPLBACKEND", "module://matplotlib_inline.backend_inline")

    def run(name):
        notebook = nbformat.read(PYTHON / f"notebooks/{name}.ipynb", as_version=4)
        NotebookClient(notebook, timeout=120, kernel_name="tribodyn").execute()
        texts, kinds = [], set()
        for cell in notebook.cells:
            for output in cell.get("outputs", []):
                if output.get("name") == "stderr":  # warnings may divide what a cell prints
                    continue
                data = output.get("data", {"text/plain": output.get("text", "")})
                texts.append(data.get("text/plain", ""))
                kinds.update(data)
        return "\n".join(texts), kinds

    return run


def test_notebooks_are_kept_without_outputs():
    names = list((PYTHON / "notebooks").glob("*.ipynb"))
    assert len(names) == 4
    for name in names:
        notebook = nbformat.read(name, as_version=4)
        nbformat.validate(notebook)
        for cell in notebook.cells:
            assert not cell.get("outputs") and cell.get("execution_count") is None, name


def test_two_oils_are_compared_with_plots_and_reasons(run_notebook):
    out, kinds = run_notebook("compare_two_oils")
    assert "saved_watts" in out and "difference_percent_value" in out and "lower_probability" in out
    assert "image/png" in kinds and "text/html" in kinds


def test_additives_are_screened_and_ranked(run_notebook):
    out, _ = run_notebook("screen_additives")
    assert re.search(r"^0 +B-2.0 +16.00? +[\d.]+ +True$", out, re.M)


def test_the_loop_of_optimisation_ends_inside_its_bounds(run_notebook):
    out, _ = run_notebook("find_best_viscosity")
    found = re.search(r"([\d.]+) W at ([\d.]+) times .* after (\d+) .*; ([\d.]+) W as it is", out)
    assert float(found[1]) < 0.97 * float(found[4]) and 1 < float(found[2]) < 6
    assert int(found[3]) < 30


def test_the_loop_with_gradients_finds_the_best_oil_within_twenty_evaluations(run_notebook):
    out, _ = run_notebook("find_best_oil")
    found = re.search(
        r"inefficiency: ([\d.]+) % .* ([\d.]+) % as it is, after (\d+) evaluations, with a film"
        r"\s+of ([\d.]+)",
        out,
    )
    assert float(found[1]) < 0.9 * float(found[2])
    assert int(found[3]) <= 20 and float(found[4]) >= 0.979
