"""Launch file that starts the node ``executor`` and brings it to the requested lifecycle state.

ros2 launch fieldhand_ros executor.launch.py mission:=/path/tree4.mission robot:=husky
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, EmitEvent, RegisterEventHandler
from launch.conditions import IfCondition
from launch.events import matches_action
from launch.substitutions import LaunchConfiguration, PythonExpression
from launch_ros.actions import LifecycleNode
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState
from launch_ros.parameter_descriptions import ParameterValue
from lifecycle_msgs.msg import Transition

#: Name, default, description.
ARGUMENTS = (
    ("mission", "", "Path of the signed mission; empty to set the parameter later."),
    ("robot", "", "Profile of this robot: a built-in name or a YAML file."),
    ("missions", "", "Folder of its missions; by default in the user's state folder."),
    ("config", "", "Folder of trusted keys; by default FIELDHAND_CONFIG or the user's."),
    ("robot_namespace", "", "Namespace of the robot, in place of the profile's; / for none."),
    ("seed", "0", "Random seed of the guard."),
    ("go_on", "false", "Continue automatically a mission that a power cut has interrupted."),
    ("use_sim_time", "false", "The robot is a simulation that publishes /clock."),
    ("namespace", "", "Namespace of this node."),
    ("until", "active", "Target state: unconfigured, inactive or active. It never starts a mission."),
)
KINDS = {"seed": int, "go_on": bool, "use_sim_time": bool}


def generate_launch_description() -> LaunchDescription:
    """Return the launch description; called by ``ros2 launch``."""
    given = {name: LaunchConfiguration(name) for name, _, _ in ARGUMENTS}
    parameters = {
        name: ParameterValue(value, value_type=KINDS.get(name, str))
        for name, value in given.items()
        if name not in ("namespace", "until")
    }
    node = LifecycleNode(
        package="fieldhand_ros",
        executable="executor",
        name="executor",
        namespace=given["namespace"],
        parameters=[parameters],
        output="screen",
    )

    def change(transition: int, condition: IfCondition | None = None) -> EmitEvent:
        event = ChangeState(lifecycle_node_matcher=matches_action(node), transition_id=transition)
        return EmitEvent(event=event, condition=condition)

    def wanted(*ends: str) -> IfCondition:
        return IfCondition(PythonExpression(["'", given["until"], f"' in {ends!r}"]))

    configured = OnStateTransition(
        target_lifecycle_node=node,
        start_state="configuring",
        goal_state="inactive",
        entities=[change(Transition.TRANSITION_ACTIVATE)],
    )
    return LaunchDescription(
        [
            *(DeclareLaunchArgument(name, default_value=value, description=text) for name, value, text in ARGUMENTS),
            RegisterEventHandler(configured, condition=wanted("active")),
            node,
            change(Transition.TRANSITION_CONFIGURE, wanted("active", "inactive")),
        ]
    )
