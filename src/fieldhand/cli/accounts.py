"""``fieldhand accounts``: people who may log in to the server, and tokens for programs, from the server's machine."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import timedelta
from typing import TYPE_CHECKING, Annotated

import typer

from fieldhand.cli.options import JsonOption, LangOption
from fieldhand.language import counted, message

if TYPE_CHECKING:
    from fieldhand.accounts.accounts import Accounts
    from fieldhand.accounts.people import Account
    from fieldhand.language import Language

#: Who acts at the command line: the local administrator.
_LOCAL = "local"

accounts = typer.Typer(
    name="accounts",
    help="People who may log in to fieldhand serve, and tokens for programs.",
    no_args_is_help=True,
)

NameArgument = Annotated[str, typer.Argument(help="Name of the account.")]
RoleOption = Annotated[
    str, typer.Option("--role", help="viewer (sees), planner (plans), approver (approves, commands) or admin.")
]
GenerateOption = Annotated[
    bool, typer.Option("--generate", help="Make a random password and print it; else it is asked for.")
]


@accounts.command("add")
def add(
    name: NameArgument,
    role: RoleOption = "viewer",
    generate: GenerateOption = False,
    language: Annotated[str, typer.Option("--language", help="Language of messages for this person.")] = "en",
    lang: LangOption = None,
    json: JsonOption = False,
) -> None:
    """Add an account; the password is asked for, read from FIELDHAND_PASSWORD, or generated."""
    from fieldhand.accounts.roles import parse_role
    from fieldhand.cli import show

    with _opened() as store:
        wanted, password = parse_role(role), _password(_language(lang), generate=generate)
        account = store.people.add(name, password, wanted, language)
        store.audit.add(_LOCAL, "account added", account.name, role=account.role.value)
    if json:
        show.print_json(_record(account) | ({"password": password} if generate else {}))
        return
    say = _language(lang).say
    show.out.print(say(message("Added: {name}, {role}", name=account.name, role=account.role.value)))
    _print_password(password, _language(lang), generate=generate)


@accounts.command("list")
def list_accounts(lang: LangOption = None, json: JsonOption = False) -> None:
    """List the accounts with their roles."""
    from fieldhand.cli import show

    with _opened() as store:
        people = store.people.all()
    if json:
        show.print_json({"accounts": [_record(account) for account in people]})
        return
    if not people:
        say = _language(lang).say
        show.out.print(say(message("No account yet; {command} adds one.", command="fieldhand accounts add NAME")))
    wide = max((len(account.name) for account in people), default=0)
    for account in people:
        since = account.created_at.date().isoformat()
        show.out.print(f"{account.name:<{wide}}  {account.role.value:<8}  {account.language}  {since}")


@accounts.command("role")
def role(
    name: NameArgument,
    role: Annotated[str, typer.Argument(help="viewer, planner, approver or admin.")],
    lang: LangOption = None,
    json: JsonOption = False,
) -> None:
    """Change the role of an account, at once."""
    from fieldhand.accounts.roles import parse_role
    from fieldhand.cli import show

    with _opened() as store:
        account = store.people.change(name, role=parse_role(role))
        store.audit.add(_LOCAL, "role", account.name, role=account.role.value)
    if json:
        show.print_json(_record(account))
        return
    say = _language(lang).say
    show.out.print(say(message("{name} is {role} from now on", name=account.name, role=account.role.value)))


@accounts.command("password")
def password(
    name: NameArgument, generate: GenerateOption = False, lang: LangOption = None, json: JsonOption = False
) -> None:
    """Set another password, and end all sessions of the account."""
    from fieldhand.cli import show

    with _opened() as store:
        store.people.find(name)
        new = _password(_language(lang), generate=generate)
        account = store.people.set_password(name, new)
        store.audit.add(_LOCAL, "password", account.name)
    if json:
        show.print_json(_record(account) | ({"password": new} if generate else {}))
        return
    language = _language(lang)
    show.out.print(language.say(message("{name} has another password, and must log in again", name=account.name)))
    _print_password(new, language, generate=generate)


@accounts.command("remove")
def remove(name: NameArgument, lang: LangOption = None, json: JsonOption = False) -> None:
    """Remove an account with its sessions and tokens; the audit log keeps its name."""
    from fieldhand.cli import show

    with _opened() as store:
        account = store.people.remove(name)
        store.audit.add(_LOCAL, "account removed", account.name)
    if json:
        show.print_json(_record(account))
        return
    show.out.print(_language(lang).say(message("Removed: {name}", name=account.name)))


@accounts.command("link")
def link(
    url: Annotated[
        str, typer.Option("--url", help="Address of the server, as it printed it.")
    ] = "http://127.0.0.1:8000/",
    lang: LangOption = None,
    json: JsonOption = False,
) -> None:
    """Print a link that logs in once as this machine's administrator, as the server does when it starts."""
    from fieldhand.cli import show

    with _opened() as store:
        made = f"{url.rstrip('/')}/#code={store.codes.new()}"
        store.audit.add(_LOCAL, "link created")
    if json:
        show.print_json({"link": made})
        return
    show.out.print(_language(lang).say(message("Open this once, within 12 hours:")))
    show.out.print(made)


