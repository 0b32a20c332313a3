"""The link from a sender to a robot: every answer is checked, every failure says whether trying again may help."""

from __future__ import annotations

import ssl
from collections.abc import Mapping
from importlib.util import find_spec
from typing import TYPE_CHECKING, TypeVar

from pydantic import BaseModel, ValidationError

from fieldhand.delivery.bundle_checks import sha256_of
from fieldhand.delivery.json_models import LONGEST_WAIT_S, Events, Heard, Receipt, RobotState
from fieldhand.errors import DeliveryError, InputError, UnreachableError
from fieldhand.execution.operator_commands import AgentCommand

if TYPE_CHECKING:
    import httpx

A = TypeVar("A", bound=BaseModel)

#: Bytes of an answer; 500 events are far less.
MOST_ANSWER = 16_000_000
#: What a later try may not meet any more: a token that was not at hand, too slow, too many at once, a full disk.
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
    """A client that talks to this robot alone: no proxy of the environment, no redirection."""
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
    """A robot's agent, as its sender sees it.

    Args:
        client: From :func:`open_client`.
    """

    def __init__(self, client: httpx.Client) -> None:
        self._client = client
        self._at = str(client.base_url).rstrip("/")

    def close(self) -> None:
        """Let go of the connection."""
        self._client.close()

    def robot(self) -> RobotState:
        """The robot, and the missions that arrived last."""
        return self._ask(RobotState, "GET", "/agent")

    def deliver(self, data: bytes, hashes: Mapping[str, str]) -> Receipt:
        """Hand a mission over; one that the robot has already is not sent again.

        Args:
            data: The bundle.
            hashes: That were computed of it here: the robot has to have found the same.

        Raises:
            UnreachableError: Not now.
            DeliveryError: The robot refuses it, or says that something else has arrived.
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
                f"the robot says that something else has arrived ({', '.join(wrong) or 'another mission'})",
                where=self._at,
                advice="do not start it; see whether this is your robot",
            )
        return receipt

    def mission(self, sha256: str) -> Receipt | None:
        """A mission that has arrived, with its hashes; None if it has not."""
        answer = self._send("GET", f"/agent/missions/{sha256}")
        return None if answer[0] == 404 else self._read(Receipt, *answer)

    def order(self, sha256: str, said: AgentCommand, because: str = "") -> Heard:
        """Tell a mission something; the same order may be sent again."""
        body = {"order": said, "because": because}
        return self._ask(Heard, "POST", f"/agent/missions/{sha256}/orders", json=body)

    def order_now(self, said: AgentCommand, because: str = "") -> Heard | None:
        """Tell the mission under way, else the one begun last; None if this agent has to be told which one.

        Raises:
            DeliveryError: There is none, or it has ended.
        """
        status, body = self._send("POST", "/agent/orders", json={"order": said, "because": because})
        # An agent of an earlier version has no such address, and says so as of any other.
        return None if status in (404, 405) and b"there is nothing here" in body else self._read(Heard, status, body)

    def events(self, sha256: str, after: int, wait_s: float) -> Events:
        """The events behind number ``after``.

        Raises:
            DeliveryError: One is missing.
        """
        found = self._ask(
            Events, "GET", f"/agent/missions/{sha256}/events", params={"after": after, "wait": wait_s}
        )  # fmt: skip
        if [event.n for event in found.events] != list(range(after + 1, after + 1 + len(found.events))):
            raise DeliveryError(f"an event behind number {after} is missing", where=self._at)
        return found

    def _ask(self, model: type[A], method: str, path: str, **more: object) -> A:
        return self._read(model, *self._send(method, path, **more))

    def _send(self, method: str, path: str, **more: object) -> tuple[int, bytes]:
        """Status and body of an answer."""
        import httpx

        try:
            with self._client.stream(method, path, **more) as answer:  # type: ignore[arg-type]
                body = bytearray()
                for chunk in answer.iter_bytes():
                    body += chunk
                    if len(body) > MOST_ANSWER:
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
                f"does not answer: {why}", where=self._at, advice="see whether it is switched on and in reach"
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
                f"answers something else than an agent does ({'.'.join(map(str, first['loc']))}: {first['msg']})",
                where=self._at,
                advice="see whether this is the address of fieldhand agent",
            ) from None

    def _problem(self, status: int, body: bytes) -> DeliveryError:
        """What the robot says is wrong."""
        try:
            said = _Problem.model_validate_json(body)
        except ValidationError:
            said = _Problem(what=f"answers with HTTP status {status}")
        kind = UnreachableError if status in _LATER else DeliveryError
        where = f"{self._at}, {said.where}" if said.where else self._at
        return kind(said.what, where=where, advice=said.advice)


class _Problem(BaseModel):
    what: str
    where: str = ""
    advice: str = ""


def _is_mistrust(error: BaseException | None) -> bool:
    """Whether a certificate was refused: trying again would not help, and may not be right."""
    while error is not None:
        if isinstance(error, ssl.SSLCertVerificationError):
            return True
        error = error.__cause__ or error.__context__
    return False
