"""The benchmark itself: figures that can be recomputed, the same on every engine, and a picture of them."""

import json
from contextlib import contextmanager

import numpy as np
import pytest

from fieldhand.errors import FieldhandError, ProblemError
from fieldhand_bench.orienteering.engine import spread
from fieldhand_bench.orienteering.graphs import BenchmarkGraph, load_graphs
from fieldhand_bench.orienteering.plot import plot
from fieldhand_bench.orienteering.published import published_for
from fieldhand_bench.orienteering.run import run, wilson
from fieldhand_bench.orienteering.solvers import Options

OPTIONS = Options(missions=10)


def graph(n=10, seed=1):
    rng = np.random.default_rng(seed)
    return BenchmarkGraph(name=f"random{n}", xy=tuple(map(tuple, rng.random((n, 2)))), reward=tuple(rng.random(n)))


def rows(trials=60, solvers=("online", "fixed"), **where):
    return list(
        run([graph()], budget=2.0, failure_probability=0.1, trials=trials, solvers=solvers, options=OPTIONS, **where)
    )


def figures(found):
    return [(r.graph, r.solver, r.trials, r.reward, r.reward_over_all, r.failures) for r in found]


@contextmanager
def cluster():
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address="127.0.0.1:0", silence_logs=50
    ) as made:
        yield made.scheduler_address.removeprefix("tcp://")


def test_a_row_says_what_its_missions_did():
    online, fixed = rows(jobs=1)
    assert (online.solver, fixed.solver) == ("online", "fixed")
    for row in (online, fixed):
        assert row.trials == 60
        assert row.reward_interval[0] <= row.reward <= row.reward_interval[1]
        assert row.reward_over_all == pytest.approx(row.reward * (1.0 - row.failures))
        assert row.failures_interval[0] <= row.failures <= row.failures_interval[1]
        assert 0.0 <= row.median_ms <= row.p99_ms
        assert row.peak_mb > 10.0
    # Who stops wherever a fixed route does collects the same in every mission that keeps to the budget.
    assert fixed.reward_interval[1] - fixed.reward_interval[0] == pytest.approx(0.0, abs=1e-9)


def test_processes_of_this_machine_give_the_figures_of_one_process():
    assert figures(rows(jobs=2)) == figures(rows(jobs=1))


def test_a_dask_cluster_of_real_workers_gives_the_figures_of_one_process():
    with cluster() as address:
        assert figures(rows(engine=f"dask://{address}")) == figures(rows(jobs=1))


@pytest.mark.parametrize("engine", ["slurm", "dask://", "dask://nowhere", "dask://127.0.0.1:1"])
def test_an_engine_that_is_not_there_is_refused(engine, monkeypatch):
    monkeypatch.setattr("fieldhand_bench.orienteering.engine._CONNECT_S", 1)
    with pytest.raises(ProblemError):
        spread(abs, [1], engine)


def test_wilson_is_wider_for_fewer_trials_and_holds_the_part():
    assert wilson(0.1, 1000)[0] == pytest.approx(0.0829, abs=1e-3)
    assert wilson(0.1, 1000)[1] == pytest.approx(0.1202, abs=1e-3)
    assert wilson(0.0, 50) == (0.0, pytest.approx(0.0714, abs=1e-3))


def test_published_rows_are_there_for_their_setting_only():
    assert [p.reward for p in published_for("graph40", 2.0, 0.1)] == [5.785, 2.710, 8.843]
    assert published_for("graph40", 3.0, 0.1) == published_for("graph41", 2.0, 0.1) == ()


@pytest.mark.parametrize("ending", ["png", "svg"])
def test_the_plot_is_a_picture(tmp_path, ending):
    file = tmp_path / f"bench.{ending}"
    plot(rows(trials=20, solvers=("fixed", "greedy"), jobs=1), file)
    assert file.read_bytes()[:5] in {b"\x89PNG\r", b"<?xml"}


def test_a_plot_of_an_unknown_kind_is_refused(tmp_path):
    with pytest.raises(FieldhandError, match="plot"):
        plot(rows(trials=2, solvers=("fixed",), jobs=1), tmp_path / "bench.nothing")


def test_graphs_come_in_the_order_of_their_size(tmp_path):
    for n in (12, 3):
        (tmp_path / f"{100 - n}.json").write_text(graph(n).model_dump_json())
    assert [len(g.xy) for g in load_graphs(tmp_path)] == [3, 12]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("{", "no JSON"),
        ("[]", "no graph"),
        ('{"name": "g", "xy": [[0, "a"]], "reward": [1]}', "xy.0.1"),
        ('{"name": "g", "reward": [1]}', "xy"),
    ],
)
def test_a_file_that_is_no_graph_is_refused_with_its_name(tmp_path, text, says):
    file = tmp_path / "broken.json"
    file.write_text(text)
    with pytest.raises(ProblemError, match=says) as error:
        load_graphs(tmp_path)
    assert "broken.json" in str(error.value)


@pytest.mark.parametrize(
    "changes", [{"reward": (1.0,)}, {"reward": (0.0, float("nan"), 0.0)}, {"end": 9}, {"xy": ()}, {"alpha": 2.0}]
)
def test_a_graph_that_is_no_problem_is_refused(changes):
    values = {"name": "g", "xy": ((0, 0), (1, 0), (2, 0)), "reward": (0.0, 1.0, 0.0)} | changes
    with pytest.raises(ProblemError):
        BenchmarkGraph(**values).problem(3.0, 0.1)


def test_no_graphs_are_said_to_be_none(tmp_path):
    with pytest.raises(ProblemError, match="no graphs"):
        load_graphs(tmp_path)


def test_a_graph_survives_its_file(tmp_path):
    file = tmp_path / "g.json"
    file.write_text(json.dumps(graph(5).model_dump()))
    assert load_graphs(file) == (graph(5),)
