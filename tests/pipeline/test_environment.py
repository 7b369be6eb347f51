"""The environment of all jobs: this folder's package, and the same digits on all processors."""

import ast
import os
import subprocess
import sys
from pathlib import Path

import lube
from lube.pipeline.environment import compute_alike, use_package

NAME = "NPY_DISABLE_CPU_FEATURES"
BLAS = {"linalg", "matmul", "dot", "inner", "tensordot", "lstsq", "polyfit"}
BLAS |= {"corrcoef", "cov", "spearmanr", "pearsonr"}
# They fit planes to measured surfaces, and lines to measured spectra, by least squares.
FITS = {"abel.py", "surface_statistics.py", "topography.py"}
# They solve for the film and its response, of which six digits are kept.
FITS |= {"line_contact.py", "reynolds.py", "response.py", "transient.py", "waves.py"}
FITS |= {"answered_windows.py", "surface_answers.py"}
# They free effects of lines from those of pairs, and keep six decimals.
FITS |= {"line_effects.py"}
# It adds up waves for a passage, of whose gaps four digits are kept.
FITS |= {"rough_piece.py"}


def test_later_processes_import_the_package_of_a_folder(monkeypatch, tmp_path):
    monkeypatch.setenv("PYTHONPATH", "theirs")
    use_package(tmp_path)
    assert os.environ["PYTHONPATH"] == f"{tmp_path}{os.pathsep}theirs"


def test_later_processes_do_without_avx_512(monkeypatch):
    monkeypatch.delenv(NAME, raising=False)
    compute_alike()
    command = [sys.executable, "-c", "import numpy; numpy.show_runtime()"]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    found = said.split("'found': ")[1].split("'not_found'")[0]
    assert "V4" not in found and "AVX512" not in found


def test_a_value_set_by_the_user_is_kept(monkeypatch):
    monkeypatch.setenv(NAME, "")
    compute_alike()
    assert os.environ[NAME] == ""


def test_no_digit_depends_on_the_kernels_that_a_blas_library_chooses():
    for path in Path(lube.__file__).parent.rglob("*.py"):
        if path.name in FITS:
            continue
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            assert not isinstance(node, ast.MatMult), path
            assert getattr(node, "attr", getattr(node, "name", None)) not in BLAS, path
