"""Hypothesis strategies for orchards, Tasks and event logs.

Raises:
    ModuleNotFoundError: Hypothesis, which Fieldhand does not install, is missing.
"""

from importlib.util import find_spec

if find_spec("hypothesis") is None:
    raise ModuleNotFoundError(
        'fieldhand.testing.generated needs Hypothesis; install it with: pip install "fieldhand[testing]"',
        name="hypothesis",
    )
