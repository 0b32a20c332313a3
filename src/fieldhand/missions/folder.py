"""The folder of a mission: every byte that it needs, so that it depends on no other file from then on."""

from __future__ import annotations

import hashlib
import json
import secrets
import shutil
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fieldhand import mission
from fieldhand.errors import JournalError
from fieldhand.execution.vehicle import Connection
from fieldhand.files import store_names, write_stored, write_whole
from fieldhand.missions.signed import require_signed
from fieldhand.task.authorization import Authorization, AuthorizedTask

if TYPE_CHECKING:
    from fieldhand.approval.bundle.opening import Bundle
    from fieldhand.execution.vehicle import Vehicle
    from fieldhand.execution.world import World
    from fieldhand.robot.model import RobotProfile
    from fieldhand.site.model import Site

#: Of mission.json: of one that is carried out in simulation, and of one on a robot. A program that knows no robots
#: shall not go on with the latter.
FORMAT, ON_ROBOT = 1, 2

LOCK, JOURNAL, ORDERS, LOG, ABOUT = "lock", "journal.sqlite", "orders.sqlite", "events.jsonl", "mission.json"
#: The page of its report, once one was written here.
REPORT = "report.html"
_SIGNED = "signed.mission"


@dataclass(frozen=True, kw_only=True)
class Departure:
    """On which robot a mission was begun.

    Attributes:
        by: How it was reached.
        charge_percent: Of its battery then: the guard reckons from it.
    """

    by: Connection
    charge_percent: float


@dataclass(frozen=True, kw_only=True)
class Inputs:
    """What a mission is: every byte that it needs, so that it depends on no other file from then on.

    Attributes:
        task: The Task document that was approved.
        site: The site's files by name, the one that is opened first.
        lenient: Whether the site was read leniently.
        robot: The profile.
        world: A world file; None for a world without surprises.
        seed: Of every random thing in the simulation, and of the guard.
        planner: Who planned it.
        signed: The signed bundle that all but the world and the seed came from; None where nobody has signed.
        departure: Of a mission on a robot; None in simulation.
    """

    task: bytes
    site: Mapping[str, bytes]
    robot: bytes
    authorization: Authorization
    world: bytes | None = None
    lenient: bool = False
    seed: int = 0
    planner: str = ""
    signed: bytes | None = None
    departure: Departure | None = None


@dataclass(frozen=True, kw_only=True)
class Mission:
    """A mission as its folder holds it.

    Attributes:
        bundle: The signed mission that it is, where it is one and that was verified.
        departure: Of a mission on a robot; None in simulation.
    """

    folder: Path
    authorized: AuthorizedTask
    site: Site
    robot: RobotProfile
    world: World
    seed: int
    planner: str
    sha256: str
    bundle: Bundle | None = None
    departure: Departure | None = None

    @property
    def id(self) -> str:
        """Its name: that of the folder."""
        return self.folder.name


def departure_on(vehicle: Vehicle | None) -> Departure | None:
    """The departure of a mission that begins now on this robot; None for the simulation."""
    if vehicle is None or vehicle.by is None:
        return None
    return Departure(by=vehicle.by, charge_percent=vehicle.charge_percent)


def new_id(at: datetime) -> str:
    """A name for a mission that begins now."""
    return f"{at:%Y%m%d-%H%M%S}-{secrets.token_hex(3)}"


