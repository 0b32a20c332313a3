"""Work of somebody else that is told beside the robot's work: "I'll do the rest on Friday"."""

from __future__ import annotations

import re
from collections.abc import Sequence

_PEOPLE = (
    r"(?:i|we|he|she|they|somebody|someone|(?:somebody|someone) else"
    r"|(?:my|our) (?!robot|tractor|machine|mower|rover|husky|amiga)\w+"
    r"|the (?:neighbours?|neighbors?|crew|team|boys|girls|lads|men|guys|students?|farmer|contractors?|gardeners?|boss))"
)
_WILL = r"(?:'ll| will| shall| can|'m going to| am going to|'re going to| are going to| is going to)"
_VERB = (
    r"(?:do|mow|cut|finish(?: off)?|complete|take care of|see to|look after|handle|tackle|manage|deal with|sort out"
    r"|take|tend to|get to|come to|attend to|spray|film|photograph|measure|sample|read|check|probe)"
)
_REST = (
    r"(?:the (?:rest|remainder|others?|remaining \w+|other (?:half|part|side|one|ones|end|third|two|rows?|beds?|zones?)"
    r"|second half|last bit|last part)|what(?:'s| is) left|whatever is left)(?: of (?:it|them|the \w+(?: \w+)?))?"
)
_WHEN = (
    r"(?: (?:myself|ourselves|himself|herself|by hand|on foot|later(?: on| today)?|tomorrow(?: \w+)?|tonight"
    r"|(?:another|some other) (?:day|time)|afterwards|soon|then|anyway|on \w+days?(?: \w+)?|next \w+|this \w+"
    r"|over the weekend|(?:at|on) the weekend|in the (?:morning|afternoon|evening)|in a few days"
    r"|with the \w+(?: \w+)?))*"
)
_WAITS = r"(?:(?:can|will) wait(?: (?:until|till) (?:\w+day|tomorrow|next week|later))?|(?:is|are) (?:mine|for me))"
_TOLD = re.compile(
    rf"(?:(?:^|(?<= ))(?:(?:,|and|but|because|since|as|so) )*)(?:{_PEOPLE}{_WILL} {_VERB} {_REST}{_WHEN}"
    rf"|{_REST} {_WAITS}{_WHEN}|(?:you can )?leave {_REST} (?:to|for) (?:me|us)(?:{_WHEN}))(?= [,.!]|$)"
)


def work_of_others(sentence: Sequence[str]) -> range:
    """Return which words of a sentence tell what somebody else does with the rest of the work; empty if none do.

    Args:
        sentence: Words of the sentence in lower case, its commas among them.
    """
    text = " ".join(sentence)
    said = _TOLD.search(text)
    if said is None:
        return range(0)
    first = text[: said.start()].count(" ")
    return range(first, first + len(said[0].split()))
