"""Constructions of wishes for results: "tell me the average", "I want the mean and the spread of the readings"."""

from __future__ import annotations

from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import ResultsWish, Subject
from fieldhand.planning.grammar.words import Lex

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction("result: one=statistic", cost=0.0)
def statistic_wanted(one: Subject) -> Subject:
    """Compose "the average soil moisture in row 3" as what is wanted."""
    return one


@construction("result: [DET] STATISTIC AND of=statistic", "result: THEIR STATISTIC AND of=statistic", cost=0.1)
def statistics_of_one(of: Subject) -> Subject:
    """Compose "the lowest and the highest value"."""
    return of


@construction(
    "result: [DET] reading=READING",
    "result: EACH [count] reading=READING",
    "result: DET count reading=READING",
    "result: THEIR reading=READING",
    "result: ALLRESULTS",
    cost=0.2,
)
def all_readings(reading: Lex | None = None) -> Subject | None:
    """Compose "the readings"; "a reading" is one that is taken."""
    return Subject() if reading is None or reading.plural else None


@construction("result: [DET] noun=NOUN reading=READING", cost=0.2)
def readings_of(noun: Lex, reading: Lex) -> list[Subject] | None:
    """Compose "the CO2 readings"."""
    if not reading.plural:
        return None
    return [Subject(name) for name in dict.fromkeys(noun.value.quantities) or noun.value.actions[:1]] or None


@construction(
    "result: one=result INEACH", "result: one=result PERGROUP", "result: one=result ONAVERAGE",
    "result: one=result AFTERWARDS", "result: one=result OF DET [count] READING", cost=0.1,
)  # fmt: skip
def result_of_each(one: Subject) -> Subject:
    """Compose "the average of each", "the mean per bed" and "the readings afterwards"."""
    return one


@construction("result: one=result AND other=result", "result: one=result COMMA other=result", cost=0.2)
def several_results(one: Subject, other: Subject) -> Subject | None:
    """Compose "the average and the spread"."""
    if "" not in (one.quantity, other.quantity) and one.quantity != other.quantity:
        return None
    return other if other.quantity else one


@construction(
    "results: TELLRESULTS one=result", "results: WHATRESULT one=result", "results: WITH one=result REPORTED",
    "results: AND one=result REPORTED", cost=0.2,
)  # fmt: skip
def results(one: Subject, used: int) -> ResultsWish:
    """Compose "tell me the average" and "what is the average"."""
    return ResultsWish(one.quantity, used)


@construction(
    "results: TELLRESULTS WHERE IT IS STATISTIC", "results: TELLRESULTS WHERE [DET] noun=NOUN IS STATISTIC",
    "results: TELLRESULTS WHERE IT IS MOSTREAD", "results: TELLRESULTS WHERE [DET] noun=MEDIUM IS MOSTREAD",
    cost=0.0,
)  # fmt: skip
def where_it_is_most(used: int, noun: Lex | None = None) -> ResultsWish:
    """Compose "tell me where it is highest"."""
    quantities: list[str] = [] if noun is None else list(noun.value.quantities)
    return ResultsWish(quantities[0] if len(quantities) == 1 else "", used)


@construction("command: one=results", cost=0.0)
def results_as_command(one: ResultsWish) -> ResultsWish:
    """Compose "I want the average" as a clause behind what is read."""
    return one
