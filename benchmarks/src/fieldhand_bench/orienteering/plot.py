"""Plot the benchmark: reward against failures of each solver, one panel per graph, budget and failure probability."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fieldhand.errors import OutputError
from fieldhand_bench.orienteering.published import published_for
from fieldhand_bench.orienteering.run import SolverResult

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def plot(rows: Sequence[SolverResult], file: Path) -> None:
    """Plot the rows to a file; its suffix selects the format (png, svg, pdf).

    Raises:
        OutputError: The file cannot be written.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    graphs = list(dict.fromkeys(row.graph for row in rows))
    settings = list(dict.fromkeys((row.budget, row.failure_probability) for row in rows))
    solvers = list(dict.fromkeys(row.solver for row in rows))
    figure = Figure(figsize=(4.2 * max(2, len(graphs)), 3.6 * len(settings) + 0.8), layout="constrained")
    FigureCanvasAgg(figure)
    panels = figure.subplots(len(settings), len(graphs), squeeze=False)
    for across, setting in zip(panels, settings, strict=True):
        for panel, graph in zip(across, graphs, strict=True):
            mine = [r for r in rows if r.graph == graph and (r.budget, r.failure_probability) == setting]
            _draw(panel, graph, setting, mine, solvers)
        across[0].set_ylabel("mean reward of the missions within budget")
    shown = dict[str, Any]()
    for panel in panels.flat:
        shown |= {label: handle for handle, label in zip(*panel.get_legend_handles_labels(), strict=True)}
    figure.legend(shown.values(), shown.keys(), loc="outside lower center", ncols=5, fontsize="small")
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(file)
    except (OSError, ValueError) as error:
        raise OutputError(f"the plot cannot be written: {error}", where=str(file)) from error


def _draw(
    panel: Axes, graph: str, setting: tuple[float, float], rows: Sequence[SolverResult], solvers: Sequence[str]
) -> None:
    budget, chance = setting
    for row in rows:
        low, high = row.failures_interval
        panel.errorbar(
            100 * row.failures, row.reward,
            xerr=[[100 * (row.failures - low)], [100 * (high - row.failures)]],
            yerr=(row.reward_interval[1] - row.reward_interval[0]) / 2,
            fmt="o", capsize=2, color=f"C{solvers.index(row.solver)}", label=row.solver,
        )  # fmt: skip
    for other, marker in zip(published_for(graph, budget, chance), "x+*", strict=False):
        panel.plot(100 * other.failures, other.reward, marker, color="0.4", label=f"published: {other.solver}")
    panel.axvline(100 * chance, color="0.7", linestyle="--", linewidth=1)
    panel.set(title=f"{graph}, B = {budget:g}, Pf = {chance:g}", xlabel="missions over budget, %")
    panel.set_ylim(0.0, 1.06 * panel.get_ylim()[1])
