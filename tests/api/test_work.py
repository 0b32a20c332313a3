"""Callers take turns at the server's threads: whoever asks for much waits, and keeps nobody else away."""

from __future__ import annotations

import asyncio
import threading
from collections import Counter

import anyio
import pytest

from fieldhand.api.problems import RefusedRequest
from fieldhand.api.work import Limits, Workers
from support.processes.patience import LONG_S


class Crowd:
    """Requests of several callers to one thread, which the first one holds until all have come."""

    def __init__(self, waiting: int) -> None:
        self.workers = Workers(Limits(at_once=1, waiting=waiting))
        self.release = threading.Event()
        self.done: list[str] = []
        self.refused = Counter[str]()

    async def ask(self, caller: str) -> None:
        def work() -> None:
            assert self.release.wait(LONG_S)
            self.done.append(caller)

        try:
            await self.workers.do(work, caller)
        except RefusedRequest as error:
            assert error.status == 503  # noqa: PT017  others are in the group
            self.refused[caller] += 1

    def run(self, *callers: str) -> None:
        async def all_of_them() -> None:
            async with anyio.create_task_group() as group:
                for caller in callers:
                    group.start_soon(self.ask, caller)
                    await anyio.sleep(0)
                self.release.set()

        asyncio.run(asyncio.wait_for(all_of_them(), LONG_S))


def test_a_caller_with_few_requests_does_not_wait_for_one_with_many() -> None:
    crowd = Crowd(waiting=20)
    crowd.run(*["many"] * 10, "few", *["many"] * 5, "other", "few")
    assert crowd.done[:5] == ["many", "few", "other", "many", "few"]
    assert Counter(crowd.done) == {"many": 15, "few": 2, "other": 1}
    assert not crowd.refused


def test_of_too_many_requests_those_of_who_has_the_most_are_refused() -> None:
    crowd = Crowd(waiting=8)
    crowd.run(*["many"] * 30, "few", "other", "few")
    assert crowd.refused == {"many": 24}
    assert Counter(crowd.done) == {"many": 6, "few": 2, "other": 1}


def test_one_caller_has_all_places_while_nobody_else_asks() -> None:
    crowd = Crowd(waiting=8)
    crowd.run(*["one"] * 12)
    assert crowd.refused == {"one": 3}
    assert len(crowd.done) == 9


def test_a_request_that_is_cancelled_leaves_its_place() -> None:
    workers = Workers(Limits(at_once=1, waiting=2))
    release = threading.Event()

    async def cancelled() -> None:
        async with anyio.create_task_group() as group:
            group.start_soon(workers.do, lambda: release.wait(LONG_S))
            await anyio.sleep(0.01)
            for _ in range(5):
                with anyio.move_on_after(0.01):
                    await workers.do(lambda: None)
            release.set()
        assert await workers.do(lambda: "done") == "done"

    asyncio.run(asyncio.wait_for(cancelled(), LONG_S))


def test_a_failure_gives_the_thread_back() -> None:
    workers = Workers(Limits(at_once=1, waiting=0))

    async def twice() -> None:
        for _ in range(2):
            with pytest.raises(ZeroDivisionError):
                await workers.do(lambda: 1 // 0)

    asyncio.run(twice())
