"""``fieldhand inspect``: show the approval and the contents of a signed mission, and if it may run here."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fieldhand.cli.options import JsonOption, LangOption

if TYPE_CHECKING:
    from fieldhand.approval.bundle.manifest import Manifest
    from fieldhand.approval.bundle.opening import Content, Sealed
    from fieldhand.language import Language
    from fieldhand.mission import Review


#: Prefix of all rows from the signed mission, so that none can look like a line of this program.
_MARK = "  | "


@dataclass(frozen=True, kw_only=True)
class _Findings:
    """The findings about a signed mission; fields after the first failure are None.

    Attributes:
        state: State of its key: ``trusted``, ``unknown`` or ``revoked``; ``broken`` if the file is damaged.
        problems: Reasons why it may not run here; empty if it may.
        whose: Name of the key; empty if it is unknown.
        sealed: Verified members and hashes.
        manifest: Manifest.
        content: Task, site and robot.
        review: Review of the Task.
    """

    state: str
    problems: tuple[str, ...]
    whose: str = ""
    sealed: Sealed | None = None
    manifest: Manifest | None = None
    content: Content | None = None
    review: Review | None = None


def inspect(
    file: Annotated[Path, typer.Argument(help="A signed mission (.mission).")],
    lang: LangOption = None,
    json: JsonOption = False,
) -> None:
    """Show who approved a mission, when, and what it will do; exit status 1 if it would not run here."""
    import os

    from fieldhand.approval.bundle.container import read_bundle_file
    from fieldhand.cli import show
    from fieldhand.language import spoken

    language = spoken(lang, os.environ)
    found = _findings(read_bundle_file(file), str(file), language)
    if json:
        show.print_json(_record(file, found, language))
    else:
        with show.out.behind(), show.err.behind():
            _show(file, found, language)
    if found.problems:
        raise SystemExit(1)


def _findings(data: bytes, source: str, language: Language) -> _Findings:
    import os
    from datetime import UTC, datetime

    from fieldhand import mission
    from fieldhand.approval.bundle.opening import content_of, manifest_of, require_trusted, unseal
    from fieldhand.approval.memory import approval_memory, require_unexpired, trust_store
    from fieldhand.errors import BundleError, FieldhandError, NotApprovedError, NotTrustedError

    known = trust_store(os.environ).known()
    try:
        sealed = unseal(data, source=source)
    except BundleError as error:
        return _Findings(state="broken", problems=(str(error),))
    signer = known.get(sealed.signature.public.fingerprint)
    state, whose = ("unknown", "") if signer is None else (signer.state, signer.name)
    problems: list[str] = []
    try:
        require_trusted(sealed, known)
    except NotTrustedError as error:
        problems.append(str(error))
    found = _Findings(state=state, problems=(), whose=whose, sealed=sealed)
    now = datetime.now(UTC)
    try:
        found = replace(found, manifest=manifest_of(sealed, now=now))
        try:
            require_unexpired(manifest_of(sealed, now=now), approval_memory(os.environ).time(now), now, source)
        except NotApprovedError as error:
            problems.append(str(error))
        content = content_of(sealed, now=now, stranger=state != "trusted")
    except FieldhandError as error:
        return replace(found, problems=(*problems, str(error)))
    review = mission.review(content.task, content.site, content.robot)
    problems.extend(language.say(problem.line()) for problem in review.errors)
    return replace(found, problems=tuple(problems), content=content, review=review)


def _show(file: Path, found: _Findings, language: Language) -> None:
    from fieldhand.cli import show

    if found.sealed is not None:
        whose = f" of {found.whose}" if found.whose else ""
        show.out.print(f"Signature {found.state}: key{whose} {found.sealed.signature.public.fingerprint}")
        show.out.print("SHA-256")
        for name, sha256 in found.sealed.hashes.items():
            show.out.print(f"  {sha256}  {name}")
        show.out.print()
    if found.manifest is not None:
        show.out.print(f'What {file} holds stands behind "{_MARK.strip()}":')
        with show.out.behind(_MARK):
            _show_manifest(found.manifest, found.content)
            if found.review is not None:
                show.show_review(found.review, language)
        show.out.print()
    for problem in found.problems:
        show.err.print(f"fieldhand: {problem}")
    show.out.print(f"{file} would not run here." if found.problems else f"{file} would run here.")


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


def _record(file: Path, found: _Findings, language: Language) -> dict[str, Any]:
    from fieldhand.cli import show

    sealed, manifest = found.sealed, found.manifest
    return {
        "file": str(file),
        "runs": not found.problems,
        "problems": list(found.problems),
        "signature": {
            "state": found.state,
            "name": found.whose,
            "fingerprint": "" if sealed is None else sealed.signature.public.fingerprint,
        },
        "hashes": {} if sealed is None else dict(sealed.hashes),
        "manifest": None if manifest is None else manifest.model_dump(),
        "review": None if found.review is None else show.review_record(found.review, language),
    }
