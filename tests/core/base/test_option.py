"""Options are declared once: what is said of them and what they may be goes with the fields."""

from dataclasses import dataclass, fields, replace

import numpy as np
import pytest
from mobius_flow.core import METHODS, OptionError, RelaxOptions
from mobius_flow.core.base.arguments import check_known, declared, documented, option
from mobius_flow.core.driver.prepare import start_problem
from mobius_flow.core.driver.run import Run
from mobius_flow.core.energies import ENERGIES
from mobius_flow.core.solve.metrics import METRICS
from shapes import torus_trefoil

DECLARED = {each.name: each for each in declared(RelaxOptions)}


def test_every_field_is_declared_in_order():
    assert list(DECLARED) == [field.name for field in fields(RelaxOptions)]
    assert {name: each.default for name, each in DECLARED.items()} == vars(RelaxOptions())


@pytest.mark.parametrize("each", DECLARED.values(), ids=DECLARED)
def test_every_option_says_what_it_does(each):
    assert each.label == each.label.strip().title()
    assert len(each.help) > 15
    assert not each.help.endswith(".")
    assert each.sentence()[0].isupper()
    assert bool(each.automatic) == (each.default is None)
    assert f"\n{each.name}\n    {each.sentence('None')}.\n" in RelaxOptions.__doc__


def test_names_come_from_the_registries():
    tables = {"method": METHODS, "energy": ENERGIES, "metric": METRICS}
    assert all(DECLARED[name].choices is table for name, table in tables.items())
    assert DECLARED["edge_lengths"].choices == ("auto", "equal", "keep")
    assert DECLARED["mesh"].choices == ("auto", "fixed", "finer", "adaptive")


def test_what_auto_means_to_a_method_goes_with_the_method():
    paper = RelaxOptions(method="paper", untangle="auto")
    meant = {"barrier": "off", "solver": "dense", "mesh": "fixed", "untangle": "never", "radius": "none"}
    assert vars(paper.resolved) == vars(RelaxOptions()) | {"method": "paper"} | meant
    assert replace(paper, method="lbfgs") == RelaxOptions() == RelaxOptions().resolved
    assert replace(paper, barrier="on").resolved.barrier == "on"
    problem = start_problem(torus_trefoil(40), paper)
    assert problem.objective.barrier is None
    assert Run(problem, torus_trefoil(40), paper).options == paper.resolved
    with pytest.raises(OptionError, match="leave it or mesh='fixed' out"):
        replace(paper, untangle="always")


@documented
@dataclass(frozen=True, kw_only=True)
class Oven:
    """How to bake.

    Raises
    ------
    OptionError
        If it would burn.
    """

    heat: float = option(180.0, "Heat", "how hot it is", low=0, high=250)
    minutes: int | None = option(None, "Minutes", "how long it takes", automatic="until brown", low=1, high=90)
    shelf: str = option("top", "Shelf", "where it stands", choices=("top", "middle"))
    fan: bool = option(False, "Fan", "blow")

    def __post_init__(self):
        for each in declared(type(self)):
            object.__setattr__(self, each.name, each.checked(getattr(self, each.name)))


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"heat": 0}, "heat is 0; it must be a finite number above 0 and at most 250"),
        ({"heat": 250.5}, "heat is 250.5; it must be a finite number above 0 and at most 250"),
        ({"heat": float("nan")}, "heat is nan; it must be a finite number above 0 and at most 250"),
        ({"heat": None}, "heat is None; it must be a number"),
        ({"heat": True}, "heat is True; it must be a number"),
        ({"heat": 10**400}, "heat is too large for a number of this program"),
        ({"minutes": 0}, "minutes is 0; it must be from 1 to 90"),
        ({"minutes": 91}, "minutes is 91; it must be from 1 to 90"),
        ({"minutes": 1.5}, "minutes is 1.5; it must be a whole number"),
        ({"shelf": "midle"}, "shelf is 'midle'; did you mean middle? choose one of top, middle"),
        ({"shelf": 2}, "shelf is 2; it must be a name"),
        ({"fan": 1}, "fan is 1; it must be True or False"),
    ],
)
def test_checks_follow_from_the_declaration(options, said):
    with pytest.raises(OptionError) as error:
        Oven(**options)
    assert str(error.value) == said


@pytest.mark.parametrize("options", [{"heat": 250}, {"minutes": None}, {"minutes": 1}, {"minutes": 90}, {"fan": True}])
def test_what_is_allowed_is_taken(options):
    (name,) = options
    assert getattr(Oven(**options), name) == options[name]


@pytest.mark.parametrize("options", [{"grow": np.float32(1.5)}, {"hops": np.int8(3)}, {"stability": np.True_}])
def test_numpys_numbers_become_pythons(options):
    """Without a warning: tests turn these into errors."""
    ((name, value),) = options.items()
    taken = getattr(RelaxOptions(**options), name)
    assert type(taken) is type(DECLARED[name].default)
    assert taken == value


def test_docstrings_list_the_options():
    parameters, raises = Oven.__doc__.split("\n\nRaises\n")
    assert "\nminutes\n    How long it takes; None: until brown.\nshelf\n" in parameters
    assert "burn" in raises


def test_a_registry_does_not_know_a_name():
    with pytest.raises(OptionError, match="fruit 'aple' is unknown; did you mean apple"):
        check_known("fruit", "aple", {"apple": 1})
