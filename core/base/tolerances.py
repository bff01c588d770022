"""Tolerances on which a proof or several rooms depend, by rooms: each with its reason and the test that holds it."""

# -- energies

ENERGY_ROUNDING = 1e-14
"""Relative difference of two energies that counts as none: some 45 units of the last place of a sum over all pairs.

Searches accept steps that raise the energy by no more; with 0, tests/core/descent/{test_claims,test_searches}.py fail.
"""

# -- descent

BULK = 0.1
"""Eigenvalues of the second derivative against J_C: flat and soft directions of knots are below, all others above.

tests/core/descent/test_soft_modes.py
"""

# -- collision: proofs by separating planes

PLANE_ROUNDING = 32 * 2.0**-53
"""Bound of the rounding errors of ⟨n, x_i − y_j⟩ in units of Σ|n_k||d_k|, of sums of which the planes are lowered.

Differences of coordinates are relatively exact, one unit roundoff u; a dot product of m ≤ 3 terms adds m, the
combination of D, e and f or g two, the interpolation in time three, this bound's own evaluation a few: below 16 u.
Twice that is taken.  tests/core/collision/test_embedded.py
"""

PLANE_UNDERFLOW = 1e-300
"""Products below 2⁻¹⁰²² lose absolute, not relative accuracy: planes are lowered and boxes widened by more than that.

tests/core/collision/test_windows.py
"""

# -- collision: curves that one can compute with

MIN_SPACING = 2.0**-48
"""Distance of neighbours, relative to the curve's size, below which they coincide: 32 u, up to which all is rounding.

tests/core/collision/test_embedded.py
"""

MIN_GAP = 1e-11
"""Distance of strands relative to the curve's length: at half of that, energies are wrong by percents.

Curve and obstacles keep it, too.  tests/core/collision/test_clearance.py
"""

ON_EDGE_UNITS = 2.5
"""Bound of the rounding errors of tail + t (head − tail), in units of the last place of the largest coordinate.

One each of the difference, which may be twice as large, and of the product, and half a one of the sum; that of t itself
only moves the vertex along its edge.  `core/proof/checker.py`, which has no constants of others, allows for 16.
tests/core/test_certificate.py
"""

# -- proof: the filter before the checker

SIEVE_ROUNDING = 2.0**-48
"""Bound of the rounding errors of sums of products relative to the sum of the absolute values.

Differences of coordinates are exact up to 2⁻⁵³, and there are fewer than 16 roundings after them.
tests/core/proof/test_filter.py
"""

SIEVE_UNDERFLOW = 1e-290
"""What products may lose below 2⁻¹⁰²², with much to spare: no motion is known for which it is needed."""
