"""The ROS packages of the types that the built-in profiles define: the same definitions, and all that colcon needs."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Mapping
from pathlib import Path

import pytest
from lxml import etree

import fieldhand
from fieldhand.robot.loader import load_robot, robot_names

FOLDER = Path(__file__).parents[2] / "ros2"


def defined() -> Mapping[str, Mapping[str, str]]:
    """The definitions of the built-in profiles: by package and file."""
    packages: dict[str, dict[str, str]] = defaultdict(dict)
    for name in robot_names():
        bound = load_robot(name).ros2
        for type_name, text in {} if bound is None else bound.interfaces.items():
            package, kind, short = type_name.split("/")
            assert packages[package].setdefault(f"{kind}/{short}.{kind}", text) == text
    return packages


def test_every_package_that_a_built_in_profile_defines_is_there() -> None:
    interfaces = {file.parent.parent.name for kind in ("msg", "srv", "action") for file in FOLDER.glob(f"*/*/*.{kind}")}
    assert interfaces == set(defined()) != set()


@pytest.mark.parametrize("package", sorted(defined()))
def test_a_package_has_the_definitions_of_the_profile_and_builds_them(package: str) -> None:
    folder, wanted = FOLDER / package, defined()[package]
    files = {
        f"{f.parent.name}/{f.name}": f.read_text()
        for kind in ("msg", "srv", "action")
        for f in folder.rglob(f"*.{kind}")
    }
    assert files == {file: text.rstrip("\n") + "\n" for file, text in wanted.items()}
    build = (folder / "CMakeLists.txt").read_text()
    assert f"project({package})" in build
    listed = re.search(r"rosidl_generate_interfaces\(\$\{PROJECT_NAME\}([^)]*)\)", build)
    assert listed is not None
    assert sorted(re.findall(r'"([^"]+)"', listed[1])) == sorted(wanted)


@pytest.mark.parametrize("package", sorted(defined()))
def test_its_manifest_makes_it_a_package_of_interfaces(package: str) -> None:
    root = etree.parse(str(FOLDER / package / "package.xml")).getroot()
    assert (root.tag, root.get("format"), root.findtext("name")) == ("package", "3", package)
    assert root.findtext("version") == fieldhand.__version__
    assert all(root.findtext(tag) for tag in ("description", "maintainer", "license"))
    assert {e.text for e in root.findall("buildtool_depend")} == {"ament_cmake", "rosidl_default_generators"}
    assert "rosidl_default_runtime" in {e.text for e in root.findall("exec_depend")}
    # What an action and a service are made of; everything else in the definitions is a number, a flag or words.
    assert {e.text for e in root.findall("depend")} == {"action_msgs"}
    assert not any("/" in text for text in defined()[package].values())
    assert root.findtext("member_of_group") == "rosidl_interface_packages"
    assert root.findtext("export/build_type") == "ament_cmake"
