"""A second look at a plan that knows no grammar: what it holds, counted, against what the request says outright.

Whoever planned a Task, a few facts of it can be counted by code (:mod:`.planned`), and a few facts of a request can be
read by whoever knows numbers, units, the compass and the names of this robot and this site (:mod:`.stated`). Where the
two contradict each other for certain, one of them was misread (:mod:`.compare`). What could be right is passed over:
silence here does not mean that a plan is right, but a mismatch means that somebody should look.

None of it shares a word list or a rule with the English planner, so that it does not repeat that planner's mistakes.
"""

from fieldhand.request_check.compare import mismatches
from fieldhand.request_check.mismatch import PlanMismatch

__all__ = ["PlanMismatch", "mismatches"]
