"""Hostile text in everything that has no border, or that a border lets pass: no output of it is led astray.

What everyone can see (tags, scripts, TeX, formulas) stands in site, profile, Task and bundle; what nobody can see in
the event log, in names of files, in options, and in what a robot's agent and a language model answer.
"""

from __future__ import annotations

import hashlib
import http.server
import json
import os
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path
from typing import Any
from urllib.parse import quote

import pytest
import yaml
from mcap.reader import make_reader

from fieldhand.approval.authorize import EveryWarning, approve
from fieldhand.approval.bundle.opening import unseal
from fieldhand.approval.bundle.packing import pack
from fieldhand.approval.checks import examine
from fieldhand.compatibility import UTC
from fieldhand.places.selectors import TreeIs, Where
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.llm.scripted import ScriptedEndpoint
from fieldhand.robot.capabilities import measures_of
from fieldhand.robot.loader import parse_profile, profile_bytes
from fieldhand.site.drawing.choices import save_choices_picture
from fieldhand.site.formats.files import SiteFiles
from fieldhand.site.loader import site_of
from fieldhand.task.build import make_task
from fieldhand.task.codec import encode
from fieldhand.task.frames import Resource
from fieldhand.task.plan import Act, ForEach, InOrder
from support.hostile import (
    FORMULA,
    SEEN,
    UNSEEN,
    each_text,
    every_text,
    require_json,
    require_page,
    require_table,
    require_visible,
    require_xml,
)  # fmt: skip
from support.missions.signed import signing_key
from support.processes.browser import browser, corner_warnings, corner_xml
from support.processes.command import Run, fieldhand
from test_hostile_inputs import orchard

#: Names that a plan and a site give; a log that has others is not one of this mission.
KEPT = (
    "event",
    "node",
    "action",
    "kind",
    "place",
    "status",
    "exit",
    "then",
    "fault",
    "task",
    "site",
    "robot",
    "quantity",
    "level",
)
#: A name of a file has no slash and no end of a text.
FILE = UNSEEN.replace("/", "|").replace("\x00", "")[:80]
#: An argument of a command has no end of a text.
WORD = f"{SEEN}{UNSEEN}".replace("\x00", "")


def seen(text: str, key: str) -> str:
    """A text of a site with what everyone can see behind it, where no word of the format stands."""
    if key in ("type", "kind", "barrier", "width_m", "note"):
        return text if key != "note" else FORMULA
    return f"{text}{SEEN[:50]}" if key == "id" else f"{text}{SEEN}"


def worst_site() -> SiteFiles:
    whole = orchard()
    for k, tree in enumerate(whole["features"][:3]):
        tree["properties"]["block"] = "AB"[k % 2]
    features = [{**one, "properties": every_text(one["properties"], seen)} for one in whole["features"]]
    document = json.dumps({**whole, "name": f"Home{SEEN}", "features": features})
    return SiteFiles(parts={"site.geojson": document.encode()}, source="site.geojson")


def worst_profile() -> bytes:
    profile = yaml.safe_load(profile_bytes("husky")[0])
    profile["description"] = SEEN
    for action in profile["actions"].values():
        action |= {"description": SEEN, "labels": {"en": SEEN[:79], "es": FORMULA}}
    for quantity in profile["quantities"].values():
        quantity["labels"] = {"en": SEEN[:79], "es": FORMULA}
    return yaml.safe_dump(profile).encode()


def poisoned(event: dict[str, Any]) -> dict[str, Any]:
    """An event with hostile text behind each of its own."""
    worst = f"{FORMULA}{SEEN}{UNSEEN}"
    changed: dict[str, Any] = every_text(event, lambda text, key: text if key in KEPT else f"{worst}{text}")
    if event.get("readings"):
        changed["readings"] = {**event["readings"], worst: 1.5}
        changed["units"] = {**event["units"], worst: worst}
    return changed


