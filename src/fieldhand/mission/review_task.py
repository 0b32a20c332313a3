"""Review a Task: every check, the forecast, and the plan in words."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from fieldhand.errors import NotApprovedError
from fieldhand.mission.seeds import checked_seed
from fieldhand.robot.model import RobotProfile
from fieldhand.short_repr import short_repr
from fieldhand.site.model import Site
from fieldhand.task.frames import Task

if TYPE_CHECKING:
    from fieldhand.approval.checks import Examination, PlanProblem
    from fieldhand.approval.readback import ReadBack
    from fieldhand.forecast.estimate import Estimate


@dataclass(frozen=True, kw_only=True, repr=False)
class Review:
    """The review of a Task, for an operator to read before approving it.

    Attributes:
        examination: Problems and forecast, for one Task, site and robot.
        read_back: The plan in words; None if the mission cannot be forecast.
    """

    examination: Examination
    read_back: ReadBack | None

    __repr__ = short_repr

    @property
    def task(self) -> Task:
        """The Task that was reviewed."""
        return self.examination.task

    @property
    def site(self) -> Site:
        """The site it was reviewed for."""
        return self.examination.site

    @property
    def robot(self) -> RobotProfile:
        """The robot it was reviewed for."""
        return self.examination.robot

    @property
    def problems(self) -> tuple[PlanProblem, ...]:
        """Every problem found, errors first."""
        return self.examination.problems

    @property
    def estimate(self) -> Estimate | None:
        """Forecast of distance, time and energy on every branch; None if the mission cannot be forecast."""
        return self.examination.estimate

    @property
    def errors(self) -> tuple[PlanProblem, ...]:
        """The problems that forbid approval."""
        return self.examination.errors

    @property
    def warnings(self) -> tuple[str, ...]:
        """The warnings to be confirmed, each as a message: :func:`authorize` takes them in the language shown."""
        return tuple(p.line() for p in self.problems if p.severity == "warning")

    @property
    def words(self) -> str:
        """The plan in words, a line each, as an operator reads it; empty if the mission cannot be forecast."""
        return "" if self.read_back is None else "\n".join(str(line) for line in self.read_back.text_lines())

    def words_in(self, language: str) -> str:
        """Return :attr:`words` in another language.

        Args:
            language: Code of the language, such as ``es``.

        Raises:
            InputError: There is no catalogue for this language.
        """
        from fieldhand.language import open_language

        say = open_language(language).say
        return "" if self.read_back is None else "\n".join(say(line) for line in self.read_back.text_lines())

    def save_map(self, path: str | Path, *, language: str = "en") -> None:
        """Draw the map of the plan: the drives of the first branch, and what the others add.

        Args:
            path: PNG file.
            language: Code of the language of its labels.

        Raises:
            NotApprovedError: The mission cannot be forecast; the error names its problems.
            OutputError: The file cannot be written.
            InputError: There is no catalogue for this language.
        """
        from fieldhand.approval.preview import save_map
        from fieldhand.language import open_language

        spoken = open_language(language)
        if self.estimate is None:
            problems = "; ".join(spoken.say(p.line()) for p in self.errors)
            raise NotApprovedError(f"there is no map of a mission that cannot be driven: {problems}", where=str(path))
        save_map(self.task, self.site, self.robot, self.estimate, Path(path), spoken)

    def _repr_html_(self) -> str:
        """Return map, words and problems for a notebook."""
        from fieldhand.mission.notebook import html_of_review

        return html_of_review(self)


def review(
    task: Task,
    site: Site,
    robot: RobotProfile,
    *,
    seed: int = 0,
    document: bytes | None = None,
    charge_percent: float = 100.0,
) -> Review:
    """Check a Task, forecast it and put it into words.

    Args:
        task: The Task.
        site: Site it is to be approved for.
        robot: Robot it is to be approved for.
        seed: Seed of the forecast.
        document: The bytes that the Task was read from, if it was read.
        charge_percent: Charge at the beginning, in percent of a full battery.

    Raises:
        InputError: The seed is negative, or not a whole number.
    """
    from fieldhand.approval.checks import examine
    from fieldhand.approval.readback import read_back

    found = examine(task, site, robot, document=document, seed=checked_seed(seed), charge_percent=charge_percent)
    words = None if found.estimate is None else read_back(task, site, robot, found.estimate)
    return Review(examination=found, read_back=words)
