"""A key that anybody could sign with is no key, and a name that can be read as another's is no name."""

# ruff: noqa: RUF001

from __future__ import annotations

import base64
import json
import unicodedata
from datetime import datetime
from pathlib import Path

import pytest
from cryptography.exceptions import InvalidSignature
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey
from hypothesis import given, settings
from hypothesis import strategies as st

from fieldhand.approval.bundle.container import MANIFEST, SIGNATURE, wrap
from fieldhand.approval.bundle.opening import unseal
from fieldhand.approval.keys.curve import is_sound
from fieldhand.approval.keys.names import clean_name, look_alike
from fieldhand.approval.keys.public import PublicKey, parse_public
from fieldhand.approval.keys.trust import TrustStore
from fieldhand.compatibility import UTC
from fieldhand.errors import BundleError, KeyFileError
from support.examples import examples
from support.missions.signed import good, members_of, signing_key

NOW = datetime(2026, 5, 1, tzinfo=UTC)
_P = 2**255 - 19
_EIGHTH = 2707385501144840649318225287225658788936804267575313519463743609750303021421
#: The points of order 1, 2, 4 and 8, in every form in which 32 bytes can hold them.
SMALL = sorted(
    {
        (y + extra) | sign << 255
        for y in (0, 1, _P - 1, _EIGHTH, _P - _EIGHTH)
        for extra in (0, _P)
        for sign in (0, 1)
        if y + extra < 2**255
    }
)


@pytest.mark.parametrize("number", SMALL)
def test_a_point_of_small_order_is_no_key_wherever_it_is_met(number: int, tmp_path: Path) -> None:
    raw = number.to_bytes(32, "little")
    key = PublicKey(raw=raw, name="Ada")
    assert not is_sound(raw)
    with pytest.raises(KeyFileError, match="anybody could sign"):
        parse_public(key.line(), source="ada.pub")
    store = TrustStore(tmp_path)
    with pytest.raises(KeyFileError, match="anybody could sign"):
        store.trust(key, name="Ada", at=NOW)
    record = {"fingerprint": key.fingerprint, "name": "Ada", "since": "2026-05-01T00:00:00+00:00"}
    record["public_key"] = base64.b64encode(raw).decode()
    store.folder.mkdir(parents=True)
    (store.folder / f"{key.fingerprint}.json").write_text(json.dumps(record))
    with pytest.raises(KeyFileError, match="anybody could sign"):
        store.known()


def test_a_signature_that_holds_without_a_private_key_signs_nothing() -> None:
    """With the neutral element as key, R = S·B holds for every message: the library takes it, Fieldhand does not."""
    raw, value = (1).to_bytes(32, "little"), (1).to_bytes(32, "little") + bytes(32)
    forged = 0
    for message in (b"one plan", b"another plan"):
        try:
            Ed25519PublicKey.from_public_bytes(raw).verify(value, message)
            forged += 1
        except InvalidSignature:
            pass
        assert not PublicKey(raw=raw).verifies(value, message)
    assert forged == 2
    members = members_of(good())
    encoded = base64.b64encode(raw), base64.b64encode(value)
    members[SIGNATURE] = b"fieldhand-ed25519 %s\n%s\n" % encoded
    assert members[MANIFEST]
    with pytest.raises(BundleError, match="signature is broken"):
        unseal(wrap(members), source="m")


@settings(max_examples=examples(20, thorough=500), deadline=None)
@given(seed=st.integers(0, 255))
def test_a_key_that_was_made_is_sound_and_so_is_no_sum_with_a_small_one(seed: int) -> None:
    from fieldhand.approval.keys import curve

    raw = signing_key(seed).public.raw
    assert is_sound(raw)
    point, minus_one = curve._decoded(raw), curve._decoded((_P - 1).to_bytes(32, "little"))
    assert point is not None
    assert minus_one is not None
    x, y, z, _ = curve._sum(point, minus_one)
    x, y = (v * pow(z, _P - 2, _P) % _P for v in (x, y))
    assert not is_sound((y | (x & 1) << 255).to_bytes(32, "little"))


