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
from fieldhand.errors import JournalError, NotApprovedError
from fieldhand.execution.vehicle import Connection
from fieldhand.files import FileFault, read_file, store_names, write_stored, write_whole
from fieldhand.folders import Unguarded, require_guarded, require_own_file
from fieldhand.hidden_characters import json_text
from fieldhand.language import message, named
from fieldhand.missions.direct_commands import no_command
from fieldhand.missions.signed_contents import require_signed
from fieldhand.task.authorization import Authorization, AuthorizedTask

if TYPE_CHECKING:
    from fieldhand.approval.bundle.opening import Bundle
    from fieldhand.execution.drivers.simulation.world import World
    from fieldhand.execution.operator_commands import OperatorCommand
    from fieldhand.execution.vehicle import Vehicle
    from fieldhand.robot.model import RobotProfile
    from fieldhand.site.formats.files import SiteFiles
    from fieldhand.site.model import Site

#: Of mission.json: of one that is carried out in simulation, and of one on a robot. A program that knows no robots
#: shall not go on with the latter.
FORMAT, ON_ROBOT = 1, 2

JOURNAL, ORDERS, LOG, ABOUT = "journal.sqlite", "orders.sqlite", "events.jsonl", "mission.json"
#: The page of its report, once one was written here.
REPORT = "report.html"
_SIGNED = "signed.mission"
#: Of any of its files: a site of 100 MB, and a bundle around it.
_MOST_BYTES = 128_000_000


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
    """A mission that is to begin, with the bytes from which each part of it was read.

    Attributes:
        authorized: The Task, as it was approved.
        site, robot: For which it was approved.
        files, profile: The bytes from which these two were read.
        lenient: Whether the site was read leniently.
        world: Of the simulation; None for a world without surprises.
        seed: Of every random thing in the simulation, and of the guard.
        planner: Who planned it.
        bundle: The signed mission that all but the world and the seed came from; None where nobody has signed.
        departure: Of a mission on a robot; None in simulation.

    Raises:
        NotApprovedError: These bytes are not the ones that were approved.
    """

    authorized: AuthorizedTask
    site: Site
    robot: RobotProfile
    files: SiteFiles
    profile: bytes
    lenient: bool = False
    world: World | None = None
    seed: int = 0
    planner: str = ""
    bundle: Bundle | None = None
    departure: Departure | None = None

    def __post_init__(self) -> None:
        approved = self.authorized.authorization
        for what, read, given, wanted in (
            (message("Task"), approved.task_sha256, _sha256(self.document), approved.task_sha256),
            (message("site"), self.site.sha256, self.files.sha256, approved.site_sha256),
            (message("robot profile"), self.robot.sha256, _sha256(self.profile), approved.robot_sha256),
        ):
            if not read == given == wanted:
                raise NotApprovedError(
                    message(
                        "the {kind} is not the one that was approved (SHA-256 {given}, approved {wanted})",
                        kind=what,
                        given=given[:12],
                        wanted=wanted[:12],
                    ),
                    advice=message("approve the Task again"),
                )
        if self.bundle is not None and self.authorized != self.bundle.authorized:
            raise NotApprovedError(
                message("the Task is not the one that was signed"), advice=message("carry out the signed mission")
            )

    @property
    def document(self) -> bytes:
        """The Task document."""
        from fieldhand.task.codec import encode

        return encode(self.authorized.task)


def signed_inputs(
    bundle: Bundle, *, world: World | None = None, seed: int = 0, departure: Departure | None = None
) -> Inputs:
    """Return what a signed mission begins with."""
    return Inputs(
        authorized=bundle.authorized,
        site=bundle.site,
        robot=bundle.robot,
        files=bundle.files,
        profile=bundle.profile,
        lenient=bundle.manifest.site.lenient,
        world=world,
        seed=seed,
        planner=bundle.manifest.task.planner,
        bundle=bundle,
        departure=departure,
    )


