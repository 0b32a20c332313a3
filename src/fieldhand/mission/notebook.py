"""Reviews, runs and simulations as HTML for notebooks: a map, words and tables."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fieldhand.markup import element, list_html, picture_html, table_html
from fieldhand.site.drawing.notebook import figure_html

if TYPE_CHECKING:
    from fieldhand.mission.review_task import Review
    from fieldhand.mission.run import Run
    from fieldhand.mission.simulations import SimulatedQuantity, Simulations


def html_of_review(review: Review) -> str:
    """Return the map of a review, the plan in words, and its problems."""
    from fieldhand.approval.preview import plan_figure

    parts = [element("h4", review.task.command.request or review.task.id)]
    if review.estimate is not None:
        parts.append(figure_html(plan_figure(review.task, review.site, review.robot, review.estimate)))
        parts.append(element("pre", review.words))
    parts.append(list_html([f"{problem.severity}: {problem.line()}" for problem in review.problems]))
    return "".join(parts)


def html_of_run(run: Run) -> str:
    """Return how a run ended, its map, and the outcome of each goal."""
    from fieldhand.evaluation.report.maps import report_maps
    from fieldhand.evaluation.report.readings import summaries
    from fieldhand.wording.events import goal_names

    mission, spent = run.mission, run.result.spent
    drawn = report_maps(mission.site, run.events, summaries(mission.task, mission.robot, run.events)[:1])[0]
    name = goal_names(mission.task, mission.robot)
    ended = f"{run.status}{f' ({run.reason})' if run.reason else ''}"
    took = f"{spent.metres:.0f} m, {spent.seconds / 60:.1f} min, {spent.percent:.1f} % of the battery"
    return "".join(
        (
            element("h4", mission.task.command.request or mission.task.id),
            element("p", f"{ended}: {took}"),
            picture_html(drawn.svg, "image/svg+xml"),
            table_html(("goal", "outcome", "why"), [(name(o.goal), o.outcome, o.why) for o in run.outcomes]),
        )
    )


def html_of_simulations(runs: Simulations) -> str:
    """Return how many simulations succeeded, and quantiles of their figures."""
    quantities: dict[str, SimulatedQuantity] = {
        "distance, m": "travelled_m",
        "time, s": "seconds",
        "charge left, %": "charge_percent",
    }
    rows = [(label, *(f"{value:.1f}" for value in runs.quantiles(name))) for label, name in quantities.items()]
    done = f"{sum(run.success for run in runs)} of {len(runs)} simulations succeeded"
    return element("p", done) + table_html(("", "10 %", "median", "90 %"), rows)
