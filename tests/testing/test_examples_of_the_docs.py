"""The examples of docs/testing.md pass as test files of a user, outside this project."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

PAGE = Path(__file__).resolve().parents[2] / "docs" / "testing.md"
EXAMPLES = re.findall(r"^```python\n(.*?)^```", PAGE.read_text(), re.MULTILINE | re.DOTALL)


@pytest.fixture(scope="module")
def ran(tmp_path_factory: pytest.TempPathFactory) -> tuple[ElementTree.Element, str]:
    """The report of one run of all examples, each in a file of its own, and what it printed."""
    folder = tmp_path_factory.mktemp("mine")
    for number, example in enumerate(EXAMPLES):
        (folder / f"test_mine_{number}.py").write_text(example)
    (folder / "conftest.py").write_text('import pytest\n\npytest.register_assert_rewrite("fieldhand.testing")\n')
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--rootdir", str(folder)]
    done = subprocess.run(
        [*command, "--junitxml", "report.xml", str(folder)], cwd=folder, capture_output=True, text=True, check=False
    )
    assert done.returncode in (0, 1), done.stdout + done.stderr
    return ElementTree.parse(folder / "report.xml").getroot(), done.stdout


def test_the_page_has_examples() -> None:
    assert len(EXAMPLES) == 4


@pytest.mark.parametrize("number", range(len(EXAMPLES)))
def test_an_example_passes(number: int, ran: tuple[ElementTree.Element, str]) -> None:
    report, printed = ran
    tests = [one for one in report.iter("testcase") if f"test_mine_{number}" in one.get("classname", "").split(".")]
    assert any(len(one) == 0 for one in tests), printed  # one that passed has neither failure, error nor skip
    assert not [one for one in tests if one.find("failure") is not None or one.find("error") is not None], printed
