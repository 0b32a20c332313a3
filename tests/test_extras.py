"""The smallest set of packages carries out signed missions; what more needs names the extra that installs it."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest

from fieldhand.extras import EXTRAS, missing_package
from support.processes.command import fieldhand
from support.processes.robot_set import absent, fieldhand_on_robot, requirements

REFUSED = {
    "a map": (("site", "demo", "--picture", "x.png"), "matplotlib", "plan"),
    "a plan": (("plan", "Reead CO2 at tree 4.", "--site", "demo"), "rapidfuzz", "plan"),
    "the REST API": (("serve",), "fastapi", "serve"),
    "accounts": (("accounts", "list"), "sqlalchemy", "serve"),
}


#: Distributions that have another name than the package that is imported.
DISTRIBUTIONS = {"argon2": "argon2-cffi"}


def names(declared: list[str]) -> set[str]:
    return {re.split(r"[\[>;= ]", text)[0] for text in declared}


def test_the_extra_of_a_package_is_the_one_that_installs_it() -> None:
    base, extras = requirements()
    for package, extra in EXTRAS.items():
        distribution = DISTRIBUTIONS.get(package, package)
        assert distribution in names(extras[extra])
        assert distribution not in names(base)
    more = names(extras["plan"]) | names(extras["solver"])
    assert more - {"fieldhand"} == {package for package, extra in EXTRAS.items() if extra in ("plan", "solver")}


def test_a_package_of_no_extra_is_a_fault_of_the_program() -> None:
    assert missing_package(ModuleNotFoundError("no", name="fieldhand.nothing")) is None
    assert missing_package(ImportError("no name")) is None
    found = missing_package(ModuleNotFoundError("no", name="matplotlib.pyplot"))
    assert 'needs matplotlib, which is not installed; install it with: pip install "fieldhand[plan]"' in str(found)


def test_the_smallest_set_has_no_planner_and_no_plots() -> None:
    assert {"matplotlib", "numba", "llvmlite", "joblib", "rapidfuzz", "mcap", "jinja2", "pydantic_ai"} <= absent()
    assert not absent() & {"fieldhand", "numpy", "pydantic", "cryptography", "py_trees"}


@pytest.fixture(scope="module")
def config(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Keys of a person who signs, and whom the robot trusts."""
    folder = tmp_path_factory.mktemp("keys")
    config = folder / "config"
    for words in (("new", "--name", "Ada", "-o", "ada.pub"), ("trust", "ada.pub", "--yes")):
        done = fieldhand("keys", *words, cwd=folder, env=environment(config))
        assert done.status == 0, done.err
    return config


def environment(config: Path) -> dict[str, str]:
    return dict(os.environ) | {"FIELDHAND_CONFIG": str(config)}


def signed(request: str, folder: Path, config: Path) -> Path:
    words = ("approve", request, "--site", "demo", "-o", "signed.mission", "--yes")
    done = fieldhand(*words, cwd=folder, env=environment(config))
    assert done.status == 0, done.err
    return folder / "signed.mission"


def test_the_smallest_set_flies_a_signed_mission_and_no_other(tmp_path: Path, config: Path) -> None:
    request = "Measure CO2 at tree 4. If it is low, take 2 thermal pictures of nearby trees, else one of tree 9."
    mission = signed(request, tmp_path, config)
    done = fieldhand_on_robot("run", str(mission), "--production", cwd=tmp_path, config=config)
    assert done.status == 0, done.err
    assert "Mission completed" in done.out
    changed = bytearray(mission.read_bytes())
    changed[len(changed) // 2] ^= 1
    mission.write_bytes(changed)
    refused = fieldhand_on_robot("run", str(mission), "--production", cwd=tmp_path, config=config)
    assert refused.status != 0
    assert "Traceback" not in refused.err


def test_optional_visits_need_the_solver_before_the_robot_moves(tmp_path: Path, config: Path) -> None:
    mission = signed("Visit as many trees as you can within 200 m.", tmp_path, config)
    refused = fieldhand_on_robot("run", str(mission), "--production", "--out", "out", cwd=tmp_path, config=config)
    assert refused.status == 2
    assert 'install it with: pip install "fieldhand[' in refused.err
    refused = fieldhand_on_robot("run", str(mission), "--production", cwd=tmp_path, config=config)
    assert refused.status == 2
    assert refused.out.startswith("Approved by Ada")
    assert len(refused.out.splitlines()) == 1  # nothing begins
    assert 'this needs numba, which is not installed; install it with: pip install "fieldhand[solver]"' in refused.err


@pytest.mark.parametrize("words", REFUSED)
def test_a_command_that_needs_more_names_the_extra(words: str, tmp_path: Path, config: Path) -> None:
    command, package, extra = REFUSED[words]
    refused = fieldhand_on_robot(*command, cwd=tmp_path, config=config)
    assert refused.status == 2
    assert package in refused.err or extra == "serve"
    assert f'pip install "fieldhand[{extra}]"' in refused.err
    assert "Traceback" not in refused.err
