"""Compiled kernels are as new as all the files they are made of."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import lube

SCAN = """
import numpy as np
from lube.kernels.scan import scan_window
line = np.array([3, 3, 0], np.int32)
print(*scan_window(line, line, 0, 0, 3, 0, 1.0))
"""


def scan_in(folder):
    """Scan a window in a fresh process, with the package copied to a folder."""
    environment = {**os.environ, "PYTHONPATH": str(folder)}
    command = [sys.executable, "-c", SCAN]
    done = subprocess.run(
        command, env=environment, cwd=folder, capture_output=True, text=True, check=True
    )
    return done.stdout.split()


def test_change_of_the_layers_criterion_reaches_the_kernels_that_use_it(tmp_path):
    kernels = tmp_path / "lube" / "kernels"
    shutil.copytree(
        Path(lube.__file__).parent / "kernels",
        kernels,
        ignore=shutil.ignore_patterns("__pycache__"),
    )
    (tmp_path / "lube" / "__init__.py").touch()
    assert scan_in(tmp_path) == ["2", "2", "12"]
    layer = kernels / "layer.py"
    text = layer.read_text()
    changed = text.replace("return float(points)", "return 1e9 + float(points)")
    assert changed != text
    layer.write_text(changed)
    assert scan_in(tmp_path) == ["2", "0", "12"]
    layer.write_text(text)
    assert scan_in(tmp_path) == ["2", "2", "12"]
