"""Qualities are values of options."""

from types import SimpleNamespace

import pytest
from mobius_flow.addon.properties import QUALITIES, quality_of
from mobius_flow.core import RelaxOptions, minimize
from shapes import torus_trefoil

DEFAULT = RelaxOptions()


def settings(**values):
    return SimpleNamespace(**QUALITIES["GOOD"].values | values)


def test_good_is_what_the_library_does_by_itself():
    wanted = {name: getattr(DEFAULT, name) or 0 for name in QUALITIES["GOOD"].values}
    assert QUALITIES["GOOD"].values == wanted


@pytest.mark.parametrize("name", QUALITIES)
def test_settings_have_the_quality_whose_values_they_have(name):
    assert quality_of(SimpleNamespace(**QUALITIES[name].values)) == name


@pytest.mark.parametrize(
    "change", [{"tolerance": 2e-4}, {"vertices": 100}, {"method": "cg"}, {"max_iterations": 7}], ids=str
)
def test_other_settings_have_none(change):
    assert quality_of(settings(**change)) is None


def test_a_better_quality_has_less_energy():
    def energy(quality):
        values = quality.values | {"vertices": None}
        return minimize(torus_trefoil(60), RelaxOptions(**values)).final_energy

    preview, good, exact = map(energy, QUALITIES.values())
    assert exact == pytest.approx(good, rel=1e-8)
    assert good < preview
    assert good - exact < 1e-4 * exact
    assert preview - exact < 0.05 * exact
