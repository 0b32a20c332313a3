"""Passphrases, typed at the terminal or read from the environment, never from the command line."""

from __future__ import annotations

import os

import typer

from fieldhand.cli.inputs import may_ask
from fieldhand.errors import InputError, KeyFileError
from fieldhand.language import Language, message

VARIABLE = "FIELDHAND_KEY_PASSPHRASE"
PASSWORD_VARIABLE = "FIELDHAND_PASSWORD"  # noqa: S105  the name of a variable


def new_passphrase(*, asked: bool) -> str | None:
    """Return a passphrase for a new key, from the environment or typed twice; None for a key without passphrase.

    Args:
        asked: Ask for a passphrase if the environment has none.

    Raises:
        KeyFileError: A passphrase must be typed, and standard input is not a terminal.
    """
    given = os.environ.get(VARIABLE)
    if given:
        return given
    if not asked:
        return None
    if not may_ask():
        raise KeyFileError("a passphrase cannot be asked for without a terminal", advice=f"put it in {VARIABLE}")
    typed: str = typer.prompt("Passphrase", hide_input=True, confirmation_prompt=True, err=True)
    return typed


def new_account_password(language: Language) -> str:
    """Return the new password of an account, from the environment or typed twice.

    Args:
        language: Language to ask in.

    Raises:
        InputError: A password must be typed, and standard input is not a terminal.
    """
    given = os.environ.get(PASSWORD_VARIABLE)
    if given:
        return given
    if not may_ask():
        raise InputError(
            message("a password cannot be asked for without a terminal"),
            advice=message("give --generate, or put it in {variable}", variable=PASSWORD_VARIABLE),
        )
    again = language.say(message("The same again"))
    typed: str = typer.prompt(language.say(message("Password")), hide_input=True, confirmation_prompt=again, err=True)
    return typed


def passphrase() -> str | None:
    """Return the passphrase of a key, from the environment or typed; None if standard input is not a terminal."""
    given = os.environ.get(VARIABLE)
    if given or not may_ask():
        return given or None
    typed: str = typer.prompt("Passphrase of the key", hide_input=True, err=True)
    return typed
