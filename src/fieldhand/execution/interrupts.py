"""Ctrl-C, and the signals of a closed terminal or a shutdown, as requests: not in the middle of something."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

from fieldhand.language import message

_REASONS = {
    signal.SIGINT: message("stopped by the operator (Ctrl-C)", context="log"),
    signal.SIGTERM: message("the program was told to end (SIGTERM)", context="log"),
    signal.SIGHUP: message("the terminal was closed (SIGHUP)", context="log"),
}


@contextmanager
def ctrl_c_as_request() -> Iterator[Callable[[], str | None]]:
    """Within this, the first Ctrl-C is remembered, and the next raises KeyboardInterrupt as ever.

    A closed terminal (SIGHUP) and a polite kill (SIGTERM) are remembered likewise, every time.

    So that no event is half written and no capture is lost. Only in the main thread, and only signals that nobody else
    handles or ignores: a mission in the background is not ended by the Ctrl-C of another, but it is by a kill.

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

    main = threading.current_thread() is threading.main_thread()
    usual = {signal.SIG_DFL, signal.default_int_handler}
    ours = [number for number in _REASONS if main and signal.getsignal(number) in usual]
    before = {number: signal.signal(number, remember) for number in ours}
    try:
        yield reason
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
