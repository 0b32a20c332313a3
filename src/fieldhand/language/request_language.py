"""The language of a request, so that all parts of the program read its words by the same lists."""

from __future__ import annotations

import re
import unicodedata
from functools import lru_cache
from typing import Literal

RequestLanguage = Literal["en", "es"]


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


#: Frequent words of Spanish requests, without accents, that are no English words.
_SPANISH = _words(
    """
    ademas ahi al algun alguna alli altura amarilla amarillas amarillo amarillos ambos antes arbol arboles aqui azar
    baja bajo bateria bloque borde busca cada caliente campo cargador centro cepa cepas cerca cercano cercanos como
    con conduce contiguos continua cualquier cualquiera cuando cuatro de debajo del desde despues detente distintos
    donde dos edad el ella ellas ellos empieza encima en entonces entre es esa ese eso esos esquina esquinas
    esta estan este esten excepto extremo fila filas finca foto fotos fotografia fotografias fotografiando fotografie
    fotografiar fotografialo fotografialos gracias grados guarda hacia haga hasta haz hazlo hilera hileras hoja
    huerto humedad imagen imagenes impares inicio la lado las lectura lecturas lo los luego lugar mas mayor medicion
    mediciones medir menor menos metros mide midelo midiendo mientras minutos mitad muestra muestras mueve nitrato
    noreste noroeste norte nuevo o oeste otra otras otro otros para pares parcela partida planta plantas por primer
    primera primero proceso puedas puntos punto quiero realiza recorre recorrer recorriendo recompensa registra
    regresa repite rendimiento saca saque segunda segundo segun si siguiente sino sobre suelo supera sur sureste
    suroeste tanto tantos temperatura tercer tercera termica termicas termina tomale todas todo todos toma tomar
    tomando tome tras tres ultima ultimo una unas uno unos ve vaya vid vides viejos vina vinedo visita volver vuelve
    vuelva y zona cinco seis siete ocho nueve diez veinte treinta cien doscientos hola podrias puedes tomen mida midan
    verdes verde recorrido iniciar acto continuacion fin leer lee lea sacar hacer ir
    """
)
#: Frequent words of English requests that are no Spanish words.
_ENGLISH = _words(
    """
    about above across after again air all along also an and another any apart are as at back be before below between
    both but by canopy capture charger check closest collect corner corners degrees do down drive each east eastern
    edge end every except far farthest feet few field first five for four from further get give go half head here
    highest home hot if image images in inside into is it its keep last leaf least left less let level low lowest
    make many measure measurement measurements meters metres middle minutes more most move near nearby nearest next
    nitrate north northern not of off oldest on one ones only orchard other otherwise out over part photo photograph
    photos pic pics pick picture pictures please point points quarter random read reading readings record rest return
    robot's row rows same sample samples second send side six snap soil some south southern spot start starting stop
    take takes taken temp temperature than that the their them then there these they third this those three through
    to tree trees twice two under until up use vine vines visit walk want we west western what when where which while
    whole with within without yellow you your youngest
    """
)
#: Letters and signs that Spanish has and English has not.
_SPANISH_SIGNS = re.compile("[\u00e1\u00e9\u00ed\u00f3\u00fa\u00f1\u00bf\u00a1]", re.IGNORECASE)
_WORD = re.compile(r"[^\W\d_]+(?:['\u2019][^\W\d_]+)?")


@lru_cache(maxsize=64)
def language_of_request(request: str) -> RequestLanguage:
    """Return the language of which a request has more frequent words; English if they are equally many.

    The same text is always of the same language.
    """
    words = [word.lower() for word in _WORD.findall(unicodedata.normalize("NFC", request))]
    spanish = sum(_folded(word) in _SPANISH or _SPANISH_SIGNS.search(word) is not None for word in words)
    english = sum(word in _ENGLISH for word in words)
    return "es" if spanish > english else "en"


def _folded(word: str) -> str:
    """Return a word without accents."""
    return "".join(c for c in unicodedata.normalize("NFD", word) if not unicodedata.combining(c))
