"""Entry points of other distributions: found in a fixed order, loaded on demand, named when they are broken."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import NoReturn

import pytest

from fieldhand.errors import InputError, PluginError
from fieldhand.execution.drivers.registry import driver_kind
from fieldhand.execution.vehicle import Connection
from fieldhand.plugins import GROUPS, active, list_plugins
from fieldhand.task.plan import StopMission
from fieldhand.testing.small_orchard import husky, orchard, task_for


@pytest.fixture
def installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder on the path that distributions are installed into."""
    monkeypatch.syspath_prepend(tmp_path)
    return tmp_path


def install(folder: Path, distribution: str, entries: str, **modules: str) -> None:
    """Install a distribution that registers entry points in ``fieldhand.planners``."""
    info = folder / f"{distribution.replace('-', '_')}-2.5.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {distribution}\nVersion: 2.5\n")
    (info / "entry_points.txt").write_text(f"[fieldhand.planners]\n{entries}\n")
    for name, source in modules.items():
        (folder / f"{name}.py").write_text(source)


def test_a_plugin_is_imported_when_it_is_loaded_and_not_before(installed: Path) -> None:
    install(installed, "acme-plan", "acme = acme_lazy:make", acme_lazy="def make():\n    return 7\n")
    (plugin,) = [p for p in list_plugins("fieldhand.planners") if p.name == "acme"]
    assert (plugin.distribution, plugin.version, plugin.value) == ("acme-plan", "2.5", "acme_lazy:make")
    assert "acme_lazy" not in sys.modules
    made = plugin.load()
    assert callable(made)
    assert made() == 7


@pytest.mark.parametrize(
    ("value", "source", "reason"),
    [
        ("acme_broken:make", "import nothing_of_this_name", "ModuleNotFoundError: No module named"),
        ("acme_broken:make", "raise SystemExit(3)", "SystemExit: 3"),
        ("acme_broken:make", "def make(:", "SyntaxError"),
        ("acme_broken:make", "made = 1", "AttributeError"),
        ("acme_broken:make", "raise KeyError", "KeyError"),
        ("acme broken!", "", "not of the form module:attribute"),
        ("", "", "not of the form module:attribute"),
    ],
)
def test_whatever_fails_the_error_names_plugin_and_distribution(
    installed: Path, monkeypatch: pytest.MonkeyPatch, value: str, source: str, reason: str
) -> None:
    install(installed, "acme-plan", f"acme = {value}", acme_broken=source)
    monkeypatch.delitem(sys.modules, "acme_broken", raising=False)
    plugin = active("fieldhand.planners")["acme"]
    with pytest.raises(PluginError) as raised:
        plugin.load()
    said = str(raised.value)
    assert reason in said
    assert "'acme' of acme-plan 2.5" in said
    assert "fieldhand.planners: acme" in said
    assert "uninstall acme-plan" in said
    assert isinstance(raised.value, InputError)


