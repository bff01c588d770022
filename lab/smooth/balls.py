"""Points of smooth closed curves to twice the digits of doubles, by ball arithmetic.

A component is γ(t) = Re Σₖ cₖ e^{2πikt}, 0 ≤ t < 1, with coefficients c, shape (modes + 1, 3), taken as exact: an
entire function of t.
"""

from functools import partial

import numpy as np

from ...core.base.errors import MobiusFlowError
from ...core.base.types import ComplexArray, FloatArray

try:
    from flint import acb as acb
    from flint import arb as arb
    from flint import ctx
except ImportError as error:
    raise MobiusFlowError('ball arithmetic needs python-flint: pip install python-flint (the extra "lab")') from error

precise = partial(ctx.workprec, 128)  # bits, more than cancellation here takes from those of two doubles


def points(coefficients: ComplexArray, nodes: int, order: int = 0, shift: int = 0) -> tuple[FloatArray, FloatArray]:
    """A component's derivative at (j + shift/2)/nodes, and what these doubles leave; shapes (3, nodes).

    The error of both together is at most 2⁻¹⁰⁰ of the sum of all |(2πk)ʳ cₖ|, r the order.  It is a discrete Fourier
    transform, where frequencies are folded.
    """
    with precise():
        spectra = [[acb(0)] * nodes for _ in range(3)]
        for k, row in enumerate(coefficients):
            wave = acb(0, 2 * k * arb.pi()) ** order * acb(arb(k * shift) / nodes).exp_pi_i()
            for spectrum, x in zip(spectra, row, strict=True):
                spectrum[k % nodes] += (acb(complex(x)) * wave).conjugate()
        exact = [[z.real for z in acb.dft(spectrum)] for spectrum in spectra]
        high = [[float(x) for x in row] for row in exact]
        low = [[float(x - y) for x, y in zip(*rows, strict=True)] for rows in zip(exact, high, strict=True)]
    return np.array(high), np.array(low)
