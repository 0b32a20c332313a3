"""The ROS domain id: only nodes of one domain discover each other."""

from __future__ import annotations

import os
from collections.abc import Mapping

from fieldhand.errors import InputError

#: Highest domain that leaves ports for 120 processes (RTPS 9.6.1).
MOST_DOMAIN = 232


def domain_of(given: int | None, environ: Mapping[str, str] = os.environ) -> int:
    """Return the domain id to use.

    Args:
        given: Domain id; None for ``ROS_DOMAIN_ID`` of the environment, else 0.
        environ: Environment variables.

    Raises:
        InputError: The value is not a domain id.
    """
    text = str(given) if given is not None else environ.get("ROS_DOMAIN_ID", "").strip() or "0"
    if not text.isascii() or not text.isdigit() or int(text) > MOST_DOMAIN:
        where = "" if given is not None else "ROS_DOMAIN_ID"
        raise InputError(
            f"{text[:40]!r} is not a DDS domain", where=where, advice=f"give a number from 0 to {MOST_DOMAIN}"
        )
    return int(text)
