"""Topic endpoints over DDS."""

from __future__ import annotations

from typing import Any

from cyclonedds.core import DDSException
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader

from fieldhand.errors import Ros2Error
from fieldhand.execution.drivers.ros2.dds.message_codec import MessageCodec, Unreadable
from fieldhand.execution.drivers.ros2.transport import RosMessage


def samples(reader: Any, most: int) -> list[Any]:
    """Return the received valid samples; skips notifications that a writer has gone."""
    return [s for s in reader.take(N=most) if s.sample_info.valid_data and not isinstance(s, Unreadable)]


def write(writer: Any, sample: Any) -> None:
    """Send a sample. It is dropped if the reader is too slow; callers that expect a reply have a time limit.

    Raises:
        Ros2Error: DDS rejects the sample.
    """
    try:
        writer.write(sample)
    except DDSException as error:
        if error.code != DDSException.DDS_RETCODE_TIMEOUT:
            raise Ros2Error("DDS does not send this message", advice="check if it is larger than 32 MiB") from error


def close(*entities: Any) -> None:
    """Remove endpoints from the network now instead of at garbage collection."""
    for entity in entities:
        entity.__del__()


class DdsSubscription:
    """A :class:`~fieldhand.execution.drivers.ros2.transport.Subscription` over DDS."""

    def __init__(self, codec: MessageCodec, message: str, reader: DataReader[Any], depth: int) -> None:
        self._codec, self._message, self._reader, self._depth = codec, message, reader, depth
        self.open = True

    def take(self) -> tuple[RosMessage, ...]:
        if not self.open:
            return ()
        taken = samples(self._reader, self._depth)
        return tuple(self._codec.decode(self._message, sample) for sample in taken)

    def publishers(self) -> int:
        return len(self._reader.get_matched_publications()) if self.open else 0

    def close(self) -> None:
        if self.open:
            self.open = False
            close(self._reader)


class DdsPublisher:
    """A :class:`~fieldhand.execution.drivers.ros2.transport.Publisher` over DDS."""

    def __init__(self, codec: MessageCodec, message: str, writer: DataWriter[Any]) -> None:
        self._codec, self._message, self._writer = codec, message, writer
        self.open = True

    def send(self, message: RosMessage) -> None:
        sample = self._codec.encode(self._message, message)
        if self.open:
            write(self._writer, sample)

    def subscribers(self) -> int:
        return len(self._writer.get_matched_subscriptions()) if self.open else 0

    def close(self) -> None:
        if self.open:
            self.open = False
            close(self._writer)
