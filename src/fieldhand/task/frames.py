"""The frames of IEEE 1872.1-2024: what a Task holds beside its plan.

Command (goal, state, parameter), task composition (plan, exits), results (goals' metrics), constraints and resources.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from fieldhand.brief import brief_repr
from fieldhand.task.plan import Node, Span

Then = Literal["return_to_end", "return_to_start", "stay"]
Fault = Literal["action_failed", "drive_failed", "low_budget", "aborted"]
BudgetKind = Literal["distance_m", "duration_s", "energy_percent"]


@dataclass(frozen=True, kw_only=True)
class Goal:
    """A countable outcome that was asked for; its outcome is success, failure or indeterminate.

    Attributes:
        node: The ``Act`` that serves it.
        expected: Captures wanted where the request fixes their number; None where the site or a reading decides.
        conditional: The node stands under an if or an otherwise: not reaching it is no failure.
        optional: The budget decides how often ("as many as you can").
    """

    id: str
    node: str
    action: str
    expected: int | None = None
    conditional: bool = False
    optional: bool = False


@dataclass(frozen=True, kw_only=True)
class Variable:
    """A state variable: the reading that a node binds."""

    name: str
    quantity: str
    unit: str
    node: str


@dataclass(frozen=True, kw_only=True)
class Command:
    """What was asked: the request word for word, its goals, its state variables, what was assumed in reading it.

    Attributes:
        no_part: Ranges of the request that have no part in the plan: politeness, a reason that is given.
        read_as: The request with what was answered to questions about it; empty where nothing was asked.
        warnings: What its planner wants confirmed before it is approved, as sentences.
    """

    request: str
    goals: tuple[Goal, ...] = ()
    variables: tuple[Variable, ...] = ()
    assumptions: tuple[str, ...] = ()
    no_part: tuple[Span, ...] = ()
    read_as: str = ""
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class FaultedExit:
    """What to do when a fault ends the mission."""

    fault: Fault
    then: Then


@dataclass(frozen=True, kw_only=True)
class Composition:
    """The plan and its exits. ``nominal`` is taken when the plan is done.

    Attributes:
        nominal_said: Ranges of the request that say where the robot goes then.
    """

    plan: Node
    nominal: Then = "return_to_end"
    nominal_said: tuple[Span, ...] = ()
    faulted: tuple[FaultedExit, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Budget:
    """At most ``limit`` of a resource for the whole mission, the way home included.

    Attributes:
        kind: Metres driven, seconds, or percent of a full battery.
        failure_probability: Accepted chance of exceeding it (Pf), above 0 and below 1.
        said: Ranges of the request from which it came.
    """

    kind: BudgetKind
    limit: float
    failure_probability: float = 0.1
    said: tuple[Span, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Constraints:
    """Limits of the whole mission.

    Attributes:
        reserve_percent: The charge that must be left at the end; else the profile's own reserve.
        speed_m_s: Drive no faster.
        reserve_said: Ranges of the request that ask for the reserve.
    """

    budgets: tuple[Budget, ...] = ()
    reserve_percent: float | None = None
    reserve_said: tuple[Span, ...] = ()
    speed_m_s: float | None = None


@dataclass(frozen=True, kw_only=True)
class Resource:
    """A resource that the Task was planned for, by name and SHA-256 of its source."""

    kind: Literal["robot", "site"]
    name: str
    sha256: str


@dataclass(frozen=True, kw_only=True, repr=False)
class Task:
    """A mission as it is planned, approved, carried out and judged (level 1 of the design)."""

    id: str
    command: Command
    composition: Composition
    constraints: Constraints = Constraints()
    resources: tuple[Resource, ...] = ()

    __repr__ = brief_repr

    @classmethod
    def from_xml(cls, document: bytes | str | Path) -> Task:
        """Read a Task from its XML, or from a file of that path.

        Whether a robot can carry it out is part of the review.

        Raises:
            TaskError: The file cannot be read, or it holds no Task; says where.
        """
        from fieldhand.task.codec import decode
        from fieldhand.task.codec_xml import read_xml

        if isinstance(document, Path):
            data, source = read_xml(document, advice="give a Task document"), str(document)
            return decode(data, source=source)
        return decode(document.encode() if isinstance(document, str) else document)

    def to_xml(self) -> bytes:
        """Return the Task as XML, UTF-8; the same bytes for the same Task."""
        from fieldhand.task.codec import encode

        return encode(self)
