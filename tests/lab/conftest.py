"""Commands are run as those of the command line are."""

from commands import on_iterate, refused, room, run, scratch, terminated  # noqa: F401 (fixtures)
