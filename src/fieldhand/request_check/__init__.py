"""Check a plan against its request by facts that can be counted, without parsing the request's grammar.

Facts of a plan are counted by code (:mod:`.plan_facts`); facts of a request are recognized by numbers, units, the
compass and the names of this robot and this site (:mod:`.request_facts`). If the two certainly contradict each other,
a part of the request was misinterpreted (:mod:`.compare`). Doubtful cases are not reported, so a plan without
contradictions may still be wrong.

The check shares no word list or rule with the English planner, so that it does not repeat that planner's mistakes.
"""

from fieldhand.request_check.compare import mismatches
from fieldhand.request_check.mismatch import PlanMismatch

__all__ = ["PlanMismatch", "mismatches"]
