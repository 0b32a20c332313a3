"""The frames of a Task (IEEE 1872.1-2024): everything in it besides the nodes of its plan.

Command (goals, state, parameters), task composition (plan, exits), results (metrics of the goals), constraints and
resources.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path
from typing import Literal

from fieldhand.short_repr import short_repr
from fieldhand.site.earlier_missions import EarlierMissions
from fieldhand.task.plan import Node, Span
from fieldhand.task.timing import Timing
from fieldhand.task.watches import Watch
from fieldhand.task.ways import Avoid, OnlyGate, SlowNear

Then = Literal["return_to_end", "return_to_start", "stay"]
Fault = Literal["action_failed", "drive_failed", "low_budget", "aborted"]
BudgetKind = Literal["distance_m", "duration_s", "energy_percent"]


@dataclass(frozen=True, kw_only=True)
class Goal:
    """A countable outcome of a mission, evaluated as success, failure or indeterminate.

    Attributes:
        id: Identifier within the Task.
        node: Id of the ``Act`` whose captures count.
        action: Name of its action.
        expected: Number of captures if the request fixes it; None if it depends on the site or a reading.
        conditional: The node is inside an if or an otherwise, so not reaching it is no failure.
        optional: The budget decides on the number of captures ("as many as you can").
    """

    id: str
    node: str
    action: str
    expected: int | None = None
    conditional: bool = False
    optional: bool = False


@dataclass(frozen=True, kw_only=True)
class Variable:
    """A state variable: a reading that a node of the plan takes.

    Attributes:
        name: Name of the reading, used by conditions.
        quantity: Measured quantity.
        unit: Unit of its values.
        node: Id of the ``Act`` that takes it.
    """

    name: str
    quantity: str
    unit: str
    node: str


@dataclass(frozen=True, kw_only=True)
class Command:
    """The command frame: the request, its goals and state variables, and how it was interpreted.

    Attributes:
        request: The request as typed.
        goals: Goals, one for each action of the plan.
        variables: State variables, one for each reading and quantity.
        assumptions: Assumptions made in interpreting the request, as sentences.
        no_part: Character ranges of the request without a part in the plan, such as politeness or a reason.
        read_as: The request completed by the answers to clarifying questions; empty without questions.
        warnings: Sentences that must be confirmed before approval.
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
    """The exit of a mission that a fault ends: ``fault`` is its kind, ``then`` the exit taken."""

    fault: Fault
    then: Then


