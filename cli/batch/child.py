"""The program of a child process: a line of JSON for each job in, one for its row out, until there is no parent."""

import json
import os
import queue
import sys
import threading
import warnings

READY, REFUSED = "ready", "refused"


def main() -> None:
    """Answer jobs for ever; only the end of standard input ends it."""
    lines: queue.SimpleQueue[str] = queue.SimpleQueue()
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8", buffering=1)
    os.dup2(2, 1)  # what libraries print is no answer
    warnings.simplefilter("ignore")
    threading.Thread(target=_listen, args=(lines,), daemon=True).start()
    from ...core.errors import OutputError
    from .job import Job
    from .single import relaxed

    print(READY, file=answers)
    while True:
        try:
            answer = vars(relaxed(Job(**json.loads(lines.get()))))
        except OutputError as error:
            answer = {REFUSED: f"{error}; when that is mended, give the same command again to go on"}
        print(json.dumps(answer), file=answers)


def _listen(lines: "queue.SimpleQueue[str]") -> None:
    """Take lines in; the parent's end, also a sudden one, is noticed at once and ends the work under way."""
    for line in sys.stdin:
        lines.put(line)
    os._exit(0)


if __name__ == "__main__":
    main()
