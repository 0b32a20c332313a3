"""The exceptions of Fieldhand, in one hierarchy.

    FieldhandError                  exit status 1: the mission or a check failed
    ├── InputError                  exit status 2: an input is unusable
    │   ├── RequestError            request text
    │   ├── SiteError               site file
    │   ├── ProfileError            robot profile
    │   ├── TaskError               Task document: XML, schema, or consistency
    │   ├── WorldError              world file of a simulation
    │   ├── CaseError               file of test cases: requests with their expected plans
    │   ├── BundleError             mission bundle: container, signature, manifest, or content
    │   ├── KeyFileError            key: missing file, permissions, or passphrase
    │   ├── PlaceError              selector that cannot be resolved on this site
    │   │   └── NoPlaceError        selector that matches nothing on this site
    │   ├── OutputError             file or folder that cannot be written
    │   │   ├── JournalError        folder or journal of a mission that cannot be continued
    │   │   ├── StoreError          queue of missions: the robot's store or the sender's outbox
    │   │   └── DatabaseError       database of the server
    │   ├── ProblemError            orienteering problem: inconsistent or without a solution
    │   ├── ModelError              language model: key, endpoint, or answer
    │   └── PluginError             extension of another distribution
    ├── NotApprovedError            failed check, or approval denied
    │   ├── NotConfirmedError       unconfirmed warnings
    │   └── NotTrustedError         unsigned mission, or unknown or revoked signing key
    ├── DeliveryError               failed transfer of a mission to a robot
    │   └── UnreachableError        temporary; a later attempt may succeed
    └── ExecutionError              failure of the robot
        ├── Ros2Error               unreachable over ROS 2, or inconsistent with its profile
        ├── DriveFault              leg that cannot be driven
        │   ├── BlockedFault        no way left around the blockages that the robot found
        │   │   └── OccupiedFault   obstacle where the robot would stand
        │   └── LostFault           unknown position
        └── ActionFault             failed action or sensor

A message states the problem, its location and a remedy. ``exit_status`` is the exit status of the command line.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from fieldhand.hidden_characters import visible

__all__ = [
    "ActionFault",
    "BlockedFault",
    "BundleError",
    "CaseError",
    "DatabaseError",
    "DeliveryError",
    "DriveFault",
    "ExecutionError",
    "FieldhandError",
    "InputError",
    "JournalError",
    "KeyFileError",
    "LostFault",
    "ModelError",
    "NoPlaceError",
    "NotApprovedError",
    "NotConfirmedError",
    "NotTrustedError",
    "OccupiedFault",
    "OutputError",
    "PlaceError",
    "PluginError",
    "ProblemError",
    "ProfileError",
    "RequestError",
    "Ros2Error",
    "SiteError",
    "StoreError",
    "TaskError",
    "UnreachableError",
    "WorldError",
    "few",
]


#: Maximum length in characters of an error's description or advice, and of its location.
_LONGEST, _LONGEST_PLACE = 900, 300


class FieldhandError(Exception):
    """The base class of all exceptions of Fieldhand: a problem with its location and a remedy.

    Text from untrusted sources is safe in all three parts: hidden characters are made visible and long text is cut.

    Example:
        >>> try:
        ...     fh.Robot.load("no-such-robot")
        ... except fh.FieldhandError as error:
        ...     print(error.what, error.advice, error.exit_status)

    Args:
        what: Description of the problem, without a full stop.
        where: Location: file, line, element, tree or node; empty if there is none.
        advice: Remedy; empty if there is none.

    Attributes:
        what, where, advice: As above.
        exit_status: Exit status of the command line for this error: 2 for unusable input, else 1.
    """

    exit_status = 1

    def __init__(self, what: str, *, where: str = "", advice: str = "") -> None:
        self.what = _cut(visible(what, lines=True), _LONGEST)
        self.where = _cut(visible(where), _LONGEST_PLACE)
        self.advice = _cut(visible(advice, lines=True), _LONGEST)
        super().__init__(str(self))

    def __str__(self) -> str:
        return self.line(str)

    def line(self, translate: Callable[[str], str]) -> str:
        """Return the error as one line in some language: "location: description; advice".

        Args:
            translate: Function that translates a message (:meth:`fieldhand.language.Language.say`).
        """
        at = f"{translate(self.where)}: " if self.where else ""
        todo = f"; {translate(self.advice)}" if self.advice else ""
        return f"{at}{translate(self.what)}{todo}"


def _cut(text: str, longest: int) -> str:
    """Return a text, cut to a maximum length with an ellipsis."""
    return text if len(text) <= longest else f"{text[: longest - 3]}..."


def few(names: Sequence[str], most: int = 12, sign: str = ", ") -> str:
    """Return the first names and the number of the others: "a, b and 37 more"; "none" for no names."""
    if not names:
        return "none"
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return sign.join(names[:most]) + more


class InputError(FieldhandError):
    """An input is unusable: a request, file, option, or environment variable."""

    exit_status = 2


class RequestError(InputError):
    """The request is empty, too long, or not understood."""


class SiteError(InputError):
    """The site file cannot be used."""


class ProfileError(InputError):
    """The robot profile cannot be used."""


class TaskError(InputError):
    """A Task document is not well-formed, not valid against the robot's schema, or contradicts itself."""


