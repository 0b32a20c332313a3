"""Cameras of the simulated robot: a drawn picture that names the place and the position of the robot."""

from __future__ import annotations

import io
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.protocol import Position
from fieldhand.execution.drivers.ros2.interfaces import Interfaces
from fieldhand.execution.drivers.ros2.transport import IMAGE_TYPES, Publisher, QosProfile, RosMessage, Transport
from fieldhand.robot.bindings import CallBinding, Ros2Bindings
from fieldhand.site.model import Place

if TYPE_CHECKING:
    from PIL import Image

#: Seconds between two images; size in pixels; quality of a JPEG.
_PERIOD_S, WIDTH, HEIGHT, _QUALITY = 0.5, 160, 120, 80
#: Colours of sky and ground, and height of the horizon.
_SKY, _GROUND, _HORIZON = (150, 190, 230), (110, 90, 60), 50


@dataclass
class _Camera:
    """A topic with images, and the time of its last one."""

    type: str
    publisher: Publisher
    sent_s: float = field(default=float("-inf"))


class CameraTopics:
    """Publishes the images that a profile binds to topics, as long as somebody subscribes to them.

    Args:
        transport: Its node.
        bindings: ROS 2 bindings of the robot.
        view: Returns the nearest place and the position of the robot.
        header: Returns a header with the current time.

    Raises:
        Ros2Error: A topic is bound with two types.
    """

    def __init__(
        self,
        transport: Transport,
        bindings: Ros2Bindings,
        *,
        view: Callable[[], tuple[Place, Position]],
        header: Callable[[], RosMessage],
    ) -> None:
        self._view, self._header = view, header
        self._cameras: dict[str, _Camera] = {}
        for bound in bindings.actions.values():
            for image in bound.images.values():
                topic = bindings.whole_name(image.topic)
                known = self._cameras.get(topic)
                if known is not None and known.type != image.type:
                    raise Ros2Error(f"{topic} is bound as {image.type} and as {known.type}")
                if known is None:
                    publisher = transport.publish(topic, image.type, QosProfile(reliable=True, depth=1))
                    self._cameras[topic] = _Camera(image.type, publisher)

    def step(self, now: float) -> None:
        """Publish what is due."""
        for camera in self._cameras.values():
            if now - camera.sent_s >= _PERIOD_S and camera.publisher.subscribers():
                camera.sent_s = now
                camera.publisher.send(self.message(camera.type))

    def message(self, type_name: str) -> RosMessage:
        """Return a message with what the camera sees now."""
        return {"header": self._header(), **picture_message(type_name, *self._view())}

    def answers(self, interfaces: Interfaces, call: CallBinding, answer: str) -> dict[str, object]:
        """Return the images of a call's reply by path.

        Args:
            answer: Type of the reply.

        Raises:
            Ros2Error: A path leads to something that is no image.
        """
        found: dict[str, object] = {}
        for path in call.images.values():
            kind = interfaces.field_at(answer, path).base
            if kind not in IMAGE_TYPES:
                raise Ros2Error(f"{path} of {answer} is a {kind}, which is no image")
            found[path] = self.message(kind)
        return found


def picture_message(type_name: str, place: Place, position: Position) -> RosMessage:
    """Return an image message that shows a place and a position."""
    picture = draw(place, position)
    if type_name == "sensor_msgs/msg/CompressedImage":
        out = io.BytesIO()
        picture.save(out, format="JPEG", quality=_QUALITY)
        return {"format": "jpeg", "data": out.getvalue()}
    return {
        "height": HEIGHT,
        "width": WIDTH,
        "encoding": "rgb8",
        "is_bigendian": 0,
        "step": 3 * WIDTH,
        "data": picture.tobytes(),
    }


def draw(place: Place, position: Position) -> Image.Image:
    """Draw a tree with its name and the position from which it is seen."""
    from PIL import Image, ImageDraw

    picture = Image.new("RGB", (WIDTH, HEIGHT), _SKY)
    pen = ImageDraw.Draw(picture)
    pen.rectangle((0, _HORIZON, WIDTH, HEIGHT), fill=_GROUND)
    if place.kind == "tree":
        middle = WIDTH // 2
        pen.rectangle((middle - 5, 45, middle + 5, 90), fill=(90, 60, 30))
        pen.ellipse((middle - 30, 8, middle + 30, 62), fill=(60, 130, 60))
    pen.text((4, 92), f"{place.kind} {place.id}"[:24], fill=(255, 255, 255))
    pen.text((4, 105), f"{position.lat:.6f} {position.lon:.6f}", fill=(255, 255, 255))
    return picture
