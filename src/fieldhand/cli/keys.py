"""``fieldhand keys``: make signing keys, and manage the keys that a machine trusts."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fieldhand.cli.options import JsonOption
from fieldhand.cli.outputs import to_file

if TYPE_CHECKING:
    from fieldhand.approval.keys.signing import OwnKey, SigningKeys
    from fieldhand.approval.keys.trust import KnownKey, TrustStore

keys = typer.Typer(
    name="keys",
    help="Keys that sign missions: make one, and choose the ones that a robot trusts.",
    no_args_is_help=True,
)


@keys.command("new")
def new(
    name: Annotated[
        str | None, typer.Option("--name", help="Name of its owner; else the user who is logged in.")
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", callback=to_file, help="Write the public line to this file, too, to be sent."),
    ] = None,
    passphrase: Annotated[
        bool, typer.Option("--passphrase", help="Ask for a passphrase (or set FIELDHAND_KEY_PASSPHRASE).")
    ] = False,
    json: JsonOption = False,
) -> None:
    """Make a key to approve missions with; the private half stays on this machine."""
    from fieldhand.cli import show
    from fieldhand.cli.approving import user_name
    from fieldhand.cli.inputs import write_file
    from fieldhand.cli.secrets import new_passphrase

    own, _ = _folders()
    key, file = own.make(name or user_name(), new_passphrase(asked=passphrase))
    public = key.public
    if output is not None:
        write_file(output, f"{public.line()}\n".encode())
    if json:
        record = {"name": public.name, "fingerprint": public.fingerprint, "public_key": public.line()}
        show.print_json(record | {"file": str(file)})
        return
    show.out.print(f"A key for {public.name}, in {file.with_suffix('.key')}")
    show.out.print_lines(
        "",
        "Send this line to whoever looks after the robot (it is not a secret); it is also in",
        f"{file}:",
        "",
        f"  {public.line()}",
        "",
        "They pass it to fieldhand keys trust and compare the fingerprint with you:",
        "",
        f"  {public.fingerprint}",
    )


@keys.command("list")
def list_keys(json: JsonOption = False) -> None:
    """List your own keys, and those that this machine trusts or has revoked."""
    from fieldhand.cli import show

    own, trust = _folders()
    held, known = own.held(), tuple(trust.known().values())
    if json:
        show.print_json({"own": [_own_record(k) for k in held], "known": [_known_record(k) for k in known]})
        return
    show.out.print("Your own keys" if held else "No key of your own; fieldhand keys new makes one.")
    for key in held:
        guarded = "has a passphrase" if key.encrypted else "no passphrase"
        show.out.print(f"  {key.public.fingerprint}  {key.public.name}  ({guarded})")
    show.out.print()
    show.out.print("Trusted here" if known else "No key is trusted here; fieldhand keys trust FILE trusts one.")
    for other in known:
        state = "trusted" if other.revoked is None else f"REVOKED {other.revoked}"
        show.out.print(f"  {other.fingerprint}  {other.name}  since {other.since}  {state}")


@keys.command("trust")
def trust(
    file: Annotated[
        Path, typer.Argument(help="The line of a public key, as keys new wrote it, or a mail that holds it.")
    ],
    name: Annotated[str | None, typer.Option("--name", help="Name of its owner; else the one in the line.")] = None,
    fingerprint: Annotated[
        str | None,
        typer.Option("--fingerprint", help="Fingerprint as its owner told it to you; another one is refused."),
    ] = None,
    yes: Annotated[bool, typer.Option("--yes", "-y", help="You have compared the fingerprint.")] = False,
    json: JsonOption = False,
) -> None:
    """Trust a key, so that missions signed with it may run."""
    from datetime import datetime

    from fieldhand.approval.keys.public import parse_fingerprint, parse_public
    from fieldhand.approval.keys.rights import MAX_BYTES, not_a_key
    from fieldhand.cli import show
    from fieldhand.compatibility import UTC
    from fieldhand.errors import KeyFileError
    from fieldhand.files import FileFault, read_file

    try:
        text = read_file(file, MAX_BYTES).decode(errors="replace")
    except FileFault as fault:
        raise not_a_key(file, fault) from None
    public = parse_public(text, source=str(file))
    if fingerprint is not None and parse_fingerprint(fingerprint) != public.fingerprint:
        raise KeyFileError(
            f"the key has another fingerprint: {public.fingerprint}",
            where=str(file),
            advice="do not trust it; ask its owner to send the line again",
        )
    whose = name or public.name
    if not whose:
        raise KeyFileError(
            "the line does not name the owner of the key", where=str(file), advice="give the name with --name"
        )
    if fingerprint is None and not yes:
        _require_comparison(public.fingerprint, whose)
    known = _folders()[1].trust(public, name=whose, at=datetime.now(UTC))
    if json:
        show.print_json(_known_record(known))
    else:
        show.out.print(f"Trusted from now on: {known.name}, {known.fingerprint}")


@keys.command("revoke")
def revoke(
    fingerprint: Annotated[str, typer.Argument(help="Fingerprint of the key, as keys list shows it.")],
    json: JsonOption = False,
) -> None:
    """Revoke a key for good: no mission signed with it runs again."""
    from datetime import datetime

    from fieldhand.cli import show
    from fieldhand.compatibility import UTC

    known = _folders()[1].revoke(fingerprint, at=datetime.now(UTC))
    if json:
        show.print_json(_known_record(known))
    else:
        show.out.print(f"Revoked for good: {known.name}, {known.fingerprint}")


@keys.command("confirm")
def confirm(
    valid_for: Annotated[
        str | None,
        typer.Option(
            "--valid-for", help="Let the list expire after this time, such as 30d, unless it is confirmed again."
        ),
    ] = None,
    yes: Annotated[bool, typer.Option("--yes", "-y", help="You have looked at the list and at the clock.")] = False,
    json: JsonOption = False,
) -> None:
    """Confirm that the list of trusted keys and the clock are right."""
    import os
    from datetime import datetime

    from fieldhand.approval.memory import approval_memory
    from fieldhand.cli import show
    from fieldhand.cli.approve import parse_validity
    from fieldhand.cli.inputs import may_ask
    from fieldhand.compatibility import UTC
    from fieldhand.errors import NotApprovedError

    trust, now = _folders()[1], datetime.now(UTC)
    until = None if valid_for is None else now + parse_validity(valid_for)
    found = tuple(trust.listed().values())
    if not json:
        show.out.print(f"The clock says {now.isoformat(timespec='seconds')}.")
        for key in found:
            show.out.print(f"  {key.fingerprint}  {key.name}  since {key.since}  {key.state}")
    if not yes:
        if not may_ask():
            raise NotApprovedError("confirming the trusted keys needs a terminal to ask at", advice="give --yes")
        if not typer.confirm("Are these the keys that you trust, and is the clock right?"):
            raise NotApprovedError("not confirmed, nothing was changed")
    trust.confirm(until)
    approval_memory(os.environ).set_clock(now)
    if json:
        show.print_json([_known_record(key) for key in trust.known().values()])
    else:
        show.out.print("Confirmed." if until is None else f"Confirmed until {until.isoformat(timespec='seconds')}.")


def _folders() -> tuple[SigningKeys, TrustStore]:
    import os

    from fieldhand.approval.keys.signing import SigningKeys
    from fieldhand.approval.memory import trust_store
    from fieldhand.files import config_folder

    return SigningKeys(config_folder(os.environ)), trust_store(os.environ)


def _require_comparison(fingerprint: str, whose: str) -> None:
    """Ask the user to compare the fingerprint, as the file may have been changed on its way."""
    from fieldhand.cli import show
    from fieldhand.cli.inputs import may_ask
    from fieldhand.errors import NotApprovedError

    if not may_ask():
        raise NotApprovedError(
            f"comparing the fingerprint {fingerprint} needs a terminal to ask at",
            advice="give --fingerprint as its owner read it to you, or --yes if you have compared it",
        )
    show.out.print(f"The fingerprint of this key: {fingerprint}")
    if not typer.confirm(f"Did {whose} read the same fingerprint to you?"):
        raise NotApprovedError("not trusted, nothing was changed")


def _own_record(key: OwnKey) -> dict[str, Any]:
    public = key.public
    return {
        "name": public.name,
        "fingerprint": public.fingerprint,
        "public_key": public.line(),
        "file": str(key.file),
        "encrypted": key.encrypted,
    }


def _known_record(key: KnownKey) -> dict[str, Any]:
    return {
        "name": key.name,
        "fingerprint": key.fingerprint,
        "state": key.state,
        "since": key.since,
        "revoked": key.revoked,
    }