class WorldError(InputError):
    """The world file of a simulation cannot be used."""


class CaseError(InputError):
    """A file of test cases (requests with their expected plans), or an event log to be evaluated, cannot be used."""


class BundleError(InputError):
    """A mission bundle is damaged, was changed after it was signed, or has an unknown format."""


class KeyFileError(InputError):
    """A key cannot be used, or there is none."""


class PlaceError(InputError):
    """A selector matches no place on this site, or names something that the site lacks."""


class NoPlaceError(PlaceError):
    """A selector matches no place on this site, although all that it names exists."""


class OutputError(InputError):
    """A file or folder cannot be written."""


class JournalError(OutputError):
    """The folder or journal of a mission cannot be continued: damaged, of another mission, in use, or not writable.

    A mission that cannot record its progress stops; no ``Try`` of its plan catches this error.
    """


class StoreError(OutputError):
    """The queue of missions cannot be used: the robot's store, or the sender's outbox."""


class DatabaseError(OutputError):
    """The server's database of accounts cannot be opened, read or written."""


class ProblemError(InputError):
    """An orienteering problem is invalid: bad numbers, a vertex that does not exist, or no way to the end."""


class ModelError(InputError):
    """The language model could not be reached, or gave no usable answer."""


class PluginError(InputError):
    """An extension registered by another distribution cannot be loaded, or does not fit its entry-point group."""


class NotApprovedError(FieldhandError):
    """A check failed, or the operator did not approve."""


class NotConfirmedError(NotApprovedError):
    """A Task has warnings that were not confirmed.

    Args:
        what: Description of the warnings.
        warnings: Text of each warning as it was shown and must be confirmed.
        advice: Remedy.
    """

    def __init__(self, what: str, warnings: tuple[str, ...], *, advice: str) -> None:
        self.warnings = warnings
        super().__init__(what, advice=advice)


class NotTrustedError(NotApprovedError):
    """A mission is unsigned, or its signing key is unknown here or revoked."""


class DeliveryError(FieldhandError):
    """A mission could not be transferred to a robot, or the robot's answer is invalid."""


class UnreachableError(DeliveryError):
    """The robot does not answer or cannot accept a mission now; a later attempt may succeed."""


class ExecutionError(FieldhandError):
    """The robot failed to execute a part of the Task."""


class Ros2Error(ExecutionError):
    """The robot cannot be reached over ROS 2, or its interfaces differ from its profile."""


class DriveFault(ExecutionError):
    """A leg cannot be driven."""


class BlockedFault(DriveFault):
    """Every way to a place is blocked, as far as the robot found."""


class OccupiedFault(BlockedFault):
    """Something stands wherever the robot would stand at a place, as far as it found."""


class LostFault(DriveFault):
    """The robot's position is unknown, and waiting for it took too long."""


class ActionFault(ExecutionError):
    """An action or a sensor failed."""
