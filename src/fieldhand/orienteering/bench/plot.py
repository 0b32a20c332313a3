"""The benchmark as a picture: reward of each solver by its failures, one panel a graph."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from fieldhand.errors import OutputError
from fieldhand.orienteering.bench.published import published_for
from fieldhand.orienteering.bench.run import Row


def plot(rows: Sequence[Row], file: Path) -> None:
    """Draw the rows to a file of the kind that its ending says (png, svg, pdf).

    Raises:
        OutputError: The file cannot be written.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    graphs = list(dict.fromkeys(row.graph for row in rows))
    solvers = list(dict.fromkeys(row.solver for row in rows))
    figure = Figure(figsize=(4.2 * len(graphs) + 1.6, 4.4), layout="constrained")
    FigureCanvasAgg(figure)
    panels = figure.subplots(1, len(graphs), squeeze=False)[0]
    for panel, graph in zip(panels, graphs, strict=True):
        mine = [row for row in rows if row.graph == graph]
        for row in mine:
            low, high = row.failures_interval
            panel.errorbar(
                100 * row.failures, row.reward,
                xerr=[[100 * (row.failures - low)], [100 * (high - row.failures)]],
                yerr=(row.reward_interval[1] - row.reward_interval[0]) / 2,
                fmt="o", capsize=2, color=f"C{solvers.index(row.solver)}", label=row.solver,
            )  # fmt: skip
        first = mine[0]
        others = published_for(graph, first.budget, first.failure_probability)
        for other, marker in zip(others, "x+*", strict=False):
            panel.plot(100 * other.failures, other.reward, marker, color="0.4", label=f"published: {other.solver}")
        panel.axvline(100 * first.failure_probability, color="0.7", linestyle="--", linewidth=1)
        panel.set(title=f"{graph}, B = {first.budget:g}", xlabel="missions over budget, %")
        panel.set_ylim(bottom=0.0)
    panels[0].set_ylabel("mean reward of the missions within budget")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside right center", fontsize="small")
    try:
        figure.savefig(file)
    except (OSError, ValueError) as error:
        raise OutputError(f"the plot cannot be written: {error}", where=str(file)) from error
