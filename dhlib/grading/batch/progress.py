"""What whoever waits gets to see: a bar with the rate and the time left on a terminal, plain lines elsewhere."""

from __future__ import annotations

import sys
from typing import Any, TextIO

#: Without a terminal so many lines appear in all, and none before so many submissions.
LINES = 20
AT_LEAST = 100


class Progress:
    """Counts submissions.

    Parameters
    ----------
    total : int
    stream : text file, optional
        Standard error if left out.

    Examples
    --------
    >>> import sys
    >>> with Progress(2, sys.stdout) as progress:
    ...     progress.say("a.ipynb: stopped")
    ...     progress.advance()
    a.ipynb: stopped
    """

    def __init__(self, total: int, stream: TextIO | None = None) -> None:
        self._stream = stream or sys.stderr
        self._total, self._done = total, 0
        self._bar: Any = None
        if total and self._stream.isatty():
            try:
                from tqdm import tqdm
            except ImportError:
                return
            self._bar = tqdm(total=total, file=self._stream, unit=" notebooks", dynamic_ncols=True, smoothing=0.1)

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()

    def say(self, line: str) -> None:
        """Write a line above the bar; what is no plain text in it is written out."""
        line = "".join(letter if letter.isprintable() else " " for letter in line)
        line = line.encode(self._stream.encoding or "utf-8", "backslashreplace").decode(
            self._stream.encoding or "utf-8"
        )
        if self._bar is not None:
            self._bar.write(line, file=self._stream)
        else:
            print(line, file=self._stream, flush=True)

    def advance(self) -> None:
        """One more is done."""
        self._done += 1
        if self._bar is not None:
            self._bar.update()
        elif self._done % max(AT_LEAST, self._total // LINES) == 0:
            self.say(f"{self._done} of {self._total} notebooks")
