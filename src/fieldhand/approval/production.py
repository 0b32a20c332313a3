"""Production mode, in which a machine runs only signed missions."""

from __future__ import annotations

from collections.abc import Mapping

from fieldhand.errors import InputError, NotTrustedError
from fieldhand.language import message

#: The environment variable that puts a machine in production mode.
VARIABLE = "FIELDHAND_PRODUCTION"
_YES, _NO = ("1", "true", "yes", "on"), ("", "0", "false", "no", "off")


def in_production(environ: Mapping[str, str]) -> bool:
    """Return True if this machine runs only signed missions.

    Raises:
        InputError: The variable is neither a yes nor a no; an unclear value must not be guessed.
    """
    setting = environ.get(VARIABLE, "").strip().lower()
    if setting in _YES:
        return True
    if setting in _NO:
        return False
    raise InputError(
        message("'{said}' is neither yes nor no", said=setting[:40]),
        where=VARIABLE,
        advice=message("set it to 1, or unset it"),
    )


def require_unsigned_allowed(environ: Mapping[str, str], *, asked: bool = False) -> None:
    """Refuse an unsigned mission on a machine in production mode.

    Args:
        environ: Environment variables.
        asked: True if production mode was requested by other means, such as an option.

    Raises:
        NotTrustedError: The machine is in production mode.
        InputError: The variable is neither a yes nor a no.
    """
    if in_production(environ) or asked:
        raise NotTrustedError(
            message("in production only signed missions run, and this one is not signed"),
            advice=message(
                "have it approved (fieldhand approve) with a key that is trusted here, and run the .mission file"
            ),
        )