def test_entries_that_the_library_refuses_are_listed(installed: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Some releases raise for a whole environment as soon as one entry in it is invalid."""

    def refused(distribution: object) -> NoReturn:
        raise ValueError("Invalid object reference")

    install(installed, "acme-plan", "# a comment\n\nacme = acme broken!\nno value\nother=acme:other [extra]")
    install(installed, "another", "")
    (installed / "another-2.5.dist-info" / "entry_points.txt").write_text("[console_scripts]\nx = 1 2 3\n")
    for name in ("importlib.metadata", "importlib_metadata"):
        if name in sys.modules:
            monkeypatch.setattr(sys.modules[name].Distribution, "entry_points", property(refused))
    listed = [p for p in list_plugins("fieldhand.planners") if p.distribution == "acme-plan"]
    assert [(p.name, p.value) for p in listed] == [
        ("acme", "acme broken!"),
        ("no value", ""),
        ("other", "acme:other [extra]"),
    ]
    for plugin in listed[:2]:
        with pytest.raises(PluginError, match="not of the form module:attribute"):
            plugin.load()


def test_of_several_versions_the_one_that_is_imported_is_listed(
    installed: Path, tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> None:
    newer = tmp_path_factory.mktemp("newer")
    install(installed, "acme-plan", "acme = acme:make\ngone = acme:gone")
    install(newer, "acme-plan", "acme = acme:make_better")
    monkeypatch.syspath_prepend(newer)
    listed = [p for p in list_plugins("fieldhand.planners") if p.distribution == "acme-plan"]
    assert [(p.name, p.value) for p in listed] == [("acme", "acme:make_better")]


def test_a_distribution_without_metadata_is_called_unknown(installed: Path) -> None:
    install(installed, "acme-plan", "acme = acme:make")
    (installed / "acme_plan-2.5.dist-info" / "METADATA").unlink()
    plugin = active("fieldhand.planners")["acme"]
    assert (plugin.distribution, plugin.version) == ("", "")
    assert "an unknown distribution" in str(plugin.error("cannot be loaded"))


def test_of_one_name_the_first_distribution_is_used_and_the_others_are_listed(installed: Path) -> None:
    install(installed, "zebra", "acme = zebra:make")
    install(installed, "acme-plan", "acme = acme:make\nother = acme:other")
    listed = [p for p in list_plugins("fieldhand.planners") if p.distribution in {"zebra", "acme-plan"}]
    assert [(p.name, p.distribution, p.overridden_by) for p in listed] == [
        ("acme", "acme-plan", ""),
        ("acme", "zebra", "acme-plan"),
        ("other", "acme-plan", ""),
    ]
    assert active("fieldhand.planners")["acme"].distribution == "acme-plan"


def test_no_plugin_overrides_what_is_built_in(installed: Path) -> None:
    """Neither this package's own plugins nor the names that a caller keeps for itself."""
    install(installed, "acme-plan", "english = acme:make\nkept = acme:make")
    ours = {p.name: p for p in list_plugins("fieldhand.planners", built_in=["kept"]) if p.distribution == "acme-plan"}
    assert {name: p.overridden_by for name, p in ours.items()} == {"english": "fieldhand", "kept": "fieldhand"}
    used = active("fieldhand.planners", built_in=["kept"])
    assert used["english"].distribution == "fieldhand"
    assert "kept" not in used


def test_a_group_holds_what_is_registered_in_it_alone(installed: Path) -> None:
    install(installed, "acme-plan", "acme = acme:make")
    assert [g for g in GROUPS if "acme" in active(g)] == ["fieldhand.planners"]


@pytest.mark.parametrize(
    ("body", "reason"),
    [
        ("raise ValueError('no cart')\n    yield", "failed to connect: ValueError: no cart"),
        ("return\n    yield", "failed to connect: RuntimeError"),
    ],
)
def test_a_driver_that_fails_to_connect_is_named(
    installed: Path, monkeypatch: pytest.MonkeyPatch, body: str, reason: str
) -> None:
    module = (
        "from contextlib import contextmanager\n"
        "from fieldhand.execution.drivers.registry import DriverKind\n\n"
        "@contextmanager\n"
        f"def connect(site, robot, task, connection, within_s):\n    {body}\n\n"
        "KIND = DriverKind(connect=connect, summary='a cart')\n"
    )
    install(installed, "acme-drive", "", acme_drive=module)
    monkeypatch.delitem(sys.modules, "acme_drive", raising=False)
    entries = installed / "acme_drive-2.5.dist-info" / "entry_points.txt"
    entries.write_text("[fieldhand.drivers]\nacme-cart = acme_drive:KIND\n")
    kind = driver_kind("acme-cart")
    site, robot = orchard(), husky()
    task, connection = task_for(site, StopMission(id="")), Connection(transport="acme-cart")
    with pytest.raises(PluginError) as caught, kind.connect(site, robot, task, connection, 1.0):
        pass
    assert reason in str(caught.value)
    assert "'acme-cart' of acme-drive 2.5" in str(caught.value)