@dataclass(frozen=True, kw_only=True)
class Scene:
    """A folder with everything that is hostile.

    Attributes:
        folder: With site.geojson, robot.yaml, task.xml, m.mission, flown/events.jsonl, and events.jsonl, poisoned.
        env: Of commands.
    """

    folder: Path
    env: dict[str, str]

    def run(self, *words: str, statuses: tuple[int, ...] = (0, 1), **more: str) -> Run:
        run = fieldhand(*words, cwd=self.folder, env=self.env | more)
        assert run.status in statuses, (words, run.status, run.err)
        assert "Traceback" not in run.err, run.err
        if "--json" in words and run.out:
            require_json(run.out, visible=False)
        require_visible(run.out + run.err)
        ours = [line for line in (run.out + run.err).splitlines() if line.startswith("fieldhand: Signature")]
        assert not ours, ours
        return run


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Scene:
    folder = tmp_path_factory.mktemp("scene")
    files, profile = worst_site(), worst_profile()
    site, robot = site_of(files), parse_profile(profile, source="robot.yaml")
    steps = (
        Act(id="", action="read_co2", at=TreeIs(tree=site.trees[0].place.id), said=((0, 4),)),
        ForEach(
            id="", select=Where(attribute="variety", test="eq", value=f"Kerman{SEEN}"), label=SEEN,
            body=Act(id="", action="take_thermal_picture", label=SEEN, reading="r"),
        ),
    )  # fmt: skip
    resources = tuple(
        Resource(kind=kind, name=one.name, sha256=one.sha256) for kind, one in (("robot", robot), ("site", site))
    )
    plan, request = InOrder(id="", steps=steps), f"Read {SEEN}\n{FORMULA}"
    plain = make_task(request=request, plan=plan, measures=measures_of(robot), resources=resources)
    task = replace(plain, command=replace(plain.command, assumptions=(SEEN,), warnings=(SEEN, FORMULA)))
    approved = approve(
        examine(task, site, robot),
        by=SEEN,
        at=datetime.now(UTC).isoformat(timespec="seconds"),
        confirmed=EveryWarning(),
    )
    bundle = pack(
        approved, site, robot, files=files, lenient=False, profile=profile, key=signing_key(7, "Eve"), planner=SEEN
    )
    (folder / "m.mission").write_bytes(bundle)
    (folder / "site.geojson").write_bytes(files.parts["site.geojson"])
    (folder / "robot.yaml").write_bytes(profile)
    (folder / "task.xml").write_bytes(encode(task))
    env = os.environ | {"FIELDHAND_CONFIG": str(folder / "config"), "XDG_STATE_HOME": str(folder / "state")}
    made = Scene(folder=folder, env=env | {"FIELDHAND_MISSIONS": str(folder / "missions"), "LANG": "C.UTF-8"})
    made.run("run", "task.xml", *GROUND, "--yes", "--confirm", "--by", SEEN, "-o", "flown", "--mcap", "flown/log.mcap")
    events = [json.loads(line) for line in (folder / "flown/events.jsonl").read_text().splitlines()]
    happened = [
        {"event": "fault", "t": 1.0, "node": "n1", "fault": "action_failed", "what": "x", "handled": True},
        {"event": "limit", "t": 1.0, "node": "n1", "quantity": "charge_percent", "level": "warn", "value": 1.0,
         "threshold": 2.0, "then": "go_on", "cleared": False, "lat": 37.0, "lon": -120.0, "travelled_m": 1.0,
         "charge_percent": 1.0},
    ]  # fmt: skip
    lines = [json.dumps(poisoned(event)) for event in (*events[:-1], *happened, events[-1])]
    (folder / "events.jsonl").write_text("\n".join(lines) + "\n")
    return made


GROUND = ("--site", "site.geojson", "--robot", "robot.yaml")
LOG = ("--task", "task.xml", *GROUND)


def require_film(path: Path) -> None:
    """Fail where what people read in a log for Foxglove hides something."""
    with path.open("rb") as file:
        for _, channel, message in make_reader(file).iter_messages():
            require_json(message.data.decode(), visible=not channel.topic.startswith("/mission/"))


