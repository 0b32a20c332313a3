"""Whoever connects and says nothing keeps nobody out."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from fieldhand.api.admission import Admission, AdmittedConnection, Rank, network_of

ranks = st.sampled_from(list(Rank))


class Crowd:
    """Connections that close when they are told to."""

    def __init__(self, total: int, of_address: int) -> None:
        self.admission = Admission(total=total, of_address=of_address)
        self.closed: list[int] = []
        self.ranks: dict[int, Rank] = {}
        self.places: dict[int, AdmittedConnection] = {}

    def come(self, address: str, rank: Rank = Rank.WAITING) -> int:
        number = len(self.places)
        self.ranks[number] = Rank.WAITING
        place = self.admission.enter(address, rank=lambda: self.ranks[number], close=lambda: self.closed.append(number))
        self.places[number], self.ranks[number] = place, rank
        return number


@given(
    coming=st.lists(st.tuples(st.sampled_from("abc"), ranks), max_size=60),
    total=st.integers(1, 12),
    of_address=st.integers(1, 12),
)
def test_a_new_connection_is_admitted_and_one_that_matters_least_is_closed(
    coming: list[tuple[str, Rank]], total: int, of_address: int
) -> None:
    crowd = Crowd(total, of_address)
    for address, rank in coming:
        before = set(crowd.places) - set(crowd.closed)
        number = crowd.come(address, rank)
        now = set(crowd.places) - set(crowd.closed)
        assert len(now) == len(crowd.admission) <= total
        for one in "abc":
            assert sum(crowd.places[n].address == one for n in now) <= of_address
        assert number in now
        for gone in before - now:
            of_its_own = {n for n in before if crowd.places[n].address == crowd.places[gone].address}
            assert all(crowd.ranks[n] >= crowd.ranks[gone] for n in of_its_own)


def test_the_address_with_the_most_connections_loses_one() -> None:
    crowd = Crowd(total=10, of_address=10)
    operator = crowd.come("10.0.0.9")
    for k in range(200):
        crowd.come(f"10.0.0.{k % 3}")
    assert operator not in crowd.closed
    assert crowd.closed == sorted(crowd.closed)


def test_an_ipv6_network_is_one_address() -> None:
    assert network_of("2001:db8::1") == network_of("2001:db8::ffff:1") != network_of("2001:db8:0:1::1")
    assert network_of("::ffff:10.0.0.1") == network_of("10.0.0.1") == "10.0.0.1"
    assert network_of("") == ""


def test_a_connection_that_has_left_counts_once() -> None:
    crowd = Crowd(total=3, of_address=3)
    first = crowd.come("a")
    for _ in range(2):
        crowd.admission.leave(crowd.places[first])
    assert len(crowd.admission) == 0
