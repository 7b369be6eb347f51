"""Kill the smoke study at some moment, and recover as the documentation says."""

import math
import os
import random
import re
import shutil
import signal
import subprocess
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import psutil
from repository import RESULTS, ROOT, environment, products_of

VICTIMS = ("snakemake", "all", "job")
"""Snakemake alone, so that its jobs are orphans; its process group; one job or its kernel."""
PATIENCE = 600.0
"""Longest wait for a process, s."""


@dataclass(frozen=True)
class Kill:
    """One `kill -9` of a run.

    The run begins with `nothing`; with a share of the `datasets`, and is asked for those and one
    figure; or with all but a share of the `figures`. The kill comes `delay` seconds after its
    first job, sooner if it ends before.
    """

    victim: str
    begin: str
    share: float
    delay: float


@dataclass(frozen=True)
class Finished:
    """The study as an undisturbed run leaves it: its folder, its products, all its files."""

    folder: Path
    products: dict
    files: set


def finished(repository, folder):
    """Keep a copy of a finished study, to begin trials from and to compare them with."""
    for name in ("results", ".snakemake"):
        shutil.copytree(repository / name, folder / name)
    return Finished(folder, repository.products(), files_of(repository))


def recovery_commands():
    """Arguments of each `snakemake` that the documentation names after a crash."""
    section = (ROOT / "docs/troubleshooting.md").read_text("utf-8").split("## After a crash")[1]
    block = re.search(r"```bash\n(.*?)```", section, re.DOTALL)[1]
    return [line.split("#")[0].split()[1:] for line in block.replace("&&", "\n").splitlines()]


def survive(repository, whole, kill, seed=0):
    """Begin the study, kill it, recover, and compare with an undisturbed run.

    Returns the names of the jobs that were running at the kill, and the faults, one line each.
    """
    jobs, delay, chance = [], kill.delay, random.Random(seed)
    while not jobs:
        targets = begin_with(repository, whole, kill, chance)
        jobs = run_and_kill(repository, targets, kill.victim, delay, chance)
        delay /= 2.0
    faults = []
    for arguments in recovery_commands():
        said = repository.snakemake(*arguments, *([] if arguments else targets))
        if said.returncode != 0:
            faults.append(f"snakemake {' '.join(arguments)} failed: {said.stdout[-2000:]}")
    return jobs, [*faults, *differences(repository, whole, targets)]


def begin_with(repository, whole, kill, chance):
    """Put back some of an undisturbed run's results; return what to ask for, all if empty."""
    for name in ("results", ".snakemake"):
        shutil.rmtree(repository / name, ignore_errors=True)
        if kill.begin != "nothing":
            shutil.copytree(whole.folder / name, repository / name)
    if kill.begin == "nothing":
        return []
    figures, targets = repository.notebooks, []
    chance.shuffle(figures)
    few = math.ceil(kill.share * len(figures))
    gone = figures[:few] if kill.begin == "figures" else figures
    gone = [name for figure in gone for name in products_of(figure)]
    if kill.begin == "datasets":
        datasets = [name for name in whole.products if name.endswith(".nc")]
        made = [*datasets, *(name for name in whole.files if name.startswith("batches/"))]
        made.sort(key=lambda name: (whole.folder / RESULTS / name).stat().st_mtime_ns)
        gone += made[int(kill.share * len(made)) :]
        targets = [f"{RESULTS}/{name}" for name in (*datasets, f"notebooks/{figures[0]}.ipynb")]
    for name in gone:
        (repository.results / name).unlink()
    return targets


def run_and_kill(repository, targets, victim, delay, chance):
    """Run Snakemake, kill a while after its first job, and return the names of the running jobs.

    There are none if the run ended before.
    """
    running = subprocess.Popen(
        repository.command(*targets),
        cwd=repository.folder,
        env=environment(),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    try:
        if jobs_of(running):
            time.sleep(delay)
        jobs = jobs_of(running)
        names = [name_of(job) for job in jobs]
        if jobs and victim == "all":
            os.killpg(running.pid, signal.SIGKILL)
        elif jobs and victim == "snakemake":
            running.kill()
            psutil.wait_procs(jobs, PATIENCE)
        elif jobs:
            chance.choice(jobs).kill()
        running.wait(PATIENCE)
    finally:
        running.kill()
        running.wait()
    return names if running.returncode != 0 else []


def jobs_of(running):
    """Processes of the running jobs, and those that execute notebooks; none if the run is over."""
    deadline = time.monotonic() + PATIENCE
    while running.poll() is None and time.monotonic() < deadline:
        with suppress(psutil.NoSuchProcess):
            jobs = psutil.Process(running.pid).children(recursive=True)
            if jobs and all(map(name_of, jobs)):
                return jobs
        time.sleep(0.01)
    return []


def name_of(job):
    """Rule whose script a process runs; empty if it has not begun or has ended."""
    try:
        command = " ".join(job.cmdline())
    except psutil.Error:
        return ""
    script = re.search(r"scripts/tmp\w+\.(\w+)\.py", command)
    return script[1] if script else ""


def differences(repository, whole, targets):
    """Yield what distinguishes the results from those of the undisturbed run, one line each."""
    products, files = repository.products(), files_of(repository)
    asked = {str(Path(name).relative_to(RESULTS)) for name in targets} or set(whole.products)
    for name in sorted(asked | set(products)):
        if products.get(name) != whole.products.get(name):
            yield f"{name} is {'different' if name in products else 'missing'}"
    yield from (f"{name} is left over" for name in sorted(files - whole.files))
    for name in ("locks", "incomplete"):
        if any((repository / f".snakemake/{name}").glob("*")):
            yield f".snakemake/{name} is not empty"


def files_of(repository):
    """Names of all files of the results."""
    paths = repository.results.rglob("*")
    return {str(path.relative_to(repository.results)) for path in paths if path.is_file()}