#: How a file is looked at, by the end of its name.
LOOK: dict[str, Callable[[Path], object]] = {
    "report.html": lambda path: require_page(path.read_text(), scripts=0),
    "replay.html": lambda path: require_page(path.read_text(), scripts=2),
    ".csv": lambda path: require_table(path.read_bytes().decode()),
    ".geojson": lambda path: require_json(path.read_text(), visible=True),
    ".json": lambda path: require_json(path.read_text(), visible=False),
    ".jsonl": lambda path: require_visible(path.read_text()),
    ".plan": lambda path: require_json(path.read_text(), visible=True),
    ".kml": lambda path: require_xml(path.read_bytes()),
    ".xml": lambda path: require_xml(path.read_bytes()),
    ".svg": lambda path: require_xml(path.read_bytes()),
    ".txt": lambda path: require_visible(path.read_text()),
    ".mcap": require_film,
    ".gif": lambda path: path.stat().st_size,
    ".png": lambda path: path.stat().st_size,
}


def require_looked_at(folder: Path) -> None:
    """Fail where one of the files in a folder leads a reader of it astray."""
    files = [path for path in folder.rglob("*") if path.is_file()]
    assert files
    for path in files:
        looks = [look for end, look in LOOK.items() if path.name.endswith(end)]
        assert looks, f"nothing is said about {path.name}"
        looks[0](path)


#: Commands, and what they are given; ``OUT`` is a folder of each command's own, for what it writes.
COMMANDS: dict[str, tuple[str, ...]] = {
    "site": ("site", "site.geojson"),
    "site as JSON": ("site", "site.geojson", "--json"),
    "site in a picture": ("site", "site.geojson", "--picture", "OUT/site.svg"),
    "robot": ("robot", "robot.yaml"),
    "check": ("check", "task.xml", *GROUND),
    "check as JSON": ("check", "task.xml", *GROUND, "--json"),
    "check in Spanish": ("check", "task.xml", *GROUND, "--lang", "es", "--picture", "OUT/map.png"),
    "inspect": ("inspect", "m.mission"),
    "inspect as JSON": ("inspect", "m.mission", "--json"),
    "run": ("run", "task.xml", *GROUND, "--yes", "--confirm", "--by", SEEN, "-o", "OUT/run"),
    "missions": ("missions",),
    "status": ("status",),
    "report": ("report", "events.jsonl", *LOG, "-o", "OUT/report"),
    "report as JSON": ("report", "events.jsonl", *LOG, "-o", "OUT/report", "--json"),
    "replay": ("replay", "events.jsonl", *GROUND, "-o", "OUT/replay.html"),
    "replay, moving": ("replay", "events.jsonl", *GROUND, "--seconds", "0.5", "-o", "OUT/replay.gif"),
    **{
        f"export of a {what} to {to}": ("export", file, "--to", to, *GROUND, "-o", f"OUT/out.{end}")
        for what, file, formats in (
            ("Task", "task.xml", {"btcpp": "xml", "geojson": "geojson", "kml": "kml", "csv": "csv", "qgc": "plan"}),
            ("log", "events.jsonl",
             {"geojson": "geojson", "kml": "kml", "csv": "csv", "mcap": "mcap", "events": "jsonl"}),
        )
        for to, end in formats.items()
    },
}  # fmt: skip


@pytest.mark.parametrize("name", COMMANDS)
def test_no_output_hides_or_runs_what_others_wrote(name: str, scene: Scene) -> None:
    folder = scene.folder / f"out {list(COMMANDS).index(name)}"
    run = scene.run(*(word.replace("OUT", folder.name) for word in COMMANDS[name]))
    if folder.exists():
        require_looked_at(folder)
    else:
        assert run.out
        assert not any("OUT" in word for word in COMMANDS[name])


