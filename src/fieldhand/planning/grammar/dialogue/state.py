"""The state of a dialogue: the plan so far and what later clauses can refer to, with the steps that change it."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal, TypeVar

from fieldhand.places import selectors as s
from fieldhand.places.series_statistics import Statistic
from fieldhand.planning.grammar.dialogue.faults import Fork, NotComposed, OpenQuestion
from fieldhand.planning.grammar.dialogue.plans import EMPTY, Path, block_at, with_node
from fieldhand.planning.grammar.meaning import (
    AllTests,
    DriveCommand,
    Home,
    InAnOrder,
    Lead,
    LimitClause,
    PaceClause,
    PlaceMeaning,
    RankCommand,
    RechargeClause,
    SettleClause,
    Thing,
    WayRule,
)
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task import plan as p
from fieldhand.task.conditions import Condition
from fieldhand.task.frames import Then
from fieldhand.task.watches import Watch

Spans = tuple[p.Span, ...]
#: Ranges of the request that corrections change, each with what stands there then.
Edits = tuple[tuple[p.Span, str], ...]
T = TypeVar("T")


def _names_nothing(_category: str, _used: int) -> bool:
    """Return False: no phrases are known."""
    return False


@dataclass(frozen=True)
class Setting:
    """The robot and the site that the clauses are read for.

    Attributes:
        robot: Robot profile.
        site: Site, whose rows are named where something is said of each of them.
        spans_of: Returns the character ranges of a bit mask of tokens.
        request: The request as typed, which questions quote.
        chosen: Number of the way that was chosen at each fork.
        names: Returns True if some tokens contain a phrase of a category.
    """

    robot: RobotProfile
    site: Site
    spans_of: Callable[[int], Spans]
    request: str = ""
    chosen: Mapping[Hashable, int] = field(default_factory=dict)
    names: Callable[[str, int], bool] = _names_nothing

    def either(self, what: str, used: int, ways: Sequence[T]) -> T:
        """Return the chosen one of several ways to continue.

        Args:
            what: What has to be chosen.
            used: Tokens that leave it open; with ``what`` they name the fork.
            ways: Ways to continue, at least one.

        Raises:
            Fork: None of them has been chosen.
        """
        if len(ways) == 1:
            return ways[0]
        key = (what, used)
        if key not in self.chosen:
            raise Fork(key, len(ways))
        return ways[self.chosen[key]]

    def quoted(self, used: int) -> str:
        """Return the words of the request from the first to the last of some tokens."""
        said = self.spans_of(used)
        return self.request[said[0][0] : said[-1][1]] if said else ""

    def action_measuring(self, quantity: str) -> str | None:
        """Return the name of the first action that measures a quantity."""
        return next((one.name for one in self.robot.actions if quantity in one.measures), None)


@dataclass(frozen=True)
class SaidPace:
    """A driving speed that was said.

    Attributes:
        pace: The speed.
        said: Spans that say it.
        step: Index of the step of the plan that it stands with.
        of_drive: True if it is the speed of one drive.
        of_all: True if it is said of the whole mission.
    """

    pace: PaceClause
    said: Spans
    step: int
    of_drive: bool = False
    of_all: bool = False


@dataclass(frozen=True)
class DialogueState:
    """The plan of the clauses read so far, and what later ones can refer to.

    Attributes:
        plan: Block of the plan itself; every block is an InOrder while the plan is made.
        scope: Path of the block that takes the next command.
        loop: Path of the body of the last for-each.
        choice: Path of the last condition.
        captured: Path of the last capture.
        lead: Place at which the next command is done.
        things: What was captured last.
        where: Place of the last command.
        where_scope: Block in which that command stands.
        readings: Number of readings that have a name.
        limits: Limits of the request.
        limits_said: Spans that say each limit.
        ways: Rules of where it drives, each with the spans that say it.
        nominal: How the mission ends, if the request says so.
        nominal_said: Spans that say it.
        open: True while a condition of the current sentence has no command yet.
        decided: Tests of the last condition.
        commands_in_sentence: Number of commands of the current sentence.
        area: Rows or an area that the robot was sent along or into, until it says what is done there.
        order: Order of the next places.
        home: Return with which the mission ends, if nothing follows.
        within: Rows or area in which the places of the sentence are.
        each_of: Rows of each of which the places of the sentence are ("in each row, ... the first tree, ... the last").
        asked: Test of the last question.
        in_case: How the mission ends in one case.
        returned: True if the last drive is a return ("come back to the charger").
        tested_at: Place and block of the command before the last condition.
        ended_by: Condition that ends the last for-each, until something else is done.
        joints: Spans of the connectives.
        ranking: Trees that were ranked.
        edits: What corrections change in the request.
        paces: Driving speeds, with the parts of the plan that they may be of.
        settles: Waits before captures.
        speed: Driving speed of the whole mission, when all clauses are read.
        runs_on: True if the last "otherwise" stands in a text without a mark that shows where its case ends.
        watches: Conditions that are checked throughout the mission.
        after_watch: True if the last clause said how long the robot waits in one of them.
        asked_for: Statistic of the last readings that was asked for; empty if none was.
        sequenced: True if a connective says that one command follows another ("then").
    """

    plan: p.InOrder = EMPTY
    scope: Path = ()
    loop: Path | None = None
    choice: Path | None = None
    captured: Path | None = None
    lead: Lead | None = None
    things: tuple[Thing, ...] = ()
    where: PlaceMeaning | None = None
    where_scope: Path | None = None
    readings: int = 0
    limits: tuple[LimitClause, ...] = ()
    limits_said: tuple[Spans, ...] = ()
    ways: tuple[tuple[WayRule, Spans], ...] = ()
    recharging: tuple[tuple[RechargeClause, Spans], ...] = ()
    nominal: Then | None = None
    nominal_said: Spans = ()
    open: bool = False
    decided: AllTests | None = None
    commands_in_sentence: int = 0
    area: DriveCommand | None = None
    order: InAnOrder | None = None
    home: Home | None = None
    within: s.Selector | None = None
    each_of: s.Selector | None = None
    asked: AllTests | None = None
    in_case: Then | None = None
    returned: bool = False
    tested_at: tuple[PlaceMeaning | None, Path | None] = (None, None)
    ended_by: Condition | None = None
    joints: Spans = ()
    ranking: RankCommand | None = None
    assumed: tuple[str, ...] = ()
    runs_on: bool = False
    edits: Edits = ()
    paces: tuple[SaidPace, ...] = ()
    settles: tuple[SettleClause, ...] = ()
    speed: SaidPace | None = None
    watches: tuple[Watch, ...] = ()
    after_watch: bool = False
    sequenced: bool = False
    asked_for: Statistic | Literal[""] = ""

    @property
    def block(self) -> p.InOrder:
        """The block that takes the next command."""
        return block_at(self.plan, self.scope)

    @property
    def next_step(self) -> Path:
        """The path of the next step of that block."""
        return (*self.scope, len(self.block.steps))

    @property
    def awaits_command(self) -> bool:
        """True if a place was named, and what is done there was not."""
        return self.lead is not None or self.area is not None


def with_step(state: DialogueState, node: p.Node) -> DialogueState:
    """Return the state after a further step of the block that takes commands."""
    block = state.block
    plan = with_node(state.plan, state.scope, replace(block, steps=(*block.steps, node)))
    return replace(state, plan=plan, open=False, ended_by=None)


def with_capture(state: DialogueState, act: p.Act, scope: Path) -> DialogueState:
    """Return the state after a further capture in a block."""
    block = block_at(state.plan, scope)
    plan = with_node(state.plan, scope, replace(block, steps=(*block.steps, act)))
    return replace(state, plan=plan, captured=(*scope, len(block.steps)), open=False)


def with_last_step(state: DialogueState, node: p.Node) -> DialogueState:
    """Return the state with another node for the last step of the block that takes commands."""
    block = state.block
    return replace(state, plan=with_node(state.plan, state.scope, replace(block, steps=(*block.steps[:-1], node))))


def with_joints(state: DialogueState, said: Spans) -> DialogueState:
    """Return the state after words that join commands and have no step of their own."""
    return replace(state, joints=(*state.joints, *said))


def with_assumption(state: DialogueState, sentence: str) -> DialogueState:
    """Return the state after something was assumed."""
    return replace(state, assumed=(*state.assumed, sentence))


def done_at(state: DialogueState, place: PlaceMeaning) -> DialogueState:
    """Return the state after a command was done at a place."""
    return replace(state, where=place, where_scope=state.scope, commands_in_sentence=state.commands_in_sentence + 1)


__all__ = [
    "DialogueState",
    "Edits",
    "NotComposed",
    "OpenQuestion",
    "Path",
    "Setting",
    "Spans",
    "done_at",
    "with_assumption",
    "with_capture",
    "with_joints",
    "with_last_step",
    "with_step",
]  # fmt: skip
