"""The folder of a stored mission: copies of all its inputs, so that it depends on no other file."""

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
from fieldhand.errors import JournalError, NotApprovedError, TaskError
from fieldhand.execution.vehicle import Connection
from fieldhand.files import FileFault, read_file, store_names, write_stored, write_whole
from fieldhand.folders import Unguarded, require_guarded, require_own_file
from fieldhand.hidden_characters import json_text
from fieldhand.language import message, named
from fieldhand.missions.direct_commands import no_command
from fieldhand.missions.records_file import records_from_json, records_json
from fieldhand.missions.signed_contents import require_signed
from fieldhand.task.authorization import Authorization, AuthorizedTask
from fieldhand.task.earlier import site_of_run
from fieldhand.task.timing import Schedule

if TYPE_CHECKING:
    from fieldhand.approval.bundle.opening import Bundle
    from fieldhand.execution.drivers.simulation.world import World
    from fieldhand.execution.operator_commands import OperatorCommand
    from fieldhand.execution.vehicle import Vehicle
    from fieldhand.robot.model import RobotProfile
    from fieldhand.site.earlier_missions import EarlierMissions
    from fieldhand.site.formats.files import SiteFiles
    from fieldhand.site.model import Site
    from fieldhand.task.frames import Task

#: Formats of mission.json: of a simulated mission, and of one on a robot. They differ so that versions without support
#: for robots do not resume the latter.
FORMAT, ON_ROBOT = 1, 2

JOURNAL, ORDERS, LOG, ABOUT = "journal.sqlite", "orders.sqlite", "events.jsonl", "mission.json"
#: Report, if one was written to the folder.
REPORT = "report.html"
_SIGNED, _EARLIER = "signed.mission", "earlier.json"
#: Largest file in bytes: a signed mission with a site of 100 MB.
_MOST_BYTES = 128_000_000


@dataclass(frozen=True, kw_only=True)
class RobotAtStart:
    """The robot on which a mission was begun.

    Attributes:
        by: Connection to the robot.
        charge_percent: Charge of its battery at the start, on which the guard bases its budget.
    """

    by: Connection
    charge_percent: float


@dataclass(frozen=True, kw_only=True)
class Inputs:
    """The inputs of a new mission, with the files that they were read from.

    Attributes:
        authorized: Task with its approval.
        site: Site of the approval.
        robot: Robot of the approval.
        files: Files of the site.
        profile: Bytes of the robot profile.
        lenient: True if the site was read leniently.
        world: World of the simulation; None for a world in which nothing fails.
        seed: Seed of the simulation and of the budget guard.
        planner: Name of the planner of the Task.
        bundle: Signed mission that everything but world and seed came from; None for an unsigned mission.
        started_on: Robot on which the mission begins; None for the simulation.

    Raises:
        NotApprovedError: A file is not the approved one.
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
    started_on: RobotAtStart | None = None

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
                message("the Task is not the one that was signed"), advice=message("run the signed mission")
            )

    @property
    def counted(self) -> EarlierMissions | None:
        """The earlier missions that a run of a standing mission counts; None if they are those in the Task."""
        task = self.authorized.task
        found = site_of_run(task, self.site).earlier
        return None if found == task.earlier else found

    @property
    def document(self) -> bytes:
        """The Task document."""
        from fieldhand.task.codec import encode

        return encode(self.authorized.task)


def signed_inputs(
    bundle: Bundle, *, world: World | None = None, seed: int = 0, started_on: RobotAtStart | None = None
) -> Inputs:
    """Return the inputs of a signed mission."""
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
        started_on=started_on,
    )


@dataclass(frozen=True, kw_only=True)
class StoredMission:
    """A mission that was begun; of its folder, only the journal is read again when it is carried out.

    Attributes:
        folder: Folder of the mission.
        authorized: Task with its approval.
        site: Site of the mission.
        robot: Robot of the mission.
        world: World of the simulation.
        seed: Seed of the simulation and of the budget guard.
        planner: Name of the planner of the Task.
        sha256: SHA-256 of mission.json, which the journal contains, too.
        bundle: The verified signed mission; None for an unsigned one.
        started_on: Robot on which it was begun; None for the simulation.
        direct_command: Returns the command in the memory of this process, beside those in the folder.
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
    started_on: RobotAtStart | None = None
    direct_command: Callable[[], OperatorCommand | None] = no_command

    @property
    def id(self) -> str:
        """Name of the mission: the name of its folder."""
        return self.folder.name


