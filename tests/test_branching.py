"""What a node or a selector means is said in its own file: few other modules branch on its class."""

from __future__ import annotations

import ast
from collections import defaultdict
from pathlib import Path

import fieldhand

SOURCE = Path(fieldhand.__file__).parent

#: Modules that may branch on a class, beside the one that defines it.
MOST_MODULES = 3


def defined_in(folder: Path) -> dict[str, Path]:
    """Return the classes of a folder with the files that define them."""
    found = {}
    for file in sorted(folder.rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.ClassDef):
                found.setdefault(node.name, file)
    return found


def branched_on(tree: ast.AST) -> set[str]:
    """Return the names of the classes that a module branches on, by ``isinstance`` or by ``case``."""
    found = set()
    for node in ast.walk(tree):
        classes: list[ast.AST] = []
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            if node.func.id in ("isinstance", "issubclass") and len(node.args) == 2:
                classes = list(ast.walk(node.args[1]))
        elif isinstance(node, ast.MatchClass):
            classes = [node.cls]
        for named in classes:
            if isinstance(named, ast.Name):
                found.add(named.id)
            elif isinstance(named, ast.Attribute):
                found.add(named.attr)
    return found


def test_few_modules_branch_on_a_class_of_a_node_or_a_selector() -> None:
    own = defined_in(SOURCE / "places") | defined_in(SOURCE / "task" / "nodes")
    modules: dict[str, list[str]] = defaultdict(list)
    for file in sorted(SOURCE.rglob("*.py")):
        for name in branched_on(ast.parse(file.read_text())) & own.keys():
            if own[name] != file:
                modules[name].append(str(file.relative_to(SOURCE)))
    assert modules["ForEach"], "the test sees no branch at all"
    assert {name: files for name, files in modules.items() if len(files) > MOST_MODULES} == {}
