"""Folder in which the images of a mission are saved.

Files are named by what this program counts and knows, never by what a message says. Each is written whole, so that a
power cut leaves no half, and before the capture counts as done.
"""

from __future__ import annotations

import hashlib
import re
import shutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from fieldhand.execution.drivers.protocol import CapturedImage
from fieldhand.execution.images.metadata import ImageFacts, with_metadata
from fieldhand.files import write_whole
from fieldhand.language import message
from fieldhand.robot.camera import Camera
from fieldhand.robot.model import RobotProfile
from fieldhand.task.results import ImageFile

#: Name of the folder, below that of the mission.
IMAGES = "images"
#: Bytes that must remain free on the disk, so that the mission's own journal has space.
LEAST_FREE = 500_000_000
_ENDINGS = {"png": "png", "jpeg": "jpg", "tiff": "tif"}
_PLAIN = re.compile(r"[A-Za-z0-9_-]{1,60}")


def free_bytes(folder: Path) -> int:
    """Return the free bytes of the disk of a folder.

    Raises:
        OSError: The disk fails.
    """
    return shutil.disk_usage(folder).free


@dataclass(frozen=True, kw_only=True)
class ImageFolder:
    """The folder of a mission's images.

    Attributes:
        mission_folder: Folder of the mission, which exists; images lie in :data:`IMAGES` below it.
        mission, robot: Id of the mission's Task and name of the robot, for the metadata.
        cameras: Camera of each action whose side is known, for the direction of its images.
        least_free: Bytes that must remain free; with less, images are not saved.
        free: Returns the free bytes of a folder's disk.
    """

    mission_folder: Path
    mission: str = ""
    robot: str = ""
    cameras: Mapping[str, Camera] = field(default_factory=dict)
    least_free: int = LEAST_FREE
    free: Callable[[Path], int] = free_bytes

    @classmethod
    def of(cls, mission_folder: Path, mission: str, robot: RobotProfile) -> ImageFolder:
        """Return the folder of a mission that a robot carries out."""
        cameras = {name: action.camera for name, action in robot.doable.items() if action.camera is not None}
        return cls(mission_folder=mission_folder, mission=mission, robot=robot.name, cameras=cameras)

    def save(self, image: CapturedImage, facts: ImageFacts) -> ImageFile:
        """Save an image; without space, or if the disk fails, the result says why it was not."""
        name = "-".join([f"{facts.number:05d}", *([facts.node] if _PLAIN.fullmatch(facts.node) else []), image.name])
        file = f"{IMAGES}/{name}.{_ENDINGS[image.format]}"
        facts = replace(facts, camera=self.cameras.get(facts.action))
        try:
            data = with_metadata(image, facts, self.mission, self.robot)
            (self.mission_folder / IMAGES).mkdir(mode=0o755, exist_ok=True)
            free = self.free(self.mission_folder)
            if free - len(data) < self.least_free:
                least = f"{self.least_free / 1e6:.0f}"
                return unsaved(
                    image,
                    message(
                        "images are not saved: less than {least} MB are free on the disk", context="log", least=least
                    ),
                )
            write_whole(self.mission_folder / file, data, mode=0o644)
        except (OSError, RuntimeError, ValueError) as error:
            why = (error.strerror if isinstance(error, OSError) else None) or type(error).__name__
            return unsaved(image, message("images are not saved: {why}", context="log", why=why))
        return ImageFile(
            name=image.name,
            file=file,
            sha256=hashlib.sha256(data).hexdigest(),
            bytes=len(data),
            width=image.width,
            height=image.height,
            encoding=image.encoding,
        )


def save_image(folder: ImageFolder | None, image: CapturedImage, facts: ImageFacts) -> ImageFile:
    """Save an image in a folder; without one the result says that it was not saved."""
    if folder is None:
        return unsaved(image, message("images are not saved: the mission has no folder", context="log"))
    return folder.save(image, facts)


def unsaved(image: CapturedImage, what: str) -> ImageFile:
    """Return the record of an image that was not saved, with the reason."""
    return ImageFile(name=image.name, width=image.width, height=image.height, encoding=image.encoding, what=what)
