"""``--lang``: the same plan in another language, from the flag or from the environment."""

from __future__ import annotations

import json
import os

from support.processes.command import fieldhand

REQUEST = "Take a picture of tree 4."


def environment(**more: str) -> dict[str, str]:
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("LC_", "LANG"))}
    return kept | more


def test_the_flag_says_the_read_back_in_spanish() -> None:
    run = fieldhand("plan", REQUEST, "--site", "demo", "--lang", "es", "--json", env=environment(LANG="C"))
    assert run.status == 0, run.err
    record = json.loads(run.out)
    assert record["language"] == "es"
    assert "  1. En el árbol 4: tomar una fotografía térmica." in record["read_back"]


def test_the_environment_says_it_where_no_flag_does() -> None:
    run = fieldhand("plan", REQUEST, "--site", "demo", env=environment(LANG="es_ES.UTF-8"))
    assert run.status == 0, run.err
    assert "Lo que se hará" in run.out
    assert "Volver al punto final." in run.out


def test_a_language_that_there_is_not_is_one_clear_line() -> None:
    run = fieldhand("plan", REQUEST, "--site", "demo", "--lang", "klingon")
    assert run.status == 2
    assert run.err.strip() == "fieldhand: --lang: there is no language 'klingon'; choose one of en, es"
