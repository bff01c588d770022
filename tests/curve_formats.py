"""The formats whose files hold a curve's vertices, with all their digits."""

from mobius_flow.core.curve.io import WRITTEN_FORMATS

CODES = {".pd", ".dt", ".gauss"}
OF_VERTICES = [suffix for suffix in WRITTEN_FORMATS if suffix not in CODES]