@accounts.command("token")
def token(
    name: Annotated[str, typer.Argument(help="Name of the token: the program that will use it.")],
    scopes: Annotated[
        str, typer.Option("--scopes", help="Rights, with commas: read, plan, approve, command, admin.")
    ] = "read",
    owner: Annotated[
        str | None, typer.Option("--owner", help="Account of its owner; else this machine's administrator.")
    ] = None,
    days: Annotated[int, typer.Option("--days", min=1, max=3650, help="Days in which it can be used.")] = 90,
    lang: LangOption = None,
    json: JsonOption = False,
) -> None:
    """Create a token for a program, and print it once; it never has more rights than its owner."""
    from fieldhand.accounts.roles import parse_scopes, sorted_scopes
    from fieldhand.cli import show

    with _opened() as store:
        wanted = parse_scopes(part.strip() for part in scopes.split(","))
        account = None if owner is None else store.people.find(owner)
        secret, made = store.tokens.add(None if account is None else account.id, name, wanted, timedelta(days=days))
        rights = ", ".join(sorted_scopes(made.effective_scopes))
        store.audit.add(_LOCAL, "token created", made.name, id=made.id, owner=made.owner, scopes=rights)
    if json:
        show.print_json({"token": secret, "id": made.id, "name": made.name, "owner": made.owner, "scopes": rights})
        return
    say = _language(lang).say
    show.out.print(
        say(
            counted(
                "Token {name} of {owner} for one day, with the rights: {rights}",
                "Token {name} of {owner} for {count} days, with the rights: {rights}",
                days,
                name=made.name,
                owner=made.owner,
                rights=rights or "-",
            )
        )
    )
    show.out.print(secret)


@contextmanager
def _opened() -> Iterator[Accounts]:
    """Open the accounts of the server, for the duration of the context."""
    from fieldhand.accounts.accounts import open_accounts

    store = open_accounts(os.environ)
    try:
        yield store
    finally:
        store.close()


def _password(language: Language, *, generate: bool) -> str:
    """Return a new password: random, from the environment, or typed twice.

    Raises:
        InputError: A password must be typed, and standard input is not a terminal.
    """
    from fieldhand.accounts.random_secrets import new_password
    from fieldhand.cli.secrets import new_account_password

    return new_password() if generate else new_account_password(language)


def _print_password(password: str, language: Language, *, generate: bool) -> None:
    from fieldhand.cli import show

    if generate:
        show.out.print(language.say(message("Password: {password}", password=password)))


def _record(account: Account) -> dict[str, str]:
    return {
        "name": account.name,
        "role": account.role.value,
        "language": account.language,
        "created_at": account.created_at.isoformat(),
    }


def _language(lang: str | None) -> Language:
    from fieldhand.language import spoken

    return spoken(lang, os.environ)
