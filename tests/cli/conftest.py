"""Commands are run as those of the command line are."""

from commands import on_iterate, run, scratch  # noqa: F401 (fixtures)