NAMES = {
    "hidden": ["A\u200bda", "Ada\u202e", "Ada\u00ad", "A\u0007da", "Ada\u3164", "Ada\ufe0f", "\u2066Ada\u2069"],
    "variant of another": ["Ａda", "Ａｄａ", "ﬁona", "Ⓐda", "Ada²", "𝐀𝐝𝐚", "𝒜da", "𝟏da", "ℵda", "ſam"],
    "mixes the scripts": ["Аda", "Аdа", "Adа", "Αda", "Ada山", "Αдa"],
    "no living language": ["ᎪᎠᎪ", "ᎠᎳᎢ", "ɑda", "ᴀᴅᴀ", "ǃda", "ⲀⲆⲀ", "ꓐꓲꓡꓡ", "𐐀𐐁", "Ѡда", "ꙁда", "Aԁa", "𐌀𐌁"],
    "mark without a letter": ["\u0301", "\u0301Ada", "1\u0301"],
    "variant of another|space": ["Ada\u00a0L", "Ada\u2003L", "Ada\u3000L"],
    "two spaces": ["Ada  L"],
    "neither a letter nor a digit": ["-", "...", "()"],
    "digit": ["Ada ٣"],
    "empty": ["", "   "],
    "more than 80": ["A" * 81],
}


@pytest.mark.parametrize(("why", "name"), [(why, name) for why, names in NAMES.items() for name in names])
def test_a_name_that_can_be_taken_for_another_is_refused_and_the_error_says_why(why: str, name: str) -> None:
    with pytest.raises(KeyFileError, match=why):
        clean_name(name)


@pytest.mark.parametrize(
    "name",
    [
        "Ada",
        "Ada Lovelace (farm 2)",
        "José Núñez",
        "Jose\u0301",
        "Ада Лавлейс",
        "Αθηνά",
        "山田たろう",
        "김철수",
        "Łukasz Żółć",
        "Đặng Thị Ánh",
        "Þórður Guðmundsson",
        "Ğül Işık",
        "Əli",
        "Ɗanladi Ƙofar",
        "Ґрунт Їжак",
        "Қазақ Әлия",
        "Հայկ",
        "דוד כהן",
        "محمد علي",
        "देवी",
        "สมชาย",
        "გიორგი",
        "O'Neil, A.",
    ],
)
def test_names_of_people_are_names(name: str) -> None:
    assert clean_name(name) == unicodedata.normalize("NFC", name)


@given(text=st.text(max_size=20))
def test_a_name_that_is_taken_stays_the_same_and_says_all_that_it_holds(text: str) -> None:
    try:
        name = clean_name(text)
    except KeyFileError:
        return
    assert clean_name(name) == name
    assert name.isprintable()
    assert unicodedata.normalize("NFKC", name) == name


@pytest.mark.parametrize(
    ("trusted", "other"),
    [
        ("Ada", "ADA"),
        ("Ada", "Àda"),
        ("Ada", "Ada."),
        ("Bill", "BiII"),
        ("Mark", "rnark"),
        ("caco", "сасо"),
        ("NIKO", "ΝΙΚΟ"),
        ("niko", "ΝΙΚΟ"),
        ("ПАВЕЛ", "Павел"),
        ("bob", "ЬОЬ"),
        ("oooo", "օօօօ"),
        ("oooo", "σσσσ"),
        ("Yaya", "үаүа"),
        ("ΠΑΦ", "ПАФ"),
        ("ΛΑΓ", "ЛАГ"),
        ("hehe", "ћҽћҽ"),
        ("oooo", "ഠഠഠഠ"),
        ("333", "ЗЗЗ"),
        ("666", "ббб"),
    ],
)
def test_a_second_key_with_a_name_that_looks_the_same_is_not_trusted(trusted: str, other: str, tmp_path: Path) -> None:
    store = TrustStore(tmp_path)
    first, second = signing_key(1).public, signing_key(2).public
    assert look_alike(trusted, other)
    store.trust(first, name=trusted, at=NOW)
    with pytest.raises(KeyFileError, match="looks like"):
        store.trust(second, name=other, at=NOW)
    assert list(store.known()) == [first.fingerprint]
    store.trust(first, name=other, at=NOW)
    store.trust(second, name=f"{other} 2", at=NOW)
    store.revoke(first.fingerprint, at=NOW)
    store.trust(second, name=trusted, at=NOW)


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("Ada", "Ida"),
        ("Anna", "Ahha"),
        ("Павел", "Петр"),
        ("Νίκος", "Νέος"),
        ("Ada", "Ада Л"),
        ("Bob", "Rob"),
        ("1", "2"),
    ],
)
def test_names_that_differ_are_two_names(one: str, other: str) -> None:
    assert not look_alike(one, other)
