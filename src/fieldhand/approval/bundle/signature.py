"""The signature of a bundle: over its manifest, which holds the hash of everything else."""

from __future__ import annotations

import base64
import re
from dataclasses import dataclass

from fieldhand.approval.keys.public import MARK, PublicKey
from fieldhand.approval.keys.signing import SigningKey
from fieldhand.errors import BundleError

#: Signed before the manifest, so that what was signed for anything else is no signature of a mission.
CONTEXT = b"fieldhand mission bundle\n"
_TEXT = re.compile(rf"{MARK} ([A-Za-z0-9+/]{{43}}=)\n([A-Za-z0-9+/]{{86}}==)\n")


@dataclass(frozen=True, kw_only=True)
class Signature:
    """Who signed, and the 64 bytes of it."""

    public: PublicKey
    value: bytes

    def text(self) -> bytes:
        """As it stands in the bundle: the public key on one line, the signature on the next."""
        return b"%s %s\n%s\n" % (MARK.encode(), base64.b64encode(self.public.raw), base64.b64encode(self.value))


def sign_manifest(manifest: bytes, key: SigningKey) -> Signature:
    """The signature of the bytes of a manifest."""
    return Signature(public=PublicKey(raw=key.public.raw), value=key.sign(CONTEXT + manifest))


def require_signature(text: bytes, manifest: bytes, *, source: str) -> Signature:
    """The signature, if it is one of this manifest. Whether anybody trusts its key is another question.

    Raises:
        BundleError: It is none, or one of something else.
    """
    match = _TEXT.fullmatch(text.decode("ascii", errors="replace"))
    if match is not None:
        raw, value = (base64.b64decode(part) for part in match.groups())
        signature = Signature(public=PublicKey(raw=raw), value=value)
        # The last letters of base 64 have bits to spare: only the one way to write it is taken.
        if signature.text() == text and signature.public.verifies(value, CONTEXT + manifest):
            return signature
    raise BundleError(
        "the signature is broken: this is not what was approved",
        where=source,
        advice="ask for the file again from whoever approved it",
    )
