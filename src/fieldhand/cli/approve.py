"""``fieldhand approve``: show a plan, ask for approval, and sign it as a file for the robot."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldhand.cli.earlier import StoredEarlierOptions, add_earlier
from fieldhand.cli.option_groups import grouped
from fieldhand.cli.options import (
    ApprovalOptions,
    DisplayOptions,
    PictureOption,
    PlanningOptions,
    SiteAndRobotOptions,
)
from fieldhand.cli.outputs import to_whole_file
from fieldhand.compatibility import datetime_from_iso
from fieldhand.language import message

if TYPE_CHECKING:
    from datetime import timedelta


@dataclass(frozen=True, kw_only=True)
class SigningOptions(ApprovalOptions):
    """Approval with a signature."""

    by: Annotated[str | None, typer.Option("--by", help="Name of the operator; else the name of the key.")] = None
    key: Annotated[str | None, typer.Option("--key", help="Name of the key to sign with, if you have several.")] = None
    valid_for: Annotated[
        str,
        typer.Option("--valid-for", help="Time within which the robot may begin it, such as 12h or 30d; at most 366d."),
    ] = "90d"


@grouped(
    "request site output robot planner key by yes confirm valid_for picture answer assume transcript lenient"
    " missions count_simulated recount lang json"
)
def approve(
    request: Annotated[str, typer.Argument(help="A Task (.xml), or what the robot should do, in plain words.")],
    place: SiteAndRobotOptions,
    planning: PlanningOptions,
    signing: SigningOptions,
    display: DisplayOptions,
    earlier: StoredEarlierOptions,
    output: Annotated[
        Path,
        typer.Option("-o", "--output", callback=to_whole_file, help="Where to write the signed mission (.mission)."),
    ],
    picture: PictureOption = None,
) -> None:
    """Show what a mission will do and take, ask for approval, and sign it for the robot."""
    import os
    from dataclasses import replace

    from fieldhand import mission
    from fieldhand.approval.keys.signing import SigningKeys
    from fieldhand.cli import show
    from fieldhand.cli.approving import approve_plan, review_plan
    from fieldhand.cli.asking import Replies, plan_or_read
    from fieldhand.cli.bundles import require_ending, signed_record
    from fieldhand.cli.inputs import read_site_and_robot, write_whole
    from fieldhand.cli.secrets import passphrase
    from fieldhand.files import config_folder

    require_ending(output)
    valid_for = parse_validity(signing.valid_for)
    language = display.language
    keys = SigningKeys(config_folder(os.environ))
    key = keys.choose(signing.key)
    site_and_robot, files = read_site_and_robot(place.site, place.robot, lenient=place.lenient, language=language)
    replies = Replies.of(planning, display)
    task, document, planner = plan_or_read(request, site_and_robot, planning.planner, planning.transcript, replies)
    task, document = add_earlier(task, document, site_and_robot, earlier, earlier.missions, display)
    review = review_plan(site_and_robot, task, document, display)
    if picture is not None:
        review.save_map(picture, language=language.code)
        if not display.json:
            show.out.print(language.say(message("Map: {file}", file=str(picture))))
    approval = replace(signing, by=signing.by or key.public.name)
    approved = approve_plan(review, approval, display, message("Approve and sign?"))
    authorization = approved.authorized.authorization
    opened = keys.open(key, passphrase)
    number = keys.next_number(key, datetime_from_iso(authorization.at))
    data = mission.sign(approved, files, key=opened, planner=planner, valid_for=valid_for, number=number)
    write_whole(output, data)
    if display.json:
        show.print_json(signed_record(output, data, authorization, opened.public))
        return
    signed = message("Signed by {who} with the key {key}.", who=authorization.by, key=key.public.fingerprint)
    show.out.print_lines("", language.say(signed), language.say(message("Mission: {file}", file=str(output))))


def parse_validity(text: str) -> timedelta:
    """Return the time for which a mission may be begun.

    Raises:
        InputError: The text is not a duration, or longer than an approval may last.
    """
    from datetime import timedelta

    from fieldhand.approval.bundle.manifest import LONGEST_VALID
    from fieldhand.errors import InputError

    found = re.fullmatch(r"([1-9][0-9]{0,6})([mhd])", text.strip())
    lasting = timedelta(minutes=int(found[1]) * {"m": 1, "h": 60, "d": 1440}[found[2]]) if found else None
    if lasting is None or lasting > LONGEST_VALID:
        raise InputError(
            message("'{text}' is not a valid period", text=text[:40]),
            where="--valid-for",
            advice=message("give minutes, hours or days: 30m, 12h, 90d; at most {days}d", days=LONGEST_VALID.days),
        )
    return lasting
