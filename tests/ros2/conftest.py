"""Over real DDS, but only within this machine, and apart from every other test that runs on it."""

from __future__ import annotations

import os
from collections.abc import Iterator

import pytest

_ONLY = '<Interfaces><NetworkInterface name="lo"/></Interfaces>'
LOOPBACK = f"<CycloneDDS><Domain><General>{_ONLY}</General></Domain></CycloneDDS>"


@pytest.fixture(scope="session", autouse=True)
def domain() -> Iterator[int]:
    """The domain of this test process, which commands that it starts use as well."""
    number = 100 + os.getpid() % 100
    with pytest.MonkeyPatch.context() as environment:
        environment.setenv("CYCLONEDDS_URI", LOOPBACK)
        environment.setenv("ROS_DOMAIN_ID", str(number))
        yield number