@pytest.mark.parametrize("ending", ["png", "svg"])
def test_a_question_is_drawn_as_it_was_asked(ending: str, tmp_path: Path) -> None:
    site = site_of(worst_site())
    places = [(site.trees[0].place,), (site.trees[1].place,)]
    save_choices_picture(site, f"{SEEN}{UNSEEN}", (SEEN, UNSEEN), places, tmp_path / f"choices.{ending}")
    require_looked_at(tmp_path)


def test_a_mission_s_own_folder_is_looked_at(scene: Scene) -> None:
    require_looked_at(scene.folder / "flown")


def copied(scene: Scene, name: str, end: str) -> str:
    """A file of the scene under a name that hides something."""
    path = scene.folder / f"{FILE}{end}"
    path.write_bytes((scene.folder / name).read_bytes())
    return path.name


#: Options and arguments in which something is hidden; FILE.xml is a file of the scene under such a name.
OPTIONS: dict[str, tuple[str, ...]] = {
    "command": (WORD,),
    "request": ("plan", WORD, *GROUND),
    "answer": ("plan", "Read CO2.", *GROUND, "--answer", WORD),
    "site": ("plan", "Read CO2.", "--site", WORD),
    "robot": ("plan", "Read CO2.", "--site", "demo", "--robot", WORD),
    "planner": ("plan", "Read CO2.", "--site", "demo", "--planner", WORD),
    "language": ("check", "task.xml", *GROUND, "--lang", WORD),
    "picture": ("check", "task.xml", *GROUND, "--picture", FILE),
    "world": ("run", "task.xml", *GROUND, "--yes", "--confirm", "--world", FILE),
    "approver": ("run", "task.xml", *GROUND, "--yes", "--confirm", "--by", WORD, "-o", "by"),
    "signer": ("approve", "task.xml", *GROUND, "--yes", "--confirm", "--by", WORD, "-o", "by.mission"),
    "folder": ("run", "task.xml", *GROUND, "--yes", "--confirm", "-o", FILE),
    "missions": ("missions", "--missions", FILE),
    "mission": ("status", WORD),
    "report": ("report", "events.jsonl", *LOG, "-o", f"{FILE}x"),
    "report's log": ("report", WORD, *LOG),
    "format": ("export", "task.xml", "--to", WORD, *GROUND, "-o", "x"),
    "export": ("export", "task.xml", "--to", "kml", *GROUND, "-o", f"{FILE}.kml"),
    "key": ("keys", "new", "--name", WORD),
    "key file": ("keys", "trust", FILE),
    "host": ("serve", "--host", WORD),
    "address": ("order", WORD, "pause"),
    "order": ("order", "http://127.0.0.1:9", WORD),
    "number": ("run", "task.xml", *GROUND, "--seed", WORD),
    "Task by name": ("check", "FILE.xml", *GROUND),
    "site by name": ("site", "FILE.geojson"),
    "profile by name": ("robot", "FILE.yaml"),
    "bundle by name": ("inspect", "FILE.mission"),
    "log by name": ("report", "FILE.jsonl", *LOG, "-o", "by name"),
}


@pytest.mark.parametrize("name", OPTIONS)
def test_no_command_hides_what_it_was_given(name: str, scene: Scene) -> None:
    whole = {"xml": "task.xml", "geojson": "site.geojson", "yaml": "robot.yaml", "mission": "m.mission",
             "jsonl": "events.jsonl"}  # fmt: skip
    words = [
        copied(scene, whole[word[5:]], f".{word[5:]}") if word.startswith("FILE.") else word for word in OPTIONS[name]
    ]
    run = scene.run(*words, statuses=(0, 1, 2))
    assert run.out + run.err
    if "by" in words:
        require_looked_at(scene.folder / "by")


