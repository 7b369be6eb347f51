import numpy as np
import pytest
from scipy.stats import norm

from lube.sensitivity.samples import deviations
from lube.study.uncertainty import Uncertainty

UNIT = np.linspace(0.0005, 0.9995, 1000)[:, None]


def of(**section):
    factors = Uncertainty.model_validate(section).factors()
    return deviations(factors, np.repeat(UNIT, len(factors), axis=1))


def test_uniform_deviations_go_evenly_through_their_range():
    found = of(temperature={"range": "-1 K to 3 K", "source": "assumed"})["temperature"]
    np.testing.assert_allclose(found, -1.0 + 4.0 * UNIT[:, 0])


def test_95_percent_of_normal_deviations_lie_within_their_range():
    given = {"range": "-10 % to 30 %", "distribution": "normal", "source": "assumed"}
    found = of(viscosity=given)["viscosity"]
    assert np.mean((found > -0.1) & (found < 0.3)) == pytest.approx(0.95, abs=0.002)
    inner = np.abs(norm.ppf(UNIT[:, 0])) < 1.5 * norm.ppf(0.975)
    expected = norm.ppf(UNIT[:, 0], 0.1, 0.2 / norm.ppf(0.975))
    np.testing.assert_allclose(found[inner], expected[inner])
    assert found.min() == pytest.approx(-0.2) and found.max() == pytest.approx(0.4)


@pytest.mark.parametrize("given", ["-0.2 to 0.2", "-0.3 to 0.1"])
def test_normal_deviations_go_as_far_as_the_ends_that_are_stated(given):
    """Exactly: heights are tabulated between them."""
    section = {"range": given, "distribution": "normal", "source": "assumed"}
    factors = Uncertainty.model_validate({"skewness": section}).factors()
    found = deviations(factors, np.array([[0.0], [1.0]]))["skewness"]
    assert tuple(found) == factors[0].given.ends


def test_choices_are_equally_likely():
    given = {"choices": ["paper", "moes", "grubin"], "source": "assumed"}
    found = of(film_formula=given)["film_formula"]
    assert np.bincount(found).tolist() == [333, 334, 333]
    both_ends = deviations(
        Uncertainty.model_validate({"film_formula": given}).factors(), np.array([[0.0], [1.0]])
    )
    assert both_ends["film_formula"].tolist() == [0, 2]
