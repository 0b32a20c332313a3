"""The domain of a ROS 2 graph: nodes hear each other within one."""

from __future__ import annotations

import os
from collections.abc import Mapping

from fieldhand.errors import InputError

#: Where ports are left for 120 processes (RTPS 9.6.1).
MOST_DOMAIN = 232


def domain_of(given: int | None, environ: Mapping[str, str] = os.environ) -> int:
    """The domain that is meant.

    Args:
        given: None means ``ROS_DOMAIN_ID`` of the environment, else 0.
        environ: The environment.

    Raises:
        InputError: It is none.
    """
    text = str(given) if given is not None else environ.get("ROS_DOMAIN_ID", "").strip() or "0"
    if not text.isascii() or not text.isdigit() or int(text) > MOST_DOMAIN:
        where = "" if given is not None else "ROS_DOMAIN_ID"
        raise InputError(
            f"{text[:40]!r} is no DDS domain", where=where, advice=f"give a number from 0 to {MOST_DOMAIN}"
        )
    return int(text)
