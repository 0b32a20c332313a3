"""What needs neither pytest nor Hypothesis is imported without them; what needs one says so."""

from __future__ import annotations

import pkgutil
import subprocess
import sys

import pytest

import fieldhand.testing

PLAIN = sorted(m.name for m in pkgutil.iter_modules(fieldhand.testing.__path__) if not m.ispkg)
WITHOUT = "import sys; sys.modules['pytest'] = sys.modules['hypothesis'] = None\n"


def run(program: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)


def test_helpers_are_imported_without_pytest_and_hypothesis() -> None:
    assert "driver_contract" in PLAIN
    imports = "\n".join(f"import fieldhand.testing.{name}" for name in PLAIN)
    done = run(WITHOUT + imports)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("name", ["orchards", "tasks", "events"])
def test_strategies_say_what_to_install(name: str) -> None:
    # A finder that knows of no Hypothesis, as on a machine without it.
    hidden = (
        "import importlib.util as u, sys; known = u.find_spec\n"
        "u.find_spec = lambda name, *rest: None if name == 'hypothesis' else known(name, *rest)\n"
    )
    done = run(hidden + f"import fieldhand.testing.generated.{name}")
    assert done.returncode == 1
    assert done.stderr.splitlines()[-1] == (
        "ModuleNotFoundError: fieldhand.testing.generated needs Hypothesis;"
        ' install it with: pip install "fieldhand[testing]"'
    )
