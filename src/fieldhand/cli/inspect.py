"""``fieldhand inspect``: show the approval and the contents of a signed mission, and if it may run here."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fieldhand.cli.options import JsonOption, LangOption

if TYPE_CHECKING:
    from fieldhand.approval.bundle.manifest import Manifest
    from fieldhand.approval.bundle.opening import Content
    from fieldhand.language import Language
    from fieldhand.mission import BundleInspection


#: Prefix of all rows from the signed mission, so that none can look like a line of this program.
_MARK = "  | "


def inspect(
    file: Annotated[Path, typer.Argument(help="A signed mission (.mission).")],
    lang: LangOption = None,
    json: JsonOption = False,
) -> None:
    """Show who approved a mission, when, and what it will do; exit status 1 if it would not run here."""
    import os
    from datetime import datetime

    from fieldhand import mission
    from fieldhand.approval.bundle.container import read_bundle_file
    from fieldhand.cli import show
    from fieldhand.compatibility import UTC
    from fieldhand.language import spoken

    language = spoken(lang, os.environ)
    data = read_bundle_file(file)
    inspection = mission.inspect_bundle(
        data, source=str(file), environ=os.environ, now=datetime.now(UTC), language=language
    )
    if json:
        show.print_json(_record(file, inspection, language))
    else:
        with show.out.behind(), show.err.behind():
            _show(file, inspection, language)
    if not inspection.may_run:
        raise SystemExit(1)


def _show(file: Path, inspection: BundleInspection, language: Language) -> None:
    from fieldhand.cli import show

    if inspection.sealed is not None:
        whose = f" of {inspection.signer}" if inspection.signer else ""
        show.out.print(f"Signature {inspection.state}: key{whose} {inspection.sealed.signature.public.fingerprint}")
        show.out.print("SHA-256")
        for name, sha256 in inspection.sealed.hashes.items():
            show.out.print(f"  {sha256}  {name}")
        show.out.print()
    if inspection.manifest is not None:
        show.out.print(f'What {file} holds stands behind "{_MARK.strip()}":')
        with show.out.behind(_MARK):
            _show_manifest(inspection.manifest, inspection.content)
            if inspection.review is not None:
                show.show_review(inspection.review, language)
        show.out.print()
    for problem in inspection.problems:
        show.err.print(f"fieldhand: {problem}")
    show.out.print(f"{file} would run here." if inspection.may_run else f"{file} would not run here.")


def _show_manifest(manifest: Manifest, content: Content | None) -> None:
    """Print the manifest of a signed mission, and the number of trees if its site was read."""
    from fieldhand.cli import show

    approved = manifest.approved
    show.out.print(f"Approved by {approved.by} at {approved.at}, read in {approved.language}")
    show.out.print(f"  number {manifest.number}, may be started until {manifest.until.isoformat(timespec='seconds')}")
    show.out.print(f"  planned by {manifest.task.planner}, signed with {manifest.program}, format {manifest.format}")
    trees = "" if content is None else f", {len(content.site.trees)} trees"
    show.out.print(f"  site {manifest.site.name}{trees}{' (lenient)' * manifest.site.lenient}")
    show.out.print(f"  robot {manifest.robot.name}")
    for warning in approved.confirmed:
        show.out.print(f"  confirmed: {warning}")


def _record(file: Path, inspection: BundleInspection, language: Language) -> dict[str, Any]:
    from fieldhand.cli import show

    sealed, manifest = inspection.sealed, inspection.manifest
    return {
        "file": str(file),
        "runs": inspection.may_run,
        "problems": list(inspection.problems),
        "signature": {
            "state": inspection.state,
            "name": inspection.signer,
            "fingerprint": "" if sealed is None else sealed.signature.public.fingerprint,
        },
        "hashes": {} if sealed is None else dict(sealed.hashes),
        "manifest": None if manifest is None else manifest.model_dump(),
        "review": None if inspection.review is None else show.review_record(inspection.review, language),
    }
