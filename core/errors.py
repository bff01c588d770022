"""Errors that a user can act on: one sentence saying what, where, and what to do."""

from pathlib import Path


class MobiusFlowError(ValueError):
    """Base of every error that is the input's fault rather than the program's."""


class CurveError(MobiusFlowError):
    """A curve that cannot be used: too few points, not finite, touching itself, ..."""


class OptionError(MobiusFlowError):
    """An option outside its range; the message names the option and what is allowed."""


class CurveFileError(CurveError):
    """A curve file that cannot be read; the message names the file, the line and the reason."""

    def __init__(self, path: Path | str, reason: str, line: int | None = None) -> None:
        place = f"{path}" if line is None else f"{path}, line {line}"
        super().__init__(f"{place}: {reason}")
        self.path, self.line, self.reason = Path(path), line, reason
