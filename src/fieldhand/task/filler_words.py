"""Words that ask for nothing wherever they occur: the only words that a planner may ignore without a warning.

The list is deliberately small. A missing word costs one confirmation; a wrong word costs a wrong mission. So it has no
number, side, time, manner or measured quantity, and nothing that negates or restricts ("not", "except", "if",
"instead").
"""

from __future__ import annotations

import unicodedata

from fieldhand.language import RequestLanguage


def _words(text: str) -> frozenset[str]:
    """Return the words of a text."""
    return frozenset(text.split())


#: Articles, prepositions, conjunctions, pronouns and auxiliaries.
FUNCTION_WORDS = _words(
    """
    a about also am an and are as at be been being but by can could did do does for from had has have he her here
    him i in into is it its let may me might must my of on onto or our shall she should so than that the their
    them then there these they this those to too us was we were which who will with would you your
    plus canst couldst dost doth hast hath shalt shouldst thee thine thou thy unto wouldst ye
    """
)
#: Courtesies.
_COURTESY = _words(
    """
    afternoon ah aha appreciated boss brilliant buddy cheers course dear eh er erm evening fine folks glad great
    greetings guys happy hello hey hi hmm huh kind kindly lovely madam mate mind morning much nice oh ok okay pal
    perfect please pls replicate plz sir sure ta thank thanks thx tnx uh uhm um welcome well wonder wondering yes
    """
)
#: Names for the robot and its equipment.
_ADDRESSED = _words(
    """
    bot camera case equipment goal instruction instructions job machine mission missions onboard plan request
    robot robots rover sensor sensors task test thing things ugv unit vehicle
    """
)
#: Verbs and phrases that only introduce the request.
_LEADING = _words(
    """
    able advance ahead ask asked because before begin capture carry check choose collect come deploy do doing done
    drive driving find forget get give go going head i'd i'll i'm it'd it's keep kick know let's lets like likes look
    looking love make measure measured measuring need needed needs off out over perform photograph photographing pick
    picture pictures proceed reading readings record remember require required requires see send sent start started
    take taken taking tell that's there's through u use using visit want wanted wants way we'd we're what what's
    whats wish wishes you'd
    """
)
#: Words of little content, and nouns common to all requests.
_SAYING_LITTLE = _words(
    """
    actually after again any apart approximately around basically block certain confirm consider content distance
    each entire estate even every exactly farm field finally finished first firstly focus following full given
    good grove how itself just least level lies limit limited many max maximum meaning merely minimum more most namely
    next now once one ones only orchard order own particular place places plant plantation plants plot point
    points possible precisely really rectangle rectangular regarded respective result roughly seen simply single
    site solely some somewhere spaced spot spots stands still such time tops total treat treating tree trees up upper
    value very viewed viewing vine vines vineyard when where while whole
    """
)
#: Words that ask for nothing.
FILLER_WORDS = FUNCTION_WORDS | _COURTESY | _ADDRESSED | _LEADING | _SAYING_LITTLE

#: The same of Spanish, without accents.
_SPANISH_FUNCTION_WORDS = _words(
    """
    a al con de del e el ella ellas ellos en era es esa esas ese eso esos esta estan estas este esten esto estos fue
    la las le les lo los me mi mis nos o para pero por que se sea son su sus te u un una y
    """
)
_SPANISH_FILLERS = _words(
    """
    ademas ahora algun arbol arboles azar bien buenas buenos cada campo como comprobarlo confirmar confirmarlo
    considerando cualquier debe debes despues dias entonces envia favor finca foto fotos gracias gustaria hola
    huerto luego lugar manda media medicion mediciones medio muchas necesito orden podria podrias primero
    promedio puede puedes punto quiero quisiera rectangulo robot tambien tardes toma tomar vale vaya ve viendo
    """
)


def is_function_word(word: str, language: RequestLanguage = "en") -> bool:
    """Return True for an article, a preposition, a conjunction, a pronoun or an auxiliary of a language."""
    if language == "es":
        return _plain(word) in _SPANISH_FUNCTION_WORDS
    return word in FUNCTION_WORDS


def is_filler(word: str, language: RequestLanguage = "en") -> bool:
    """Return True if a word asks for nothing wherever it occurs in a request of a language."""
    if language == "es":
        return _plain(word) in _SPANISH_FUNCTION_WORDS | _SPANISH_FILLERS
    return word.strip().lower().replace("\u2019", "'").rstrip(".") in FILLER_WORDS


def _plain(word: str) -> str:
    """Return a word in lower case without accents."""
    return "".join(c for c in unicodedata.normalize("NFD", word.strip().lower()) if not unicodedata.combining(c))
