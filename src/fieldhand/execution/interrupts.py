"""Ctrl-C, and the signals of a closed terminal or a shutdown, as requests: not in the middle of something."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

_REASONS = {
    signal.SIGINT: "stopped by the operator (Ctrl-C)",
    signal.SIGTERM: "the program was told to end (SIGTERM)",
    signal.SIGHUP: "the terminal was closed (SIGHUP)",
}


@contextmanager
def ctrl_c_as_request() -> Iterator[Callable[[], str | None]]:
    """Within this, the first Ctrl-C is remembered, and the next raises KeyboardInterrupt as ever.

    A closed terminal (SIGHUP) and a polite kill (SIGTERM) are remembered likewise, every time.

    So that no event is half written and no capture is lost. Only in the main thread, and only where nobody else
    handles Ctrl-C: elsewhere it does nothing.

    Yields:
        A function that gives the reason once Ctrl-C was pressed, else None.
    """
    pressed: list[str] = []

    def remember(number: int, frame: FrameType | None) -> None:  # noqa: ARG001  the signature that signal wants
        pressed.append(_REASONS[signal.Signals(number)])
        if number == signal.SIGINT:
            signal.signal(signal.SIGINT, signal.default_int_handler)

    def reason() -> str | None:
        return pressed[0] if pressed else None

    ours = (
        threading.current_thread() is threading.main_thread()
        and signal.getsignal(signal.SIGINT) is signal.default_int_handler
    )
    if not ours:
        yield reason
        return
    before = {number: signal.signal(number, remember) for number in _REASONS}
    try:
        yield reason
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