@contextmanager
def answering(status: int, body: Callable[[str], bytes]) -> Iterator[str]:
    """A server that answers everything with this status and this body, which is given the path; yields its address."""

    class Handler(http.server.BaseHTTPRequestHandler):
        def answer(self) -> None:
            self.rfile.read(int(self.headers.get("Content-Length", 0)))
            data = body(self.path)
            self.send_response(status)
            self.send_header("Content-Type", "application/json")
            self.send_header("Content-Length", str(len(data)))
            self.end_headers()
            self.wfile.write(data)

        do_GET = do_PUT = do_POST = answer  # noqa: N815  names of the standard library

        def log_message(self, *args: object) -> None:
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.02}, daemon=True).start()
    try:
        yield f"http://127.0.0.1:{server.server_address[1]}"
    finally:
        server.shutdown()
        server.server_close()


def robot_says(bundle: bytes) -> Callable[[str], bytes]:
    """The answers of a robot's agent, all of its words hostile."""
    sha256, worst = hashlib.sha256(bundle).hexdigest(), f"{FORMULA}{SEEN}{UNSEEN}"
    standing = {
        "bundle": sha256, "mission": worst, "task": worst, "request": worst, "signer": worst, "received_at": worst,
        "begun_at": worst, "state": "ended", "status": worst, "reason": worst, "doing": worst, "lat": None, "lon": None,
        "charge_percent": 1.0, "travelled_m": 1.0, "events": 2, "fault": worst, "report": worst,
    }  # fmt: skip
    lines = [json.dumps({"event": worst, "t": 1.0, worst: worst}), worst]
    robot = {"robot": worst, "robot_sha256": worst, "sites": [worst], "version": worst, "on": worst, "missing": [worst],
             "active": sha256, "missions": [standing]}  # fmt: skip
    events = [{"n": n, "at": worst, "line": line} for n, line in enumerate(lines, start=1)]
    receipt = {"hashes": dict(unseal(bundle, source="m").hashes), "new": True, "mission": standing}

    def answer(path: str) -> bytes:
        said: dict[str, Any] = robot if path == "/agent" else {**receipt, "heard": False}
        if "/events" in path:
            said = {"events": events if "after=0" in path else [], "idle": True, "mission": standing}
        return json.dumps(said).encode()

    return answer


def refusing(said: object) -> Callable[[str], bytes]:
    """The body of an error, whoever reads it."""
    return lambda _: json.dumps(said).encode() if not isinstance(said, bytes) else said


WORST = f"{FORMULA}{SEEN}{UNSEEN}"
#: What is wrong, as agents and models say it.
WRONG: dict[str, tuple[int, object]] = {
    "refused": (422, {"what": WORST, "where": WORST, "advice": WORST, "error": {"message": WORST}}),
    "refused by a model": (401, {"error": {"message": WORST, "type": WORST, "code": WORST}}),
    "another form": (200, {WORST: WORST}),
    "no JSON": (200, WORST.encode("utf-8", "replace")),
    "no text": (404, b"\x9b\x1b[2J\xff\x00"),
}
TO_ROBOT: dict[str, tuple[str, ...]] = {
    "send": ("send", "m.mission", "--to", "URL"),
    "watch": ("watch", "URL", "--events", "watched.jsonl"),
    "watch as JSON": ("watch", "URL", "--json"),
    "order": ("order", "URL", "pause", "--because", WORD),
    "order to start": ("order", "URL", "start"),
}


@pytest.mark.parametrize("command", TO_ROBOT)
def test_what_a_robot_says_is_shown_whole(command: str, scene: Scene) -> None:
    bundle = (scene.folder / "m.mission").read_bytes()
    with answering(200, robot_says(bundle)) as url:
        run = scene.run(*(word.replace("URL", url) for word in TO_ROBOT[command]))
    assert command == "send" or "202e" in (run.out + run.err).replace(SEEN, "")
    assert scene.run("outbox").out


