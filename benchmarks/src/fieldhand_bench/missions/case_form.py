"""Pydantic models of a case file: its keys and their values."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from pydantic import (
    AfterValidator,
    AwareDatetime,
    BeforeValidator,
    Field,
    StrictBool,
    StrictInt,
    model_validator,
)

from fieldhand_bench.missions import places
from fieldhand_bench.missions.case_earlier import EarlierForm
from fieldhand_bench.missions.case_site import CornerName
from fieldhand_bench.missions.cases import Expected, ExpectedStep, ExpectedWork, KeptFrom, MarkerName, SlowWithin
from fieldhand_bench.missions.form import Form
from fieldhand_bench.missions.places import ANYWHERE, CasePlace, Demand, Side


def _number(value: object) -> object:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ValueError("must be a number")
    return value


def _rising(value: tuple[float, float]) -> tuple[float, float]:
    if value[0] > value[1]:
        raise ValueError("the least comes first, then the most")
    return value


def _plain(value: object) -> object:
    if not isinstance(value, str | bool | int | float):
        raise ValueError("must be a text, a number, true or false")
    return value


def _listed(value: object) -> object:
    return [value] if isinstance(value, str) else value


NumberField = Annotated[float, BeforeValidator(_number), Field(allow_inf_nan=False)]
Above0 = Annotated[NumberField, Field(gt=0)]
Least1 = Annotated[StrictInt, Field(ge=1)]
Text = Annotated[str, Field(min_length=1, strict=True)]
BoundsPair = Annotated[
    tuple[Annotated[NumberField, Field(ge=0)], Annotated[NumberField, Field(ge=0)]], AfterValidator(_rising)
]

_QUARTERS: Mapping[str, tuple[Side, Side]] = {
    "nw": ("north", "west"),
    "ne": ("north", "east"),
    "sw": ("south", "west"),
    "se": ("south", "east"),
}
#: Defaults of keys that qualify another key, and the keys that each of them qualifies.
_NEXT_TO, _NEAR, _FAR, _MOST_M = 4, 8, 0.8, 6.0
_MORE_ABOUT = {"rank": ("next_to", "near"), "fraction": ("far",), "tol_m": ("most",), "toward": ("offset",)}


class OffsetForm(Form):
    """A distance from the tree of a step, in tree spacings: ``{from: A, trees: 5}``."""

    from_: Text = Field(alias="from")
    trees: Above0


class PlaceForm(Form):
    """A place: a tree that meets the condition of every key."""

    any: Literal[True] | None = None
    corner: CornerName | Literal["any"] | None = None
    half: Side | None = None
    quarter: CornerName | None = None
    most: Side | None = None
    tol_m: Above0 | None = None
    center: Above0 | None = None
    mid_edge: Side | None = None
    same: Text | None = None
    not_: Annotated[tuple[Text, ...], BeforeValidator(_listed), Field(min_length=1)] | None = Field(None, alias="not")
    next_to: Text | None = None
    near: Text | None = None
    rank: Least1 | None = None
    far: Text | None = None
    fraction: Annotated[Above0, Field(le=1)] | None = None
    offset: OffsetForm | None = None
    toward: Side | None = None
    ids: Annotated[tuple[Annotated[StrictInt, Field(ge=0)], ...], Field(min_length=1)] | None = None
    first: Literal[True] | None = None
    last: Literal[True] | None = None
    attribute: Annotated[dict[str, Annotated[Any, AfterValidator(_plain)]], Field(min_length=1)] | None = None

    @model_validator(mode="after")
    def _whole(self) -> PlaceForm:
        for more, about in _MORE_ABOUT.items():
            if more in self.model_fields_set and not self.model_fields_set & set(about):
                raise ValueError(f"'{more}' says more about '{' or '.join(about)}', which is not here")
        return self

    def place(self) -> CasePlace:
        """Return the place as used by the judge."""
        return CasePlace(demands=tuple(self._demands()), words=self.words())

    def words(self) -> str:
        """Return the place as written in the file, on one line."""
        fields = self.model_dump(by_alias=True, exclude_none=True)
        return "{" + ", ".join(f"{key}: {_flow(value)}" for key, value in fields.items()) + "}"

    def _demands(self) -> Iterator[Demand]:
        if self.corner is not None:
            yield places.Corner(None if self.corner == "any" else self.corner)
        if self.half is not None:
            yield places.Beyond((self.half,))
        if self.quarter is not None:
            yield places.Beyond(_QUARTERS[self.quarter])
        if self.most is not None:
            yield places.Most(self.most, self.tol_m or _MOST_M)
        if self.center is not None:
            yield places.Central(self.center)
        if self.mid_edge is not None:
            yield places.MidEdge(self.mid_edge)
        if self.same is not None:
            yield places.Same(self.same)
        if self.not_ is not None:
            yield places.OtherThan(self.not_)
        if self.next_to is not None:
            yield places.Near(self.next_to, self.rank or _NEXT_TO, adjacent=True)
        if self.near is not None:
            yield places.Near(self.near, self.rank or _NEAR)
        if self.far is not None:
            yield places.Far(self.far, self.fraction or _FAR)
        if self.offset is not None:
            yield places.Offset(self.offset.from_, self.offset.trees, self.toward)
        if self.ids is not None:
            yield places.Positions(frozenset(self.ids))
        if self.first:
            yield places.EndTree("start")
        if self.last:
            yield places.EndTree("end")
        if self.attribute is not None:
            yield places.Attributes(self.attribute)


class EndForm(PlaceForm):
    """The expected position of the robot at the end: either a marker or a place."""

    marker: MarkerName | None = None

    @model_validator(mode="after")
    def _alone(self) -> EndForm:
        if self.marker is not None and len(self.model_fields_set) > 1:
            raise ValueError("a marker stands alone")
        return self


class StepForm(Form):
    """An action that must be done."""

    do: Text
    n: Least1 = 1
    at: PlaceForm | None = None
    as_: Text | None = Field(None, alias="as")

    def step(self) -> ExpectedStep:
        """Return the step as used by the judge."""
        at = ANYWHERE if self.at is None else self.at.place()
        return ExpectedStep(action=self.do, captures=self.n, at=at, label=self.as_ or "")


class KeptFromForm(Form):
    """A zone or trees from which every drive keeps a distance: ``{zone: pond, m: 5}``."""

    zone: Text | None = None
    trees: PlaceForm | None = None
    m: Above0

    @model_validator(mode="after")
    def _one(self) -> KeptFromForm:
        if (self.zone is None) == (self.trees is None):
            raise ValueError("give either a zone or trees")
        if self.trees is not None:
            _require(self.trees.place().labels, set(), "keeps_from")
        return self

    def kept(self) -> KeptFrom:
        """Return the distance as used by the judge."""
        return KeptFrom(
            zone=self.zone or "", trees=ANYWHERE if self.trees is None else self.trees.place(), metres=self.m
        )


class SlowForm(KeptFromForm):
    """A zone or trees near which every drive is slow: ``{zone: pond, m: 5, most_m_s: 0.5}``."""

    most_m_s: Above0

    def slow(self) -> SlowWithin:
        """Return the ground as used by the judge."""
        return SlowWithin(near=self.kept(), most_m_s=self.most_m_s)


class WorkForm(Form):
    """Work along paths that must be done."""

    do: Text
    metres: BoundsPair
    past: PlaceForm | None = None
    reach_m: Above0 = 2.5

    def work(self) -> ExpectedWork:
        """Return the work as used by the judge."""
        past = ANYWHERE if self.past is None else self.past.place()
        return ExpectedWork(action=self.do, metres=self.metres, past=past, reach_m=self.reach_m)


class ExpectForm(Form):
    """The outcome expected in a world."""

    steps: tuple[StepForm, ...] | None = None
    order: Literal["any"] | None = None
    count_only: Annotated[dict[str, BoundsPair], Field(min_length=1)] | None = None
    distinct_trees: dict[str, BoundsPair] = Field(default_factory=dict)
    at_all: PlaceForm | None = None
    worked: tuple[WorkForm, ...] = ()
    free_points: StrictBool = False
    repeats: StrictBool = False
    apart_m: BoundsPair | None = None
    max_travel_m: Above0 | None = None
    lasts_s: BoundsPair | None = None
    max_speed_m_s: Above0 | None = None
    stands: Least1 | None = None
    min_steps: Least1 | None = None
    charges: BoundsPair | None = None
    waited_s: BoundsPair | None = None
    status: Literal["completed", "returned", "faulted", "aborted"] = "completed"
    end: EndForm | None = None
    keeps_from: tuple[KeptFromForm, ...] = ()
    slow_near: tuple[SlowForm, ...] = ()

    @model_validator(mode="after")
    def _require_content(self) -> ExpectForm:
        if self.steps is None and self.count_only is None and not self.worked:
            raise ValueError("nothing is said of what must be done: give steps, count_only or worked")
        if self.order is not None and self.steps is None:
            raise ValueError("'order' is about steps, which are not here")
        self._require_labels()
        return self

    def _require_labels(self) -> None:
        """Raise a ValueError if a label is defined twice, or used before or outside the steps that define it."""
        known: set[str] = set()
        for number, step in enumerate(self.steps or (), start=1):
            if step.at is not None:
                _require(step.at.place().labels, known, f"step {number}")
            if step.as_ in known:
                raise ValueError(f"step {number}: an earlier step is called '{step.as_}' already")
            known |= {step.as_} if step.as_ else set()
        for name, place in (("at_all", self.at_all), ("end", self.end), *(("worked", one.past) for one in self.worked)):
            if place is not None:
                _require(place.place().labels, set(), name)

    @property
    def actions(self) -> Iterator[str]:
        """Every action that is named, with repetitions."""
        yield from (step.do for step in self.steps or ())
        yield from self.count_only or {}
        yield from self.distinct_trees
        yield from (work.do for work in self.worked)

    @property
    def counts_nothing(self) -> bool:
        """Return True if the steps are all that may be done."""
        return self.steps is not None or self.count_only is None

    def expected(self) -> Expected:
        """Return the expected outcome as used by the judge."""
        return Expected(
            # Nothing but work along paths: no action at a place.
            steps=tuple(step.step() for step in self.steps or ()) if self.counts_nothing else None,
            any_order=self.order == "any",
            counts=self.count_only,
            trees=self.distinct_trees,
            at_all=ANYWHERE if self.at_all is None else self.at_all.place(),
            works=tuple(work.work() for work in self.worked),
            free_points=self.free_points,
            repeats=self.repeats,
            apart_m=self.apart_m,
            most_travel_m=self.max_travel_m,
            lasts_s=self.lasts_s,
            most_speed_m_s=self.max_speed_m_s,
            stands=self.stands,
            least_stops=self.min_steps or 0,
            charges=self.charges,
            waited_s=self.waited_s,
            status=self.status,
            end=None if self.end is None else self.end.marker or self.end.place(),
            keeps_from=tuple(one.kept() for one in self.keeps_from),
            slow_near=tuple(one.slow() for one in self.slow_near),
        )


class WorldForm(Form):
    """A world and the outcome expected in it. ``context`` is a note for readers of the case.

    The other keys are those of a world file.
    """

    readings: dict[str, Any] = Field(default_factory=dict)
    events: tuple[dict[str, Any], ...] = ()
    charge_percent: Above0 = 100.0
    expect: ExpectForm
    context: Any = None

    def world(self) -> dict[str, Any]:
        """Return the content of a world file."""
        return {"readings": self.readings, "events": list(self.events), "charge_percent": self.charge_percent}


class CaseForm(Form):
    """A request with its expected outcomes."""

    id: Annotated[Text, Field(pattern=r"^\S+$")]
    request: Text
    site: Text | None = None
    robot: Text | None = None
    ask: StrictBool = False
    runs: tuple[AwareDatetime, ...] = ()
    worlds: Annotated[tuple[WorldForm, ...], Field(min_length=1)] | None = None
    task: Text | None = None
    earlier: EarlierForm | None = None

    @model_validator(mode="after")
    def _one_way(self) -> CaseForm:
        if self.ask and self.worlds is not None:
            raise ValueError("a request that has to be asked about is driven in no world: leave out ask or worlds")
        if not self.ask and self.worlds is None:
            raise ValueError("the key 'worlds' is missing (or 'ask: true' where a question is right)")
        if self.ask and self.task is not None:
            raise ValueError("a request that has to be asked about has no Task: leave out ask or task")
        return self


class BookForm(Form):
    """The whole file."""

    site: Text | None = None
    robot: Text | None = None
    cases: Annotated[tuple[CaseForm, ...], Field(min_length=1)]


def _require(labels: frozenset[str], known: set[str], where: str) -> None:
    unknown = sorted(labels - known)
    if unknown:
        raise ValueError(f"{where}: no earlier step is called '{unknown[0]}'")


def _flow(value: object) -> str:
    match value:
        case dict():
            return "{" + ", ".join(f"{key}: {_flow(inner)}" for key, inner in value.items()) + "}"
        case tuple() | list():
            return "[" + ", ".join(_flow(inner) for inner in value) + "]"
        case bool():
            return str(value).lower()
        case float():
            return f"{value:g}"
        case _:
            return str(value)
