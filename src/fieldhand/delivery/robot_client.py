"""Client of a robot's agent: each response is validated, each error tells if a later attempt may succeed."""

from __future__ import annotations

import ssl
from collections.abc import Mapping
from datetime import datetime
from importlib.util import find_spec
from typing import TYPE_CHECKING, TypeVar

from pydantic import BaseModel, ValidationError

from fieldhand.delivery.bundle_checks import sha256_of
from fieldhand.delivery.json_models import LONGEST_WAIT_S, CommandResponse, Events, Receipt, RobotState, Runs
from fieldhand.errors import DeliveryError, InputError, UnreachableError
from fieldhand.execution.operator_commands import AgentCommand

if TYPE_CHECKING:
    import httpx

A = TypeVar("A", bound=BaseModel)

#: Largest size of a response, in bytes; 500 events are far smaller.
MOST_ANSWER = 16_000_000
#: Largest image in bytes.
MOST_IMAGE = 300_000_000
#: Statuses after which a later attempt may succeed: missing token, timeout, too many requests, full disk.
_LATER = frozenset({401, 408, 429, 500, 502, 503, 504, 507})
_CHUNK = 65_536


def require_httpx() -> None:
    """Check that the optional package is installed.

    Raises:
        InputError: It is not.
    """
    if find_spec("httpx") is None:
        raise InputError(
            "sending needs a package that is not installed (httpx)",
            advice='install it with: pip install "fieldhand[send]"',
        )


def open_client(url: str, token: str | None, context: ssl.SSLContext | None) -> httpx.Client:
    """Return an HTTP client of one robot, without proxies of the environment and without redirects."""
    import httpx

    return httpx.Client(
        base_url=url,
        headers={} if token is None else {"Authorization": f"Bearer {token}"},
        verify=True if context is None else context,
        timeout=httpx.Timeout(10.0, read=30.0 + LONGEST_WAIT_S, write=30.0),
        follow_redirects=False,
        trust_env=False,
    )


