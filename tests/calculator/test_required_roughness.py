"""The roughness found is low enough: put in again, it gives the share asked for."""

import pytest
from made import on_few_surfaces
from put_in_again import (
    CHOICES,
    FEW,
    POINT,
    RUNS,
    SURFACE,
    assert_has_the_share,
    of_roughness,
    probability,
)

import lube
from lube import LubeError


def test_rollers_whose_asperities_carry_load_may_be_rougher(rollers, oil, busy):
    """Put in again, they have the share and the film of their own heights."""
    sharing, given = {"load_sharing": "iterated"}, POINT | RUNS | {"share": 0.6}
    found, whole = (
        lube.required_roughness(rollers, oil, **given, **more) for more in (sharing, {})
    )
    factor = found["roughness_factor"].item()
    assert factor > 1.01 * whole["roughness_factor"].item()
    rougher = of_roughness(f"{0.2 * factor!r} um", busy.study.line_spec)
    back = lube.contact_probability(rougher, oil, **POINT, **RUNS, **sharing)
    assert back["breakthrough_probability_mean"].item() == pytest.approx(0.6, rel=0.05)
    assert back["lambda_ratio"].item() == pytest.approx(found["lambda_ratio"].item(), rel=2e-3)


def test_the_roughness_has_the_share(rollers, oil, busy):
    """Rollers of that roughness, drawn anew, have the share asked for."""
    found = lube.required_roughness(rollers, oil, **POINT, share=0.02, **RUNS)
    assert found["roughness_factor"].attrs["units"] == "1"
    rms = f"{0.2 * found['roughness_factor'].item()!r} um"
    smoother = of_roughness(rms, busy.study.line_spec)
    assert probability(smoother, oil) == pytest.approx(0.02, rel=0.05)
    assert probability(rollers, oil) > 0.04


def test_the_roughness_may_be_for_a_rare_share(rollers, oil, busy):
    found = lube.required_roughness(rollers, oil, **POINT, share=1e-7, **RUNS)
    rms = f"{0.2 * found['roughness_factor'].item()!r} um"
    smoother = of_roughness(rms, busy.study.line_spec)
    back = lube.contact_probability(smoother, oil, **POINT, realisations=1, seed=2)
    assert back["tail_breakthrough_probability"].item() == pytest.approx(1e-7, rel=0.05)


def test_under_any_film_the_roughness_has_the_share(rollers, oil, busy):
    """Rollers of that roughness, drawn anew."""
    choices = CHOICES | FEW
    found = lube.required_roughness(rollers, oil, **POINT, share=0.02, **choices)
    rms = f"{0.2 * found['roughness_factor'].item()!r} um"
    smoother = of_roughness(rms, busy.study.line_spec)
    back = lube.contact_probability(smoother, oil, **POINT, **choices)
    assert back["breakthrough_probability_mean"].item() == pytest.approx(0.02, rel=0.05)


def test_on_the_surface_the_roughness_has_the_share(rollers, oil, busy):
    """Rollers of that roughness, drawn anew."""
    with on_few_surfaces(10):
        found = lube.required_roughness(rollers, oil, **POINT, share=0.2, **SURFACE)
        rms = f"{0.2 * found['roughness_factor'].item()!r} um"
        smoother = of_roughness(rms, busy.study.line_spec)
        assert_has_the_share(lube.contact_probability(smoother, oil, **POINT, **SURFACE), 0.2)


def test_rollers_may_be_much_rougher_than_those_given(rollers, oil, busy):
    """The film with a shape is needed as far as the rougher rollers touch."""
    given = POINT | {"share": 0.2, "film_shape": "computed"} | FEW
    found = lube.required_roughness(rollers, oil, **given)["composite_rms_roughness"].item()
    smooth = of_roughness("0.02 um", busy.study.line_spec)
    same = lube.required_roughness(smooth, oil, **given)["composite_rms_roughness"].item()
    assert same == pytest.approx(found, rel=2e-3)


def test_no_film_is_known_of_rollers_whose_asperities_carry_nearly_all_of_the_load(rollers, oil):
    message = "the asperities of such rough rollers carry more than 99.9 % of the load"
    with pytest.raises(
        LubeError, match=f"^share: got 0.9, which no film is known to have: {message}"
    ):
        lube.required_roughness(rollers, oil, **POINT, **RUNS, share=0.9, load_sharing="iterated")
