"""Tolerances on which a proof or several rooms depend, by rooms: each with its reason and the test that holds it."""

# -- energies

ENERGY_ROUNDING = 1e-14
"""Relative difference of two energies that counts as none: some 45 units of the last place of a sum over all pairs.

Searches accept steps that raise the energy by no more; with 0, tests/core/descent/{test_claims,test_searches}.py fail.
"""
