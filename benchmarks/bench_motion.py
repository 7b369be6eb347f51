"""Surfaces in motion: how long contacts last and layers are broken, counted and by theory.

    PYTHONPATH=tests python benchmarks/bench_motion.py    # some three minutes on two cores

Both rollers' surfaces are drawn, moved step by step, and their contacts followed in time. Films are
flat, or those of an oil at 1600 N, 100 r/min and 80 °C that answers each wave, scaled to a lambda
ratio. Beside what is counted stands the theory of `lube.contact.strip_film`:

- the number of contacts in the strip, and of those that appear on the way;
- for layers that should break at some parts of the contacts, the part that does, and how far the
  rollers move while a layer is broken.
"""

import os
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field

import numpy as np
import scipy
from whole_surfaces import (
    Filtered,
    Unchanged,
    answered_strip,
    begun,
    curved_more,
    in_motion,
    summits_in,
)

from lube.contact.strip_film import StripFilm, surface_moments
from lube.contact.surface_answers import COARSEST
from lube.study.study import load_study
from lube.surfaces.rough_surface import field as heights_of
from lube.surfaces.rough_surface import rough_surface

STUDY = "workflow/config/paper.yaml"
WIDTH = 0.3e-3
"""Width of the strip under a flat film that answers nothing, m."""
PARTS = 0.9, 0.7, 0.3, 0.1
"""Parts of the contacts at which the layer should break."""
STEPS = 160
SURFACES = 6


@dataclass(frozen=True)
class Case:
    """Surfaces and the film between them.

    Attributes
    ----------
    film : str
        ``as drawn``, or the shape, ``flat`` or ``computed``, of a film that answers them.
    ratio, slip : float
        Lambda ratio and slide-to-roll ratio.
    shortest : str, optional
        Shortest wavelength.
    roughness : dict, optional
        Further keys of ``roughness`` in a study.
    second : dict, optional
        Changes of the second roller.
    """

    film: str
    ratio: float
    slip: float
    shortest: str = "5 points"
    roughness: dict = field(default_factory=dict)
    second: dict = field(default_factory=dict)

    def __str__(self):
        more = [f"{name} {value}" for name, value in (self.roughness | self.second).items()]
        first = f"{self.film}, lambda ratio {self.ratio:g}, slip {self.slip:g}"
        return ", ".join([first, f"waves down to {self.shortest}", *more])


RIDGES = {"lay_ratio": 3.0, "lay_angle": "90 deg"}
AT_AN_ANGLE = {"lay_ratio": 3.0, "lay_angle": "30 deg"}
SMOOTHER = {"rms_roughness": "0.0667 um"}
CASES = [
    *(Case("as drawn", ratio, slip) for ratio in (2.0, 2.6) for slip in (0.0, 0.3, 1.0)),
    Case("as drawn", 2.6, 0.5, second=SMOOTHER),
    Case("as drawn", 2.6, 0.5, roughness=RIDGES),
    Case("as drawn", 2.6, 0.5, roughness=AT_AN_ANGLE),
    *(Case(film, 2.2, slip) for film in ("flat", "computed") for slip in (0.0, 0.5, 1.0)),
    *(
        Case(film, 2.2, slip, shortest="20 points")
        for film in ("flat", "computed")
        for slip in (0.0, 0.5)
    ),
]


@dataclass(frozen=True)
class Motion:
    """Surfaces in motion through a strip.

    Attributes
    ----------
    surface : lube.surfaces.rough_surface.Surface
        How they are drawn.
    strip : StripFilm
        Film across the strip.
    heights : callable
        Makes the heights in the gap from the waves of both surfaces.
    slip : float
        Slide-to-roll ratio.
    """

    surface: object
    strip: StripFilm
    heights: Callable
    slip: float

    def steps(self, seed):
        """Yield heights, in height steps, and mean curvatures in the gap, in these per m^2."""
        surface, as_drawn = self.surface, Unchanged(self.surface)
        columns = self.strip.films(surface.spacing[1]).size
        for moved in in_motion(surface, np.random.default_rng(seed), self.slip, STEPS):
            heights = self.heights(moved)(0, columns)
            added = heights - as_drawn.heights(moved)(0, columns)
            curved = heights_of(sum(moved) * surface.curvatures, surface.points)[:, :columns]
            yield heights, curved + curved_more(added, surface.spacing)


