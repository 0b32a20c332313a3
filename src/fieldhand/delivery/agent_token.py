"""The token that authorizes senders on a robot, read from the environment or a private file, never an argument."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from fieldhand.errors import InputError

#: Environment variable with the token.
VARIABLE = "FIELDHAND_TOKEN"
#: Number of characters; a random token of the shortest length cannot be guessed.
SHORTEST, LONGEST = 24, 1000


def read_token(environ: Mapping[str, str], file: Path | None) -> str | None:
    """Return the token in a file, else the one in the environment; None if there is neither.

    Raises:
        KeyFileError: The file cannot be read, or other users can read it.
        InputError: The token is too short to be safe, or contains a character that an HTTP header cannot.
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
            f"a token has at least {SHORTEST} letters and digits, and no spaces",
            where=where,
            advice="make a random one: openssl rand -hex 32",
        )
    return text