@dataclass(frozen=True, kw_only=True)
class Composition:
    """The plan and its exits.

    Attributes:
        plan: Root node of the plan.
        nominal: Exit after the plan.
        nominal_said: Character ranges of the request that state the nominal exit.
        faulted: Exit after each kind of fault; default exits apply to the others.
        watches: Conditions that are checked throughout the mission, each with its response.
    """

    plan: Node
    nominal: Then = "return_to_end"
    nominal_said: tuple[Span, ...] = ()
    faulted: tuple[FaultedExit, ...] = ()
    watches: tuple[Watch, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Budget:
    """At most ``limit`` of a resource for the whole mission, including the way home.

    Attributes:
        kind: Metres driven, seconds, or percent of a full battery.
        failure_probability: Accepted probability of exceeding it (Pf), above 0 and below 1.
        said: Character ranges of the request that state the budget.
    """

    kind: BudgetKind
    limit: float
    failure_probability: float = 0.1
    said: tuple[Span, ...] = ()


@dataclass(frozen=True, kw_only=True, repr=False)
class Constraints:
    """Limits of the whole mission: its ``budgets``, reserve, speed, and where it drives.

    Attributes:
        reserve_percent: Charge to leave at the end; None for the profile's reserve.
        reserve_said: Character ranges of the request that state the reserve.
        speed_m_s: Maximum speed; None for the robot's.
        avoid: Places that the robot keeps away from.
        only_gates: Gates that it may pass; empty for all gates.
        slow: Places at which it drives slowly.
        return_percent: Charge at which the robot drives home, wherever it is; None for the profile's.
        recharge: Charge at the site's charger whenever the work needs it, and go on.
        recharge_below_percent: Charge below which it goes to the charger although the next visit would still fit.
        recharge_until_percent: Charge up to which it charges; None for the profile's.
        recharge_at_most: Maximum number of charges; None for any number.
        energy_said: Character ranges of the request that state the recharging or the return.
    """

    budgets: tuple[Budget, ...] = ()
    reserve_percent: float | None = None
    reserve_said: tuple[Span, ...] = ()
    speed_m_s: float | None = None
    avoid: tuple[Avoid, ...] = ()
    only_gates: tuple[OnlyGate, ...] = ()
    return_percent: float | None = None
    recharge: bool = False
    recharge_below_percent: float | None = None
    recharge_until_percent: float | None = None
    recharge_at_most: int | None = None
    energy_said: tuple[Span, ...] = ()
    slow: tuple[SlowNear, ...] = ()

    def __repr__(self) -> str:
        """Return the fields as text. Those added later are left out at their default: ids of Tasks are hashes of it."""
        first = ("budgets", "reserve_percent", "reserve_said", "speed_m_s")
        said = (f for f in fields(self) if f.name in first or getattr(self, f.name) != f.default)
        return f"{type(self).__name__}({', '.join(f'{f.name}={getattr(self, f.name)!r}' for f in said)})"


@dataclass(frozen=True, kw_only=True)
class Resource:
    """A site or robot for which the Task was planned.

    Attributes:
        kind: ``robot`` or ``site``.
        name: Name of the robot or site.
        sha256: SHA-256 of its source file in hexadecimal.
    """

    kind: Literal["robot", "site"]
    name: str
    sha256: str


@dataclass(frozen=True, kw_only=True, repr=False)
class Task:
    """A mission that can be reviewed, approved, executed and evaluated (``fh.Task``; IEEE 1872.1-2024).

    A planner or :func:`fh.build_task <fieldhand.mission.build_task>` makes one from a request or a plan;
    :meth:`from_xml` reads one from its document.

    Example:
        >>> task = Task.from_xml(Path("mission.xml"))
        >>> task.command.request
        'Photograph every third tree of row 2.'

    Attributes:
        id: Hash of request, plan and resources.
        command: Request, goals, state variables and assumptions.
        composition: Plan and exits.
        constraints: Budgets, reserve and maximum speed.
        resources: Site and robot for which the Task was planned.
        timing: Time at which it begins, or schedule of a standing mission; None to begin when it is started.
        earlier: What earlier missions did on the site, as far as the plan depends on it; None if it does not.
    """

    id: str
    command: Command
    composition: Composition
    constraints: Constraints = Constraints()
    resources: tuple[Resource, ...] = ()
    timing: Timing | None = None
    earlier: EarlierMissions | None = None

    __repr__ = short_repr

    @classmethod
    def from_xml(cls, document: bytes | str | Path) -> Task:
        """Read a Task from an XML document or file.

        Only the form is checked here; :func:`fh.review <fieldhand.mission.review>` checks that a robot can execute it.

        Args:
            document: XML as bytes or text, or the path of a file as a :class:`pathlib.Path`.

        Raises:
            TaskError: The file cannot be read or is not a Task document; the message gives line and element.
        """
        from fieldhand.task.codec import decode
        from fieldhand.task.codec_xml import read_xml

        if isinstance(document, Path):
            data, source = read_xml(document, advice="give a Task document"), str(document)
            return decode(data, source=source)
        return decode(document.encode() if isinstance(document, str) else document)

    def to_xml(self) -> bytes:
        """Return the Task as a UTF-8 XML document; equal Tasks give identical bytes.

        Raises:
            TaskError: A text has hidden characters, a number is not finite, or the document is too large or deep.
        """
        from fieldhand.task.codec import encode

        return encode(self)
