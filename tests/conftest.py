"""For every test: no language model, no network beyond this machine, no configuration of the developer's own."""

from __future__ import annotations

import gc
import os
import socket
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

from support.processes.certificates import certificate
from support.requests.planned import keep_in

TESTS = Path(__file__).parent

# Every run draws the same examples: what fails here fails for everyone. Others, and of expensive properties many more,
# are drawn with --hypothesis-profile=thorough, which is how to look for what these miss.
# No example has a time limit: how long one takes depends on what else the machine does.
settings.register_profile("steady", derandomize=True, max_examples=50, deadline=None)
settings.register_profile("thorough", derandomize=False, max_examples=300, deadline=None)
settings.load_profile("steady")

#: A developer's own keys, endpoints and proxies must not change what a test sees, nor spend money.
_PRIVATE = ("FIELDHAND_", "OPENAI_", "ANTHROPIC_", "GOOGLE_", "GEMINI_")
_PROXIES = ("http_proxy", "https_proxy", "all_proxy")
_LOCAL = ("127.0.0.1", "::1", "localhost", None, b"localhost")


#: Files whose tests wait for robots and for processes most of their time, and those of the longest tests. They are
#: begun first: one worker waits while the others compute, and at the end nobody waits for a long test.
_FIRST = (
    "ros2/test_missions_over_dds.py",
    "cli/test_resume.py",
    "program/test_agent.py",
    "agent/test_busy.py",
    "api/test_event_stream.py",
    "fleet/test_fleet.py",
    "cli/test_interrupt.py",
    "cli/test_two_processes.py",
    "ros2/test_faults_over_dds.py",
    "ros2/test_sim_robot_command.py",
    "test_example_plugin.py",
    "test_notebook.py",
    "test_docs.py",
)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with the tests of some files; keep the order otherwise."""
    turns = {TESTS / name: turn for turn, name in enumerate(_FIRST)}
    items.sort(key=lambda item: turns.get(item.path, len(turns)))


def pytest_configure() -> None:
    """Look for no garbage until the tests begin: all that is loaded and collected remains."""
    gc.disable()


def pytest_collection_finish() -> None:
    """Look for garbage among what the tests make, and not again and again among a million objects that remain.

    A plan makes some ten thousand objects that live as long as its chart: they are looked at once or twice, not often.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(100_000, 20, 20)
    gc.enable()


@pytest.fixture(scope="session", autouse=True)
def _no_private_environment(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Nor must a test leave anything in the developer's own folders."""
    with pytest.MonkeyPatch.context() as patch:
        for name in list(os.environ):
            if name.startswith(_PRIVATE) or name.lower() in _PROXIES:
                patch.delenv(name)
        patch.setenv("XDG_STATE_HOME", str(tmp_path_factory.mktemp("state")))
        yield


@pytest.fixture(scope="session", autouse=True)
def _no_authority_of_the_world(
    _no_private_environment: None, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[None]:
    """Trust one certificate that signs nothing, where a client would read the 150 of the world for each connection.

    A client that ignores the environment reads those of certifi, also to connect without encryption.
    """
    cert, _, _ = certificate(tmp_path_factory.mktemp("authority"), "nobody")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SSL_CERT_FILE", str(cert))
        if find_spec("certifi") is not None:
            patch.setattr("certifi.where", lambda: str(cert))
        yield


@pytest.fixture(scope="session", autouse=True)
def _missions_of_the_tests(_no_private_environment: None, tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Missions of the tests do not lie among the developer's own."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("FIELDHAND_MISSIONS", str(tmp_path_factory.mktemp("missions")))
        yield


@pytest.fixture(scope="session", autouse=True)
def _plans_of_this_run(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Share plans: a request that one process has planned is not planned by the others."""
    own = tmp_path_factory.getbasetemp()
    keep_in((own.parent if "PYTEST_XDIST_WORKER" in os.environ else own) / "plans")


@pytest.fixture(scope="session", autouse=True)
def _no_real_model_calls() -> Iterator[None]:
    """A test that reaches for another machine fails, whoever catches exceptions on the way."""
    connect, resolve = socket.socket.connect, socket.getaddrinfo

    def guarded_connect(self: socket.socket, address: Any) -> None:
        if self.family in (socket.AF_INET, socket.AF_INET6) and address[0] not in _LOCAL:
            pytest.fail(f"a test tried to connect to {address[0]}")
        connect(self, address)

    def guarded_resolve(host: Any, *args: Any, **kwargs: Any) -> Any:
        if host not in _LOCAL:
            pytest.fail(f"a test tried to find the address of {host}")
        return resolve(host, *args, **kwargs)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(socket.socket, "connect", guarded_connect)
        patch.setattr(socket, "getaddrinfo", guarded_resolve)
        yield
