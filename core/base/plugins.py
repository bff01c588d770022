"""Tables of what is chosen by name, to which installed packages add by entry points."""

import logging
from collections.abc import Callable, Iterator, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

_Thing = TypeVar("_Thing")
_LOG = logging.getLogger(__name__)


class Table(Mapping[str, _Thing]):
    """What is built in, and what packages add in a group: an object by its name, or a mapping from names to objects.

    Packages are loaded when the table is gone through, or has no such name: while the table's own module is imported,
    they could not import it. One that cannot be loaded, or adds nonsense, is left out, with a warning.
    """

    def __init__(self, group: str, is_one: Callable[[object], bool], built_in: Mapping[str, _Thing]) -> None:
        self.group, self._is_one, self._built_in = group, is_one, built_in

    def __getitem__(self, name: str) -> _Thing:
        return self._built_in[name] if name in self._built_in else self._added[name]

    def __iter__(self) -> Iterator[str]:
        return iter({**self._built_in, **self._added})

    def __len__(self) -> int:
        return len(self._built_in) + len(self._added)

    @cached_property
    def _added(self) -> dict[str, _Thing]:
        from importlib.metadata import entry_points  # which takes a while to import

        found: dict[str, _Thing] = {}
        for entry in entry_points(group=self.group):
            try:
                given = entry.load()
                things: Mapping[str, Any] = given if isinstance(given, Mapping) else {entry.name: given}
                if taken := {*self._built_in, *found}.intersection(things):
                    raise ValueError(f"{min(taken)} exists already")
                if not all(map(self._is_one, things.values())):
                    raise TypeError(f"{entry.value} is not what belongs there")
            except Exception as error:  # whatever another package's code may raise
                leave_out(entry, error)
            else:
                found |= things
        return found


def leave_out(entry: "EntryPoint", error: Exception) -> None:
    """Warn that an entry point is left out, in one sentence that names the package that has it."""
    whose = entry.dist.name if entry.dist else "a package"
    _LOG.warning("%s in %s, of the package %s, is left out: %s", entry.name, entry.group, whose, error)
