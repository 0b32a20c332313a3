"""Models of request bodies, and the sites, robots and Tasks that they contain.

No file named by a client is opened: a site is a built-in one or its data, a robot is a built-in name.
"""

from __future__ import annotations

import json
import re
from dataclasses import replace
from functools import lru_cache
from pathlib import PurePath
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, StringConstraints, model_validator

from fieldhand import mission
from fieldhand.errors import ProfileError, SiteError, WorldError
from fieldhand.hidden_characters import find_hidden
from fieldhand.language import languages
from fieldhand.mission.documents import InputFiles, SiteAndRobot
from fieldhand.planning.planner import Answer
from fieldhand.robot.model import RobotProfile
from fieldhand.site.formats.files import SiteFiles
from fieldhand.site.loader import BUILT_IN_SITES, BuiltInSite
from fieldhand.site.model import Site
from fieldhand.task.frames import Task

if TYPE_CHECKING:
    from fieldhand.execution.drivers.simulation.world import World

MAX_REQUEST = 20_000
MAX_XML = 4_000_000
#: Characters that names of stored site files do not have, and characters that they have at most.
_NOT_IN_NAMES, _LONGEST_STEM = re.compile(r"[^\w -]"), 60


def _whole(text: str) -> str:
    # JSON can contain a lone surrogate; UTF-8 cannot.
    try:
        text.encode()
    except UnicodeEncodeError:
        raise ValueError("this is not valid Unicode text") from None
    return text


def _on_one_line(text: str) -> str:
    hidden = find_hidden(text)
    if hidden is not None:
        raise ValueError(f"this contains the invisible character {hidden.name}")
    return text


Text = Annotated[str, AfterValidator(_whole)]
RequestText = Annotated[Text, StringConstraints(max_length=MAX_REQUEST)]
Xml = Annotated[Text, StringConstraints(max_length=MAX_XML)]
Name = Annotated[
    Text, StringConstraints(strip_whitespace=True, min_length=1, max_length=100), AfterValidator(_on_one_line)
]

#: Event logs of earlier missions; None if there are none to count.
EarlierLogs = Annotated[list[list[dict[str, Any]]], Field(max_length=1000)] | None


