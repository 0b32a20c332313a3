"""Parameters with which Nav2 loads the files of an export, as YAML for ``--params-file``.

Names are absolute, because the costmap filters of Humble and Jazzy look for relative ones below their own node. File
names are relative to the folder in which the servers are started.
"""

from __future__ import annotations

from typing import Any

import yaml

from fieldhand.robot.model import RobotProfile

#: Types of ``nav2_msgs/msg/CostmapFilterInfo``: keep-out, and a speed limit in m/s.
_KEEP_OUT, _SPEED_LIMIT_M_S = 0, 2

_HEADER = """\
# Parameters of Nav2 for the files in this folder. Start the servers here, or make the file names absolute.
# speed_filter is off where the robot's profile names a topic for the speed limit: Fieldhand limits the speed itself,
# and the filter lifts every limit on that topic where the robot leaves slow ground.
"""


class _WithoutAliases(yaml.SafeDumper):
    """A writer that repeats equal parts, since parameter files have no aliases."""

    def ignore_aliases(self, data: Any) -> bool:  # noqa: ARG002
        return True


def write_parameters(robot: RobotProfile, frame: str) -> bytes:
    """Return the parameters of the map server, the servers of the filters, the costmaps and the route server."""
    bindings = robot.ros2

    def whole(name: str) -> str:
        return f"/{name}" if bindings is None else bindings.whole_name(name)

    limit_topic = "" if bindings is None else bindings.navigation.speed_limit
    keepout = {
        "plugin": "nav2_costmap_2d::KeepoutFilter",
        "enabled": True,
        "filter_info_topic": whole("keepout_costmap_filter_info"),
    }
    speed = {
        "plugin": "nav2_costmap_2d::SpeedFilter",
        "enabled": not limit_topic,
        "filter_info_topic": whole("speed_costmap_filter_info"),
        "speed_limit_topic": whole(limit_topic or "speed_limit"),
    }
    masks = [
        ("keepout", _KEEP_OUT, 0.0, 1.0),
        ("speed", _SPEED_LIMIT_M_S, float(robot.speed_m_s), -float(robot.speed_m_s) / 100.0),
    ]
    servers = [
        f"{mask}_{server}" for mask, *_ in masks for server in ("filter_mask_server", "costmap_filter_info_server")
    ]
    nodes: dict[str, Any] = {"map_server": _node(yaml_filename="map.yaml", topic_name=whole("map"), frame_id=frame)}
    for mask, kind, base, multiplier in masks:
        topic = whole(f"{mask}_filter_mask")
        nodes[f"{mask}_filter_mask_server"] = _node(yaml_filename=f"{mask}.yaml", topic_name=topic, frame_id=frame)
        nodes[f"{mask}_costmap_filter_info_server"] = _node(
            type=kind,
            filter_info_topic=whole(f"{mask}_costmap_filter_info"),
            mask_topic=topic,
            base=base,
            multiplier=multiplier,
        )
    nodes["lifecycle_manager_filters"] = _node(autostart=True, node_names=servers)
    filters = ["keepout_filter", "speed_filter"]
    nodes["global_costmap"] = {"global_costmap": _node(filters=filters, keepout_filter=keepout, speed_filter=speed)}
    nodes["local_costmap"] = {"local_costmap": _node(filters=filters[:1], keepout_filter=keepout)}
    nodes["route_server"] = _node(graph_filepath="route.geojson", route_frame=frame, smooth_corners=False)
    text = yaml.dump(nodes, Dumper=_WithoutAliases, sort_keys=False, width=120)
    return (_HEADER + text).encode()


def _node(**parameters: Any) -> dict[str, Any]:
    return {"ros__parameters": parameters}
