"""Earlier missions of a case: what was done and read on its site before it was planned."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import datetime, timedelta
from typing import Annotated, Literal

from pydantic import AwareDatetime, Field, StrictFloat, StrictInt, model_validator

from fieldhand.site.earlier_missions import EarlierCapture, EarlierMission, EarlierMissions, EarlierValue
from fieldhand_bench.missions.form import Form

#: Time between two captures of an earlier mission.
_BETWEEN = timedelta(minutes=1)


class ReadForm(Form):
    """A value that was read."""

    name: Annotated[str, Field(min_length=1)]
    value: StrictFloat | StrictInt
    unit: str


class CaptureForm(Form):
    """Work at some trees, one after the other, a minute apart."""

    trees: Annotated[tuple[StrictInt | str, ...], Field(min_length=1)]
    do: str = ""
    outcome: Literal["done", "failed", "left_out"] = "done"
    read: tuple[ReadForm, ...] = ()

    @model_validator(mode="after")
    def _whole(self) -> CaptureForm:
        if bool(self.do) == (self.outcome == "left_out"):
            raise ValueError("give the action under 'do', or 'outcome: left_out' where nothing was done")
        return self

    def captures(self, at: datetime) -> Iterator[EarlierCapture]:
        """Yield the captures, the first one at a time."""
        values = tuple(EarlierValue(name=one.name, value=float(one.value), unit=one.unit) for one in self.read)
        for number, tree in enumerate(self.trees):
            time = (at + number * _BETWEEN).isoformat()
            yield EarlierCapture(place=str(tree), at=time, action=self.do, outcome=self.outcome, values=values)


class MissionForm(Form):
    """An earlier mission."""

    begun: AwareDatetime
    captures: Annotated[tuple[CaptureForm, ...], Field(min_length=1)]

    def mission(self) -> EarlierMission:
        """Return the mission; its captures follow each other from its beginning on."""
        found: list[EarlierCapture] = []
        for form in self.captures:
            found += form.captures(self.begun + len(found) * _BETWEEN)
        begun = self.begun.isoformat()
        return EarlierMission(id=f"earlier-{begun}", begun=begun, captures=tuple(found))


class EarlierForm(Form):
    """The earlier missions on a site, as they are known at ``as_of``."""

    as_of: AwareDatetime
    missions: tuple[MissionForm, ...] = ()

    def records(self) -> EarlierMissions:
        """Return the earlier missions in the order in which they began."""
        ordered = sorted(self.missions, key=lambda form: form.begun)
        return EarlierMissions(as_of=self.as_of.isoformat(), missions=tuple(form.mission() for form in ordered))
