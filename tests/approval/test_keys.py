"""Keys: what is private stays so, what is public can be sent and compared, what is revoked stays revoked."""

from __future__ import annotations

import os
import stat
from datetime import datetime, timedelta
from pathlib import Path

import pytest
from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric import ec, x25519
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey
from hypothesis import given
from hypothesis import strategies as st

from fieldhand.approval.keys.public import PublicKey, parse_fingerprint, parse_public
from fieldhand.approval.keys.signing import SigningKeys
from fieldhand.approval.keys.trust import TrustStore
from fieldhand.approval.production import in_production, require_unsigned_allowed
from fieldhand.compatibility import UTC
from fieldhand.errors import InputError, KeyFileError, NotTrustedError, OutputError
from support.missions.signed import signing_key

NOW = datetime(2026, 5, 1, tzinfo=UTC)
names = st.from_regex(r"[A-Za-zÀ-ÖØ-öø-ÿ][A-Za-z0-9_.,'()&-]{0,28}[a-z0-9)]", fullmatch=True)
seeds = st.binary(min_size=32, max_size=32)


def public_of(seed: bytes) -> bytes:
    """The public key of a private one."""
    return Ed25519PrivateKey.from_private_bytes(seed).public_key().public_bytes_raw()


@given(seed=seeds, name=names)
def test_a_public_key_comes_back_from_its_line_also_out_of_a_mail(seed: bytes, name: str) -> None:
    key = PublicKey(raw=public_of(seed), name=name)
    for mail in ("{}\n", "Hello,\n\n> {}\n\nSee you, {{}}\n", "{}\r\n", "   {}"):
        assert parse_public(mail.format(key.line()), source="mail") == key


@given(seed=seeds, place=st.integers(0, 42), letter=st.sampled_from("ABab01+/"))
def test_a_letter_changed_on_the_way_changes_the_fingerprint(seed: bytes, place: int, letter: str) -> None:
    key = PublicKey(raw=public_of(seed))
    mark, text = key.line().split()
    other = f"{mark} {text[:place]}{letter}{text[place + 1 :]}"
    try:
        read = parse_public(other, source="mail")
    except KeyFileError:
        return
    assert (read.fingerprint == key.fingerprint) == (other == key.line())


@given(raw=st.binary(min_size=32, max_size=32))
def test_a_fingerprint_is_known_however_it_is_typed(raw: bytes) -> None:
    fingerprint = PublicKey(raw=raw).fingerprint
    assert len(fingerprint) == 39
    for typed in (fingerprint.lower(), fingerprint.replace("-", ""), fingerprint.replace("-", " "), f" {fingerprint} "):
        assert parse_fingerprint(typed) == fingerprint
    for typed in (fingerprint[:-1], fingerprint + "A", fingerprint.replace(fingerprint[0], "1"), ""):
        with pytest.raises(KeyFileError):
            parse_fingerprint(typed)


TEXTS = {
    "nothing": "",
    "another text": "ssh-ed25519 AAAAC3Nza ada@farm",
    "a private key": "-----BEGIN PRIVATE KEY-----\nMC4CAQAwBQYDK2VwBCIEIA==\n-----END PRIVATE KEY-----\n",
    "too short": "fieldhand-ed25519 AAAA Ada",
    "no base 64": "fieldhand-ed25519 AA=AA Ada",
    "two keys": f"{signing_key(1).public.line()}\n{signing_key(2).public.line()}\n",
    "empty lines without end": "\n" * 60_000 + signing_key(1).public.line() + " " * 60_000 + "\x00",
    "a name that steers the terminal": f"{signing_key(1).public.line()}\x1b[2J",
}


@pytest.mark.parametrize("kind", TEXTS)
def test_a_text_without_one_public_key_is_refused(kind: str) -> None:
    with pytest.raises(KeyFileError):
        parse_public(TEXTS[kind], source="ada.pub")


@pytest.mark.parametrize("passphrase", [None, "correct horse"])
def test_a_key_signs_after_it_was_kept(passphrase: str | None, tmp_path: Path) -> None:
    keys = SigningKeys(tmp_path)
    made, shared = keys.make("Ada Lovelace", passphrase)
    held = keys.choose()
    assert (held.public, held.encrypted) == (made.public, passphrase is not None)
    opened = keys.open(held, lambda: passphrase)
    assert parse_public(shared.read_text(), source="").verifies(opened.sign(b"plan"), b"plan")
    assert not made.public.verifies(opened.sign(b"plan"), b"plane")
    assert "PRIVATE" not in repr(opened)


