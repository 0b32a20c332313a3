"""What an event log says about one action of a plan."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(kw_only=True)
class Tally:
    """What the log says about one action of the plan.

    Attributes:
        wanted: Captures to be made on the branch that was taken, as far as that is known.
        done: Captures that succeeded.
        seen: Those of them that the replay has come to.
        reached: The robot came to this action at least once.
        open: More may be wanted: a loop or a step that holds the action was not reached, or not to its end.
        undecided: A condition that leads here was not tested.
        failed: Times that it failed for good.
        given_up: Places given up although they had to be visited.
        left_out: Places of an optional loop that were shed.
        skipped: Why a branch that leads here was not taken, each time.
        stopped: A stop of the plan came before it.
    """

    wanted: int = 0
    done: int = 0
    seen: int = 0
    reached: bool = False
    open: bool = False
    undecided: bool = False
    failed: int = 0
    given_up: int = 0
    left_out: int = 0
    skipped: list[str] = field(default_factory=list)
    stopped: bool = False
    reasons: list[str] = field(default_factory=list)
