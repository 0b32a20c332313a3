"""The steps of a mission, one function each, for the command line, the API, the web page and Python programs.

request ──plan──▶ Task ──review──▶ Review ──authorize──▶ ApprovedMission ──carry_out──▶ Run ──report──▶ files
"""

from fieldhand.mission.approve import ApprovedMission, approved_earlier, authorize
from fieldhand.mission.documents import admit_bundle, decode_task, import_tree, open_bundle, read_task
from fieldhand.mission.execute import carry_out, check_world, read_world, simulate
from fieldhand.mission.inspect_bundle import BundleInspection, UnverifiedBundle, inspect_bundle, read_unverified
from fieldhand.mission.plan_request import Plan, make_planner, plan, transcript_path
from fieldhand.mission.review_task import Review, review
from fieldhand.mission.run import Assessment, Run, assess, report
from fieldhand.mission.sign import sign
from fieldhand.mission.simulations import Simulation, Simulations, fly_many
from fieldhand.mission.task_builder import build_task

__all__ = [
    "ApprovedMission",
    "Assessment",
    "BundleInspection",
    "Plan",
    "Review",
    "Run",
    "Simulation",
    "Simulations",
    "UnverifiedBundle",
    "admit_bundle",
    "approved_earlier",
    "assess",
    "authorize",
    "build_task",
    "carry_out",
    "check_world",
    "decode_task",
    "fly_many",
    "import_tree",
    "inspect_bundle",
    "make_planner",
    "open_bundle",
    "plan",
    "read_task",
    "read_unverified",
    "read_world",
    "report",
    "review",
    "sign",
    "simulate",
    "transcript_path",
]
