"""A naive second solution of Reynolds' equation, for tests and benchmarks of `lube.ehl`."""

import numpy as np
from paper_grid import LENGTH, MODULUS, RADIUS
from scipy.sparse import csr_array

from lube.ehl import film_formulas
from lube.physics import dimensionless

FLOODED = 1000.0
"""Height of the gap at the inlet's end, over the film thickness. An inlet of 40 half-widths is
lower at low load and thins the film by up to 8 %; ten times this height thickens it by 0.1 %."""


class NumericalFilm:
    """Reynolds' equation with elastic rollers, solved by Newton's method.

    Roelands viscosity and Dowson-Higginson density, fully flooded, p >= 0. Lengths over the
    Hertzian half-width a, pressures over p_H, films over a^2/R*. Finite volumes with second-order
    upwind entrainment; constant pressure about a node.
    The inlet sharpens as Moes' M rises, and the nodes move together. Still finer nodes thicken
    the film by 1 % at M = 100, by 0.3 to 0.7 % on the paper's grid.
    """

    def __init__(self, force, viscosity, alpha, speed):
        load = force / LENGTH
        numbers = (
            dimensionless.dimensionless_load(load, 2 * MODULUS, RADIUS),
            dimensionless.dimensionless_speed(viscosity, speed, 2 * MODULUS, RADIUS),
            dimensionless.dimensionless_material(alpha, 2 * MODULUS),
        )
        # Moes' formula lies above the computed film by about this factor.
        self.guess = 0.85 * film_formulas.moes(*numbers) * RADIUS
        self.step = min(0.02, 0.5 / dimensionless.moes_numbers(*numbers)[0])
        self.a = np.sqrt(4 * load * RADIUS / (np.pi * MODULUS))
        self.p_hertz = 2 * load / (np.pi * self.a)
        self.hydrodynamic = 12 * viscosity * speed * RADIUS**2 / (self.a**3 * self.p_hertz)
        self.log_viscosity = np.log(viscosity) + 9.67
        self.z = alpha * 1.962e8 / self.log_viscosity
        self.x = self.nodes()
        self.operators()

    def nodes(self):
        core = np.arange(-2.0, 1.61, self.step)
        reach = np.cumsum(self.step * 1.06 ** np.arange(1, 300))
        # At this distance the undeformed gap x^2/2 has that height; the rollers bulge there.
        far = np.sqrt(2 * FLOODED * self.guess * RADIUS) / self.a + 2.0
        inlet = -2.0 - reach[: 1 + np.searchsorted(reach, far)]
        return np.concatenate([inlet[::-1], core, core[-1] + reach[reach < 4.4]])

    def operators(self):
        x, step = self.x, np.diff(self.x)
        edges = np.concatenate([x[:1], (x[1:] + x[:-1]) / 2, x[-1:]])
        self.width = np.diff(edges)
        distance = x[:, None] - edges
        antiderivative = distance * np.log(np.abs(distance) + 1e-300) - distance
        self.deflection = np.diff(antiderivative, axis=1) / np.pi
        here, there = np.eye(x.size)[:-1], np.eye(x.size)[1:]
        self.mean, self.slope = (here + there) / 2, (there - here) / step[:, None]
        before = np.vstack([here[:1], here[:-1]])
        reach = np.concatenate([[0.0], step[1:] / (2 * step[:-1])])[:, None]
        self.upwind = here + reach * (here - before)
        self.mean, self.slope, self.upwind = map(csr_array, (self.mean, self.slope, self.upwind))

    def oil(self, pressure):
        """Density and viscosity over their ambient values, with their pressure slopes."""
        p = pressure * self.p_hertz
        exponent = self.log_viscosity * ((1 + p / 1.962e8) ** self.z - 1)
        rise = self.log_viscosity * self.z * (1 + p / 1.962e8) ** (self.z - 1) / 1.962e8
        density = (0.59e9 + 1.34 * p) / (0.59e9 + p)
        density_rise = 0.34 * 0.59e9 / (0.59e9 + p) ** 2
        viscosity = np.exp(exponent)
        return density, density_rise * self.p_hertz, viscosity, viscosity * rise * self.p_hertz

    def newton_step(self, p, offset):
        h = np.maximum(offset + self.x**2 / 2 + self.deflection @ p, 1e-4)
        rho, d_rho, eta, d_eta = self.oil(p)
        flow = rho * h**3 / (eta * self.hydrodynamic)
        d_flow = np.diag(h**3 * (d_rho / eta - rho * d_eta / eta**2) / self.hydrodynamic)
        d_flow += (3 * flow / h)[:, None] * self.deflection
        gradient, conductance = (self.slope @ p)[:, None], (self.mean @ flow)[:, None]
        flux = self.upwind @ (rho * h) - conductance[:, 0] * gradient[:, 0]
        by_p = self.upwind @ (np.diag(d_rho * h) + rho[:, None] * self.deflection)
        by_p = by_p - gradient * (self.mean @ d_flow) - self.slope.multiply(conductance)
        by_offset = self.upwind @ rho - gradient[:, 0] * (self.mean @ (3 * flow / h))
        return self.complementary_step(p, np.diff(flux), np.diff(by_p, axis=0), np.diff(by_offset))

    def complementary_step(self, p, residual, by_p, by_offset):
        """Newton step of min(p, residual) = 0 with the load balance."""
        n, scale = p.size, np.abs(np.diagonal(by_p, offset=1))
        matrix, right = np.eye(n + 1), np.concatenate([-p, [np.pi / 2 - self.width @ p]])
        matrix[n] = np.concatenate([self.width, [0.0]])
        wet = 1 + np.flatnonzero(p[1:-1] > residual / scale)
        matrix[wet] = np.column_stack([by_p, by_offset])[wet - 1]
        right[wet] = -residual[wet - 1]
        return np.linalg.solve(matrix, right)

    def solve(self):
        """Central and minimum film, m."""
        p = np.sqrt(np.maximum(1.0 - self.x**2, 0.0))
        middle = np.argmin(np.abs(self.x))
        offset = self.guess * RADIUS / self.a**2 - (self.deflection @ p)[middle]
        for _ in range(150):
            step = self.newton_step(p, offset)
            largest = np.abs(step[:-1]).max()
            damping = min(1.0, 0.2 / largest)
            p, offset = np.maximum(p + damping * step[:-1], 0.0), offset + damping * step[-1]
            if largest < 1e-7:
                break
        else:
            raise ArithmeticError("the numerical film did not converge")
        h = (offset + self.x**2 / 2 + self.deflection @ p) * self.a**2 / RADIUS
        return h[middle], h.min()
