"""The computed film: its time and its errors, beside a dense Newton solution on a uniform grid.

    PYTHONPATH=tests python benchmarks/bench_film.py    # some minutes on two cores

- All 125 operating points of the paper: processor and wall time, the largest defect of the mass
  flux and of the load, and the largest change of the films on a finer mesh and with an inlet twice
  as long.
- At some points the naive solution of the tests on evenly spaced nodes, with the same inlet: time
  and error against the computed film on a mesh four times as fine. Its error falls as the square of
  the step, from which follow its film without a step, and the nodes and the time for the error
  `WANTED`.
"""

import time
from itertools import product

import numpy as np
from numerical_film import FLOODED, NumericalFilm
from paper_grid import ALPHA, FORCE, RADIUS, SPEED, TEMPERATURE, VISCOSITY, contact_at
from threadpoolctl import threadpool_limits

from lube.ehl import line_contact
from lube.ehl.line_contact import solve

UNIFORM = {(1600, 600 / 7, 80): (0.04, 0.02, 0.01), (800, 100, 40): (0.08, 0.04, 0.02)}
"""Steps over the half-width, by operating point."""
WANTED = 3e-4
"""Error of the central film that `lube.ehl` keeps at all points."""


class UniformFilm(NumericalFilm):
    """The naive solution on nodes as far apart everywhere as in the contact."""

    def __init__(self, point, step):
        force, speed, temperature = point
        self.even_step, at = step, list(TEMPERATURE).index(temperature)
        super().__init__(force, VISCOSITY[at], ALPHA[at], np.pi * speed / 600)

    def nodes(self):
        """From an inlet whose gap is `numerical_film.FLOODED` times the film."""
        far = np.sqrt(2 * FLOODED * self.guess * RADIUS) / self.a + 2.0
        return np.arange(-far, 1.6, self.even_step)


def timed(function, *arguments, **options):
    """Wall time, processor time and result."""
    wall, busy = time.perf_counter(), time.process_time()
    result = function(*arguments, **options)
    return time.perf_counter() - wall, time.process_time() - busy, result


def largest_change(profiles, others):
    """Of the central and the minimum film, in percent."""
    return [
        100.0
        * max(
            abs(getattr(there, name) / getattr(here, name) - 1.0)
            for here, there in zip(profiles, others, strict=True)
        )
        for name in ("central_film", "minimum_film")
    ]


def print_grid():
    """All operating points of the paper."""
    contacts = [contact_at(*point) for point in product(FORCE, SPEED, TEMPERATURE)]
    solve(contacts[0])  # libraries loaded before any measurement
    wall, busy, profiles = timed(lambda: [solve(contact) for contact in contacts])
    sizes = [profile.nodes.size for profile in profiles]
    defects = [
        max(getattr(profile, f"{name}_defect") for profile in profiles)
        for name in ("mass_flux", "load")
    ]
    print(
        f"lube.ehl, {len(contacts)} films: {wall:.1f} s, {busy:.1f} s of processor time, ", end=""
    )
    print(f"{min(sizes)} to {max(sizes)} nodes, at most {max(one.steps for one in profiles)} steps")
    print(f"  largest defect of the mass flux {defects[0]:.1e}, of the load {defects[1]:.1e}")
    for words, options in (
        ("on a mesh twice as fine", {"fineness": 2.0}),
        ("on a mesh four times as fine", {"fineness": 4.0}),
        ("with an inlet twice as long", {"flooded": 4.0 * line_contact.FLOODED}),
    ):
        central, least = largest_change(profiles, [solve(each, **options) for each in contacts])
        print(f"  {words}: central film {central:.3f} %, least film {least:.3f} %")


def print_uniform(point, steps):
    """The naive solution at one point."""
    contact = contact_at(*point)
    inlet = {"flooded": FLOODED}
    exact = solve(contact, fineness=4.0, **inlet).central_film * RADIUS
    wall, _, profile = timed(solve, contact, **inlet)
    error = profile.central_film * RADIUS / exact - 1.0
    print(f"{point[0]:g} N, {point[1]:.0f} r/min, {point[2]:g} degC, gap at the inlet 1000 films")
    print(f"  lube.ehl: {profile.nodes.size} nodes, {wall:.2f} s, error {100 * error:+.3f} %")
    found = []
    for step in steps:
        film = UniformFilm(point, step)
        wall, busy, (central, _) = timed(film.solve)
        error, size = central / exact - 1.0, film.x.size
        found.append((step**2, error, size, wall))
        print(f"  uniform: {size} nodes, {wall:.1f} s, {busy:.1f} s of processor time, ", end="")
        print(f"error {100 * error:+.2f} %", flush=True)
    squares, errors, sizes, walls = np.transpose(found)
    slope, rest = np.polyfit(squares[-2:], errors[-2:], 1)
    size = sizes[-1] * np.sqrt(abs(slope) * squares[-1] / WANTED)
    wall = walls[-1] * max(size / sizes[-1], 1.0) ** 3
    print(f"  uniform without a step, extrapolated: {100 * rest:+.2f} % from that of lube.ehl")
    print(f"  uniform for {100 * WANTED:g} %: {size:.0f} nodes, {wall:.0f} s", flush=True)


def main():
    print_grid()
    with threadpool_limits(2):
        for point, steps in UNIFORM.items():
            print_uniform(point, steps)


if __name__ == "__main__":
    main()
