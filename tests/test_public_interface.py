"""``import fieldhand``: the names it offers, where they come from, and what importing it costs."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import fieldhand


def test_the_public_names_are_sorted_and_each_has_its_module():
    assert fieldhand.__all__ == sorted(set(fieldhand.__all__))
    assert set(fieldhand.__all__) == set(fieldhand._PUBLIC)


def test_type_checkers_see_the_same_names_from_the_same_modules():
    assert _imported_for_types() == fieldhand._PUBLIC


def _imported_for_types() -> dict[str, tuple[str, str]]:
    """Return the names that ``if TYPE_CHECKING`` imports, in the form of ``_PUBLIC``."""
    tree = ast.parse(Path(fieldhand.__file__).read_text(encoding="utf-8"))
    (block,) = [node for node in tree.body if isinstance(node, ast.If)]
    found = {}
    for statement in block.body:
        assert isinstance(statement, ast.ImportFrom)
        for alias in statement.names:
            module, name = statement.module, alias.name
            if isinstance(_attribute(module, name), type(fieldhand)):
                module, name = f"{module}.{name}", ""
            found[alias.asname or alias.name] = (module, name)
    return found


def _attribute(module: str, name: str) -> object:
    return getattr(__import__(module, fromlist=[name]), name)


@pytest.mark.parametrize("name", fieldhand.__all__)
def test_every_name_resolves_and_is_documented(name):
    value = getattr(fieldhand, name)
    assert value.__doc__
    assert getattr(fieldhand, name) is value
    assert name in dir(fieldhand)


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="module 'fieldhand' has no attribute 'Orchard'"):
        fieldhand.Orchard  # noqa: B018
    assert not hasattr(fieldhand, "Orchard")


def test_importing_it_loads_no_library():
    code = "import sys, fieldhand; print(*sorted(m.partition('.')[0] for m in sys.modules))"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert "fieldhand" in loaded
    assert not {"numpy", "matplotlib", "scipy", "shapely", "lxml", "pydantic", "pandas"} & set(loaded)
