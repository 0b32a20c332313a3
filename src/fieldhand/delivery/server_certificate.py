"""Verification of a robot's TLS certificate: by a certificate authority or by a pinned certificate."""

from __future__ import annotations

import hashlib
import ssl
from dataclasses import dataclass
from urllib.parse import urlsplit

from fieldhand.errors import DeliveryError, InputError, UnreachableError

_WAIT_S = 10.0


@dataclass(frozen=True, kw_only=True)
class ServerTrust:
    """The certificates that a sender accepts from a robot.

    Attributes:
        ca: PEM file of the authority that signed the certificate; empty for the authorities of the system.
        pin: SHA-256 of the certificate, 64 hexadecimal digits; empty for none.
        plain: True to send without TLS, even to another machine.
    """

    ca: str = ""
    pin: str = ""
    plain: bool = False


def parse_pin(text: str) -> str:
    """Parse the SHA-256 of a certificate, written with or without colons.

    Raises:
        InputError: The text is not a SHA-256.
    """
    pin = text.strip().lower().removeprefix("sha256 fingerprint=").removeprefix("sha256:").replace(":", "")
    if len(pin) != 64 or set(pin) - set("0123456789abcdef"):
        raise InputError(
            "is not the SHA-256 of a certificate",
            where="--pin",
            advice="openssl x509 -in cert.pem -noout -fingerprint -sha256 prints it",
        )
    return pin


def require_address(url: str, trust: ServerTrust) -> str:
    """Return the address of a robot without a trailing slash.

    Raises:
        InputError: The address is invalid, or the token would be sent unencrypted.
    """
    try:
        parts = urlsplit(url)
        host, _ = parts.hostname, parts.port
    except ValueError:
        host, parts = None, urlsplit("")
    if parts.scheme not in ("http", "https") or not host or parts.query or parts.fragment or parts.username:
        raise InputError(f"'{url[:80]}' is not the address of a robot", advice="give one like https://robot:8443")
    if parts.scheme == "http" and not trust.plain and host not in ("localhost", "127.0.0.1", "::1"):
        raise InputError(
            "everyone on the network path could read the token",
            where=url,
            advice="use https, or give --insecure to accept that",
        )
    if parts.scheme == "http" and (trust.ca or trust.pin):
        raise InputError("certificates apply only with TLS", where=url, advice="use https, or leave out --ca and --pin")
    return url.rstrip("/")


def context_for(url: str, trust: ServerTrust) -> ssl.SSLContext:
    """Return the TLS context that verifies the robot's certificate.

    With a pin, the certificate is fetched and compared before anything is sent, and is then the only trusted one; the
    server must have its private key.

    Raises:
        InputError: The authority's file cannot be read.
        DeliveryError: The robot's certificate is not the pinned one.
        UnreachableError: The robot does not respond.
    """
    if trust.pin and url.startswith("https:"):
        return _pinned(url, trust.pin)
    try:
        return ssl.create_default_context(cafile=trust.ca or None)
    except (OSError, ssl.SSLError) as error:
        raise InputError(
            f"the certificate of the authority cannot be read: {error.strerror or error}",
            where=trust.ca,
            advice="give a PEM file with --ca",
        ) from None


def _pinned(url: str, pin: str) -> ssl.SSLContext:
    parts = urlsplit(url)
    try:
        pem = ssl.get_server_certificate((parts.hostname or "", parts.port or 443), timeout=_WAIT_S)
        shown = hashlib.sha256(ssl.PEM_cert_to_DER_cert(pem)).hexdigest()
    except (OSError, ValueError) as error:
        why = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise UnreachableError(f"does not answer: {why}", where=url, advice="check whether it is switched on") from None
    if shown != pin:
        raise DeliveryError(
            f"presents a different certificate from the one that was pinned (SHA-256 {shown})",
            where=url,
            advice="do not send; if the robot's certificate was renewed, give the new one's with --pin",
        )
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False
    # The certificate itself is trusted, independent of its issuer and its extensions.
    context.verify_flags = (context.verify_flags | ssl.VERIFY_X509_PARTIAL_CHAIN) & ~ssl.VERIFY_X509_STRICT
    context.load_verify_locations(cadata=pem)
    return context
