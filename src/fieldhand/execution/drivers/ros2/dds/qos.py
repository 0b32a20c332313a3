"""Quality of service in the words of DDS, and back."""

from __future__ import annotations

from cyclonedds.core import Policy, Qos
from cyclonedds.util import duration

from fieldhand.execution.drivers.ros2.dds.names import UserData
from fieldhand.execution.drivers.ros2.transport import QosProfile

#: A writer waits that long for room, then the message is lost, as on any network.
_BLOCKS_MS = 100


def to_dds_qos(qos: QosProfile, user_data: UserData) -> Qos:
    """What an endpoint offers or asks for.

    Args:
        said: What it says of itself.
    """
    reliable = Policy.Reliability.Reliable(duration(milliseconds=_BLOCKS_MS))
    return Qos(
        reliable if qos.reliable else Policy.Reliability.BestEffort,
        Policy.Durability.TransientLocal if qos.transient else Policy.Durability.Volatile,
        Policy.History.KeepLast(qos.depth),
        # ROS writes the first version of the encoding, and what asks for the second never meets it.
        Policy.DataRepresentation(use_cdrv0_representation=True),
        Policy.WriterDataLifecycle(autodispose=False),
        Policy.Userdata(data=user_data.encoded()),
    )


def from_dds_qos(qos: Qos) -> QosProfile:
    """What another endpoint offers or asks for; the depth is its own matter, and mostly not told."""
    keeps = Policy.History in qos and isinstance(qos[Policy.History], Policy.History.KeepLast)
    return QosProfile(
        reliable=Policy.Reliability in qos and isinstance(qos[Policy.Reliability], Policy.Reliability.Reliable),
        transient=Policy.Durability in qos and qos[Policy.Durability] != Policy.Durability.Volatile,
        depth=qos[Policy.History].depth if keeps else 1,
    )


def user_data_of(qos: Qos) -> UserData:
    """What another endpoint says of itself."""
    return UserData.parse(bytes(qos[Policy.Userdata].data)) if Policy.Userdata in qos else UserData()
