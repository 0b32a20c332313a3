"""What a request says, as far as it has been read, and how a mission ends."""

from __future__ import annotations

from dataclasses import dataclass, field

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.english import draft as d
from fieldhand.planning.english.limits import LimitPhrase
from fieldhand.planning.planner import Reason
from fieldhand.task.frames import Then
from fieldhand.task.plan import Span


@dataclass
class Told:
    """What a request says.

    Attributes:
        root: The plan's own level.
        limits: Budgets and reserves.
        nominal: Where the robot is to end, if the request says it.
        nominal_said: The ranges of the request that say it.
        first: The request says where to end before it says what to do.
        in_case: Where the robot is to end in one case, if the request says it.
        ends_differ: It is to end elsewhere in another case.
        assumptions: What was assumed, as sentences.
        joints: The ranges of the request that say in which order its parts follow each other ("then", "after that").
        no_part: The ranges of the request that ask for nothing.
        misfit: The first sentence that was not read as it stands, and why; None if all were.
    """

    root: d.DraftBlock = field(default_factory=d.DraftBlock)
    limits: list[LimitPhrase] = field(default_factory=list)
    nominal: Then | None = None
    nominal_said: list[Span] = field(default_factory=list)
    first: bool = False
    in_case: Then | None = None
    ends_differ: bool = False
    assumptions: list[str] = field(default_factory=list)
    joints: list[Span] = field(default_factory=list)
    misfit: Reason | None = None
    no_part: list[Span] = field(default_factory=list)


@dataclass(eq=False)
class Homeward(d.Halt):
    """A return that the request asks for at the plan's own level: the exit if nothing follows it, else a drive."""

    then: Then = "return_to_end"


def settle(told: Told) -> None:
    """Make the returns of the plan's own level drives, but for the last, which is the exit.

    ``told`` is changed.
    """
    steps = told.root.steps
    for index, step in enumerate(steps[:-1]):
        if isinstance(step, Homeward):
            marker = s.Marker(name="start" if step.then == "return_to_start" else "end")
            steps[index] = d.Go(place=marker, said=step.said)
    if steps and isinstance(steps[-1], Homeward):
        told.nominal = steps[-1].then
        told.nominal_said += steps[-1].said
        steps.pop()
    elif told.nominal in ("return_to_start", "return_to_end") and not told.first:
        told.nominal = None
    if told.nominal is None and told.ends_differ:
        told.nominal = "stay"
        told.assumptions.append(
            message(
                "Where the mission ends depends on the case; in a case that does not say where, the robot stays.",
                context="assumption",
            )
        )
    if told.nominal is None and told.in_case is not None:
        told.nominal = told.in_case
        way = message(told.in_case.replace("_", " "), context="way")
        told.assumptions.append(message("The mission ends there in any case ({way}).", context="assumption", way=way))
    while len(steps) > 1 and type(last := steps[-1]) is d.Halt:
        if last.here and told.nominal is None:
            told.nominal = "stay"  # "drive to the charger and finish there"
        told.nominal_said += steps.pop().said  # a plan ends at its end
    _without_questions(told, told.root)


def _without_questions(told: Told, block: d.DraftBlock) -> None:
    for step in list(block.steps):
        for inner in d.blocks_of(step):
            _without_questions(told, inner)
        if isinstance(step, d.Choice) and not step.then.steps and not (step.otherwise and step.otherwise.steps):
            block.steps.remove(step)
            told.no_part += step.said
            told.assumptions.append(
                message(
                    "A question about a reading is answered by the reading itself; the robot does nothing more.",
                    context="assumption",
                )
            )