class RobotClient:
    """Client of a robot's agent.

    Args:
        client: HTTP client from :func:`open_client`.
    """

    def __init__(self, client: httpx.Client) -> None:
        self._client = client
        self._at = str(client.base_url).rstrip("/")

    def close(self) -> None:
        """Close the connection."""
        self._client.close()

    def robot(self) -> RobotState:
        """Return the state of the robot, and the missions that it received last."""
        return self._ask(RobotState, "GET", "/agent")

    def deliver(self, data: bytes, hashes: Mapping[str, str]) -> Receipt:
        """Upload a signed mission, unless the robot has it already.

        Args:
            data: Bytes of the file.
            hashes: SHA-256 of the file and its members; those of the receipt must be the same.

        Raises:
            UnreachableError: The robot cannot be reached now.
            DeliveryError: The robot refuses the mission, or its receipt has other hashes.
        """
        sha256 = sha256_of(data)
        receipt = self.mission(sha256)
        if receipt is None:
            chunks = (data[k : k + _CHUNK] for k in range(0, len(data), _CHUNK))
            headers = {"Content-Length": str(len(data)), "Content-Type": "application/octet-stream"}
            receipt = self._ask(Receipt, "PUT", f"/agent/missions/{sha256}", content=chunks, headers=headers)
        if receipt.hashes != dict(hashes) or receipt.mission.bundle != sha256:
            wrong = sorted(n for n in {*receipt.hashes, *hashes} if receipt.hashes.get(n) != hashes.get(n))
            raise DeliveryError(
                f"the robot reports that something else has arrived ({', '.join(wrong) or 'another mission'})",
                where=self._at,
                advice="do not start it; check whether this is your robot",
            )
        return receipt

    def mission(self, sha256: str) -> Receipt | None:
        """Return the receipt of a mission; None if the robot has not received it."""
        answer = self._send("GET", f"/agent/missions/{sha256}")
        return None if answer[0] == 404 else self._read(Receipt, *answer)

    def runs(self, sha256: str) -> Runs:
        """Return the next and the last runs of a mission with a timetable."""
        return self._ask(Runs, "GET", f"/agent/missions/{sha256}/runs")

    def order(
        self, sha256: str, command: AgentCommand, because: str = "", *, due: datetime | None = None
    ) -> CommandResponse:
        """Send a command to a mission; the same command may be sent again.

        Args:
            sha256: SHA-256 of the mission.
            command: The command.
            because: Reason, for the event log.
            due: With ``cancel``: time of the one run to leave out, with time zone.
        """
        body = {"order": command, "because": because}
        if due is not None:
            body["due"] = due.isoformat()
        return self._ask(CommandResponse, "POST", f"/agent/missions/{sha256}/orders", json=body)

    def order_now(self, command: AgentCommand, because: str = "") -> CommandResponse | None:
        """Send a command to the running mission, else to the one begun last.

        Returns:
            The response; None if the agent requires the name of a mission, as earlier versions do.

        Raises:
            DeliveryError: There is no mission, or it has ended.
        """
        status, body = self._send("POST", "/agent/orders", json={"order": command, "because": because})
        # An agent of an earlier version does not have this address.
        return (
            None
            if status in (404, 405) and b"there is nothing here" in body
            else self._read(CommandResponse, status, body)
        )

    def events(self, sha256: str, after: int, wait_s: float) -> Events:
        """Return the events after number ``after``.

        Raises:
            DeliveryError: An event is missing.
        """
        found = self._ask(
            Events, "GET", f"/agent/missions/{sha256}/events", params={"after": after, "wait": wait_s}
        )  # fmt: skip
        if [event.n for event in found.events] != list(range(after + 1, after + 1 + len(found.events))):
            raise DeliveryError(f"an event after number {after} is missing", where=self._at)
        return found

    def image(self, sha256: str, name: str) -> bytes:
        """Return the bytes of an image of a mission.

        Raises:
            DeliveryError: There is no such image.
        """
        status, body = self._send("GET", f"/agent/missions/{sha256}/images/{name}", MOST_IMAGE)
        if status != 200:
            raise self._problem(status, body)
        return body

    def _ask(self, model: type[A], method: str, path: str, **more: object) -> A:
        return self._read(model, *self._send(method, path, **more))

    def _send(self, method: str, path: str, most: int = MOST_ANSWER, /, **more: object) -> tuple[int, bytes]:
        """Return status and body of the response to a request."""
        import httpx

        try:
            with self._client.stream(method, path, **more) as answer:  # type: ignore[arg-type]
                body = bytearray()
                for chunk in answer.iter_bytes():
                    body += chunk
                    if len(body) > most:
                        raise DeliveryError("the answer is too large", where=self._at)
                return answer.status_code, bytes(body)
        except httpx.TransportError as error:
            if _is_mistrust(error):
                raise DeliveryError(
                    f"its certificate is not trusted: {error}",
                    where=self._at,
                    advice="give the authority that signed it with --ca, or the certificate's SHA-256 with --pin",
                ) from None
            why = str(error) or type(error).__name__
            raise UnreachableError(
                f"does not answer: {why}", where=self._at, advice="check whether it is switched on and in reach"
            ) from None
        except httpx.HTTPError as error:
            raise DeliveryError(f"the answer cannot be read: {error}", where=self._at) from None

    def _read(self, model: type[A], status: int, body: bytes) -> A:
        if status not in (200, 201):
            raise self._problem(status, body)
        try:
            return model.model_validate_json(body)
        except ValidationError as error:
            first = error.errors()[0]
            raise DeliveryError(
                f"does not answer as an agent does ({'.'.join(map(str, first['loc']))}: {first['msg']})",
                where=self._at,
                advice="check whether this is the address of a fieldhand agent",
            ) from None

    def _problem(self, status: int, body: bytes) -> DeliveryError:
        """Return the error that a response describes."""
        try:
            problem = _Problem.model_validate_json(body)
        except ValidationError:
            problem = _Problem(what=f"answers with HTTP status {status}")
        kind = UnreachableError if status in _LATER else DeliveryError
        where = f"{self._at}, {problem.where}" if problem.where else self._at
        return kind(problem.what, where=where, advice=problem.advice)


class _Problem(BaseModel):
    what: str
    where: str = ""
    advice: str = ""


def _is_mistrust(error: BaseException | None) -> bool:
    """Return True if the certificate was refused, after which another attempt neither helps nor is safe."""
    while error is not None:
        if isinstance(error, ssl.SSLCertVerificationError):
            return True
        error = error.__cause__ or error.__context__
    return False
