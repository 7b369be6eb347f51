"""Sampled contact of surfaces: how often its intervals hold the mean over many seeds.

    python benchmarks/bench_areal.py [STUDY]    # some five minutes on two cores

Flat films of some lambda ratios over the contact at 200 N, of a study (the paper's, if none is
named), are sampled with `SEEDS` seeds. For contact and for breakthrough it prints the number of
independent contacts, -log(1 - P), its scatter between seeds over its mean, and in how many of the
seeds the interval holds the mean.
"""

import sys
from dataclasses import replace

import numpy as np
import xarray as xr

from lube.contact.rough_pair import RoughPair
from lube.contact.surface_strip import surface_contact
from lube.schema import LIMITS
from lube.study.study import load_study

FORCE = 200.0
LAMBDA_RATIOS = 6.0, 5.0, 4.2, 3.7, 3.3, 3.0, 2.8
SEEDS = 30
NAMES = "geometric_contact_probability", "breakthrough_probability"


def sampled(study):
    """Estimate, lower and upper limit of -log(1 - P): over seed, variable, limit and film."""
    rollers, pair = study.rough_rollers, RoughPair.of(study)
    films = np.array(LAMBDA_RATIOS) * rollers.composite_rms_roughness
    film = xr.Dataset(
        {
            "film_thickness": ("film", films),
            "contact_half_width": rollers.contact_half_width(FORCE),
            "reduced_modulus": rollers.reduced_modulus,
        }
    )
    found = []
    for seed in range(SEEDS):
        contact = surface_contact(replace(pair, seed=1000 + seed), film)
        names = [[f"{name}{end}" for end in LIMITS] for name in NAMES]
        found.append([[contact[name].values for name in each] for each in names])
    with np.errstate(divide="ignore"):
        return -np.log1p(-np.array(found))


def main():
    study = load_study(sys.argv[1] if len(sys.argv) > 1 else "workflow/config/paper.yaml")
    numbers = sampled(study)
    for column, name in enumerate(NAMES):
        print(name)
        for row, ratio in enumerate(LAMBDA_RATIOS):
            number, lower, upper = numbers[:, column, :, row].T
            if not np.isfinite(upper).all():
                print(f"  lambda ratio {ratio:g}: 1 in floating point")
                continue
            mean = number.mean()
            held = np.mean((lower <= mean) & (mean <= upper))
            print(
                f"  lambda ratio {ratio:g}: {mean:.3g} contacts, scatter "
                f"{number.std(ddof=1) / mean:.3f}, held in {100.0 * held:.0f} %",
                flush=True,
            )


if __name__ == "__main__":
    main()