def begin(under: Path, name: str, inputs: Inputs) -> Path:
    """Make the folder of a mission. Nothing is done yet; a folder that was not finished is no mission.

    Returns:
        The folder.

    Raises:
        JournalError: There is a mission of that name, or the folder cannot be written.
    """
    from fieldhand.execution.journal.desk import Desk
    from fieldhand.execution.journal.store import create

    folder = under / name
    files = {"task.xml": inputs.task, "robot.yaml": inputs.robot}
    files.update({f"site/{Path(file).name}": data for file, data in inputs.site.items()})
    if inputs.world is not None:
        files["world.yaml"] = inputs.world
    if inputs.signed is not None:
        files[_SIGNED] = inputs.signed
    about = {
        "format": FORMAT if inputs.departure is None else ON_ROBOT,
        "site": f"site/{Path(next(iter(inputs.site))).name}",
        "lenient": inputs.lenient,
        "seed": inputs.seed,
        "planner": inputs.planner,
        "authorization": asdict(inputs.authorization),
        "files": {file: hashlib.sha256(data).hexdigest() for file, data in files.items()},
    }
    if inputs.departure is not None:
        about["departure"] = asdict(inputs.departure)
    whole = json.dumps(about, ensure_ascii=False, indent=1).encode()
    if (folder / ABOUT).exists():
        raise JournalError("there is a mission of that name already", where=str(folder), advice="fieldhand resume it")
    try:
        (folder / "site").mkdir(parents=True, exist_ok=True)
        for file in (JOURNAL, f"{JOURNAL}-wal", f"{JOURNAL}-shm", ORDERS, f"{ORDERS}-wal", f"{ORDERS}-shm"):
            (folder / file).unlink(missing_ok=True)
        for file, data in files.items():
            write_stored(folder / file, data)
        create(folder / JOURNAL, hashlib.sha256(whole).hexdigest())
        Desk(folder / ORDERS).create()
        store_names(folder / "site")
        write_whole(folder / ABOUT, whole)
        store_names(under)
    except OSError as error:
        raise JournalError(
            f"the mission's folder cannot be written: {error.strerror or error}",
            where=str(folder),
            advice="free some space, or give another folder with --missions",
        ) from None
    return folder


def is_signed(folder: Path) -> bool:
    """Whether the mission came from a signed bundle, which then lies in its folder.

    Raises:
        JournalError: This is no mission.
    """
    files = read_about(folder)[0].get("files")
    return isinstance(files, dict) and _SIGNED in files


def signed_bundle(folder: Path) -> bytes | None:
    """The signed bundle that a mission came from, with the bytes that it began with; None where nobody signed it.

    Raises:
        JournalError: This is no mission, or the bundle is another.
    """
    sums = read_about(folder)[0].get("files")
    return read_file(folder, _SIGNED, sums[_SIGNED]) if isinstance(sums, dict) and _SIGNED in sums else None


def open_mission(folder: Path, verify: Callable[[bytes, str], Bundle] | None = None) -> Mission:
    """Read a mission from its folder; every byte has to be the one that it began with.

    Args:
        folder: The mission's.
        verify: Opens a signed bundle, given with what to call it, once it was found to be good
            (:func:`fieldhand.mission.open_bundle`): a signed mission is then what that bundle says, whatever else
            lies in the folder. None takes the folder's word; nothing may run from that in production.

    Raises:
        JournalError: This is no mission, or not the one that was begun.
        NotApprovedError: It is not what was approved, or not what was signed.
        BundleError, NotTrustedError: The bundle is broken, or nobody who is trusted here has signed it.
    """
    from fieldhand.approval.authorize import approved_before
    from fieldhand.execution.world import World, load_world
    from fieldhand.robot.loader import parse_profile
    from fieldhand.site.geojson import load_site

    about, whole = read_about(folder)
    try:
        sums, site_file = dict(about["files"]), str(about["site"])
        authorization = Authorization(
            **{**about["authorization"], "confirmed": tuple(about["authorization"]["confirmed"])}
        )
        lenient, seed, planner = bool(about["lenient"]), int(about["seed"]), str(about["planner"])
        departure = _departure_of(about)
    except (KeyError, TypeError, ValueError) as error:
        raise _no_mission(folder, f"{ABOUT} lacks {error}") from None
    files = {file: read_file(folder, file, sha256) for file, sha256 in sums.items()}
    if site_file not in files or not {"task.xml", "robot.yaml"} <= files.keys():
        raise _no_mission(folder, f"{ABOUT} names no Task, robot or site")
    bundle = None
    if verify is not None and _SIGNED in files:
        # Before anything else of the folder is read.
        bundle = verify(files[_SIGNED], str(folder / _SIGNED))
        require_signed(bundle, files, authorization, lenient=lenient, planner=planner, folder=folder)
        authorized, site, robot = bundle.authorized, bundle.site, bundle.robot
    else:
        robot = parse_profile(files["robot.yaml"], source=str(folder / "robot.yaml"))
        site = load_site(folder / site_file, lenient=lenient)
        task = mission.decode_task(files["task.xml"], robot, source=str(folder / "task.xml"))
        authorized = approved_before(files["task.xml"], task, authorization, site, robot)
    return Mission(
        folder=folder,
        authorized=authorized,
        site=site,
        robot=robot,
        world=load_world(folder / "world.yaml") if "world.yaml" in files else World(),
        seed=seed,
        planner=planner,
        sha256=hashlib.sha256(whole).hexdigest(),
        bundle=bundle,
        departure=departure,
    )


