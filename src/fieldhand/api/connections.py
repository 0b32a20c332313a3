"""HTTP connections with time limits, as uvicorn's protocol (h11) waits without limit for headers, bodies and readers.

Each connection has one timer. It runs while the connection waits for its client, and slow bytes do not restart it:

    TLS handshake and header │ body of a request that was answered │ reader of an answer │ next request
"""

from __future__ import annotations

import asyncio
import ssl
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, cast

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol

from fieldhand.api.admission import Admission, AdmittedConnection, Rank, rank_of, set_ending

if TYPE_CHECKING:
    from uvicorn.config import Config
    from uvicorn.server import ServerState


@dataclass(frozen=True, kw_only=True)
class Connections:
    """Limits on the connections of one server.

    Attributes:
        total: Largest number of connections.
        of_address: Largest number of connections from one address.
        header_s: Seconds for the TLS handshake, and again for a complete header.
        idle_s: Seconds until the next request begins, and for the rest of a body that is not read.
        bytes_s: Bytes of an unread response for which the client has one more second.
    """

    total: int = 256
    of_address: int = 64
    header_s: float = 10.0
    idle_s: float = 10.0
    bytes_s: float = 20_000.0


def protocol_factory(limits: Connections, tls: ssl.SSLContext | None = None) -> Callable[..., asyncio.Protocol]:
    """Return a factory of protocols for uvicorn's ``http`` setting.

    Args:
        limits: Limits on the connections.
        tls: The server's certificate; uvicorn itself must not have it, so that a handshake counts as a connection.
    """
    admission = Admission(total=limits.total, of_address=limits.of_address)

    def make(
        config: Config,
        server_state: ServerState,
        app_state: dict[str, Any],
        _loop: asyncio.AbstractEventLoop | None = None,
    ) -> asyncio.Protocol:
        http = partial(BoundedProtocol, config, server_state, app_state, _loop, admission=admission, limits=limits)
        return http() if tls is None else _Handshake(http, tls, admission, limits)

    return make


class BoundedProtocol(H11Protocol):
    """uvicorn's protocol of one connection, with a time limit for the client.

    Args:
        config, server_state, app_state, loop: As passed by uvicorn.
        admission: Admits the connection.
        limits: Time limits.
        place: Connection that was admitted before its TLS handshake.
    """

    def __init__(
        self,
        config: Config,
        server_state: ServerState,
        app_state: dict[str, Any],
        loop: asyncio.AbstractEventLoop | None = None,
        *,
        admission: Admission,
        limits: Connections,
        place: AdmittedConnection | None = None,
    ) -> None:
        super().__init__(config, server_state, app_state, loop)
        self._admission, self._limits, self._place = admission, limits, place
        self._timer: asyncio.TimerHandle | None = None
        self._idle = False

    # --- called by asyncio -----------------------------------------------------------------------------------------

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        if self._place is None:
            self._place = self._admission.enter(_address(transport), rank=self.rank, close=transport.abort)
        else:
            self._place.rank, self._place.close = self.rank, transport.abort
        self._within(self._limits.header_s)

    def connection_lost(self, exc: Exception | None) -> None:
        self._stop_timer()
        if self._place is not None:
            self._admission.leave(self._place)
        super().connection_lost(exc)
        self._unset_keepalive_if_required()

    def data_received(self, data: bytes) -> None:
        super().data_received(data)
        if self._in_progress():
            if self.flow is not None and not self.flow.write_paused:
                self._stop_timer()
        elif self._idle and not self._between_requests():
            self._idle = False
            self._within(self._limits.header_s)

    def pause_writing(self) -> None:
        super().pause_writing()
        self._await_reader()

    def resume_writing(self) -> None:
        super().resume_writing()
        self._stop_timer()
        if not self._in_progress():
            self._await_next()

    # --- called by uvicorn -----------------------------------------------------------------------------------------

    def on_response_complete(self) -> None:
        super().on_response_complete()
        # Every byte restarts uvicorn's timer, and it does not limit the time of a reader.
        self._unset_keepalive_if_required()
        if not self._in_progress():
            self._await_next()

    def shutdown(self) -> None:
        if self._in_progress():
            set_ending(cast("dict[str, Any]", self.scope))
        super().shutdown()

    # --- limits ---------------------------------------------------------------------------------------------------

    def rank(self) -> Rank:
        """Return the current rank of the connection."""
        if not self._in_progress():
            return Rank.WAITING
        given = rank_of(cast("dict[str, Any]", self.scope))
        if given is not None:
            return given
        return Rank.RECEIVING if self.cycle.more_body else Rank.WORKING

    def _in_progress(self) -> bool:
        return self.cycle is not None and not self.cycle.response_complete

    def _between_requests(self) -> bool:
        """Return True if the response was sent and no byte of another request was received."""
        return self.conn.their_state is h11.IDLE and not self.conn.trailing_data[0]

    def _await_next(self) -> None:
        """Start the timer for the rest of the response and the beginning of another request."""
        self._idle = True
        self._await_reader()

    def _await_reader(self) -> None:
        self._within(self._limits.idle_s + self.transport.get_write_buffer_size() / self._limits.bytes_s)

    def _within(self, seconds: float) -> None:
        self._stop_timer()
        self._timer = self.loop.call_later(seconds, self.transport.abort)

    def _stop_timer(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None


class _Handshake(asyncio.Protocol):
    """A connection during its TLS handshake, which counts as a connection from the start.

    Args:
        http: Creates the HTTP protocol of the connection.
        tls: The server's certificate.
        admission: Admits the connection.
        limits: Time limits.
    """

    def __init__(
        self, http: Callable[..., BoundedProtocol], tls: ssl.SSLContext, admission: Admission, limits: Connections
    ) -> None:
        self._http, self._tls, self._admission, self._limits = http, tls, admission, limits
        self._early: list[bytes] = []
        self._lost = False
        self._task: asyncio.Task[None] | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        transport = cast("asyncio.Transport", transport)
        place = self._admission.enter(_address(transport), rank=lambda: Rank.WAITING, close=transport.abort)
        self._task = asyncio.get_running_loop().create_task(self._secure(transport, place))

    def data_received(self, data: bytes) -> None:
        # Bytes between the end of the handshake and the start of the HTTP protocol.
        self._early.append(data)

    def connection_lost(self, exc: Exception | None) -> None:  # noqa: ARG002  # name given by asyncio
        self._lost = True

    async def _secure(self, transport: asyncio.Transport, place: AdmittedConnection) -> None:
        loop = asyncio.get_running_loop()
        try:
            secured = await loop.start_tls(
                transport, self, self._tls, server_side=True, ssl_handshake_timeout=self._limits.header_s
            )
        except (OSError, RuntimeError):  # includes ssl.SSLError: not a TLS client, or disconnected
            secured = None
        if secured is None or self._lost:
            self._admission.leave(place)
            transport.abort()
            return
        http = self._http(place=place)
        http.connection_made(secured)
        secured.set_protocol(http)
        for data in self._early:
            http.data_received(data)


def _address(transport: asyncio.BaseTransport) -> str:
    found = transport.get_extra_info("peername")
    return str(found[0]) if isinstance(found, tuple) and found else ""
