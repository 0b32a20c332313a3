"""Guesses become slow, and the right credential passes, whoever guesses from wherever."""

from __future__ import annotations

import asyncio
import random
from collections import Counter

import anyio
import pytest

from fieldhand.api.login_throttle import LoginLimits, LoginThrottle
from fieldhand.api.problems import RefusedRequest


class Time:
    """A clock that a sleeper advances, and what it was asked to wait."""

    def __init__(self) -> None:
        self.now, self.slept = 0.0, list[float]()

    def clock(self) -> float:
        return self.now

    async def sleep(self, seconds: float) -> None:
        self.slept.append(seconds)
        await anyio.sleep(0)


def throttle(time: Time, limits: LoginLimits | None = None) -> LoginThrottle:
    return LoginThrottle(limits, clock=time.clock, sleep=time.sleep, chance=random.Random(3))


async def wrong() -> str | None:
    await anyio.sleep(0)
    return None


async def right() -> str | None:
    await anyio.sleep(0)
    return "in"


def test_each_guess_costs_more_up_to_a_limit_and_the_right_one_nothing() -> None:
    time = Time()
    paced = throttle(time)

    async def guess() -> None:
        for _ in range(8):
            assert await paced.attempt("10.0.0.1", "ada", wrong) is None
        assert time.slept == [0.25, 0.5, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]
        assert await paced.attempt("10.0.0.1", "ada", right) == "in"
        assert len(time.slept) == 8

    asyncio.run(guess())


def test_guesses_from_many_addresses_on_one_account_become_slow_too() -> None:
    time = Time()
    paced = throttle(time)

    async def guess() -> None:
        for k in range(8):
            await paced.attempt(f"10.0.0.{k}", "ada", wrong)

    asyncio.run(guess())
    assert time.slept[-1] == 1.0


def test_an_ipv6_network_counts_as_one_address() -> None:
    time = Time()
    paced = throttle(time)

    async def guess() -> None:
        for k in range(4):
            await paced.attempt(f"2001:db8::{k}", f"person {k}", wrong)

    asyncio.run(guess())
    assert time.slept == [0.25, 0.5, 1.0, 1.0]


def test_old_guesses_are_forgotten() -> None:
    time = Time()
    paced = throttle(time)

    async def guess() -> None:
        for _ in range(4):
            await paced.attempt("10.0.0.1", "ada", wrong)
        time.now += 1000
        await paced.attempt("10.0.0.1", "ada", wrong)

    asyncio.run(guess())
    assert time.slept[-1] == 0.25


def test_the_memory_of_guesses_is_limited() -> None:
    time = Time()
    paced = throttle(time, LoginLimits(remembered=10))

    async def guess() -> None:
        for k in range(100):
            await paced.attempt(f"10.0.{k}.1", f"person {k}", wrong)

    asyncio.run(guess())
    assert len(paced._wrong) == 10
    assert paced._queues == {}
    assert paced._busy == {}


@pytest.mark.parametrize(
    ("address", "account"),
    [("10.0.0.2", "ada"), ("10.0.0.1", "bob"), ("10.0.0.1", "ada")],
    ids=["the attacked account", "the address of the attack", "both"],
)
def test_the_right_password_passes_during_an_attack(address: str, account: str) -> None:
    """60 guessers at one address begin again as soon as they are refused."""
    time = Time()
    paced = throttle(time)

    async def attack(done: anyio.Event) -> None:
        while not done.is_set():
            assert await paced.attempt("10.0.0.1", "ada", wrong) is None

    async def both() -> None:
        done = anyio.Event()
        async with anyio.create_task_group() as group:
            for _ in range(60):
                group.start_soon(attack, done)
            for _ in range(50):
                await anyio.sleep(0)
            for _ in range(3):
                assert await paced.attempt(address, account, right) == "in"
            done.set()

    asyncio.run(asyncio.wait_for(both(), 600))


def test_the_own_address_does_not_wait_for_guesses_from_another() -> None:
    """While a guess at one address waits for ever, others are answered."""
    never = anyio.Event()

    async def sleep(_: float) -> None:
        await never.wait()

    paced = LoginThrottle(sleep=sleep)

    async def both() -> None:
        async with anyio.create_task_group() as group:
            for k in range(20):
                group.start_soon(paced.attempt, "10.0.0.1", f"person {k % 5}", wrong)
            await anyio.sleep(0)
            assert await paced.attempt("10.0.0.2", "person 1", right) == "in"
            assert await paced.attempt("10.0.0.1", "person 9", right) == "in"
            group.cancel_scope.cancel()

    asyncio.run(asyncio.wait_for(both(), 600))
    assert paced._queues == {}


def test_passwords_are_verified_one_of_an_address_and_few_at_once() -> None:
    at_once, most = Counter[str](), Counter[str]()

    async def verify(address: str) -> None:
        for key in (address, "all"):
            at_once[key] += 1
            most[key] = max(most[key], at_once[key])
        for _ in range(5):
            await anyio.sleep(0)
        for key in (address, "all"):
            at_once[key] -= 1

    time = Time()
    paced = throttle(time)

    async def crowd() -> None:
        async with anyio.create_task_group() as group:
            for k in range(40):
                address = f"10.0.0.{k % 4}"
                group.start_soon(paced.attempt, address, f"person {k}", lambda a=address: verify(a))

    asyncio.run(crowd())
    assert most.pop("all") == 2
    assert set(most.values()) == {1}


def test_of_too_many_waiting_attempts_a_random_one_is_refused() -> None:
    time = Time()
    paced = throttle(time, LoginLimits(waiting=10))
    results: list[tuple[int, int]] = []

    async def one(number: int) -> None:
        try:
            await paced.attempt("10.0.0.1", "ada", wrong)
        except RefusedRequest as refused:
            results.append((number, refused.status))

    async def crowd() -> None:
        async with anyio.create_task_group() as group:
            for k in range(50):
                group.start_soon(one, k)

    asyncio.run(crowd())
    assert len(results) == 39
    assert {status for _, status in results} == {429}
    # Neither the first nor the last ones are kept away as such.
    served = set(range(50)) - {number for number, _ in results}
    assert served not in (set(range(11)), {0, *range(40, 50)})
    assert paced._queues == {}