def begun_on(folder: Path) -> Departure | None:
    """On which robot a mission was begun; None for one in simulation.

    Raises:
        JournalError: This is no mission.
    """
    try:
        return _departure_of(read_about(folder)[0])
    except (KeyError, TypeError, ValueError) as error:
        raise _no_mission(folder, f"{ABOUT} lacks {error}") from None


def _departure_of(about: Mapping[str, Any]) -> Departure | None:
    """On which robot mission.json says that a mission was begun; None for one in simulation.

    Raises:
        KeyError, TypeError, ValueError: It says that it was one, and not which.
    """
    if about["format"] != ON_ROBOT:
        return None
    said = about["departure"]
    return Departure(by=Connection(**said["by"]), charge_percent=float(said["charge_percent"]))


def remove_folder(folder: Path) -> None:
    """Remove a mission with all that it has done.

    Raises:
        JournalError: It cannot be removed.
    """
    try:
        # First what makes it a mission: half of a folder shall not be taken for one.
        (folder / ABOUT).unlink()
        shutil.rmtree(folder)
    except OSError as error:
        raise JournalError(
            f"the mission's folder cannot be removed: {error.strerror or error}",
            where=str(folder),
            advice="remove what is left of it by hand",
        ) from None


def read_about(folder: Path) -> tuple[dict[str, Any], bytes]:
    """What mission.json says, and its bytes.

    Raises:
        JournalError: It is missing, or is none.
    """
    try:
        whole = (folder / ABOUT).read_bytes()
        about = json.loads(whole)
    except OSError as error:
        raise _no_mission(folder, f"{ABOUT}: {error.strerror}") from None
    except ValueError as error:
        raise _no_mission(folder, f"{ABOUT} is not JSON: {error}") from None
    if not isinstance(about, dict) or about.get("format") not in (FORMAT, ON_ROBOT):
        raise _no_mission(folder, f"{ABOUT} has not the format {FORMAT} or {ON_ROBOT} that this version reads")
    return about, whole


def read_file(folder: Path, file: str, sha256: str) -> bytes:
    """The bytes of a file of the folder, which have to be those that the mission began with.

    Raises:
        JournalError: They are others, or cannot be read.
    """
    path = folder / file
    if path.resolve() != folder.resolve() / file:
        raise _no_mission(folder, f"{file} leads elsewhere")
    try:
        data = path.read_bytes()
    except (OSError, ValueError) as error:
        raise _no_mission(folder, f"{file} cannot be read: {error}") from None
    if hashlib.sha256(data).hexdigest() != sha256:
        raise JournalError(
            f"{file} is not the one that the mission began with",
            where=str(folder),
            advice="bring the file back, or carry the Task out as a new mission",
        )
    return data


def _no_mission(folder: Path, why: str) -> JournalError:
    return JournalError(f"this is no mission: {why}", where=str(folder), advice="give the folder that run has made")
