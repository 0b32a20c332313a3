"""Constructions that ask for work along paths in other ways: "row 4 needs spraying", "give the meadow a mow"."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.parameters import with_parameter
from fieldhand.planning.grammar.commands.working import Tract, along_tract, work
from fieldhand.planning.grammar.meaning import Amount, ParameterValue, Thing, WorkCommand
from fieldhand.planning.grammar.places.sampling import is_keep_out
from fieldhand.planning.grammar.words import Lex
from fieldhand.robot.implement import rate_unit
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction("work: verb=WORKV those=DET", "work: verb=WORKV those=DET how=parameter", cost=0.2, given=("robot",))
def work_along_those(
    verb: Lex, those: Lex, used: int, robot: RobotProfile, how: ParameterValue | None = None
) -> list[WorkCommand] | None:
    """Compose "spray those", of the rows or the area before."""
    return work(verb, used, robot, how=how) if "stands_for_noun" in those.features else None


@construction("in_need: [ONLY] where=tract SHOULD [DET] TREATMENT", cost=0.1)
def in_need(where: Tract) -> Tract:
    """Compose "only the Merlot rows need treating"."""
    return where


@construction(
    "work: where=in_need FULLSTOP one=work",
    "work: where=in_need COMMA one=work",
    "work: where=in_need [COMMA] AND one=work",
    cost=0.2,
    given=("robot",),
)
def work_in_need(where: Tract, one: WorkCommand, used: int, robot: RobotProfile) -> list[WorkCommand] | None:
    """Compose "only the Merlot rows need treating: spray those at 400 l/ha"."""
    if one.along is not None or not one.action:
        return None
    return along_tract(replace(one, used=used), where, robot)


@construction("work_name: verb=WORKV", "work_name: verb=WORKN", cost=0.0)
def work_name(verb: Lex) -> Lex:
    """Compose "spraying" and "mower" as what something needs."""
    return verb


@construction(
    "work: where=tract SHOULD [DET] verb=work_name",
    "work: where=tract MUST IS [DET] verb=work_name",
    "work: verb=work_name SHOULD where=tract",
    "work: CAUSE where=tract [TOBE] verb=WORKV",
    "work: GERUNDASK verb=work_name where=tract",
    "work: KEEPAT verb=work_name where=tract",
    "work: ASKSIF where=tract BEINF verb=WORKV",
    "work: NICEIF where=tract WERE verb=WORKV",
    "work: CAUSE [DET] verb=work_name TAKE where=tract",
    "work: GIVES where=tract [DET] verb=work_name",
    "work: GIVES where=tract DET THOROUGH verb=work_name",
    "work: where=tract SHOULD DET THOROUGH verb=work_name",
    "work: GIVES DET verb=work_name [AT] where=tract",
    "work: USE [DET] verb=WORKN OVER where=tract",
    "work: TAKE [DET] verb=WORKN OVER where=tract",
    "work: TAKE [DET] verb=WORKN where=tract",
    "work: TAKE [DET] verb=WORKV where=tract",
    "work: CAUSE DET verb=WORKN OF where=tract",
    "work: CAUSE DET verb=WORKV OF where=tract",
    "work: TAKE ONE verb=WORKN [OF] where=tract",
    "work: TAKE ONE verb=WORKV [OF] where=tract",
    "work: GO OVER where=tract WITH [DET] verb=WORKN",
    "work: GO [INORDERTO] verb=WORKV where=tract",
    "work: GO AND verb=WORKV where=tract",
    "work: GO where=tract [COMMA] AND verb=WORKV IT",
    cost=0.1,
    given=("robot",),
)
def wanted_work(verb: Lex, where: Tract, used: int, robot: RobotProfile) -> list[WorkCommand] | None:
    """Compose "row 4 needs spraying", "give row 4 a spray" and "run the mower over the meadow"."""
    return work(verb, used, robot, where)


@construction("work: DET verb=WORKN OF where=tract", "work: DET verb=WORKV OF where=tract", cost=0.8, given=("robot",))
def work_by_its_noun(verb: Lex, where: Tract, used: int, robot: RobotProfile) -> list[WorkCommand] | None:
    """Compose "a video of row 4, please"."""
    return work(verb, used, robot, where)


@construction(
    "work: CAUSE where=tract on=AT verb=work_name",
    "work: TAKE where=tract on=AT verb=work_name",
    "work: WORKV where=tract on=AT verb=work_name",
    cost=0.1,
    given=("robot",),
)
def recorded_work(verb: Lex, on: Lex, where: Tract, used: int, robot: RobotProfile) -> list[WorkCommand] | None:
    """Compose "get row 4 on video"."""
    implement = robot.action[verb.value].implement
    records = "on_record" in on.features and implement is not None and not implement.covers
    return work(verb, used, robot, where) if records else None


@construction(
    "work: one=work [COMMA] WITH [DET] verb=WORKN",
    "work: one=work [COMMA] WITH [DET] verb=WORKN RUNNING",
    "work: one=work [COMMA] USE [DET] verb=WORKN",
    cost=0.3,
)
def driven_with(one: WorkCommand, verb: Lex, used: int) -> WorkCommand | None:
    """Compose "two laps of the boundary with the camera on"."""
    known = not one.action and one.along is not None
    return replace(one, action=str(verb.value), used=used) if known else None


@construction(
    "work: USE [DET] verb=WORKN INORDERTO one=work",
    "work: USE [DET] verb=WORKN [COMMA] one=work",
    "work: WITH [DET] verb=WORKN [COMMA] one=work",
    "work: one=work [COMMA] WITH [DET] verb=WORKN",
    "work: one=work [COMMA] USE [DET] verb=WORKN",
    cost=0.2,
)
def with_its_tool(one: WorkCommand, verb: Lex, used: int) -> WorkCommand | None:
    """Compose "use the side camera to film row 4" and "film row 4 with the side camera"."""
    return replace(one, used=used) if one.action and str(verb.value) == one.action else None


@construction(
    "work: one=work [COMMA] [AND] verb=WORKV [DET] EDGE [way=ONPATH]",
    "work: one=work [COMMA] [AND] verb=WORKV [DET] bank=water_edge [way=ONPATH]",
    "work: one=work [COMMA] [AND] verb=WORKV where=edge [way=ONPATH]",
    "work: one=work [COMMA] [AND] verb=WORKV [it=IT] way=ONPATH", "work: one=work [COMMA] AND verb=WORKV it=IT",
    cost=0.1,
    given=("robot", "site"),
)  # fmt: skip
def driven_and_worked(
    one: WorkCommand,
    verb: Lex,
    used: int,
    robot: RobotProfile,
    site: Site,
    bank: Lex | None = None,
    where: Tract | None = None,
    it: Lex | None = None,
    way: Lex | None = None,
) -> WorkCommand | None:
    """Compose "go once round the pond and film the bank as you go": the edge that is driven along is worked."""
    del way
    implement = robot.action[verb.value].implement
    covers = implement is None or implement.covers
    if one.action or one.along is None or one.mode != "perimeter" or (covers and it is not None):
        return None
    if bank is not None and not is_keep_out(one.along, site):
        return None
    if where is not None and (where.mode != "perimeter" or where.heading != "any" or where.selector != one.along):
        return None
    return replace(one, action=str(verb.value), used=used)


@construction(
    "work: one=work [COMMA] WITH [DET] verb=WORKN AT [DET] EDGE [COMMA] [WHOLETIME]",
    "work: one=work [COMMA] WITH [DET] verb=WORKN AT aim=region [COMMA] [WHOLETIME]",
    cost=0.3,
    given=("robot", "site"),
)
def driven_with_aim(
    one: WorkCommand, verb: Lex, used: int, robot: RobotProfile, site: Site, aim: s.Selector | None = None
) -> WorkCommand | None:
    """Compose "a lap along the deer fence with the camera on the fence": a camera at one side faces the edge."""
    made = driven_with(one, verb, used)
    if made is None or made.mode != "perimeter" or made.along is None or aim not in (None, made.along):
        return None
    implement = robot.action[made.action].implement
    sideways = implement is not None and implement.side in ("left", "right")
    of_edge = made.along == s.Trees() or is_keep_out(made.along, site)
    return made if sideways and of_edge else None


@construction(
    "work_rate: [AT] amount=amount",
    "work_rate: WITH amount=amount",
    "work_rate: USE amount=amount",
    "work_rate: OF amount=amount",
    "work_rate: AT [DET] RATEWORD OF amount=amount",
    "work_rate: [WITH] [DET] RATEWORD [COMMA] [OF] amount=amount",
    "work_rate: [DET] RATEWORD IS amount=amount",
    cost=0.1,
)
def work_rate(amount: Amount) -> Amount | None:
    """Compose "at a rate of 250 l/ha"."""
    return amount if rate_unit(amount.unit) is not None else None


@construction(
    "work: one=work [COMMA] rate=work_rate",
    "work: one=work FULLSTOP rate=work_rate",
    "work: rate=work_rate [COMMA] one=work",
    cost=0.1,
    given=("robot",),
)
def work_at_rate(one: WorkCommand, rate: Amount, used: int, robot: RobotProfile) -> WorkCommand | None:
    """Compose "spray rows 3 to 8, 250 l/ha", wherever the rate stands."""
    if one.parameters or not one.action:
        return None
    made = with_parameter(Thing(one.action), ParameterValue(rate.number, rate.unit, ()), robot)
    return None if made is None else replace(one, parameters=made.parameters, used=used)
