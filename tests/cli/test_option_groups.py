"""Groups of options: a command gets dataclasses, its command line and its help show single options."""

from __future__ import annotations

from dataclasses import dataclass
from inspect import signature
from typing import Annotated

import pytest
import typer
from typer.testing import CliRunner

from fieldhand.cli.option_groups import grouped


@dataclass(frozen=True, kw_only=True)
class Greeting:
    """Options of a greeting."""

    name: Annotated[str, typer.Option("--name", help="Name to greet.")]
    loud: Annotated[bool, typer.Option("--loud", help="Greet in capitals.")] = False


def greet(greeting: Greeting, times: Annotated[int, typer.Option("--times")] = 1) -> None:
    """Greet somebody."""
    text = f"Hello {greeting.name}! " * times
    typer.echo(text.upper() if greeting.loud else text)


def test_the_fields_of_a_group_are_options() -> None:
    app = typer.Typer()
    app.command()(grouped()(greet))
    done = CliRunner().invoke(app, ["--name", "Ada", "--loud", "--times", "2"])
    assert done.output.strip() == "HELLO ADA! HELLO ADA!"
    assert CliRunner().invoke(app, ["--name", "Ada"]).output.strip() == "Hello Ada!"
    missing = CliRunner().invoke(app, [])
    assert missing.exit_code == 2
    assert "Missing option '--name'" in missing.output


def test_options_keep_the_order_of_the_fields_unless_another_is_given() -> None:
    assert list(signature(grouped()(greet)).parameters) == ["name", "loud", "times"]
    assert list(signature(grouped("times loud name")(greet)).parameters) == ["times", "loud", "name"]


@pytest.mark.parametrize("order", ["name loud", "name loud times times", "name loud times tone"])
def test_an_order_that_does_not_name_every_option_once_is_a_mistake_of_the_program(order: str) -> None:
    with pytest.raises(TypeError, match="greet has the options"):
        grouped(order)(greet)