def prepared(case):
    """Lines, surfaces and film of a case."""
    rollers = {"second": case.second} if case.second else {}
    shape = {"points": 50_000, "longest_wavelength": "0.4 mm", "shortest_wavelength": case.shortest}
    changes = {"name": "motion", "contact_model": ["surface"], "rollers": rollers}
    changes["roughness"] = shape | case.roughness
    study = load_study(STUDY, changes)
    spec = study.line_spec
    surface = rough_surface(spec, contact=(4e-5, 4e-5), waves=6, multiple=2**COARSEST)
    if case.film == "as drawn":
        columns = round(WIDTH / surface.spacing[1])
        film = case.ratio * np.sqrt(surface_moments(spec).height)
        strip = StripFilm.flat(film, 0.5 * columns * surface.spacing[1])
        return spec, Motion(surface, strip, Unchanged(surface).heights, case.slip)
    strip, film = answered_strip(study, spec, case.film, case.slip, case.ratio)
    return spec, Motion(surface, strip, Filtered(surface, strip, film).heights, case.slip)


def breaking_curvature(strip, spec, part):
    """Mean curvature, 1/m, that a part of the contacts exceeds by theory."""
    rms = 0.5 * np.sqrt(surface_moments(spec).curvature)

    def excess(ratio):
        return strip.breaking_part(spec, 1.0, ratio * rms) - part

    return rms * scipy.optimize.brentq(excess, 0.05, 9.0)


def counted(motion, spec, limits, seed):
    """Contacts in the strip and those that appear, then the same of broken layers."""
    spacing = motion.surface.spacing[1]
    films = motion.strip.films(spacing) / spec.height_step
    columns = motion.strip.columns(spacing)
    sharp = [motion.strip.breaking_curvatures(columns, each) / spec.height_step for each in limits]
    touching, broken, numbers = [], [[] for _ in limits], np.zeros(1 + len(limits))
    for heights, curved in motion.steps(seed):
        labels, summits = summits_in(heights - films, motion.surface.diagonal)
        for row, limit in enumerate(sharp):
            breaks = [curved[summit] > limit[summit[1]] for summit in summits]
            numbers[1 + row] += sum(breaks)
            broken[row].append(np.array([False, *breaks])[labels])
        touching.append(labels > 0)
        numbers[0] += len(summits)
    return np.stack([numbers / STEPS, [begun(each) for each in (touching, *broken)]])


def compared(case):
    """Lines of text that compare a case."""
    spec, motion = prepared(case)
    strip, side = motion.strip, motion.surface.sides[0]
    limits = [breaking_curvature(strip, spec, part) for part in PARTS]
    surfaces = SURFACES if case.shortest == "5 points" else 2 * SURFACES
    each = np.array([counted(motion, spec, limits, seed) for seed in range(surfaces)])
    numbers, appeared = each.sum(axis=0)
    way = (STEPS - 1) * motion.surface.spacing[1]
    _, number, appearing = strip.contacts(spec, side, case.slip)
    ratios = each[:, :, 0] / np.array([number, appearing * way])
    found = zip(ratios.mean(axis=0), ratios.std(axis=0, ddof=1) / surfaces**0.5, strict=True)
    found = (f"{ratio:.2f} ± {error:.2f}" for ratio, error in found)
    lines = [f"{case}", "  contacts {}, and those that appear {} of theory".format(*found)]
    for row, (part, limit) in enumerate(zip(PARTS, limits, strict=True), 1):
        ratio = numbers[row] / appeared[row] * way
        ratio /= strip.breakthrough_width(spec, side, limit, case.slip)
        lines.append(
            f"  layer breaks at {numbers[row] / numbers[0]:.2f} of them (theory {part:g}), for "
            f"{ratio:.2f} ± {ratio / appeared[row] ** 0.5:.2f} of the distance by theory"
        )
    return "\n".join(lines)


def main():
    with ProcessPoolExecutor(os.cpu_count()) as processes:
        for lines in processes.map(compared, CASES):
            print(lines, flush=True)


if __name__ == "__main__":
    main()
