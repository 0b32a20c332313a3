"""Certificate and key of a server, checked before it begins."""

from __future__ import annotations

from pathlib import Path

from fieldhand.errors import InputError


def tls_files(cert: Path | None, key: Path | None, options: tuple[str, str]) -> tuple[Path, Path] | None:
    """Return certificate and key of a server, once they were loaded for a test; None if neither is given.

    Args:
        cert: File of the certificate (PEM).
        key: File of its private key (PEM).
        options: Names of the options that give them.

    Raises:
        InputError: Only one is given, or they cannot be used.
        KeyFileError: Other users can read the key.
    """
    import ssl

    from fieldhand.approval.keys.rights import read_guarded

    if cert is None and key is None:
        return None
    if cert is None or key is None:
        raise InputError("TLS needs a certificate and its key", advice="give both {} and {}".format(*options))
    read_guarded(key, private=True)
    try:
        # Without a password function, ssl would ask for a passphrase at a terminal, which a robot does not have.
        ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER).load_cert_chain(cert, key, password=lambda: "")
    except (OSError, ValueError) as error:
        raise InputError(
            f"certificate and key cannot be used: {error}",
            where=f"{cert}, {key}",
            advice="give a PEM certificate and its own key, without a passphrase",
        ) from None
    return cert, key
