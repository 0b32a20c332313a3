"""The signature of a bundle, computed over its manifest, which lists the hash of every other file."""

from __future__ import annotations

import base64
import re
from dataclasses import dataclass

from fieldhand.approval.keys.public import MARK, PublicKey
from fieldhand.approval.keys.signing import SigningKey
from fieldhand.errors import BundleError

#: Prefix of the signed bytes, so that a signature made for another purpose is not valid for a mission.
CONTEXT = b"fieldhand mission bundle\n"
_TEXT = re.compile(rf"{MARK} ([A-Za-z0-9+/]{{43}}=)\n([A-Za-z0-9+/]{{86}}==)\n")


@dataclass(frozen=True, kw_only=True)
class Signature:
    """A signature: the public key and the 64 signature bytes."""

    public: PublicKey
    value: bytes

    def text(self) -> bytes:
        """Return the text stored in the bundle: public key on the first line, signature on the second."""
        return b"%s %s\n%s\n" % (MARK.encode(), base64.b64encode(self.public.raw), base64.b64encode(self.value))


def sign_manifest(manifest: bytes, key: SigningKey) -> Signature:
    """Return the signature over the bytes of a manifest."""
    return Signature(public=PublicKey(raw=key.public.raw), value=key.sign(CONTEXT + manifest))


def require_signature(text: bytes, manifest: bytes, *, source: str) -> Signature:
    """Parse a signature and verify it against the manifest, without checking trust in its key.

    Raises:
        BundleError: The text is not a signature, or the signature does not match the manifest.
    """
    match = _TEXT.fullmatch(text.decode("ascii", errors="replace"))
    if match is not None:
        raw, value = (base64.b64decode(part) for part in match.groups())
        signature = Signature(public=PublicKey(raw=raw), value=value)
        # Base64 allows several encodings of the last bits; only the canonical one is accepted.
        if signature.text() == text and signature.public.verifies(value, CONTEXT + manifest):
            return signature
    raise BundleError(
        "the signature is broken: this is not what was approved",
        where=source,
        advice="ask for the file again from whoever approved it",
    )
