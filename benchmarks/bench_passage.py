"""Waves of any height that pass through the contact: where the linear response ends.

    python benchmarks/bench_passage.py [STUDY]

At five operating points of the paper's study, if none is named, of lambda ratios from 1 to 4, waves
of one half-width and of a quarter of it pass in pure rolling and with slip, with amplitudes of a
tenth to one and a half of the central film. Printed are

- the difference of the wave in the gap from the linear response, root mean square over the contact,
  over the undeformed wave;
- the least gap over the central film: by the nonlinear solution, by the linear response, and of the
  wave as drawn;
- the least share of the load that the oil carries;
- and the longest time that one wave took.
"""

import sys
import time

import numpy as np

from lube.ehl.line_contact import ConvergenceError
from lube.ehl.response import WaveResponse
from lube.ehl.transient import pass_wave
from lube.grid.films import FilmGroups, hertz_contact
from lube.stages.film import film_table
from lube.study.oil_properties import lubricant_table
from lube.study.study import load_study

LAMBDA_RATIOS = (1.0, 1.75, 2.5, 3.25, 4.0)
WAVELENGTHS = (1.0, 0.25)
SPEEDS = (1.0, 1.5)
AMPLITUDES = (0.1, 0.2, 0.5, 1.0, 1.5)


def profiles(study):
    """Yield films of smooth rollers, the nearest to each lambda ratio, with their names."""
    grid = study.operating_grid
    oil = lubricant_table(study.lubricants[:1], grid.temperature)
    film = film_table(oil, study.rough_rollers, grid.force, grid.speed, ["computed"]).squeeze()
    contact = hertz_contact(study.rough_rollers, film["force"], film["speed"])
    solved = FilmGroups.at(oil, study.rough_rollers, film["force"], contact).profiles.squeeze()
    ratios = film["lambda_ratio"].stack(point=["temperature", "speed", "force"])
    solved = solved.stack(point=["temperature", "speed", "force"])
    for wanted in LAMBDA_RATIOS:
        number = np.abs(ratios.values - wanted).argmin()
        temperature, speed, force = ratios["point"].values[number]
        name = f"{force:g} N, {speed:.3g} r/min, {temperature:g} degC"
        yield f"{name}, lambda ratio {ratios.values[number]:.2f}", solved.values[number]


def described(profile, wavelength, speed, amplitude):
    """Describe the passage of one wave."""
    passed = pass_wave(profile, wavelength, speed, amplitude)
    inside = np.abs(passed.position) < 0.95
    linear = WaveResponse.of(profile, wavelength).transfer(speed, passed.position)
    difference = np.sqrt(np.mean(np.abs(passed.transfer - linear)[inside] ** 2))
    smooth = profile.scaled_gap(passed.position) / profile.central_gap
    least = [
        passed.gap.min() / profile.central_gap,
        (smooth - amplitude * np.abs(linear))[inside].min(),
        smooth[inside].min() - amplitude,
    ]
    words = ", ".join(f"{each:.2f}" for each in least)
    return f"differs by {difference:.3f}, gap {words}, oil {passed.oil_load_share:.3f}"


def main():
    """Print all figures."""
    study = load_study(sys.argv[1] if len(sys.argv) > 1 else "workflow/config/paper.yaml")
    longest = 0.0
    for name, profile in profiles(study):
        print(name)
        for wavelength in WAVELENGTHS:
            for speed in SPEEDS:
                for amplitude in AMPLITUDES:
                    start = time.process_time()
                    try:
                        found = described(profile, wavelength, speed, amplitude)
                    except ConvergenceError as error:
                        found = str(error)
                    longest = max(longest, time.process_time() - start)
                    what = f"  {wavelength:g} half-widths, speed {speed:g}, amplitude {amplitude:g}"
                    print(f"{what}: {found}", flush=True)
    print(f"longest time of a wave: {longest:.0f} s of processor time")


if __name__ == "__main__":
    main()
