"""Complete a bare plan to a Task: stable ids, goals, state variables.

Everything that follows from the plan is derived here and nowhere else, so no planner can get it wrong.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import replace

from fieldhand.task.frames import (
    Command,
    Composition,
    Constraints,
    Fault,
    FaultedExit,
    Goal,
    Resource,
    Task,
    Then,
    Variable,
)
from fieldhand.task.plan import Node, Span, acts
from fieldhand.task.timing import Timing
from fieldhand.task.watches import Watch

#: Default exits on faults.
FAULTED_EXITS = (
    FaultedExit(fault="action_failed", then="return_to_start"),
    FaultedExit(fault="drive_failed", then="stay"),
    FaultedExit(fault="low_budget", then="return_to_end"),
    FaultedExit(fault="aborted", then="stay"),
)


def exit_of(task: Task, fault: Fault) -> Then:
    """Return a Task's exit for a fault: its own, else the default one."""
    chosen = {e.fault: e.then for e in (*FAULTED_EXITS, *task.composition.faulted)}
    return chosen[fault]


def make_task(
    *,
    request: str,
    plan: Node,
    measures: Mapping[str, tuple[tuple[str, str], ...]],
    resources: tuple[Resource, ...] = (),
    constraints: Constraints | None = None,
    nominal: Then = "return_to_end",
    faulted: tuple[FaultedExit, ...] = FAULTED_EXITS,
    assumptions: tuple[str, ...] = (),
    nominal_said: tuple[Span, ...] = (),
    no_part: tuple[Span, ...] = (),
    read_as: str = "",
    warnings: tuple[str, ...] = (),
    timing: Timing | None = None,
    watches: tuple[Watch, ...] = (),
) -> Task:
    """Return a Task whose ids, goals and variables are derived from its plan.

    Args:
        request: The request, word for word.
        plan: Root of the plan; its ids are replaced by ``n1``, ``n2``, ... in document order.
        measures: For each action of the robot, the quantities that it measures as (name, unit).
        resources: Site and robot that the Task is for.
        constraints: Budgets and reserve; none by default.
        nominal: Exit taken when the plan is done.
        faulted: Exit for each fault.
        assumptions: Assumptions made in interpreting the request, as sentences.
        nominal_said: Ranges of the request that state the nominal exit.
        no_part: Ranges of the request that have no part in the plan.
        read_as: The request with the answers to clarifying questions; empty without questions.
        warnings: Warnings to confirm before approval, as sentences.
        timing: Time at which the mission begins, or its schedule.
        watches: Conditions checked throughout the mission, and their responses.

    Returns:
        The Task; its id is a hash of request, plan and resources, so equal arguments give equal Tasks.
    """
    numbered = number(plan)
    added = (*((watches,) if watches else ()), *((timing,) if timing is not None else ()))
    known = (request, numbered, resources, constraints, nominal, *added)
    digest = hashlib.sha256(repr(known).encode()).hexdigest()
    return Task(
        id=f"task-{digest[:12]}",
        command=Command(
            request=request,
            goals=goals(numbered),
            variables=variables(numbered, measures),
            assumptions=assumptions,
            no_part=no_part,
            read_as=read_as,
            warnings=warnings,
        ),
        composition=Composition(
            plan=numbered, nominal=nominal, nominal_said=nominal_said, faulted=faulted, watches=watches
        ),
        constraints=constraints or Constraints(),
        resources=resources,
        timing=timing,
    )


def number(plan: Node) -> Node:
    """Return the plan with ids ``n1``, ``n2``, ... in document order, outermost first."""
    return _number(plan, 1)[0]


def _number(node: Node, first: int) -> tuple[Node, int]:
    name, following = f"n{first}", first + 1

    def child(inner: Node) -> Node:
        nonlocal following
        numbered, following = _number(inner, following)
        return numbered

    return replace(node.with_children([child(inner) for inner in node.children]), id=name), following


def goals(plan: Node) -> tuple[Goal, ...]:
    """Return one goal for every action of the plan, at a place or along a path, in document order."""
    found: list[Goal] = []

    def visit(node: Node, times: int | None, conditional: bool, optional: bool) -> None:
        if node.act is not None:
            expected = None if times is None else times * node.act.count
            found.append(
                Goal(
                    id=f"g{len(found) + 1}",
                    node=node.id,
                    action=node.act.action,
                    expected=expected,
                    conditional=conditional,
                    optional=optional,
                )
            )
        if node.work is not None and node.work.action:
            action = node.work.action
            found.append(
                Goal(
                    id=f"g{len(found) + 1}",
                    node=node.id,
                    action=action,
                    conditional=conditional,
                    optional=optional or node.is_optional,
                )
            )
        for part in node.parts:
            again = None if times is None or part.times is None else times * part.times
            # Work that only the budget decides about is optional, not conditional.
            decided = node.tested is not None or not (part.certain or node.is_optional)
            visit(part.node, again, conditional or decided, optional or node.is_optional)

    visit(plan, 1, False, False)
    return tuple(found)


def variables(plan: Node, measures: Mapping[str, tuple[tuple[str, str], ...]]) -> tuple[Variable, ...]:
    """Return the state variables bound by the readings of a plan."""
    return tuple(
        Variable(name=node.reading, quantity=quantity, unit=unit, node=node.id)
        for node in acts(plan)
        if node.reading
        for quantity, unit in measures.get(node.action, ())
    )
