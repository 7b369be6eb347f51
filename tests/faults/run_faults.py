"""Prove that nothing is lost: kill the smoke study at random moments, recover, compare.

`python tests/faults/run_faults.py` runs the smoke study undisturbed, then kills it 50 times with
`kill -9`: Snakemake alone, or its whole process group, or one job, at moments spread over the
whole run. After each kill it does what docs/troubleshooting.md says, and compares every dataset,
figure and executed notebook byte for byte; nothing else may be left.

To save time only every tenth run begins with nothing. Half of the others begin with a part of the
datasets, half with all datasets and some figures. It takes about 20 minutes on two idle cores.
"""

import argparse
import random
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "pipeline"))
from kills import VICTIMS, Kill, finished, survive
from repository import copy_of_the_repository

FROM_NOTHING = 10
"""One in this many runs begins with nothing."""
LONGEST_DELAY = 6.0
"""Longest time to the kill of a run that begins with something, s."""


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
    survived = 0
    kills = drawn_kills(options.kills, duration, random.Random(options.seed))
    for number, kill in enumerate(kills, 1):
        jobs, faults = survive(repository, whole, kill, seed=number)
        print(f"{number:>4}  {kill}, running: {', '.join(jobs)}", flush=True)
        for fault in faults:
            print(f"      FAILED: {fault}", flush=True)
        survived += not faults
    return survived


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


if __name__ == "__main__":
    sys.exit(main())