def test_only_the_owner_reads_a_private_key(tmp_path: Path) -> None:
    keys = SigningKeys(tmp_path / "config")
    keys.make("Ada")
    held = keys.choose()
    assert stat.S_IMODE(held.file.stat().st_mode) == 0o600
    assert stat.S_IMODE(held.file.parent.stat().st_mode) == 0o700
    for mode in (0o640, 0o604, 0o660, 0o644):
        held.file.chmod(mode)
        with pytest.raises(KeyFileError, match="chmod 600"):
            keys.open(held, lambda: None)
    held.file.chmod(0o400)
    keys.open(held, lambda: None)


@pytest.mark.parametrize("given", [None, "", "wrong horse"])
def test_a_passphrase_that_is_missing_or_wrong_opens_nothing(given: str | None, tmp_path: Path) -> None:
    keys = SigningKeys(tmp_path)
    keys.make("Ada", "correct horse")
    with pytest.raises(KeyFileError, match="passphrase"):
        keys.open(keys.choose(), lambda: given)


def _pem(key: ec.EllipticCurvePrivateKey | x25519.X25519PrivateKey) -> bytes:
    encoding, form = serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8
    return key.private_bytes(encoding, form, serialization.NoEncryption())


CONTENTS = {
    "empty": b"",
    "text": b"my key",
    "cut off": b"-----BEGIN PRIVATE KEY-----\nMC4CAQAwBQYD",
    "another curve": _pem(ec.generate_private_key(ec.SECP256R1())),
    "a key that does not sign": _pem(x25519.X25519PrivateKey.generate()),
    "too large": b"A" * 100_000,
    "says that it is encrypted": b"-----BEGIN ENCRYPTED PRIVATE KEY-----\nAAAA\n-----END ENCRYPTED PRIVATE KEY-----\n",
}


@pytest.mark.parametrize("kind", CONTENTS)
def test_a_file_that_is_no_key_is_refused(kind: str, tmp_path: Path) -> None:
    keys = SigningKeys(tmp_path)
    keys.make("Ada")
    keys.choose().file.write_bytes(CONTENTS[kind])
    with pytest.raises(KeyFileError, match=r"ada\.key"):
        keys.open(keys.choose(), lambda: "secret")


def test_a_private_key_exchanged_for_another_is_noticed(tmp_path: Path) -> None:
    keys = SigningKeys(tmp_path)
    keys.make("Ada")
    keys.make("Bob")
    (tmp_path / "keys" / "ada.key").write_bytes((tmp_path / "keys" / "bob.key").read_bytes())
    with pytest.raises(KeyFileError, match="does not belong"):
        keys.open(keys.choose("Ada"), lambda: None)


def test_no_key_and_several_keys_say_what_to_do(tmp_path: Path) -> None:
    keys = SigningKeys(tmp_path)
    with pytest.raises(KeyFileError, match="fieldhand keys new"):
        keys.choose()
    keys.make("Ada")
    bob, _ = keys.make("Bob")
    with pytest.raises(KeyFileError, match="Ada, Bob"):
        keys.choose()
    with pytest.raises(KeyFileError, match="Ada, Bob"):
        keys.choose("Eve")
    assert keys.choose("Bob").public == keys.choose(bob.public.fingerprint).public == bob.public


def test_a_key_is_never_written_over(tmp_path: Path) -> None:
    keys = SigningKeys(tmp_path)
    keys.make("Ada")
    before = (tmp_path / "keys" / "ada.key").read_bytes()
    with pytest.raises(KeyFileError, match="already"):
        keys.make("Ada")
    assert (tmp_path / "keys" / "ada.key").read_bytes() == before


@pytest.mark.parametrize("name", ["", "  ", "a\nb", "x" * 81, "\x1b[2J", "..", "///"])
def test_a_name_that_is_none(name: str, tmp_path: Path) -> None:
    with pytest.raises(KeyFileError):
        SigningKeys(tmp_path).make(name)
    assert not list(tmp_path.rglob("*.key"))


def test_a_name_is_never_a_path(tmp_path: Path) -> None:
    SigningKeys(tmp_path / "config").make("../../ada")
    assert [p.parent for p in tmp_path.rglob("*.key")] == [tmp_path / "config" / "keys"]