class Body(BaseModel):
    """A request body; unknown fields are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class SiteText(Body):
    """The name and the unchanged text of a GeoJSON file, so that its SHA-256 is that of the file."""

    name: Name = "site.geojson"
    text: Text


def _not_a_path(value: object) -> object:
    if isinstance(value, str) and value not in BUILT_IN_SITES:
        names = ", ".join(f"'{name}'" for name in BUILT_IN_SITES)
        raise ValueError(f"a site is {names} or the GeoJSON itself, never the name of a file on the server")
    return value


SiteChoice = Annotated[BuiltInSite | SiteText | dict[str, Any], BeforeValidator(_not_a_path)]


def _known_language(code: str) -> str:
    there = languages()
    if code not in there:
        raise ValueError(f"there is no language '{code}', choose one of {', '.join(there)}")
    return code


Lang = Annotated[Name, AfterValidator(_known_language)]


class SiteAndRobotBody(Body):
    """A site, the name of a built-in robot, and the language of the read-back."""

    site: SiteChoice = "demo"
    robot: Name = "husky"
    lang: Lang = "en"


class SiteBody(Body):
    """A site to describe."""

    site: SiteChoice


class AnswerBody(Body):
    """An answer to a question about the request."""

    question: RequestText
    answer: RequestText


AnswerList = Annotated[list[AnswerBody], Field(max_length=20)]
Warnings = Annotated[list[RequestText], Field(max_length=200)]


class PlanBody(SiteAndRobotBody):
    """A request to plan, with the answers to earlier questions about it."""

    request: RequestText
    answers: AnswerList = []
    planner: Literal["auto", "english", "llm"] = "auto"
    earlier: EarlierLogs = None


class CheckBody(SiteAndRobotBody):
    """A Task document to check."""

    xml: Xml
    earlier: EarlierLogs = None


class MissionInputBody(SiteAndRobotBody):
    """A mission: a Task document or a request, the confirmed warnings, and the simulated world."""

    xml: Xml | None = None
    request: RequestText | None = None
    answers: AnswerList = []
    planner: Literal["auto", "english", "llm"] = "auto"
    approved_by: Name | None = None
    confirmed: Warnings = []
    seed: Annotated[int, Field(ge=0, lt=2**32)] | None = None
    world: dict[str, Any] | None = None
    earlier: EarlierLogs = None

    @model_validator(mode="after")
    def _one_of_both(self) -> MissionInputBody:
        if (self.xml is None) == (self.request is None):
            raise ValueError("give either xml or request")
        return self


class RunBody(MissionInputBody):
    """A mission to simulate at once."""


class MissionBody(MissionInputBody):
    """A mission to begin on a simulated robot."""

    speed: Annotated[float, Field(gt=0, le=1000, allow_inf_nan=False)] | Literal["max"] = 1.0


class CommandBody(Body):
    """A command to a mission."""

    command: Literal["pause", "resume", "return", "abort"]
    lang: Lang = "en"


def answers_of(body: PlanBody | MissionInputBody) -> tuple[Answer, ...]:
    """Return the answers in a request body."""
    return tuple(Answer(question=given.question, answer=given.answer) for given in body.answers)


def open_site_and_robot(body: SiteAndRobotBody) -> SiteAndRobot:
    """Open the site and the robot of a request body.

    Raises:
        SiteError, ProfileError: Site or robot cannot be used.
    """
    return SiteAndRobot(site=open_choice(body.site), robot=open_robot(body.robot))


def open_files(body: SiteAndRobotBody) -> tuple[SiteAndRobot, InputFiles]:
    """Open the site and the robot of a request body, and return their files, too.

    Raises:
        SiteError, ProfileError: Site or robot cannot be used.
    """
    from fieldhand.robot.loader import profile_bytes
    from fieldhand.site.loader import site_files

    opened = open_site_and_robot(body)
    if isinstance(body.site, str):
        files = site_files(body.site)
    else:
        text = body.site.text if isinstance(body.site, SiteText) else json.dumps(body.site)
        name = PurePath(body.site.name).stem if isinstance(body.site, SiteText) else "site"
        kept = _NOT_IN_NAMES.sub("_", name)[:_LONGEST_STEM] or "site"
        files = SiteFiles(parts={f"{kept}.geojson": text.encode()}, source=name)
    return opened, InputFiles(site=files, profile=profile_bytes(body.robot)[0], lenient=False)


def open_world(content: dict[str, Any] | None) -> World:
    """Return the world of a simulation, with the bytes of its file; a world in which nothing fails for None.

    Raises:
        WorldError: The content is not that of a world file.
    """
    import yaml

    from fieldhand.execution.drivers.simulation.world import World
    from fieldhand.execution.drivers.simulation.world_file import decode_world

    if content is None:
        return World()
    try:
        data = yaml.safe_dump(content, allow_unicode=True, sort_keys=False).encode()
    except RecursionError:
        raise WorldError("is nested too deeply", where="world", advice="send a world file as JSON") from None
    return decode_world(data, source="world")


def open_choice(choice: BuiltInSite | SiteText | dict[str, Any]) -> Site:
    """Return a built-in site, or the one in the request body.

    Raises:
        SiteError: The data is not a site.
    """
    from fieldhand.site.loader import parse_site

    if isinstance(choice, str):
        return _built_in(choice)
    if isinstance(choice, SiteText):
        file = PurePath(choice.name)
        return parse_site(choice.text.encode(), name=file.stem or "site", source=file.name or "site")
    try:
        data = json.dumps(choice).encode()
    except RecursionError:
        raise SiteError("the site is nested too deeply", where="site", advice="send plain GeoJSON") from None
    return parse_site(data, name="site", source="site")


@lru_cache(maxsize=len(BUILT_IN_SITES))
def _built_in(name: BuiltInSite) -> Site:
    """Return a built-in site, without its path on the server."""
    from fieldhand.site.loader import load_built_in

    return replace(load_built_in(name), source=name)


def open_robot(name: str) -> RobotProfile:
    """Return a built-in robot.

    Raises:
        ProfileError: There is no such robot.
    """
    from fieldhand.robot.loader import load_robot, robot_names

    names = robot_names()
    if name not in names:
        raise ProfileError("no built-in robot has that name", where="robot", advice=f"choose one of {', '.join(names)}")
    return load_robot(name)


def open_task(xml: str, robot: RobotProfile) -> tuple[Task, bytes]:
    """Decode a Task document, and return it with its bytes.

    Raises:
        TaskError: The document is not well-formed, or not valid against the robot's schema.
    """
    document = xml.encode()
    return mission.decode_task(document, robot, source="xml"), document
