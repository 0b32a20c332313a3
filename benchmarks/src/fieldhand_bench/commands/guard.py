"""``fieldhand bench guard``: simulate random missions and test if the budget guard keeps its accepted probabilities."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated

import typer

from fieldhand.cli.options import JsonOption, SeedOption

if TYPE_CHECKING:
    from rich.table import Table

    from fieldhand_bench.fly import Trial
    from fieldhand_bench.summary import Summary, Times, TrialGroup

_MOST_NAMED = 10


def bench_guard(
    missions: Annotated[int, typer.Option("--missions", min=1, help="Number of missions to simulate.")] = 500,
    seed: SeedOption = 0,
    jobs: Annotated[int, typer.Option("--jobs", help="Number of processes; -1 for one per processor.")] = -1,
    family: Annotated[str | None, typer.Option("--family", help="Only missions of this family.")] = None,
    trees: Annotated[int, typer.Option("--trees", min=20, max=2000, help="Maximum number of trees of a site.")] = 400,
    worst: Annotated[int, typer.Option("--worst", min=0, help="Number of conspicuous missions to list.")] = 0,
    only: Annotated[
        int | None, typer.Option("--only", min=0, help="Simulate only the mission of this seed and describe it.")
    ] = None,
    json: JsonOption = False,
) -> None:
    """Simulate random missions, judge each from its event log, and compare failures with accepted probabilities."""
    from dataclasses import asdict

    from fieldhand.cli import show
    from fieldhand_bench.commands.machine import machine
    from fieldhand_bench.fly import fly_all
    from fieldhand_bench.summary import summarize, worth_looking_at

    if only is not None:
        _replay(only, trees)
        return
    seeds = _seeds(missions, seed, family)
    on = machine()
    trials: list[Trial] = []
    for trial in fly_all(seeds, most_trees=trees, jobs=jobs):
        trials.append(trial)
        if len(trials) % 50 == 0:
            show.note(f"{len(trials)} of {missions} missions flown")
    summary = summarize(trials)
    looked = worth_looking_at(trials, worst)
    if json:
        show.print_json(
            {"machine": on, "seed": seed, "trees": trees, "passed": summary.passed, "summary": asdict(summary),
             "worst": [{"seed": trial.seed, "why": why} for trial, why in looked],
             "missions": [asdict(trial) for trial in trials]}
        )  # fmt: skip
    else:
        _show(summary)
        if looked:
            show.heading(f"Worth a look (replay one with --trees {trees} --only SEED)")
        for trial, why in looked:
            show.out.print(f"{trial.seed:>6}  {trial.family}, {trial.limited}: {why}")
        show.out.print()
        where = f"{on['machine']}, {on['cpu']}, {on['cores']} cores, load {on['load']}"
        show.out.print(f"{missions} missions, seed {seed}, up to {trees} trees; {where}; {on['software']}.")
    raise SystemExit(0 if summary.passed else 1)


def _seeds(missions: int, first: int, family: str | None) -> list[int]:
    """Return the seeds of so many missions; successive seeds cycle through the families."""
    import itertools

    from fieldhand.errors import InputError
    from fieldhand_bench.draw import family_of
    from fieldhand_bench.families import FAMILIES

    if family is not None and family not in FAMILIES:
        raise InputError(
            f"no family is called '{family}'", where="--family", advice=f"use one of {', '.join(FAMILIES)}"
        )
    fitting = (s for s in itertools.count(first) if family is None or family_of(s) == family)
    return list(itertools.islice(fitting, missions))


def _show(summary: Summary) -> None:
    from fieldhand.cli import show

    show.out.print(_table("Missions", summary.promises))
    show.out.print(_table("By family (home alone is safe)", summary.families))
    show.out.print(_table("By what limits them (home alone is safe)", summary.limits))
    show.out.print(_table("By accepted probability (home alone is safe)", summary.probabilities))
    show.out.print_lines(
        "Failed: a budget or the reserve was exceeded. Most: failures that chance explains (97.5 %). Safe: what must",
        "be done is within Pf at approval; warned: it is not. Visits: optional ones, mean; +/-: made less forecast;",
        "reward: over that of the best route were all legs' costs their means.",
    )
    show.heading("Beyond the limits")
    show.out.print(f"{summary.refused} drafts were not approved, and not flown")
    show.out.print(f"{summary.given_up} pieces of mandatory work given up with a reason, in {summary.gave_up} missions")
    show.out.print(f"{len(summary.silent)} pieces of mandatory work given up in silence{_some(summary.silent)}")
    show.out.print(f"{summary.lost} missions ended by a fault")
    show.out.print(f"{len(summary.wrong)} double visits, wrong ends and logs that do not fit{_some(summary.wrong)}")
    show.heading("Processor time of the guard")
    show.out.print(f"first decision: {_times_text(summary.first)}")
    show.out.print(f"later choices of an optional visit: {_times_text(summary.choices)}")
    show.out.print(f"later answers about mandatory work: {_times_text(summary.admissions)}")
    show.out.print()
    show.out.print("The guard kept what it promises." if summary.passed else "The guard did NOT keep what it promises.")


def _table(title: str, groups: Sequence[TrialGroup]) -> Table:
    from rich.box import SIMPLE_HEAD
    from rich.table import Table

    table = Table(title=title, title_justify="left", box=SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))
    for head in ("", "flown", "failed", "%", "95 %", "Pf %", "most", "visits", "+/-", "reward"):
        table.add_column(head, justify="left" if head == "" else "right", no_wrap=True)
    for group in groups:
        if not group.missions:
            continue
        low, high = group.interval
        table.add_row(
            group.name, str(group.missions), str(group.failures), f"{100 * group.rate:.1f}",
            f"{100 * low:.0f}-{100 * high:.0f}", f"{100 * group.accepted:.1f}",
            f"{group.most} {'✓' if group.kept else '✗'}", f"{group.visits:.1f}",
            "" if group.beyond_forecast is None else f"{group.beyond_forecast:+.1f}",
            "" if group.reward_share is None else f"{group.reward_share:.2f}",
        )  # fmt: skip
    return table


def _some(sentences: Sequence[str]) -> str:
    if not sentences:
        return ""
    more = f"; and {len(sentences) - _MOST_NAMED} more" if len(sentences) > _MOST_NAMED else ""
    return f": {'; '.join(sentences[:_MOST_NAMED])}{more}"


def _times_text(times: Times) -> str:
    return (
        f"median {times.median_ms:.1f} ms, 99th percentile {times.p99_ms:.0f} ms, worst {times.worst_ms:.0f} ms"
        f" ({times.count:,})"
    )


def _replay(seed: int, trees: int) -> None:
    """Simulate one mission and print its review, its events and its judgement."""
    from fieldhand import mission
    from fieldhand.cli import show
    from fieldhand.wording.events import EventText
    from fieldhand_bench.fly import fly
    from fieldhand_bench.summary import wrongs

    flown = fly(seed, trees)
    draft, trial, ruling = flown.draft, flown.trial, flown.trial.ruling
    rows = len(draft.site.planting.rows)
    show.out.print(
        f"seed {seed}: {draft.family}, limited by {draft.limited} ({draft.factor:.2f} of what everything needs),"
        f" {trial.promise}; {trial.trees} trees in {rows} rows; {draft.robot.name}, alpha {trial.alpha},"
        f" battery at {draft.charge_percent:.1f} %"
    )
    show.show_review(mission.review(draft.task, draft.site, draft.robot))
    show.heading("What happened")
    event_text = EventText(draft.robot)
    for line in filter(None, map(event_text.line, flown.events)):
        show.out.print(line)
    show.heading("How it is judged")
    for use in ruling.uses:
        show.out.print(f"{use.kind}: {use.used:.2f} of {use.limit:.2f} ({use.share:.0%})")
    show.out.print(
        f"optional visits: {ruling.visits} made, {trial.forecast.visits} forecast, {ruling.left_out} left out"
    )
    show.out.print(
        f"mandatory work: {ruling.done} done, {len(ruling.given_up)} given up, {len(ruling.silent)} in silence"
    )
    for what in ruling.silent:
        show.out.print(f"given up in silence: {what}")
    for what in wrongs(trial):
        show.out.print(f"wrong: {what}")
    if ruling.faulted:
        show.out.print(f"ended by a fault: {ruling.faulted}")
