"""ROS 2 over DDS, with no ROS installed: the transport of the extra ``ros2-dds``.

What ROS 2's middleware on Cyclone DDS (``rmw_cyclonedds``) puts on the wire, measured against it:

- topics are ``rt/NAME``, requests ``rq/NAMERequest``, replies ``rr/NAMEReply``; types ``package::msg::dds_::Name_``;
- a request and its reply begin with the client's number and the request's number, before the fields;
- a client says who it is in the user data of its two endpoints (``clientid=``), a server likewise (``serviceid=``):
  a reply gets lost if it is sent before the server has found the client's reader;
- from Iron on, user data say the hash of the type (``typehash=``);
- a message without fields has one byte.

``codec`` makes types, ``qos`` and ``names`` translate, ``topics`` and ``services`` are the endpoints, ``discovery``
is what the others have, ``transport`` puts them together.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldhand.errors import InputError

if TYPE_CHECKING:
    from fieldhand.execution.drivers.ros2.dds.transport import DdsTransport
    from fieldhand.execution.drivers.ros2.interfaces import Interfaces

__all__ = ["open_dds"]


def open_dds(interfaces: Interfaces, domain: int | None = None) -> DdsTransport:
    """Join a ROS 2 graph.

    Args:
        domain: Of DDS; None means ``ROS_DOMAIN_ID`` of the environment, else 0.

    Raises:
        InputError: The domain is none, or what speaks DDS is not installed.
        Ros2Error: The network cannot be used.
    """
    try:
        from fieldhand.execution.drivers.ros2.dds.transport import DdsTransport
    except ImportError as error:
        raise InputError(
            "DDS is not installed here",
            advice='install it with: pip install "fieldhand[ros2-dds]"; there is no package of it for a Jetson: '
            "it is reached by rclpy from there",
        ) from error
    return DdsTransport(interfaces, domain)
