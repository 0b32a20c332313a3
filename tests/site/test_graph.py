"""Shortest paths over a graph, and connected things."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from fieldhand.site.driving import graph as graphs
from fieldhand.site.driving.graph import Graph, Links, chain
from fieldhand.site.rows.labels import linked


@st.composite
def roads(draw: st.DrawFn) -> tuple[int, list[tuple[int, int, float]], list[Links]]:
    """Draw a number of nodes, edges between them and places linked to some of them."""
    count = draw(st.integers(1, 12))
    node = st.integers(0, count - 1)
    edges = draw(st.lists(st.tuples(node, node, st.floats(0.0, 10.0)), max_size=30))
    links = draw(st.lists(st.dictionaries(node, st.floats(0.0, 10.0), max_size=4), min_size=1, max_size=15))
    return count, edges, [Links(np.array(list(a), dtype=np.intp), np.array(list(a.values()))) for a in links]


@given(roads())
def test_a_search_in_python_finds_what_scipy_finds(
    drawn: tuple[int, list[tuple[int, int, float]], list[Links]],
) -> None:
    count, edges, places = drawn
    one, two = (np.array([edge[k] for edge in edges], dtype=np.intp) for k in (0, 1))
    metres = np.array([edge[2] for edge in edges])
    python, scipy = Graph(count, one, two, metres), Graph(count, one, two, metres)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(graphs, "_FEW_EDGES", -1)
        expected, lengths = scipy.rows(places), scipy.lengths(places)
    found = python.rows(places)
    assert found.metres.tolist() == expected.metres.tolist()
    assert python.lengths(places).tolist() == lengths.tolist()
    for place, links in enumerate(places):
        for node in np.flatnonzero(np.isfinite(found.metres[place])).tolist():
            first, *others = chain(found, place, node)
            walked = max(float(links.metres[links.nodes == first].min()), 1e-9)
            for a, b in zip([first, *others], others, strict=False):
                walked += max(min(m for i, j, m in edges if {i, j} == {a, b}), 1e-9)
            assert walked == found.metres[place, node]


@given(st.integers(1, 20).flatmap(lambda n: st.tuples(st.just(n), st.lists(st.tuples(*[st.integers(0, n - 1)] * 2)))))
def test_linked_things_have_one_label_in_order(drawn: tuple[int, list[tuple[int, int]]]) -> None:
    count, pairs = drawn
    one, two = np.array(pairs, dtype=np.intp).reshape(-1, 2).T
    graph = coo_matrix((np.ones(len(one)), (one, two)), shape=(count, count))
    label = linked(count, one, two)
    assert label.tolist() == connected_components(graph, directed=False)[1].tolist()


def test_long_chains_in_any_order_are_linked() -> None:
    order = np.random.default_rng(1).permutation(3_000)
    label = linked(3_000, order[:-1], order[1:])
    assert not label.any()
