"""Spanish nouns and adjectives by gender and number, and verbs in the forms in which requests have them.

Forms are without accents, as :mod:`.tokens` folds them: "fotografía" is ``fotografia``.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

#: Words at which the inflected part of a noun phrase ends: "puntos de partida".
_ENDS_HEAD = frozenset({"de", "a", "en", "por", "con", "el", "la"})
_VOWELS = "aeiou"
#: Spelling of a stem before "e", where it ends in one of these before "a" and "o".
_BEFORE_E = (("c", "qu"), ("g", "gu"), ("z", "c"))
#: Spelling of a stem before "a", where it ends in one of these before "e" and "i".
_BEFORE_A = (("gu", "g"), ("g", "j"), ("c", "zc"))


def plural_of(words: Sequence[str]) -> tuple[str, ...]:
    """Return a noun phrase in the plural: the noun and the adjectives behind it."""
    end = next((k for k, word in enumerate(words) if word in _ENDS_HEAD), len(words))
    return (*(_plural(word) for word in words[:end]), *words[end:])


def _plural(word: str) -> str:
    """Return a noun or an adjective in the plural."""
    if word.endswith("z"):
        return word[:-1] + "ces"
    return word + ("s" if word[-1] in _VOWELS else "es")


def adjective_forms(words: Sequence[str]) -> Iterator[tuple[tuple[str, ...], bool]]:
    """Yield a phrase that ends in an adjective in each gender and number, with True for the plural."""
    *before, last = words
    feminine = [last[:-1] + "a"] if last.endswith("o") else []
    for form in (last, *feminine):
        yield (*before, form), False
        yield (*before, _plural(form)), True


def verb_forms(infinitive: str, irregular: Mapping[str, Sequence[str]]) -> list[str]:
    """Return the forms of a verb that commands and clauses have.

    These are the infinitive, the imperative and the subjunctive (of tú, usted, ustedes, and of vos, which the first
    resembles without accents), the present of the third person, the gerund, and the participle.

    Args:
        infinitive: Infinitive without accents.
        irregular: By infinitive the present of the third person, which is the imperative of tú as well, the subjunctive
            of the third person, the gerund, and further forms.
    """
    stem, ending = infinitive[:-2], infinitive[-2:]
    if infinitive in irregular:
        present, subjunctive, gerund, *more = irregular[infinitive]
    else:
        more = []
        present = stem + ("a" if ending == "ar" else "e")
        subjunctive = _respelt(stem, _BEFORE_E) + "e" if ending == "ar" else _respelt(stem, _BEFORE_A) + "a"
        gerund = stem + ("ando" if ending == "ar" else "iendo")
    participle = stem + ("ad" if ending == "ar" else "id")
    forms = [infinitive, present, present + "n", subjunctive, subjunctive + "n", subjunctive + "s", gerund, *more]
    forms += [participle + gender + number for gender in "oa" for number in ("", "s")]
    forms.append(infinitive[:-1])  # the imperative of vos: "medí"
    return list(dict.fromkeys(forms))


def commanding_forms(infinitive: str, irregular: Mapping[str, Sequence[str]]) -> list[str]:
    """Return the forms to which a pronoun is joined: "mídelo", "medirlo", "midiéndolo"."""
    participles = 4
    forms = verb_forms(infinitive, irregular)
    return [form for form in forms if form not in forms[-participles - 1 : -1]]


def _respelt(stem: str, changes: Iterable[tuple[str, str]]) -> str:
    """Return a stem as it is spelt before the vowel of another form."""
    for ending, instead in changes:
        if stem.endswith(ending):
            return stem.removesuffix(ending) + instead
    return stem
