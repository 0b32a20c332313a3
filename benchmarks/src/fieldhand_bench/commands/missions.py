"""``fieldhand bench missions``: plan, simulate and judge requests whose expected outcomes are given in case files."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fieldhand.cli.options import JsonOption, PlannerOption, SeedOption, TranscriptOption
from fieldhand.cli.outputs import to_folder

if TYPE_CHECKING:
    from rich.table import Table

    from fieldhand_bench.missions.cases import Case
    from fieldhand_bench.missions.trial import CaseTrial

_ANSWERS = {
    "planned": "wrong",
    "asked": "asked back",
    "refused": "refused",
    "failed": "no answer",
    "not approved": "not approved",
}


def bench_missions(
    cases: Annotated[list[str], typer.Argument(help="Files of cases (YAML), or 'builtin' for the included ones.")],
    planner: PlannerOption = "english",
    seed: SeedOption = 0,
    only: Annotated[
        list[str] | None, typer.Option("--only", help="Run only the case of this id; may be repeated.")
    ] = None,
    logs: Annotated[
        Path | None,
        typer.Option("--logs", callback=to_folder, help="Folder for the event logs, CASE.WORLD.jsonl each."),
    ] = None,
    transcript: TranscriptOption = None,
    json: JsonOption = False,
) -> None:
    """Plan each request, simulate it in every world of its case, and judge the outcome; published rows first."""
    import os
    import time

    from fieldhand import mission
    from fieldhand.cli import show
    from fieldhand.planning.llm.chat import Chat
    from fieldhand_bench.commands.machine import machine
    from fieldhand_bench.missions.case_file import load_cases
    from fieldhand_bench.missions.published import sorted_by_row
    from fieldhand_bench.missions.trial import Metered, TrialSetup, try_all

    chosen = _chosen(load_cases(cases), only)
    models: list[Metered] = []

    def metered(chat: Chat) -> Chat:
        models.append(Metered(chat))
        return models[-1]

    made = mission.make_planner(planner, os.environ, transcript, watched=metered)
    setup = TrialSetup(
        planner=made,
        model=models[0] if models else None,
        seed=seed,
        clock=time.perf_counter,
        keep=None if logs is None else _writer(logs),
    )
    trials = []
    for trial in try_all(chosen, setup):
        trials.append(trial)
        if models:  # a language model is slow: report progress
            show.note(f"{len(trials)} of {len(chosen)}: {trial.id}, {_result(trial)}")
    passed = all(trial.as_asked for trial in trials)
    if json:
        show.print_json({"machine": machine(), "planner": planner, "seed": seed, "passed": passed, **_record(trials)})
    else:
        _show(sorted_by_row(trials), planner, seed)
    raise SystemExit(0 if passed else 1)


def _chosen(cases: Sequence[Case], only: Sequence[str] | None) -> tuple[Case, ...]:
    from fieldhand.errors import InputError

    known = {case.id for case in cases}
    for wanted in only or ():
        if wanted not in known:
            raise InputError(f"no case is called '{wanted}'", where="--only", advice="give the id of a case")
    return tuple(case for case in cases if not only or case.id in only)


def _writer(folder: Path) -> Callable[[Case, int, Sequence[str]], None]:
    from fieldhand.cli.inputs import write_file

    def write(case: Case, world: int, lines: Sequence[str]) -> None:
        name = "".join(c if c.isalnum() or c in "-_." else "_" for c in case.id)
        write_file(folder / f"{name}.{world}.jsonl", "".join(f"{line}\n" for line in lines).encode())

    return write


def _record(trials: Sequence[CaseTrial]) -> dict[str, Any]:
    from dataclasses import asdict

    from fieldhand_bench.missions.published import row_of, sorted_by_row, tallies

    rows = []
    for trial in sorted_by_row(trials):
        row = row_of(trial.id)
        rows.append(
            asdict(trial) | {"worlds_right": trial.worlds_right, "published": None if row is None else asdict(row)}
        )
    totals = {
        "cases": len(trials),
        "as_asked": sum(t.as_asked for t in trials),
        "worlds": sum(t.worlds for t in trials),
        "worlds_right": sum(t.worlds_right for t in trials),
        "tokens": sum(t.tokens for t in trials),
        "published": [asdict(tally) for tally in tallies(trials)],
    }
    return {"totals": totals, "cases": rows}


def _result(trial: CaseTrial) -> str:
    text = _ANSWERS[trial.answer]
    if not trial.as_asked:
        return text
    return "as asked" if trial.answer == "planned" else f"as asked: {text}"


def _show(trials: Sequence[CaseTrial], planner: str, seed: int) -> None:
    from fieldhand.cli import show
    from fieldhand_bench.missions.published import row_of, tallies

    rows = [trial for trial in trials if row_of(trial.id) is not None]
    others = [trial for trial in trials if row_of(trial.id) is None]
    if rows:
        show.out.print(_table("The published experiment", rows, published=True))
    if others:
        show.out.print(_table("Other cases" if rows else "Cases", others, published=False))
    wrong = [trial for trial in trials if not trial.as_asked]
    if wrong:
        show.heading("Not as asked")
    for trial in wrong:
        show.out.print(f"{trial.id}: {trial.request}")
        if trial.why:
            show.out.print(f"  {_result(trial)}: {trial.why}")
        for world, sentences in enumerate(trial.wrong):
            for sentence in sentences:
                show.out.print(f"  world {world}: {sentence}")
    show.heading("Totals")
    for tally in tallies(trials):
        show.out.print(
            f"published, {'spatial' if tally.spatial else 'not spatial'}: {tally.as_asked} of {tally.tried} as asked;"
            f" published: {tally.published_right} right"
        )
    right, worlds = sum(t.worlds_right for t in trials), sum(t.worlds for t in trials)
    show.out.print(
        f"all: {sum(t.as_asked for t in trials)} of {len(trials)} as asked, {right} of {worlds} worlds;"
        f" planner {planner}, seed {seed}"
    )


def _table(title: str, trials: Sequence[CaseTrial], *, published: bool) -> Table:
    from rich.box import SIMPLE_HEAD
    from rich.table import Table

    from fieldhand_bench.missions.published import row_of

    with_model = any(trial.tries for trial in trials)
    table = Table(title=title, title_justify="left", box=SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))
    for head in ("case", "result", *(("published",) if published else ())):
        table.add_column(head)
    for head in ("worlds", "acts", "ifs", "plan ms", *(("tokens", "tries") if with_model else ())):
        table.add_column(head, justify="right", no_wrap=True)
    for trial in trials:
        row = row_of(trial.id)
        table.add_row(
            trial.id, _result(trial), *((row.verdict,) if published and row else ()),
            f"{trial.worlds_right}/{trial.worlds}" if trial.worlds else "", str(trial.tasks or ""),
            str(trial.conditionals or ""), f"{1000 * trial.plan_s:.0f}",
            *((str(trial.tokens or ""), str(trial.tries or "")) if with_model else ()),
        )  # fmt: skip
    return table
