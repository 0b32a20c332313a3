"""Run trials in this process, in several processes of this machine (joblib), or on a Dask cluster."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from fieldhand.errors import ProblemError

T = TypeVar("T")
TaskFunction = Callable[[Any], T]

_DASK = "dask://"
_CONNECT_S = 15


def spread(work: TaskFunction[T], pieces: Sequence[Any], engine: str = "local", jobs: int = -1) -> list[T]:
    """Call a function with each piece and return the results, in the order of the pieces.

    Args:
        work: Function at module level.
        pieces: Arguments of the calls; they and the results must be picklable.
        engine: ``local``, or ``dask://HOST:PORT`` of a scheduler.
        jobs: Number of local processes; -1 for one per processor, 1 for this process alone.

    Raises:
        ProblemError: The engine is unknown, or the cluster does not answer.
    """
    if engine == "local":
        from joblib import Parallel, delayed

        return list(Parallel(n_jobs=jobs)(delayed(work)(piece) for piece in pieces))
    if not engine.startswith(_DASK) or ":" not in engine[len(_DASK) :]:
        raise ProblemError(f"no engine is called '{engine}'", advice="use local or dask://HOST:PORT")
    try:
        from distributed import Client
    except ImportError as error:
        raise ProblemError(
            "Dask is not installed", advice='install it with: pip install "fieldhand-bench[dask]"'
        ) from error
    try:
        client = Client(f"tcp://{engine[len(_DASK) :]}", timeout=_CONNECT_S)  # type: ignore[no-untyped-call]
    except (OSError, ValueError) as error:
        raise ProblemError("the Dask scheduler does not answer", where=engine, advice="is it running?") from error
    with client:
        return list(client.gather(client.map(work, pieces, pure=False)))  # type: ignore[no-untyped-call]
