"""``fieldhand inspect``: who approved what, when, and whether it would run here."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fieldhand.cli.options import JsonOption, LangOption

if TYPE_CHECKING:
    from fieldhand.approval.bundle.opening import Content, Sealed
    from fieldhand.language import Language
    from fieldhand.mission import Review


@dataclass(frozen=True, kw_only=True)
class _Findings:
    """What was found of a bundle, as far as one came.

    Attributes:
        state: ``trusted``, ``unknown``, ``revoked`` or ``broken``.
        problems: Why it would not run here; empty if it would.
    """

    state: str
    problems: tuple[str, ...]
    whose: str = ""
    sealed: Sealed | None = None
    content: Content | None = None
    review: Review | None = None


def inspect(
    file: Annotated[Path, typer.Argument(help="A signed mission (.mission).")],
    lang: LangOption = None,
    json: JsonOption = False,
) -> None:
    """Say who approved what, when, and what it will do; exit status 1 if it would not run here."""
    import os

    from fieldhand.approval.bundle.container import read_bundle_file
    from fieldhand.cli import show
    from fieldhand.language import spoken

    language = spoken(lang, os.environ)
    found = _findings(read_bundle_file(file), str(file), language)
    if json:
        show.print_json(_record(file, found, language))
    else:
        _show(file, found, language)
    if found.problems:
        raise SystemExit(1)


def _findings(data: bytes, source: str, language: Language) -> _Findings:
    import os
    from datetime import UTC, datetime

    from fieldhand import mission
    from fieldhand.approval.bundle.opening import content_of, require_trusted, unseal
    from fieldhand.approval.keys.trust import TrustStore
    from fieldhand.errors import BundleError, FieldhandError, NotTrustedError
    from fieldhand.files import config_folder

    known = TrustStore(config_folder(os.environ)).known()
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
    try:
        content = content_of(sealed, now=datetime.now(UTC))
    except FieldhandError as error:
        return _Findings(state=state, problems=(*problems, str(error)), whose=whose, sealed=sealed)
    review = mission.review(content.task, content.site, content.robot)
    problems.extend(language.say(problem.line()) for problem in review.errors)
    return _Findings(state=state, problems=tuple(problems), whose=whose, sealed=sealed, content=content, review=review)


def _show(file: Path, found: _Findings, language: Language) -> None:
    from fieldhand.cli import show

    if found.content is not None:
        manifest = found.content.manifest
        approved, here = manifest.approved, found.content
        show.out.print(f"Approved by {approved.by} at {approved.at}, read in {approved.language}")
        show.out.print(
            f"  planned by {manifest.task.planner}, signed with {manifest.program}, format {manifest.format}"
        )
        show.out.print(f"  site {here.site.name}, {len(here.site.trees)} trees{' (lenient)' * manifest.site.lenient}")
        show.out.print(f"  robot {here.robot.name}")
        for warning in approved.confirmed:
            show.out.print(f"  confirmed: {warning}")
    if found.sealed is not None:
        whose = f" of {found.whose}" if found.whose else ""
        show.out.print(f"Signature {found.state}: key{whose} {found.sealed.signature.public.fingerprint}")
        show.out.print("SHA-256")
        for name, sha256 in found.sealed.hashes.items():
            show.out.print(f"  {sha256}  {name}")
    if found.review is not None:
        show.show_review(found.review, language)
    show.out.print()
    for problem in found.problems:
        show.err.print(f"fieldhand: {problem}")
    show.out.print(f"{file} would not run here." if found.problems else f"{file} would run here.")


def _record(file: Path, found: _Findings, language: Language) -> dict[str, Any]:
    from fieldhand.cli import show

    sealed, content = found.sealed, found.content
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
        "manifest": None if content is None else content.manifest.model_dump(),
        "review": None if found.review is None else show.review_record(found.review, language),
    }
