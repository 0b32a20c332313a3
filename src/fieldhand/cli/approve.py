"""``fieldhand approve``: a plan, read and approved by a person, as a signed file for the robot."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldhand.cli.options import (
    AnswerOption,
    AssumeOption,
    ConfirmOption,
    JsonOption,
    LangOption,
    LenientOption,
    PictureOption,
    PlannerOption,
    RobotOption,
    SiteOption,
    TranscriptOption,
)
from fieldhand.cli.outputs import to_whole_file
from fieldhand.language import message

if TYPE_CHECKING:
    from datetime import timedelta

    from fieldhand.language import Language


@dataclass(frozen=True, kw_only=True)
class _Consent:
    ask: bool
    confirm: bool
    by: str | None
    quiet: bool
    language: Language


def approve(
    request: Annotated[str, typer.Argument(help="A Task (.xml), or what the robot should do, in plain words.")],
    site: SiteOption,
    output: Annotated[
        Path,
        typer.Option("-o", "--output", callback=to_whole_file, help="Where to write the signed mission (.mission)."),
    ],
    robot: RobotOption = "husky",
    planner: PlannerOption = "auto",
    key: Annotated[str | None, typer.Option("--key", help="Name of the key to sign with, if you have several.")] = None,
    by: Annotated[str | None, typer.Option("--by", help="Who approves; else the name of the key.")] = None,
    yes: Annotated[bool, typer.Option("--yes", "-y", help="Approve without asking.")] = False,
    confirm: ConfirmOption = False,
    valid_for: Annotated[
        str, typer.Option("--valid-for", help="How long the robot may begin it, such as 12h or 30d; at most 366d.")
    ] = "90d",
    picture: PictureOption = None,
    answer: AnswerOption = None,
    assume: AssumeOption = False,
    transcript: TranscriptOption = None,
    lenient: LenientOption = False,
    lang: LangOption = None,
    json: JsonOption = False,
) -> None:
    """Show what a mission will do and take, have it approved, and sign it for the robot."""
    import os
    from datetime import datetime

    from fieldhand.approval.bundle.packing import pack
    from fieldhand.approval.keys.signing import SigningKeys
    from fieldhand.cli import show
    from fieldhand.cli.approving import approve_plan, review_plan
    from fieldhand.cli.asking import Replies, plan_or_read
    from fieldhand.cli.bundles import require_ending
    from fieldhand.cli.inputs import read_ground, write_whole
    from fieldhand.cli.secrets import passphrase
    from fieldhand.files import config_folder
    from fieldhand.language import message, spoken

    require_ending(output)
    lasting = parse_validity(valid_for)
    language = spoken(lang, os.environ)
    own = SigningKeys(config_folder(os.environ))
    chosen = own.choose(key)
    ground, files = read_ground(site, robot, lenient=lenient, language=language)
    replies = Replies(
        given=tuple(answer or ()), assume=assume, ask=not json, progress=None if json else language, language=language
    )
    task, document, planned_by = plan_or_read(request, ground, planner, transcript, replies)
    consent = _Consent(ask=not yes, confirm=confirm, by=by or chosen.public.name, quiet=json, language=language)
    review = review_plan(ground, task, document, consent)
    if picture is not None:
        from fieldhand.cli.pictures import draw_plan

        draw_plan(picture, review, ground, language)
        if not json:
            show.out.print(language.say(message("Map: {file}", file=str(picture))))
    authorized = approve_plan(review, consent, message("Approve and sign?")).authorized
    signing = own.open(chosen, passphrase)
    data = pack(
        authorized,
        ground.site,
        ground.robot,
        files=files.site,
        lenient=files.lenient,
        profile=files.profile,
        key=signing,
        planner=planned_by,
        valid_for=lasting,
        number=own.next_number(chosen, datetime.fromisoformat(authorized.authorization.at)),
    )
    write_whole(output, data)
    if json:
        from fieldhand.cli.bundles import signed_record

        show.print_json(signed_record(output, data, authorized.authorization, signing.public))
        return
    signed = message(
        "Signed by {who} with the key {key}.", who=authorized.authorization.by, key=chosen.public.fingerprint
    )
    show.out.print()
    show.out.print(language.say(signed))
    show.out.print(language.say(message("Mission: {file}", file=str(output))))


def parse_validity(text: str) -> timedelta:
    """Return how long a mission may be begun.

    Raises:
        InputError: The text says no time, or more than an approval may last.
    """
    from datetime import timedelta

    from fieldhand.approval.bundle.manifest import LONGEST_VALID
    from fieldhand.errors import InputError

    found = re.fullmatch(r"([1-9][0-9]{0,6})([mhd])", text.strip())
    lasting = timedelta(minutes=int(found[1]) * {"m": 1, "h": 60, "d": 1440}[found[2]]) if found else None
    if lasting is None or lasting > LONGEST_VALID:
        raise InputError(
            message("'{text}' is no time for which a mission may be begun", text=text[:40]),
            where="--valid-for",
            advice=message("give minutes, hours or days: 30m, 12h, 90d; at most {days}d", days=LONGEST_VALID.days),
        )
    return lasting