@pytest.mark.parametrize("wrong", WRONG)
@pytest.mark.parametrize("command", ["send", "watch", "order"])
def test_what_is_wrong_with_a_robot_is_shown_whole(command: str, wrong: str, scene: Scene) -> None:
    status, said = WRONG[wrong]
    with answering(status, refusing(said)) as url:
        scene.run(*(word.replace("URL", url) for word in TO_ROBOT[command]), statuses=(1, 2))
    scene.run("outbox")


MODEL = ("plan", "Kindly portray the leafiest specimen.", *GROUND, "--planner", "llm")
DRAFT = (
    '<task xmlns="urn:fieldhand:task:1"><command><assumptions><assumption>{0}</assumption></assumptions></command>'
    '<task-composition><plan><act label="{0}"><read_co2/><at><tree-is tree="{0}"/></at></act></plan><exits/>'
    "</task-composition></task>"
)


@pytest.mark.parametrize("wrong", WRONG)
def test_what_is_wrong_with_a_model_is_shown_whole(wrong: str, scene: Scene) -> None:
    status, said = WRONG[wrong]
    with answering(status, refusing(said)) as url:
        keys = {"FIELDHAND_MODEL": f"openai-compatible:{WORD}", "FIELDHAND_BASE_URL": url, "FIELDHAND_API_KEY": "k" * 9}
        scene.run(*MODEL, statuses=(2,), **keys)
    scene.run(*MODEL, statuses=(2,), FIELDHAND_MODEL="openai-compatible:m", FIELDHAND_BASE_URL=f"http://{WORD}/v1")
    scene.run(*MODEL, statuses=(2,), FIELDHAND_MODEL=WORD, FIELDHAND_BASE_URL=url)


@pytest.mark.parametrize(
    "answer",
    [WORST, f"<question>{UNSEEN}<choice>{UNSEEN}</choice><choice>b</choice></question>",
     f"<refusal>{UNSEEN}{SEEN}</refusal>", DRAFT.format("a\u202eb\u200b\x9b"), DRAFT.format("a&#x202e;b")],
    ids=["nonsense", "question", "refusal", "Task", "Task with escapes"],
)  # fmt: skip
def test_what_a_model_answers_is_shown_whole(answer: str, scene: Scene) -> None:
    with ScriptedEndpoint([answer], repeat_last=True) as endpoint:
        keys = {"FIELDHAND_MODEL": "openai-compatible:m", "FIELDHAND_BASE_URL": endpoint.url}
        for json_ in ((), ("--json",)):
            scene.run(*MODEL, *json_, "--transcript", "talk.jsonl", statuses=(0, 1, 2), **keys)
    require_visible((scene.folder / "talk.jsonl").read_text())


BODIES: dict[str, Callable[[], dict[str, Any]]] = {
    "/api/site": lambda: {"site": {"name": "s.geojson", "text": "{}"}},
    "/api/plan": lambda: {"request": "Read CO2 at tree 4.", "answers": [{"question": "Which?", "answer": "b"}],
                          "lang": "en", "robot": "husky", "planner": "english"},
    "/api/check": lambda: {"xml": corner_xml()},
    "/api/run": lambda: {
        "xml": corner_xml(), "approved_by": "Ada", "confirmed": list(corner_warnings()), "seed": 3,
        "world": {"readings": {"co2": 1}, "faults": [{"fault": "robot_stops", "at_s": 9, "why": "cut"}]},
    },
}  # fmt: skip


@pytest.mark.parametrize("path", BODIES)
def test_no_answer_of_the_server_hides_what_it_was_sent(path: str) -> None:
    server, whole = browser(EnglishPlanner()), BODIES[path]()
    for where, body in each_text(whole, lambda text: f"{text}{SEEN}{UNSEEN}"):
        answer = server.post(path, body)
        assert answer.status_code in (200, 400, 422), (where, answer.text)
        require_json(answer.text, visible=True)
    assert server.post(path, whole | {"site": json.loads(worst_site().parts["site.geojson"])}).status_code < 500
    for odd in (WORST, f"?{WORST}"):
        require_json(server.get(f"/api/{quote(odd)}").text, visible=True)
