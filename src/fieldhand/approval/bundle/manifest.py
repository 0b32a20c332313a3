"""The manifest of a bundle: approver, time of approval, and the hash of every file in the bundle."""

from __future__ import annotations

import json
from collections.abc import Mapping
from datetime import datetime, timedelta
from typing import Annotated, Any, NoReturn

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError, model_validator

from fieldhand.approval.bundle.container import MANIFEST
from fieldhand.compatibility import datetime_from_iso
from fieldhand.errors import BundleError
from fieldhand.hidden_characters import find_hidden, json_text

#: Format versions: the one written, and the older one still read, which lacks an approval number and an expiry date.
#: Newer versions are refused, because their fields may have another meaning.
FORMAT, UNDATED = 2, 1
#: Validity of an approval: the maximum, which also applies where none is given, and the default.
LONGEST_VALID, USUALLY_VALID = timedelta(days=366), timedelta(days=90)


def _printable(text: str) -> str:
    """Return the text if every character is visible; line breaks are allowed."""
    hidden = find_hidden(text, lines=True)
    if hidden is not None:
        raise ValueError(f"contains the invisible character {hidden.name}")
    return text


def _one_line(text: str) -> str:
    if not text.strip() or "\n" in text or "\t" in text:
        raise ValueError("is empty, or has several lines")
    return _printable(text)


def _moment(text: str) -> str:
    moment = datetime_from_iso(text)
    if moment.tzinfo is None:
        raise ValueError("has no time zone")
    if not 2000 <= moment.year <= 2999:  # the first and the last year have no time in some zones
        raise ValueError("is not in the years 2000 to 2999")
    return text


def _file_name(text: str) -> str:
    if set(text) & set("/\\\n\t") or text in (".", ".."):
        raise ValueError("is not a file name")
    return _printable(text)


Sha256 = Annotated[str, Field(pattern=r"^[0-9a-f]{64}$")]
OneLine = Annotated[str, Field(max_length=500), AfterValidator(_one_line)]
PrintableText = Annotated[str, Field(max_length=100_000), AfterValidator(_printable)]
Moment = Annotated[str, Field(max_length=40), AfterValidator(_moment)]


class _FilePart(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


class Approved(_FilePart):
    """An approval: the approver, the time, the confirmed warnings, and the language of the read-back (ISO 639).

    Attributes:
        until: Latest time at which the mission may start.
        number: Sequence number among this signer's approvals, rising.
    """

    by: OneLine
    at: Moment
    until: Moment | None = None
    number: Annotated[int, Field(ge=1, le=10**12)] | None = None
    confirmed: list[PrintableText]
    language: Annotated[str, Field(pattern=r"^[a-z]{2,3}$")]


class TaskPart(_FilePart):
    """The Task, stored as ``task.xml``."""

    id: OneLine
    sha256: Sha256
    request: PrintableText
    planner: OneLine


class SitePart(_FilePart):
    """The site.

    Attributes:
        file: Original name of the site file; its extension selects the reader, and it may name the site.
        sha256: SHA-256 of the site's bytes, as in the approval.
        content_sha256: SHA-256 of the parsed site, which every later reading must reproduce.
        lenient: True if invalid parts of the site were skipped in reading it.
    """

    name: Annotated[str, Field(max_length=200), AfterValidator(_printable)]
    file: Annotated[str, Field(min_length=1, max_length=255), AfterValidator(_file_name)]
    sha256: Sha256
    content_sha256: Sha256
    lenient: bool


class RobotPart(_FilePart):
    """The robot, whose profile is stored as ``robot.yaml``."""

    name: OneLine
    sha256: Sha256


class Manifest(_FilePart):
    """The signed content of a bundle.

    Attributes:
        program: Name and version of the program that wrote the bundle.
        files: SHA-256 of every other file of the bundle except the signature, by name.
    """

    format: int
    program: OneLine
    approved: Approved
    task: TaskPart
    site: SitePart
    robot: RobotPart
    files: dict[str, Sha256]

    @model_validator(mode="after")
    def _dated(self) -> Manifest:
        given = [value is not None for value in (self.approved.until, self.approved.number)]
        if given != [self.format != UNDATED] * 2:
            raise ValueError(f"approved.until and approved.number do not fit format {self.format}")
        if not self.approved_at < self.until <= self.approved_at + LONGEST_VALID:
            raise ValueError(f"approved.until is not within {LONGEST_VALID.days} days after approved.at")
        return self

    @property
    def approved_at(self) -> datetime:
        """Return the time of approval."""
        return datetime_from_iso(self.approved.at)

    @property
    def until(self) -> datetime:
        """Return the latest time at which the mission may start."""
        until = self.approved.until
        return self.approved_at + LONGEST_VALID if until is None else datetime_from_iso(until)

    @property
    def number(self) -> int:
        """Return the rising number of this approval, or its time in seconds if it has none."""
        number = self.approved.number
        return int(self.approved_at.timestamp()) if number is None else number

    def document(self) -> bytes:
        """Return the bytes stored in the bundle: canonical JSON in UTF-8."""
        return (json_text(self.model_dump(exclude_none=True), indent=2) + "\n").encode()


def parse_manifest(data: bytes, *, source: str) -> Manifest:
    """Parse the manifest of a bundle.

    Raises:
        BundleError: The data is not a manifest, or its format version is unknown.
    """
    at = f"{source}, {MANIFEST}"
    content = _content(data, at)
    found = content.get("format")
    if type(found) is not int or found not in (FORMAT, UNDATED):
        newer = type(found) is int and found > FORMAT
        raise BundleError(
            f"has format {str(found)[:20]}, and this program reads formats {UNDATED} and {FORMAT}",
            where=at,
            advice="update this program" if newer else "approve the mission again with this version",
        )
    try:
        return Manifest.model_validate(content)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key = ".".join(str(part) for part in first["loc"])[:80]
        raise BundleError(
            f"cannot be used: {key!r}: {first['msg']}", where=at, advice="approve the mission again"
        ) from None


def _content(data: bytes, at: str) -> Mapping[str, Any]:
    try:
        content = json.loads(data.decode(), parse_constant=_no_number, object_pairs_hook=_each_once)
    except RecursionError:
        raise BundleError("is nested too deeply", where=at, advice="approve the mission again") from None
    except ValueError as error:  # no UTF-8, no JSON, a number of thousands of digits
        raise BundleError(f"is not JSON: {str(error)[:80]}", where=at, advice="approve the mission again") from None
    if not isinstance(content, dict):
        raise BundleError("is not an object", where=at, advice="approve the mission again")
    return content


def _no_number(text: str) -> NoReturn:
    raise ValueError(f"{text} is not a number")


def _each_once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) != len(pairs):
        raise ValueError("a key is given twice")
    return found
