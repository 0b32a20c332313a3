"""Ctrl-C and termination signals as requests that are polled, so that nothing is interrupted half-way."""

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
    """Turn the first Ctrl-C into a request; the next one raises KeyboardInterrupt as usual.

    A closed terminal (SIGHUP) and a termination request (SIGTERM) are treated alike, every time. No event is left half
    written and no capture is lost. Works only in the main thread, and only for signals with the default handler: Ctrl-C
    does not end a mission in the background, but a termination request does.

    Yields:
        Function that returns the reason once a signal has arrived, else None.
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
