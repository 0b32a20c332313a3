"""Match expected steps one to one with the actions done, in order or in any order."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import maximum_bipartite_matching

from fieldhand_bench.missions.case_site import CaseSite
from fieldhand_bench.missions.cases import ExpectedStep
from fieldhand_bench.missions.log import Done
from fieldhand_bench.missions.places import StepLabels


def mismatch(site: CaseSite, steps: Sequence[ExpectedStep], done: Sequence[Done], *, any_order: bool) -> str | None:
    """Return why the actions done are not exactly these steps, in words; None if they are."""
    if len(done) != len(steps):
        return f"{len(done)} actions were done where {len(steps)} were asked for{_surplus(steps, done)}"
    return _out_of_order(site, steps, done) if not any_order else _unassignable(site, steps, done)


def _surplus(steps: Sequence[ExpectedStep], done: Sequence[Done]) -> str:
    wanted, had = Counter(step.action for step in steps), Counter(d.action for d in done)
    text = [f"{n} x {action} missing" for action, n in (wanted - had).items()]
    text += [f"{n} x {action} too many" for action, n in (had - wanted).items()]
    return f": {', '.join(text)}" if text else ""


def _fits(site: CaseSite, step: ExpectedStep, done: Done, labels: StepLabels) -> bool:
    if (done.action, done.captures) != (step.action, step.captures):
        return False
    return step.at.holds(site, done.tree, labels)


def _out_of_order(site: CaseSite, steps: Sequence[ExpectedStep], done: Sequence[Done]) -> str | None:
    labels: dict[str, int] = {}
    for number, (step, one) in enumerate(zip(steps, done, strict=True), start=1):
        if not _fits(site, step, one, labels):
            wanted = f"{step.action} x{step.captures} at {step.at.words}"
            return f"step {number} was to be {wanted}, and was {describe(site, one)}"
        if step.label:
            labels[step.label] = one.tree
    return None


def _unassignable(site: CaseSite, steps: Sequence[ExpectedStep], done: Sequence[Done]) -> str | None:
    """Return why no assignment of the actions to the steps fits; None if there is one.

    Steps that refer to each other are assigned by backtracking, all others by bipartite matching.
    """
    named = {label for step in steps for label in step.at.labels}
    tied = [step for step in steps if step.label in named or step.at.labels]
    free = [step for step in steps if step not in tied]

    def assignable(number: int, left: tuple[int, ...], labels: StepLabels) -> bool:
        if number == len(tied):
            return not _unmatched(site, free, [done[k] for k in left])
        step = tied[number]
        return any(
            assignable(number + 1, tuple(j for j in left if j != k), {**labels, step.label: done[k].tree})
            for k in left
            if _fits(site, step, done[k], labels)
        )

    if assignable(0, tuple(range(len(done))), {}):
        return None
    if tied:
        return "the actions cannot be assigned to the steps so that every place holds"
    lost = _unmatched(site, free, done)
    return f"nothing that was done is left for {lost[0].action} x{lost[0].captures} at {lost[0].at.words}"


def _unmatched(site: CaseSite, steps: Sequence[ExpectedStep], done: Sequence[Done]) -> list[ExpectedStep]:
    """Return the steps that get no action in a maximum matching."""
    if not steps:
        return []
    fits = np.array([[_fits(site, step, one, {}) for one in done] for step in steps])
    matched = maximum_bipartite_matching(csr_array(fits), perm_type="column")
    return [step for step, k in zip(steps, matched, strict=True) if k < 0]


def describe(site: CaseSite, done: Done) -> str:
    """Describe an action that was done, in words."""
    east, north = site.xy[done.tree]
    return (
        f"{done.action} x{done.captures} at the tree at position {done.tree} ({east:.0f} m east, {north:.0f} m north)"
    )
