"""The same last digits on all processors."""

import ast
import os
import subprocess
import sys
from pathlib import Path

import pytest

import lube
from lube.workflow.processors import compute_alike

NAME = "NPY_DISABLE_CPU_FEATURES"


def test_processes_begun_later_do_without_avx_512(monkeypatch):
    monkeypatch.delenv(NAME, raising=False)
    compute_alike()
    said = subprocess.run(
        [sys.executable, "-c", "import numpy; numpy.show_runtime()"],
        capture_output=True,
        text=True,
        check=True,
    )
    found = said.stdout.split("'found': ")[1].split("'not_found'")[0]
    assert "V4" not in found
    assert "AVX512" not in found


def test_a_choice_of_the_users_stays(monkeypatch):
    monkeypatch.setenv(NAME, "")
    compute_alike()
    assert os.environ[NAME] == ""


@pytest.mark.parametrize("path", sorted(Path(lube.__file__).parent.rglob("*.py")), ids=str)
def test_no_last_digit_hangs_on_the_kernels_that_a_blas_chooses(path):
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        assert not isinstance(node, ast.MatMult)
        name = getattr(node, "attr", getattr(node, "name", None))
        assert name not in {"linalg", "matmul", "dot", "inner", "tensordot", "lstsq", "polyfit"}
        assert name not in {"corrcoef", "cov", "spearmanr", "pearsonr"}
