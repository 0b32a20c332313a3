"""Passphrases: typed where nobody sees them, or from the environment; never among the words of a command."""

from __future__ import annotations

import os

import typer

from fieldhand.cli.inputs import may_ask
from fieldhand.errors import KeyFileError

VARIABLE = "FIELDHAND_KEY_PASSPHRASE"


def new_passphrase(*, asked: bool) -> str | None:
    """A passphrase for a new key: the environment's, or typed twice if one was asked for, or none.

    Raises:
        KeyFileError: One was asked for, and nobody is there to type it.
    """
    given = os.environ.get(VARIABLE)
    if given:
        return given
    if not asked:
        return None
    if not may_ask():
        raise KeyFileError("nobody is here to type a passphrase", advice=f"put it in {VARIABLE}")
    typed: str = typer.prompt("Passphrase", hide_input=True, confirmation_prompt=True, err=True)
    return typed


def passphrase() -> str | None:
    """The passphrase of a key: the environment's, or typed; None where nobody is there."""
    given = os.environ.get(VARIABLE)
    if given or not may_ask():
        return given or None
    typed: str = typer.prompt("Passphrase of the key", hide_input=True, err=True)
    return typed
