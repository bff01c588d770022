"""Processes that tests start: with the signals of a terminal, and never left running."""

import signal
import subprocess
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress

PATIENCE = 600.0  # seconds; not a bound for speed, but so that nothing hangs, however busy the machine


@contextmanager
def running(command: Sequence[str], **options: object) -> Iterator["subprocess.Popen[str]"]:
    """A process with pipes and default signals; it is killed when the block ends, or when patience does.

    Shells start background jobs, and nohup and cron their commands, with signals ignored, which children inherit.
    """
    numbers = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
    before = {number: signal.signal(number, signal.SIG_DFL) for number in numbers}
    try:
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)  # type: ignore[call-overload]
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
    watchdog = threading.Timer(PATIENCE, process.kill)
    watchdog.start()
    with process:
        try:
            yield process
        finally:
            watchdog.cancel()
            process.kill()


def finished(command: Sequence[str], **options: object) -> "subprocess.CompletedProcess[str]":
    """What a process says, and its status, at its own end."""
    with running(command, **options) as process:
        output, error = process.communicate()
    return subprocess.CompletedProcess(command, process.returncode, output, error)


def listening(process: "subprocess.Popen[str]") -> set[str]:
    """The addresses at which a process and its children take calls."""
    import psutil  # which Dask needs

    parent = psutil.Process(process.pid)
    found: set[str] = set()
    for each in [parent, *parent.children(recursive=True)]:
        with suppress(psutil.NoSuchProcess):
            found |= {on.laddr.ip for on in each.net_connections() if on.status == psutil.CONN_LISTEN}
    return found
