"""The formats whose files hold a curve's vertices, with all their digits."""

from mobius_flow.core.io import written_formats

CODES = {".pd", ".dt", ".gauss"}
OF_VERTICES = [suffix for suffix in written_formats() if suffix not in CODES]
