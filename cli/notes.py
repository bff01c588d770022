"""What the library logs, kept until it is known that it is not followed by a refusal: that has one line."""

import logging
import sys
from types import TracebackType

from .streams import one_line


class Notes(logging.Handler):
    """Collects warnings while it is entered; they are printed from `show` on."""

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self._lines: list[str] = []
        self._shown = False

    def __enter__(self) -> "Notes":
        logging.getLogger().addHandler(self)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        logging.getLogger().removeHandler(self)

    def emit(self, record: logging.LogRecord) -> None:
        """Keep a line, or print it."""
        self._lines.append(one_line(f"mobius-flow: {record.getMessage()}"))
        if self._shown:
            self.show()

    def show(self) -> None:
        """Print what has been collected, and from now on what is logged at once."""
        self._shown = True
        for line in self._lines:
            print(line, file=sys.stderr)
        self._lines.clear()
