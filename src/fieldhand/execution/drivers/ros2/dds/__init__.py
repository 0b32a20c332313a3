"""ROS 2 over DDS without a ROS installation: the transport of the extra ``ros2-dds``.

Wire format of ROS 2's Cyclone DDS middleware (``rmw_cyclonedds``), verified against it:

- topics are ``rt/NAME``, requests ``rq/NAMERequest``, replies ``rr/NAMEReply``; types ``package::msg::dds_::Name_``;
- a request and its reply start with the client's id and the request's number, before the fields;
- the user data of a client's two endpoints carry its id (``clientid=``), those of a server ``serviceid=``: a reply is
  lost if it is sent before the server has discovered the client's reader;
- from Iron on, user data carry the hash of the type (``typehash=``);
- a message without fields has one byte.

``message_codec`` defines types and converts messages, ``qos`` and ``names`` convert quality of service and names,
``topics`` and ``services`` are the endpoints, ``discovery`` lists remote endpoints, ``transport`` combines them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldhand.errors import InputError

if TYPE_CHECKING:
    from fieldhand.execution.drivers.ros2.dds.transport import DdsTransport
    from fieldhand.execution.drivers.ros2.interfaces import Interfaces

__all__ = ["open_dds"]


def open_dds(interfaces: Interfaces, domain: int | None = None) -> DdsTransport:
    """Join a ROS 2 graph over DDS.

    Args:
        domain: DDS domain id; None for ``ROS_DOMAIN_ID`` of the environment, else 0.

    Raises:
        InputError: The domain id is invalid, or Cyclone DDS is not installed.
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