@dataclass(frozen=True, kw_only=True)
class StoredMission:
    """A mission that was begun. What is carried out is this; nothing of its folder but the journal is read again.

    Attributes:
        bundle: The signed mission that it is, where it is one and that was verified.
        departure: Of a mission on a robot; None in simulation.
        told: Gives the order that stands in the memory of this process, beside those in the folder.
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
    told: Callable[[], OperatorCommand | None] = no_command

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


def begin(under: Path, name: str, inputs: Inputs) -> StoredMission:
    """Make the folder of a mission. Nothing is done yet; a folder that was not finished is no mission.

    Returns:
        The mission, from what was given: the folder is not read.

    Raises:
        JournalError: There is a mission of that name, or the folder cannot be written.
    """
    from fieldhand.execution.drivers.simulation.world import World
    from fieldhand.execution.journal.store import create
    from fieldhand.execution.operator_commands import CommandFile

    folder, world = under / name, inputs.world or World()
    files = {"task.xml": inputs.document, "robot.yaml": inputs.profile}
    files.update({f"site/{Path(file).name}": data for file, data in inputs.files.parts.items()})
    if world.data is not None:
        files["world.yaml"] = world.data
    if inputs.bundle is not None:
        files[_SIGNED] = inputs.bundle.data
    about = {
        "format": FORMAT if inputs.departure is None else ON_ROBOT,
        "site": f"site/{Path(inputs.files.name).name}",
        "lenient": inputs.lenient,
        "seed": inputs.seed,
        "planner": inputs.planner,
        "authorization": asdict(inputs.authorized.authorization),
        "files": {file: _sha256(data) for file, data in files.items()},
    }
    if inputs.departure is not None:
        departure = asdict(inputs.departure)
        if not inputs.departure.by.options:
            del departure["by"]["options"]  # which versions without plugins do not know
        about["departure"] = departure
    whole = json_text(about, indent=1).encode()
    if (folder / ABOUT).exists():
        raise JournalError(
            message("there is a mission of that name already"), where=str(folder), advice=message("fieldhand resume it")
        )
    try:
        for one in (under, folder, folder / "site"):
            one.mkdir(mode=0o755, parents=True, exist_ok=True)
        _require_guarded(folder)
        for file in (JOURNAL, f"{JOURNAL}-wal", f"{JOURNAL}-shm", ORDERS, f"{ORDERS}-wal", f"{ORDERS}-shm"):
            (folder / file).unlink(missing_ok=True)
        for file, data in files.items():
            write_stored(folder / file, data, mode=0o644)
        create(folder / JOURNAL, _sha256(whole))
        CommandFile(folder / ORDERS).create()
        store_names(folder / "site")
        write_whole(folder / ABOUT, whole, mode=0o644)
        store_names(under)
    except OSError as error:
        raise JournalError(
            message("the mission's folder cannot be written: {why}", why=named(error.strerror or str(error), "reason")),
            where=str(folder),
            advice=message("free some space, or give another folder with --missions"),
        ) from None
    return StoredMission(
        folder=folder,
        authorized=inputs.authorized,
        site=inputs.site,
        robot=inputs.robot,
        world=world,
        seed=inputs.seed,
        planner=inputs.planner,
        sha256=_sha256(whole),
        bundle=inputs.bundle,
        departure=inputs.departure,
    )


@dataclass(frozen=True, kw_only=True)
class FolderContents:
    """The bytes of a mission's folder, each file read once. Everything that is decided about a mission follows from these.

    Attributes:
        about: What mission.json says; ``whole`` are its bytes.
        files: Of every file that it names, each with the SHA-256 that it gives.
    """  # noqa: E501

    folder: Path
    about: Mapping[str, Any]
    whole: bytes
    files: Mapping[str, bytes]

    @property
    def signed(self) -> bytes | None:
        """The signed bundle that the mission came from; None where nobody signed it."""
        return self.files.get(_SIGNED)

    @property
    def departure(self) -> Departure | None:
        """On which robot the mission was begun; None for one in simulation.

        Raises:
            JournalError: mission.json does not say.
        """
        try:
            return _departure_of(self.about)
        except (KeyError, TypeError, ValueError) as error:
            raise _no_mission(self.folder, f"{ABOUT} lacks {error}") from None

    def mission(self, verify: Callable[[bytes, str], Bundle] | None = None) -> StoredMission:
        """Return the mission that these bytes are.

        Args:
            verify: As for :func:`open_mission`.

        Raises:
            JournalError, NotApprovedError, BundleError, NotTrustedError: As :func:`open_mission`.
        """
        from fieldhand.execution.drivers.simulation.world import World
        from fieldhand.execution.drivers.simulation.world_file import decode_world

        folder, about, files = self.folder, self.about, self.files
        try:
            site_file = str(about["site"])
            authorization = Authorization(
                **{**about["authorization"], "confirmed": tuple(about["authorization"]["confirmed"])}
            )
            lenient, seed, planner = bool(about["lenient"]), int(about["seed"]), str(about["planner"])
        except (KeyError, TypeError, ValueError) as error:
            raise _no_mission(folder, f"{ABOUT} lacks {error}") from None
        if site_file not in files or not {"task.xml", "robot.yaml"} <= files.keys():
            raise _no_mission(folder, f"{ABOUT} names no Task, robot or site")
        bundle = None
        if verify is not None and self.signed is not None:
            # Before anything else of the folder is read.
            bundle = verify(self.signed, str(folder / _SIGNED))
            require_signed(bundle, files, authorization, lenient=lenient, planner=planner, folder=folder)
            authorized, site, robot = bundle.authorized, bundle.site, bundle.robot
        else:
            authorized, site, robot = self._unsigned(authorization, site_file, lenient=lenient)
        world = files.get("world.yaml")
        return StoredMission(
            folder=folder,
            authorized=authorized,
            site=site,
            robot=robot,
            world=World() if world is None else decode_world(world, source=str(folder / "world.yaml")),
            seed=seed,
            planner=planner,
            sha256=_sha256(self.whole),
            bundle=bundle,
            departure=self.departure,
        )

    def _unsigned(
        self, authorization: Authorization, site_file: str, *, lenient: bool
    ) -> tuple[AuthorizedTask, Site, RobotProfile]:
        """Task, site and robot as the folder has them.

        Raises:
            NotApprovedError: They are not those that were approved.
        """
        from fieldhand.approval.authorize import approved_before
        from fieldhand.robot.loader import parse_profile
        from fieldhand.site.formats.files import SiteFiles
        from fieldhand.site.loader import site_of

        folder, files = self.folder, self.files
        robot = parse_profile(files["robot.yaml"], source=str(folder / "robot.yaml"))
        named = {site_file: files[site_file]} | {file: data for file, data in files.items() if file.startswith("site/")}
        parts = {Path(file).name: data for file, data in named.items()}
        site = site_of(SiteFiles(parts=parts, source=str(folder / site_file)), lenient=lenient)
        task = mission.decode_task(files["task.xml"], robot, source=str(folder / "task.xml"))
        return approved_before(files["task.xml"], task, authorization, site, robot), site, robot


def read_folder(folder: Path) -> FolderContents:
    """Read the folder of a mission, each file once, and hold each against the SHA-256 that mission.json gives.

    Raises:
        JournalError: This is no mission, a file is not the one that it began with, or others can write there.
    """
    try:
        if folder.is_dir():
            _require_guarded(folder)
    except OSError as error:
        raise _no_mission(folder, error.strerror or str(error)) from None
    about, whole = read_about(folder)
    try:
        sums = {str(file): str(sha256) for file, sha256 in dict(about["files"]).items()}
    except (KeyError, TypeError, ValueError) as error:
        raise _no_mission(folder, f"{ABOUT} lacks {error}") from None
    files = {file: read_kept(folder, file, sha256) for file, sha256 in sums.items()}
    return FolderContents(folder=folder, about=about, whole=whole, files=files)


def open_mission(folder: Path, verify: Callable[[bytes, str], Bundle] | None = None) -> StoredMission:
    """Return the mission of a folder.

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
    return read_folder(folder).mission(verify)


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
            message("the mission's folder cannot be removed: {why}", why=named(error.strerror or str(error), "reason")),
            where=str(folder),
            advice=message("remove what is left of it by hand"),
        ) from None


