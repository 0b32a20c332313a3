"""Comparison of whole arrays, where ``pytest.approx`` compares one number at a time: seconds for a large table."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike


def assert_near(found: ArrayLike, expected: ArrayLike, *, rel: float = 0.0, within: float = 0.0) -> None:
    """Assert that arrays of one shape are the same but for ``rel`` of what is expected and ``within`` more."""
    assert np.shape(found) == np.shape(expected)
    np.testing.assert_allclose(found, expected, rtol=rel, atol=within, equal_nan=False)
