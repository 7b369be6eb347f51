"""A change of any file of the kernels reaches all compiled kernels."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numba

import lube.types
from lube.kernels.compiler import kernel
from lube.kernels.layer import layer_breaks

JUDGE = """
from lube.kernels.compiler import kernel
from lube.kernels.layer import layer_breaks

@kernel
def judge(points, overlap, factor):
    return layer_breaks(points, overlap, factor)
"""


def judge_in(folder):
    """Judge a run of touching points in a fresh process, with the package copied to a folder."""
    environment = {**os.environ, "PYTHONPATH": str(folder)}
    code = "from lube.kernels.judge import judge; print(judge(2, 9, 1.0))"
    command = [sys.executable, "-c", code]
    done = subprocess.run(
        command, env=environment, cwd=folder, capture_output=True, text=True, check=True
    )
    return done.stdout.strip()


def test_a_changed_layer_criterion_reaches_a_kernel_that_inlines_it(tmp_path):
    kernels = tmp_path / "lube" / "kernels"
    shutil.copytree(
        Path(lube.__file__).parent / "kernels",
        kernels,
        ignore=shutil.ignore_patterns("__pycache__"),
    )
    (tmp_path / "lube" / "__init__.py").touch()
    shutil.copy(lube.types.__file__, tmp_path / "lube")
    (kernels / "judge.py").write_text(JUDGE)
    assert judge_in(tmp_path) == "True"
    layer = kernels / "layer.py"
    text = layer.read_text()
    changed = text.replace("return 1.0 * points", "return 1e9 + 1.0 * points")
    assert changed != text
    layer.write_text(changed)
    assert judge_in(tmp_path) == "False"
    layer.write_text(text)
    assert judge_in(tmp_path) == "True"


def users_function(x):
    return x + 1.0


def test_other_functions_are_cached_where_numba_keeps_them():
    configured = numba.config.CACHE_DIR
    ours = Path(layer_breaks.stats.cache_path)
    assert kernel(users_function)(1.0) == 2.0
    assert configured == numba.config.CACHE_DIR
    assert Path(numba.njit(cache=True)(users_function).stats.cache_path) != ours
    if not configured:
        assert Path(lube.__file__).parent / "kernels/__pycache__" in ours.parents