def read_about(folder: Path) -> tuple[dict[str, Any], bytes]:
    """What mission.json says, and its bytes.

    Raises:
        JournalError: It is missing, or is none.
    """
    try:
        whole = read_file(folder / ABOUT, _MOST_BYTES, look=lambda status: require_own_file(folder / ABOUT, status))
        about = json.loads(whole)
    except Unguarded as fault:
        raise _unguarded(fault) from None
    except FileFault as fault:
        raise _no_mission(folder, f"{ABOUT} {fault.what}") from None
    except ValueError as error:
        raise _no_mission(folder, f"{ABOUT} is not JSON: {error}") from None
    except RecursionError:
        raise _no_mission(folder, f"{ABOUT} is nested too deep") from None
    if not isinstance(about, dict) or about.get("format") not in (FORMAT, ON_ROBOT):
        raise _no_mission(folder, f"{ABOUT} has not the format {FORMAT} or {ON_ROBOT} that this version reads")
    return about, whole


def read_kept(folder: Path, file: str, sha256: str) -> bytes:
    """The bytes of a file of the folder, which have to be those that the mission began with.

    Raises:
        JournalError: They are others, or cannot be read.
    """
    path = folder / file
    if path.resolve() != folder.resolve() / file:
        raise _no_mission(folder, f"{file} leads elsewhere")
    try:
        data = read_file(path, _MOST_BYTES, plain=True, look=lambda status: require_own_file(path, status))
    except Unguarded as fault:
        raise _unguarded(fault) from None
    except FileFault as fault:
        raise _no_mission(folder, f"{file} {fault.what}") from None
    if _sha256(data) != sha256:
        raise JournalError(
            message("{file} is not the one that the mission began with", file=file),
            where=str(folder),
            advice=message("bring the file back, or carry the Task out as a new mission"),
        )
    return data


def _require_guarded(folder: Path) -> None:
    """Check that nobody else can change the folder of a mission, or put another in its place.

    Raises:
        JournalError: Somebody else can.
        OSError: It may not be looked into.
    """
    try:
        require_guarded(folder)
    except Unguarded as fault:
        raise _unguarded(fault) from None


def _unguarded(fault: Unguarded) -> JournalError:
    return JournalError(
        fault.what,
        where=str(fault.path),
        advice=message("{advice}; or give another folder with --missions", advice=fault.advice),
    )


def _no_mission(folder: Path, why: str) -> JournalError:
    return JournalError(
        message("this is no mission: {why}", why=why),
        where=str(folder),
        advice=message("give the folder that run has made"),
    )


def _sha256(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
