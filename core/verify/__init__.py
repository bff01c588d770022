"""Check trajectory files independently of the program that wrote them."""

from .check import Verdict, verify

__all__ = ["Verdict", "verify"]