def test_trust_lasts_and_revoking_is_for_good(tmp_path: Path) -> None:
    ada, store = signing_key().public, TrustStore(tmp_path)
    assert store.known() == {}
    store.trust(ada, name="Ada", at=NOW)
    again = TrustStore(tmp_path).trust(ada, name="Ada L.", at=NOW + timedelta(days=1))
    assert (again.name, again.since, again.state) == ("Ada L.", NOW.isoformat(), "trusted")
    revoked = store.revoke(ada.fingerprint.lower(), at=NOW + timedelta(days=2))
    assert (revoked.name, revoked.state) == ("Ada L.", "revoked")
    assert store.revoke(ada.fingerprint, at=NOW + timedelta(days=3)) == revoked
    assert TrustStore(tmp_path).known() == {ada.fingerprint: revoked}
    with pytest.raises(KeyFileError, match="never trusted again"):
        store.trust(ada, name="Ada", at=NOW)


def test_a_key_can_be_revoked_before_anybody_trusts_it(tmp_path: Path) -> None:
    ada, store = signing_key().public, TrustStore(tmp_path)
    store.revoke(ada.fingerprint, at=NOW)
    assert store.known()[ada.fingerprint].state == "revoked"
    with pytest.raises(KeyFileError, match="revoked"):
        store.trust(ada, name="Ada", at=NOW)


def _other_key(text: str) -> str:
    from base64 import b64encode

    return text.replace(b64encode(signing_key(1).public.raw).decode(), b64encode(signing_key(2).public.raw).decode())


@pytest.mark.parametrize(
    "spoil",
    [
        lambda text: "",
        lambda text: text[: len(text) // 2],
        lambda text: "[" * 60_000,
        lambda text: text.replace('"name"', '"who"'),
        lambda text: text.replace("2026-05-01T00:00:00+00:00", "long ago"),
        _other_key,
    ],
    ids=["empty", "cut off", "deep", "another form", "no moment", "another key under this name"],
)
def test_a_damaged_file_of_a_trusted_key_trusts_nobody(spoil, tmp_path: Path) -> None:
    store = TrustStore(tmp_path)
    store.trust(signing_key(1).public, name="Ada", at=NOW)
    (file,) = (path for path in store.folder.iterdir() if path.name != "list.json")
    file.write_text(spoil(file.read_text()))
    with pytest.raises(KeyFileError, match="damaged"):
        store.known()


def test_what_others_could_have_written_is_not_trusted(tmp_path: Path) -> None:
    store = TrustStore(tmp_path / "config")
    store.trust(signing_key().public, name="Ada", at=NOW)
    (file,) = (path for path in store.folder.iterdir() if path.name != "list.json")
    for path, good, wide in ((file, 0o600, 0o620), (store.folder, 0o700, 0o702), (tmp_path / "config", 0o700, 0o770)):
        path.chmod(wide)
        with pytest.raises(KeyFileError, match="written by others"):
            store.known()
        path.chmod(good)
    assert store.known()


@pytest.mark.skipif(os.name != "posix" or os.geteuid() != 0, reason="only root can give a file away")
def test_what_belongs_to_another_user_is_not_trusted(tmp_path: Path) -> None:
    store, keys = TrustStore(tmp_path), SigningKeys(tmp_path)
    keys.make("Ada")
    store.trust(signing_key().public, name="Ada", at=NOW)
    os.chown(next(store.folder.iterdir()), 12345, 12345)
    os.chown(keys.choose().file, 12345, 12345)
    with pytest.raises(KeyFileError, match="another user"):
        store.known()
    with pytest.raises(KeyFileError, match="another user"):
        keys.choose()


def test_a_folder_that_cannot_be_written_is_said(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="FIELDHAND_CONFIG"):
        SigningKeys(tmp_path / "file").make("Ada")
    with pytest.raises((OutputError, KeyFileError)):
        TrustStore(tmp_path / "file").revoke(signing_key().public.fingerprint, at=NOW)


@pytest.mark.parametrize(("said", "on"), [("1", True), ("Yes", True), (" on ", True), ("", False), ("0", False)])
def test_production_is_said_plainly(said: str, on: bool) -> None:
    assert in_production({"FIELDHAND_PRODUCTION": said}) == on
    if on:
        with pytest.raises(NotTrustedError):
            require_unsigned_allowed({"FIELDHAND_PRODUCTION": said})
    else:
        require_unsigned_allowed({"FIELDHAND_PRODUCTION": said})


@pytest.mark.parametrize("said", ["maybe", "ture", "2"])
def test_a_mode_that_nobody_can_tell_runs_nothing(said: str) -> None:
    with pytest.raises(InputError, match="neither yes nor no"):
        require_unsigned_allowed({"FIELDHAND_PRODUCTION": said})
