"""Prove that nothing is lost: kill the smoke study at random moments, recover, compare.

`python tests/faults/run_faults.py` runs the smoke study undisturbed, then kills it 50 times with
`kill -9`: Snakemake alone, so that its jobs are orphans, or its whole process group, or one job.
The moments are spread over the whole run. After each kill it does what the documentation says,
and compares every dataset, figure and executed notebook byte for byte; nothing else may be left.

To save time only every tenth run begins with nothing. Half of the others begin with a part of the
datasets, as an undisturbed run has made them some moment before, and half with all datasets and
some figures. `--kills` and `--seed` give other numbers.
It takes about 20 minutes on two idle cores.
"""

import argparse
import random
import shutil
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "workflow"))
from kills import VICTIMS, Kill, finished, survive
from repository import copy_of_the_repository

FROM_NOTHING = 10
"""Every so many runs begin with nothing."""
LONGEST_DELAY = 6.0
"""Time to the kill of a run that begins with something, at most, s."""


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--kills", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="lube-faults-") as folder:
        survived = try_all(Path(folder), options)
    print(f"{survived} of {options.kills} survived")
    return 0 if survived == options.kills else 1


def try_all(folder, options):
    """Run all trials, print a line for each, and return how many ended well."""
    repository = copy_of_the_repository(folder / "repository")
    repository.run()  # compiles the kernels
    with repository.clean_slate():
        began = time.monotonic()
        repository.run()
        duration = time.monotonic() - began
        whole = finished(repository, folder / "whole")
    print(f"Undisturbed: {duration:.0f} s, {len(whole.products)} products", flush=True)
    print(
        f"{'':>4}  {'begun with':<14}{'killed':<10}{'after':>7}{'recovery':>10}  at work",
        flush=True,
    )
    kills = list(drawn_kills(options.kills, duration, random.Random(options.seed)))
    return sum(tell(number, kill, repository, whole) for number, kill in enumerate(kills, 1))


def drawn_kills(count, duration, chance):
    """Kills whose moments are spread evenly over the run, in random order."""
    moments = [(number + chance.random()) / count for number in range(count)]
    chance.shuffle(moments)
    for number, moment in enumerate(moments):
        victim = VICTIMS[number % len(VICTIMS)]
        if number % FROM_NOTHING == 0:
            yield Kill(victim, "nothing", 0.0, moment * duration)
        else:
            begin = ("datasets", "figures")[number // len(VICTIMS) % 2]
            share = moment if begin == "datasets" else 0.35
            yield Kill(victim, begin, share, chance.uniform(0.0, LONGEST_DELAY))


def tell(number, kill, repository, whole):
    """Try one kill, print its line of the table, and return whether it was survived."""
    outcome = survive(repository, whole, kill, seed=number)
    begun = {
        "nothing": "nothing",
        "datasets": f"{kill.share:.0%} datasets",
        "figures": f"{1 - kill.share:.0%} figures",
    }[kill.begin]
    times = f"{outcome.after:>5.1f} s{outcome.recovery:>8.1f} s"
    print(
        f"{number:>4}  {begun:<14}{kill.victim:<10}{times}  {', '.join(outcome.at_work)}",
        flush=True,
    )
    for fault in outcome.faults:
        print(f"      FAILED: {fault}", flush=True)
    if outcome.faults:
        kept = Path(tempfile.mkdtemp(prefix="lube-faults-failed-"))
        shutil.copytree(repository.results, kept / "results")
        shutil.copytree(whole.folder / "results", kept / "undisturbed")
        print(f"      kept in {kept}", flush=True)
    return not outcome.faults


if __name__ == "__main__":
    sys.exit(main())
