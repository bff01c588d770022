"""Qualities are values of options, and say which in their tooltips."""

from types import SimpleNamespace

import numpy as np
import pytest
from mobius_flow.addon.engine.quality import QUALITIES, quality_of
from mobius_flow.core import METHODS, RelaxOptions, minimize
from shapes import torus_trefoil

DEFAULT = RelaxOptions()


def settings(**values):
    return SimpleNamespace(**QUALITIES["GOOD"].values | values)


def test_good_is_what_the_library_does_by_itself():
    good = QUALITIES["GOOD"]
    assert (good.method, good.tolerance, good.max_iterations) == (
        DEFAULT.method,
        DEFAULT.tolerance,
        DEFAULT.max_iterations,
    )


@pytest.mark.parametrize("name", QUALITIES)
def test_settings_have_the_quality_whose_values_they_have(name):
    values = QUALITIES[name].values
    assert quality_of(SimpleNamespace(**values)) == name
    assert quality_of(SimpleNamespace(**values | {"tolerance": float(np.float32(values["tolerance"]))})) == name


@pytest.mark.parametrize(
    "change", [{"tolerance": 2e-4}, {"vertices": 100}, {"method": "cg"}, {"max_iterations": 7}], ids=str
)
def test_other_settings_have_none(change):
    assert quality_of(settings(**change)) is None


@pytest.mark.parametrize("quality", QUALITIES.values(), ids=QUALITIES)
def test_the_tooltip_says_what_it_means(quality):
    said = quality.description
    for words in (
        METHODS[quality.method].label,
        f"Tolerance: {quality.tolerance:g},",
        f"Max Iterations: {quality.max_iterations},",
        "Vertices",
    ):
        assert words in said
    assert not said.endswith(".")
    assert not METHODS[quality.method].comparison


def test_a_better_quality_has_less_energy():
    def energy(quality):
        values = quality.values | {"vertices": None}
        return minimize(torus_trefoil(60), RelaxOptions(**values)).final_energy

    preview, good, exact = map(energy, QUALITIES.values())
    assert exact == pytest.approx(good, rel=1e-8)
    assert good < preview
    assert good - exact < 1e-4 * exact
    assert preview - exact < 0.05 * exact
