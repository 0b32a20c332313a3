"""``fieldhand bench orienteering`` says what the benchmark found; how long anything takes is never tested."""

import json

import numpy as np
import pytest

from support.processes.command import fieldhand


@pytest.fixture(scope="module")
def graphs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("graphs")
    rng = np.random.default_rng(2)
    (folder / "graph20.json").write_text(
        json.dumps({"name": "graph20", "xy": rng.random((8, 2)).tolist(), "reward": rng.random(8).tolist()})
    )
    return str(folder)


def bench(graphs, *words):
    return fieldhand(
        "bench", "orienteering", "--graphs", graphs, "--trials", "20", "--learn", "5", "--jobs", "1", *words
    )


def test_the_record_has_a_row_for_each_solver_and_setting_and_the_published_ones(graphs, tmp_path):
    picture = tmp_path / "p.png"
    made = bench(
        graphs, "--budget", "2", "--budget", "3", "--solvers", "online,fixed", "--json", "--plot", str(picture)
    )
    assert made.status == 0, made.err
    record = json.loads(made.out)
    assert [(r["solver"], r["budget"]) for r in record["rows"]] == [
        ("online", 2.0), ("fixed", 2.0), ("online", 3.0), ("fixed", 3.0),
    ]  # fmt: skip
    assert all(0.0 <= r["failures"] <= 1.0 and r["trials"] == 20 for r in record["rows"])
    assert {p["solver"] for p in record["published"]} == {"GNN tree search", "language model", "MILP 10 min"}
    assert "cpu" in record["machine"]
    assert picture.stat().st_size > 1000


def test_the_table_shows_every_solver_and_the_published_rows(graphs):
    made = bench(graphs, "--solvers", "greedy,fixed")
    assert made.status == 0, made.err
    for word in ("greedy", "fixed", "MILP 10 min*", "GNN tree search*", "graph20", "published"):
        assert word in made.out


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--solvers", "oracle"), "no solver is called 'oracle'"),
        (("--pf", "0"), "failure probability"),
        (("--pf", "1.5"), "failure probability"),
        (("--budget", "0.000001"), "direct way"),
        (("--budget", "nan"), "budget"),
        (("--engine", "slurm"), "no engine"),
    ],
)
def test_what_cannot_be_run_is_one_line_and_status_two(graphs, words, says):
    made = bench(graphs, *words)
    assert made.status == 2
    assert says in made.err
    assert "Traceback" not in made.err


def test_a_folder_without_graphs_is_said_to_be_so(tmp_path):
    made = bench(str(tmp_path))
    assert made.status == 2
    assert "no graphs" in made.err
