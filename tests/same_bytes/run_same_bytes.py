"""Prove that the smoke study makes the same bytes whichever way it is run.

`python tests/same_bytes/run_same_bytes.py` makes its datasets on one core and on two, in batches
of 1, 2, 3 and 4, through a submit script as on a cluster, and in a second clone at another path,
and compares the checksum of each dataset; the clone's figures and executed notebooks too, and all
that the code and the study's file in the clone's archive make.

It then compares runs as on older processors: NumPy without AVX2 and fused multiply-add, Numba
without the processor's own instructions, OpenBLAS as on an early one. Last it prints what NumPy's
functions for AVX-512 would change, which the workflow switches off; this is not a failure.
It takes about ten minutes on two idle cores.
"""

import os
import shutil
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "pipeline"))
from repository import RESULTS, Repository, copy_of_the_repository
from test_cluster_generic import SUBMIT

from lube.pipeline.environment import AVX512

BATCH_SIZES = (1, 2, 3, 4)

OLDER = {
    "NumPy as without AVX2": {"NPY_DISABLE_CPU_FEATURES": f"X86_V3 AVX2 FMA3 {AVX512}"},
    "Numba as for any x86-64": {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": ""},
    "OpenBLAS as without AVX": {"OPENBLAS_CORETYPE": "Prescott"},
}
NEWER = {"NumPy with AVX-512, if it is here": {"NPY_DISABLE_CPU_FEATURES": ""}}
"""Environments that hide some of the processor from the libraries, or none of it."""


def main():
    with tempfile.TemporaryDirectory(prefix="lube-same-bytes-") as folder:
        first = copy_of_the_repository(Path(folder) / "first" / "repository")
        expected = made(first, "all, in the first clone", [])
        print()
        datasets = [name for name in expected if name.endswith(".nc")]
        targets = [f"{RESULTS}/{name}" for name in datasets]
        failed = 0
        for what, arguments, changes in ways(first):
            again = made(first, what, [*arguments, *targets], **changes)
            failed += report(again, {name: expected[name] for name in datasets})
        second = copy_of_the_repository(Path(folder) / "second" / "deeper" / "repository")
        failed += report(made(second, "all, in a second clone", []), expected)
        failed += report(made_by_a_stranger(second, Path(folder) / "stranger"), expected)
        for what, variables in (OLDER | NEWER).items():
            os.environ.update(variables)
            again = made(first, what, targets)
            verdict = what in OLDER
            failed += report(again, {name: expected[name] for name in datasets}, verdict)
            for name in variables:
                del os.environ[name]
    print(f"{failed} runs differ" if failed else "one checksum for each dataset")
    return 1 if failed else 0


def ways(repository):
    """What to try, as words, arguments of Snakemake and changed values of the study."""
    for cores in ("1", "2"):
        for size in BATCH_SIZES:
            changes = {"batch_size": size}
            yield f"{cores} core(s), batches of {size}", ["--cores", cores], changes
    submit = repository / "submit"
    submit.write_text(SUBMIT, encoding="utf-8")
    submit.chmod(0o755)
    away = ["--executor", "cluster-generic", "--jobs", "2", "--seconds-between-status-checks", "1"]
    yield "through a submit script", [*away, "--cluster-generic-submit-cmd", str(submit)], {}


def made(repository, what, arguments, **changes):
    """Make results from nothing and return their digests; compiled kernels stay."""
    for name in ("results", ".snakemake"):
        if (repository / name).exists():
            (repository / name).rename(repository.folder.with_name(f"{name}-{time.monotonic_ns()}"))
    began = time.monotonic()
    repository.run(*arguments, study=repository.with_values(**changes))
    print(f"{what}: {time.monotonic() - began:.0f} s", end="", flush=True)
    return repository.products()


def made_by_a_stranger(repository, folder):
    """Archive a study, and make it anew with nothing but the archive's code and study file."""
    repository.run("archive", study="mine.yaml")
    archive = repository.results / "archive/smoke"
    stranger = Repository(shutil.copytree(archive / "code", folder))
    stranger.run(study=str(archive / "study/mine.yaml"))
    print("all, from the archive alone", end="")
    return stranger.products()


def report(again, expected, verdict=True):
    """Say what differs; return whether that is a failure."""
    different = sorted(name for name in expected if again.get(name) != expected[name])
    print(f", different: {', '.join(different)}" if different else ", the same", flush=True)
    return bool(different) and verdict


if __name__ == "__main__":
    sys.exit(main())
