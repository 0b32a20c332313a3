"""Production mode: what a robot in the field runs is signed, or it does not run."""

from __future__ import annotations

from collections.abc import Mapping

from fieldhand.errors import InputError, NotTrustedError
from fieldhand.language import message

#: The environment variable that puts a machine in production mode.
VARIABLE = "FIELDHAND_PRODUCTION"
_YES, _NO = ("1", "true", "yes", "on"), ("", "0", "false", "no", "off")


def in_production(environ: Mapping[str, str]) -> bool:
    """Whether only signed missions may run on this machine.

    Raises:
        InputError: The variable says neither yes nor no; nobody shall have to guess what a robot made of it.
    """
    said = environ.get(VARIABLE, "").strip().lower()
    if said in _YES:
        return True
    if said in _NO:
        return False
    raise InputError(
        message("'{said}' is neither yes nor no", said=said[:40]),
        where=VARIABLE,
        advice=message("set it to 1, or unset it"),
    )


def require_unsigned_allowed(environ: Mapping[str, str], *, asked: bool = False) -> None:
    """Refuse what nobody has signed on a machine in production.

    Args:
        environ: Where production mode is set.
        asked: Production mode was asked for otherwise.

    Raises:
        NotTrustedError: The machine is in production mode.
        InputError: The variable says neither yes nor no.
    """
    if in_production(environ) or asked:
        raise NotTrustedError(
            message("in production only signed missions run, and this is none"),
            advice=message(
                "have it approved (fieldhand approve) with a key that is trusted here, and run the .mission file"
            ),
        )
