"""The token by which a robot knows who may send to it: from the environment or a guarded file, never an argument."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from fieldhand.errors import InputError

#: The environment variable that holds it.
VARIABLE = "FIELDHAND_TOKEN"
#: Characters; so many of a random one cannot be guessed.
SHORTEST, LONGEST = 24, 1000


def read_token(environ: Mapping[str, str], file: Path | None) -> str | None:
    """The token of a file, else of the environment; None where there is neither.

    Raises:
        KeyFileError: The file cannot be read, or others can read it.
        InputError: It is too short to be safe, or holds what no header can.
    """
    if file is not None:
        from fieldhand.approval.keys.rights import read_guarded

        text, where = read_guarded(file, private=True).decode("utf-8", errors="replace").strip(), str(file)
    else:
        text, where = environ.get(VARIABLE, "").strip(), VARIABLE
        if not text:
            return None
    if not SHORTEST <= len(text) <= LONGEST or not text.isascii() or not text.isprintable() or " " in text:
        raise InputError(
            f"a token has {SHORTEST} letters and digits at least, no blanks",
            where=where,
            advice="make a random one: openssl rand -hex 32",
        )
    return text
