"""The frames of IEEE 1872.1-2024: everything in a Task beside its plan.

Command (goal, state, parameter), task composition (plan, exits), results (metrics of the goals), constraints and
resources.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from fieldhand.short_repr import short_repr
from fieldhand.task.plan import Node, Span

Then = Literal["return_to_end", "return_to_start", "stay"]
Fault = Literal["action_failed", "drive_failed", "low_budget", "aborted"]
BudgetKind = Literal["distance_m", "duration_s", "energy_percent"]


@dataclass(frozen=True, kw_only=True)
class Goal:
    """A countable outcome to be evaluated as success, failure or indeterminate.

    Attributes:
        node: Id of the ``Act`` that serves it.
        expected: Number of captures where the request fixes it; None where the site or a reading decides.
        conditional: The node is inside an if or an otherwise, so not reaching it is no failure.
        optional: The budget decides how many are made ("as many as you can").
    """

    id: str
    node: str
    action: str
    expected: int | None = None
    conditional: bool = False
    optional: bool = False


@dataclass(frozen=True, kw_only=True)
class Variable:
    """A state variable: the reading bound by a node."""

    name: str
    quantity: str
    unit: str
    node: str


@dataclass(frozen=True, kw_only=True)
class Command:
    """The command frame: request, goals, state variables, and assumptions made in interpreting the request.

    Attributes:
        no_part: Ranges of the request without a part in the plan, such as politeness or a reason.
        read_as: The request with the answers to clarifying questions; empty without questions.
        warnings: Sentences that the planner wants confirmed before approval.
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
    """The exit to take when a fault ends the mission."""

    fault: Fault
    then: Then


@dataclass(frozen=True, kw_only=True)
class Composition:
    """The plan and its exits. ``nominal`` is taken when the plan is done.

    Attributes:
        nominal_said: Ranges of the request that state the nominal exit.
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
        said: Ranges of the request that state it.
    """

    kind: BudgetKind
    limit: float
    failure_probability: float = 0.1
    said: tuple[Span, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Constraints:
    """Limits of the whole mission.

    Attributes:
        reserve_percent: Charge to leave at the end; None for the profile's reserve.
        speed_m_s: Maximum speed.
        reserve_said: Ranges of the request that state the reserve.
    """

    budgets: tuple[Budget, ...] = ()
    reserve_percent: float | None = None
    reserve_said: tuple[Span, ...] = ()
    speed_m_s: float | None = None


@dataclass(frozen=True, kw_only=True)
class Resource:
    """A resource for which the Task was planned, identified by name and the SHA-256 of its source."""

    kind: Literal["robot", "site"]
    name: str
    sha256: str


@dataclass(frozen=True, kw_only=True, repr=False)
class Task:
    """A mission as it is planned, approved, executed and evaluated (level 1 of the design)."""

    id: str
    command: Command
    composition: Composition
    constraints: Constraints = Constraints()
    resources: tuple[Resource, ...] = ()

    __repr__ = short_repr

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
