"""Every failure that Fieldhand raises, as one tree.

    FieldhandError                  exit status 1: the mission or a check failed, or it could not be told
    ├── InputError                  exit status 2: what was given cannot be used
    │   ├── RequestError            the words of the request
    │   ├── SiteError               the site file
    │   ├── ProfileError            the robot profile
    │   ├── TaskError               a Task document: its XML, its schema, its meaning
    │   ├── WorldError              the world file of a simulation
    │   ├── CaseError               a file of cases: requests with what they mean
    │   ├── BundleError             a mission bundle: its container, its signature, its manifest, what it holds
    │   ├── KeyFileError            a key: its file, its rights, its passphrase, or that there is none
    │   ├── PlaceError              a selector that this site cannot resolve
    │   ├── OutputError             a place to write to that cannot be written
    │   │   ├── JournalError        a mission's folder or journal that cannot be gone on with
    │   │   └── StoreError          where missions wait: the robot's store, the sender's outbox
    │   ├── ProblemError            an orienteering problem that contradicts itself or has no solution
    │   ├── ModelError              the language model: key, endpoint, answer
    │   └── PluginError             an extension of another distribution, named with its distribution
    ├── NotApprovedError            a check failed or the operator said no
    │   ├── NotConfirmedError       there are warnings that nobody has confirmed
    │   └── NotTrustedError         nobody whom this robot trusts has signed
    ├── DeliveryError               a mission that could not be handed to a robot
    │   └── UnreachableError        not now; later it may be
    └── ExecutionError              the robot
        ├── Ros2Error               it cannot be reached over ROS 2, or is not what its profile says
        ├── DriveFault              a leg that cannot be driven
        │   ├── BlockedFault        what the robot found in its way leaves no other
        │   └── LostFault           the robot does not know where it is
        └── ActionFault             an action or a sensor that failed

A message says what is wrong, where, and what to do. ``exit_status`` is what a command line returns for it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from fieldhand.hidden_characters import visible

__all__ = [
    "ActionFault",
    "BlockedFault",
    "BundleError",
    "CaseError",
    "DeliveryError",
    "DriveFault",
    "ExecutionError",
    "FieldhandError",
    "InputError",
    "JournalError",
    "KeyFileError",
    "LostFault",
    "ModelError",
    "NotApprovedError",
    "NotConfirmedError",
    "NotTrustedError",
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


#: Of what an error says, in characters, and of where.
_LONGEST, _LONGEST_PLACE = 900, 300


class FieldhandError(Exception):
    """Something that the user has to know, with where it is and what to do about it.

    What it quotes may come from anyone: hidden characters are made visible, what no screen holds is cut.

    Args:
        what: What is wrong, in words, without a full stop.
        where: File, line, element, tree or node; empty if there is no such place.
        advice: What to do; empty if nothing can be done.
    """

    exit_status = 1

    def __init__(self, what: str, *, where: str = "", advice: str = "") -> None:
        self.what = _cut(visible(what, lines=True), _LONGEST)
        self.where = _cut(visible(where), _LONGEST_PLACE)
        self.advice = _cut(visible(advice, lines=True), _LONGEST)
        super().__init__(str(self))

    def __str__(self) -> str:
        return self.said(str)

    def said(self, say: Callable[[str], str]) -> str:
        """Return the line that a person reads.

        Args:
            say: Says each part, in some language.
        """
        at = f"{say(self.where)}: " if self.where else ""
        todo = f"; {say(self.advice)}" if self.advice else ""
        return f"{at}{say(self.what)}{todo}"


def _cut(text: str, longest: int) -> str:
    """Return no more of a text than a screen holds."""
    return text if len(text) <= longest else f"{text[: longest - 3]}..."


def few(names: Sequence[str], most: int = 12, sign: str = ", ") -> str:
    """Return the first of some names, and how many more there are: "a, b and 37 more"; "none" where there are none."""
    if not names:
        return "none"
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return sign.join(names[:most]) + more


class InputError(FieldhandError):
    """What was given cannot be used."""

    exit_status = 2


class RequestError(InputError):
    """The request is empty, too long, or nothing in it was understood."""


class SiteError(InputError):
    """The site file cannot be used."""


class ProfileError(InputError):
    """The robot profile cannot be used."""


class TaskError(InputError):
    """A Task document is not well-formed, not valid against the robot's schema, or contradicts itself."""


class WorldError(InputError):
    """The world file of a simulation cannot be used."""


class CaseError(InputError):
    """A file of cases (requests with what they mean), or an event log that is to be judged, cannot be used."""


class BundleError(InputError):
    """A mission bundle is damaged, was changed after it was signed, or is of a form that is not known."""


class KeyFileError(InputError):
    """A key cannot be used, or there is none."""


class PlaceError(InputError):
    """A selector finds nothing on this site, or names what the site does not have."""


class OutputError(InputError):
    """A file or folder cannot be written."""


class JournalError(OutputError):
    """A mission's folder or its journal cannot be gone on with: damaged, another mission's, in use, not to be written.

    No behavior works around it: a mission that cannot keep what it does stops.
    """


class StoreError(OutputError):
    """The place where missions wait cannot be used: the robot's store, or the outbox of whoever sends."""


class ProblemError(InputError):
    """An orienteering problem is not a problem: bad numbers, a vertex that does not exist, no way to the end."""


class ModelError(InputError):
    """The language model could not be reached, or did not give an answer that can be used."""


class PluginError(InputError):
    """An extension that another distribution registers cannot be loaded, or is not what its group requires."""


class NotApprovedError(FieldhandError):
    """A check failed, or the operator did not approve."""


class NotConfirmedError(NotApprovedError):
    """A Task has warnings that nobody has confirmed.

    Args:
        what: Which ones, in words.
        warnings: Each as it was shown, and as it has to be confirmed.
        advice: What to do.
    """

    def __init__(self, what: str, warnings: tuple[str, ...], *, advice: str) -> None:
        self.warnings = warnings
        super().__init__(what, advice=advice)


class NotTrustedError(NotApprovedError):
    """A mission is not signed, or by a key that is unknown here or was revoked."""


class DeliveryError(FieldhandError):
    """A mission could not be handed to a robot, or what the robot answered is not what it has to be."""


class UnreachableError(DeliveryError):
    """The robot does not answer, or cannot take it now; the same may succeed later."""


class ExecutionError(FieldhandError):
    """The robot could not do what the Task asks."""


class Ros2Error(ExecutionError):
    """The robot cannot be reached over ROS 2, or what it says does not fit what its profile says of it."""


class DriveFault(ExecutionError):
    """A leg cannot be driven."""


class BlockedFault(DriveFault):
    """A place to which no way is left but those that the robot found blocked."""


class LostFault(DriveFault):
    """The robot does not know where it is, and has waited for that long enough."""


class ActionFault(ExecutionError):
    """An action or a sensor failed."""
