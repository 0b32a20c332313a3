"""Hooks of the documentation site (mkdocs.yml): pages from files outside ``docs``, and links between them."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]

#: Pages generated from files of the repository, by their names on the site.
SOURCES = {
    "notebook.md": "docs/notebook.ipynb",
    "example-plugin.md": "examples/plugin/README.md",
    "fieldhand-bench.md": "benchmarks/README.md",
    "fieldhand-ros.md": "ros2/fieldhand_ros/README.md",
    "changelog.md": "CHANGELOG.md",
}
_BLANK_LINES = re.compile(r"\n\s*\n")
_LINK = re.compile(r"(?<!!)\[([^\]]+)\]\((?!https?://|mailto:|#)([^)\s#]+)(#[^)\s]*)?\)")


def on_files(files: Any, config: Any) -> Any:
    """Add the pages that are generated from other files."""
    from mkdocs.structure.files import File

    for page, source in SOURCES.items():
        path = ROOT / source
        text = notebook_page(path) if path.suffix == ".ipynb" else path.read_text(encoding="utf-8")
        files.append(File.generated(config, page, content=text))
    return files


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """Return a page whose links to files of the repository lead to their pages on the site.

    A file that has no page becomes its name as text.
    """
    pages = {(ROOT / source).resolve(): name for name, source in SOURCES.items()}
    folder = (ROOT / SOURCES.get(page.file.src_uri, f"docs/{page.file.src_uri}")).parent

    def relinked(match: re.Match[str]) -> str:
        text, target, anchor = match[1], match[2], match[3] or ""
        path = (folder / target).resolve()
        if path in pages:
            return f"[{text}]({pages[path]}{anchor})"
        if path.parent == ROOT / "docs":
            return f"[{text}]({path.name}{anchor})"
        return f"{text} (`{path.relative_to(ROOT)}`)"

    return _LINK.sub(relinked, markdown)


def notebook_page(path: Path) -> str:
    """Return a notebook as Markdown with the outputs of a fresh run."""
    import nbclient
    import nbformat

    notebook = nbformat.reads(path.read_text(encoding="utf-8"), as_version=4)
    with tempfile.TemporaryDirectory() as folder:
        client = nbclient.NotebookClient(
            notebook, timeout=300, resources={"metadata": {"path": folder}}, extra_arguments=["--log-level=ERROR"]
        )
        client.execute()
        return "\n\n".join(part for cell in notebook.cells for part in _cell(cell)).replace(folder, ".")


def _cell(cell: Any) -> list[str]:
    if cell.cell_type == "markdown":
        return [cell.source]
    parts = [f"```python\n{cell.source}\n```"]
    for output in cell.get("outputs", ()):
        data = output.get("data", {})
        if html := data.get("text/html"):
            whole = _BLANK_LINES.sub("\n", html)  # a blank line would end the HTML block
            parts.append(f'<div class="notebook-output">{whole}</div>')
        elif text := data.get("text/plain"):
            parts.append(f"```text\n{text}\n```")
        elif data:
            raise ValueError(f"{cell.id}: no form for an output of {sorted(data)}")
    return parts
