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

COUNT = """
import numpy as np
from lube.kernels.whole_runs import whole_run_steps
line = np.array([0, 0, 0, 8, 8, 0, 0, 0], np.int32)
print(*whole_run_steps(line, np.array([2]), np.array([1]), 1.0))
"""


def count_in(folder):
    """Count windows with a broken run in a fresh process, with the package copied to a folder."""
    environment = {**os.environ, "PYTHONPATH": str(folder)}
    command = [sys.executable, "-c", COUNT]
    done = subprocess.run(
        command, env=environment, cwd=folder, capture_output=True, text=True, check=True
    )
    return done.stdout.split()


def test_a_changed_layer_criterion_reaches_the_kernels_that_inline_it(tmp_path):
    kernels = tmp_path / "lube" / "kernels"
    shutil.copytree(
        Path(lube.__file__).parent / "kernels",
        kernels,
        ignore=shutil.ignore_patterns("__pycache__"),
    )
    (tmp_path / "lube" / "__init__.py").touch()
    shutil.copy(lube.types.__file__, tmp_path / "lube")
    assert count_in(tmp_path) == ["4"]
    layer = kernels / "layer.py"
    text = layer.read_text()
    changed = text.replace("return float(points)", "return 1e9 + float(points)")
    assert changed != text
    layer.write_text(changed)
    assert count_in(tmp_path) == ["0"]
    layer.write_text(text)
    assert count_in(tmp_path) == ["4"]


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