def robot_at_start(vehicle: Vehicle | None) -> RobotAtStart | None:
    """Return the robot on which a mission begins now; None for the simulation."""
    if vehicle is None or vehicle.by is None:
        return None
    return RobotAtStart(by=vehicle.by, charge_percent=vehicle.charge_percent)


def new_id(at: datetime) -> str:
    """Return a unique name for a mission that begins at a time."""
    return f"{at:%Y%m%d-%H%M%S}-{secrets.token_hex(3)}"


def begin(under: Path, name: str, inputs: Inputs) -> StoredMission:
    """Create the folder of a mission; mission.json is written last, so that an incomplete folder is no mission.

    Args:
        under: Folder of all missions.
        name: Name of the mission.
        inputs: Its inputs.

    Returns:
        The mission, made from the inputs without reading the folder.

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
    if (counted := inputs.counted) is not None:
        files[_EARLIER] = records_json(counted)
    about = {
        "format": FORMAT if inputs.started_on is None else ON_ROBOT,
        "site": f"site/{Path(inputs.files.name).name}",
        "lenient": inputs.lenient,
        "seed": inputs.seed,
        "planner": inputs.planner,
        "authorization": asdict(inputs.authorized.authorization),
        "files": {file: _sha256(data) for file, data in files.items()},
    }
    if inputs.started_on is not None:
        started_on = asdict(inputs.started_on)
        if not inputs.started_on.by.options:
            del started_on["by"]["options"]  # versions without plugins do not know the field
        about["departure"] = started_on
    whole = json_text(about, indent=1).encode()
    if (folder / ABOUT).exists():
        raise JournalError(
            message("there is already a mission with this name"),
            where=str(folder),
            advice=message("continue it with fieldhand resume"),
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
        started_on=inputs.started_on,
    )


@dataclass(frozen=True, kw_only=True)
class FolderContents:
    """The contents of a mission's folder, each file read once, so that all decisions are based on the same bytes.

    Attributes:
        folder: Folder of the mission.
        about: Contents of mission.json.
        whole: Bytes of mission.json.
        files: Bytes of every file that mission.json names, checked against its SHA-256.
    """

    folder: Path
    about: Mapping[str, Any]
    whole: bytes
    files: Mapping[str, bytes]

    @property
    def signed(self) -> bytes | None:
        """Bytes of the signed mission that it came from; None for an unsigned one."""
        return self.files.get(_SIGNED)

    @property
    def started_on(self) -> RobotAtStart | None:
        """Robot on which the mission was begun; None for the simulation.

        Raises:
            JournalError: mission.json lacks it.
        """
        try:
            return _robot_at_start_of(self.about)
        except (KeyError, TypeError, ValueError) as error:
            raise _no_mission(self.folder, f"{ABOUT} lacks {error}") from None

    def mission(self, verify: Callable[[bytes, str], Bundle] | None = None) -> StoredMission:
        """Return the mission in the folder.

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
            # The signature is verified before any other file of the folder is parsed.
            bundle = verify(self.signed, str(folder / _SIGNED))
            require_signed(bundle, files, authorization, lenient=lenient, planner=planner, folder=folder)
            authorized, site, robot = bundle.authorized, bundle.site, bundle.robot
        else:
            authorized, site, robot = self._unsigned(authorization, site_file, lenient=lenient)
        world = files.get("world.yaml")
        if (counted := files.get(_EARLIER)) is not None:
            site = site.with_earlier(_counted(counted, authorized.task, folder))
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
            started_on=self.started_on,
        )

    def _unsigned(
        self, authorization: Authorization, site_file: str, *, lenient: bool
    ) -> tuple[AuthorizedTask, Site, RobotProfile]:
        """Return Task, site and robot in the folder of an unsigned mission.

        Raises:
            NotApprovedError: They are not the approved ones.
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


def _counted(data: bytes, task: Task, folder: Path) -> EarlierMissions:
    """Return the earlier missions that a run of a standing mission counts.

    Raises:
        NotApprovedError: The Task is not one of a standing mission.
        JournalError: The file is malformed.
    """
    if not isinstance(task.timing, Schedule):
        raise NotApprovedError(
            message("the mission's folder has other earlier missions than the approved Task"),
            where=str(folder),
            advice=message("run the Task as a new mission"),
        )
    try:
        return records_from_json(data)
    except TaskError as error:
        raise _no_mission(folder, f"{_EARLIER} {error.what}") from None


def read_folder(folder: Path) -> FolderContents:
    """Read the folder of a mission, each file once, and check each against its SHA-256 in mission.json.

    Raises:
        JournalError: The folder is not that of a mission, a file was changed, or other users can write to the folder.
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
        folder: Folder of the mission.
        verify: Opens a signed mission from its bytes and a name for messages, and verifies its signature
            (:func:`fieldhand.mission.open_bundle`); Task, site and robot are then those of the signed mission. None
            takes the folder's files without verification, which must not run in production.

    Raises:
        JournalError: The folder is not that of a mission, or a file was changed.
        NotApprovedError: A file is not the approved or the signed one.
        BundleError: The signed mission is damaged.
        NotTrustedError: Its key is not trusted here.
    """
    return read_folder(folder).mission(verify)


def _robot_at_start_of(about: Mapping[str, Any]) -> RobotAtStart | None:
    """Return the robot that mission.json names; None for a simulated mission.

    Raises:
        KeyError, TypeError, ValueError: The entry is missing or malformed.
    """
    if about["format"] != ON_ROBOT:
        return None
    entry = about["departure"]
    return RobotAtStart(by=Connection(**entry["by"]), charge_percent=float(entry["charge_percent"]))


def remove_folder(folder: Path) -> None:
    """Remove the folder of a mission.

    Raises:
        JournalError: It cannot be removed.
    """
    try:
        # mission.json goes first, so that a partly removed folder is no mission.
        (folder / ABOUT).unlink()
        shutil.rmtree(folder)
    except OSError as error:
        raise JournalError(
            message("the mission's folder cannot be removed: {why}", why=named(error.strerror or str(error), "reason")),
            where=str(folder),
            advice=message("remove what is left of it by hand"),
        ) from None


def read_about(folder: Path) -> tuple[dict[str, Any], bytes]:
    """Return the contents of mission.json, and its bytes.

    Raises:
        JournalError: The file is missing or malformed.
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
        raise _no_mission(folder, f"{ABOUT} is nested too deeply") from None
    if not isinstance(about, dict) or about.get("format") not in (FORMAT, ON_ROBOT):
        raise _no_mission(folder, f"{ABOUT} has not the format {FORMAT} or {ON_ROBOT} that this version reads")
    return about, whole


def read_kept(folder: Path, file: str, sha256: str) -> bytes:
    """Return the bytes of a file in the folder, checked against its SHA-256.

    Raises:
        JournalError: The file was changed or cannot be read.
    """
    path = folder / file
    if path.resolve() != folder.resolve() / file:
        raise _no_mission(folder, f"{file} points outside the folder")
    try:
        data = read_file(path, _MOST_BYTES, plain=True, look=lambda status: require_own_file(path, status))
    except Unguarded as fault:
        raise _unguarded(fault) from None
    except FileFault as fault:
        raise _no_mission(folder, f"{file} {fault.what}") from None
    if _sha256(data) != sha256:
        raise JournalError(
            message("{file} is not the file that the mission started with", file=file),
            where=str(folder),
            advice=message("restore the file, or run the Task as a new mission"),
        )
    return data


def _require_guarded(folder: Path) -> None:
    """Require that no other user can change or replace the folder of a mission.

    Raises:
        JournalError: Another user can.
        OSError: The folder may not be read.
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
        message("this is not a mission: {why}", why=why),
        where=str(folder),
        advice=message("give a folder that fieldhand run created"),
    )


def _sha256(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
