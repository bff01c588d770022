"""Check trajectory files independently of the program that wrote them."""

from .check import verify
from .verdict import Verdict

__all__ = ["Verdict", "verify"]
