"""Spanish requests with the outlines of their plans, on the built-in orchard with the robot ``husky``."""

# ruff: noqa: E501 - a request and its plan stand on one line each

from __future__ import annotations

PLANNED: list[tuple[str, str]] = [
    ("Fotografía cada tercer árbol de la fila 2", "for EveryNth(3, of Rows(2, 2)): [picture]"),
    ("Toma una foto de cada tres árboles de la fila 5.", "for EveryNth(3, of Rows(5, 5)): [picture]"),
    ("Mide el CO2 en los árboles 4, 9 y 12.", "for UnionOf(TreeIs(4)+TreeIs(9)+TreeIs(12)): [co2]"),
    ("Por favor, fotografía todos los árboles de las filas 2 a 5.", "for Rows(2, 5): [picture]"),
    (
        "Fotografía los árboles de las filas 2, 4 y 7 en cualquier orden.",
        "for UnionOf(Rows(2, 2)+Rows(4, 4)+Rows(7, 7)): [picture]",
    ),
    ("Saca una foto del último árbol de la fila 3.", "picture @ InRow(-1, -1, of Rows(3, 3))"),
    ("Toma fotos de los cinco árboles más viejos de la mitad sur.", "for Top(age_years, 5, of Half(south)): [picture]"),
    (
        "Fotografía los árboles que tengan más de 8 años en el cuadrante noreste.",
        "for Where(age_years, gt, 8, of Quarter(ne)): [picture]",
    ),
    ("Fotografía el árbol amarillo más al oeste.", "picture @ Extreme(west, of Where(leaf_color, eq, yellow))"),
    (
        "Toma una foto térmica de todos los árboles a menos de 20 metros del cargador.",
        "for Within(20, Marker(charger)): [picture]",
    ),
    ("Mide la temperatura del aire en el árbol más cercano al cargador.", "air @ Nearest(Marker(charger))"),
    ("Mide el CO2 cada 20 m a lo largo de la fila 4.", "for Spaced(20, of Rows(4, 4)): [co2]"),
    ("Haz tres lecturas de CO2 separadas 15 metros.", "for Spaced(15, 3): [co2]"),
    (
        "Toma una foto del árbol 4. Si está por encima de 38,5 °C, mide el CO2; si no, vuelve al inicio.",
        "picture @ TreeIs(4) = r1; if r1 > 38.5 degC: [co2] else [go Marker(start)] | return_to_start",
    ),
    (
        "Si el CO2 en el árbol 4 es menor de 400 ppm, toma una foto del árbol 5.",
        "co2 @ TreeIs(4) = r1; if r1 < 400 ppm: [picture @ TreeIs(5)]",
    ),
    (
        "En cada árbol amarillo toma una foto; si está más caliente que 38 grados, mide también el CO2.",
        "for Where(leaf_color, eq, yellow): [picture = r1; if r1 > 38 degC: [co2]]",
    ),
    (
        "Fotografía las esquinas y vuelve antes de que la batería baje del 30 %.",
        "for Corners: [picture] | reserve 30 | return_to_start",
    ),
    (
        "Fotografía tantos árboles de la mitad norte como puedas en 20 minutos.",
        "for Half(north) optional: [picture] | duration_s 1200",
    ),
    (
        "Fotografía todos los árboles que puedas, a lo sumo 200 metros.",
        "for Trees optional: [picture] | distance_m 200",
    ),
    (
        "Toma una foto del árbol 4. Si la batería lo permite, toma también una foto del árbol 5.",
        "picture @ TreeIs(4); maybe [picture @ TreeIs(5)]",
    ),
    (
        "Toma una foto en el árbol 4. Si falla, mide el CO2 en el árbol 5.",
        "try [picture @ TreeIs(4)] or [co2 @ TreeIs(5)]",
    ),
    ("Visita los árboles 3 y 9 y fotografíalos.", "for UnionOf(TreeIs(3)+TreeIs(9)): [picture]"),
    (
        "Fotografía los árboles amarillos de norte a sur.",
        "for Ordered(north_to_south, of Where(leaf_color, eq, yellow)) given: [picture]",
    ),
    (
        "Fotografía los árboles amarillos, los más viejos primero.",
        "for Ordered(attribute, age_years, True, of Where(leaf_color, eq, yellow)) given: [picture]",
    ),
    ("Toma dos fotos del árbol veintitrés.", "picture x2 @ TreeIs(23)"),
    ("Ve al árbol 12, mide el CO2, ve al árbol 30 y mídelo otra vez.", "go TreeIs(12); co2; go TreeIs(30); co2"),
    ("Después de fotografiar el árbol 9, vuelve al inicio.", "picture @ TreeIs(9) | return_to_start"),
    ("Fotografía los tres primeros árboles de cada fila.", "for InRow(1, 3, of Rows): [picture]"),
    (
        "Fotografía todos los árboles de la fila 3 excepto los árboles 40 y 41.",
        "for Excluding(UnionOf(TreeIs(40)+TreeIs(41)), of Rows(3, 3)): [picture]",
    ),
    (
        "Fotografía los árboles 5, 9 y 30 hasta que uno esté por encima de 38 °C.",
        "for UnionOf(TreeIs(5)+TreeIs(9)+TreeIs(30)) until r1 > 38 degC: [picture = r1]",
    ),
    ("Recorre la fila 3 y fotografía cada segundo árbol.", "for EveryNth(2, of Rows(3, 3)): [picture]"),
    (
        "Mide el CO2 en el árbol 4. Si es bajo, toma una foto. Luego ve al árbol 9 y mide el CO2.",
        "co2 @ TreeIs(4) = r1; if r1 low: [picture]; go TreeIs(9); co2",
    ),
    ("Toma una foto de los árboles que no sean amarillos.", "for Where(leaf_color, ne, yellow): [picture]"),
    ("Mide el CO2 en cuatro árboles de la segunda fila desde el este.", "for Take(4, of Rows(2, 2, east)): [co2]"),
    ("Toma una foto del árbol 50 y del árbol que está enfrente.", "picture @ TreeIs(50); picture @ Across"),
    ("Fotografía hasta 6 árboles de la mitad norte.", "for Half(north) at most 6: [picture]"),
    (
        "Toma una foto en ambos extremos de la fila 4.",
        "for UnionOf(InRow(1, 1, of Rows(4, 4))+InRow(-1, -1, of Rows(4, 4))): [picture]",
    ),
    ("Fotografía un árbol sí y otro no de la fila 6.", "for EveryNth(2, of Rows(6, 6)): [picture]"),
    (
        "Mide la temperatura en el árbol 4 y, si está entre 20 y 30 °C, toma una foto.",
        "air @ TreeIs(4) = r1; if 20 <= r1 <= 30 degC: [picture]",
    ),
    ("Fotografía el árbol del medio de la fila 4.", "picture @ Middle(of Rows(4, 4))"),
    (
        "Fotografía cada árbol de las filas pares sin usar más del 40 % de la batería.",
        "for Rows(2, 2): [picture] | energy_percent 40",
    ),
    ("Haz una foto a cada árbol de la fila 7, por favor.", "for Rows(7, 7): [picture]"),
    ("Ve al árbol más lejano del cargador y mide el CO2.", "go Farthest(Marker(charger)); co2"),
    ("Tómale una foto al árbol 12.", "picture @ TreeIs(12)"),
    ("Visita las cuatro esquinas y mide el CO2 en cada una.", "for Corners: [co2]"),
    ("Fotografía los árboles 1, 2 y 3 en ese orden.", "for UnionOf(TreeIs(1)+TreeIs(2)+TreeIs(3)) given: [picture]"),
    ("Toma una foto de los árboles situados en la parte oeste de la finca.", "for Half(west): [picture]"),
    ("Recorre las filas 2 y 4 y toma una foto de cada árbol.", "for UnionOf(Rows(2, 2)+Rows(4, 4)): [picture]"),
    (
        "Usa como máximo el 50 % de la batería y fotografía tantos árboles como puedas.",
        "for Trees optional: [picture] | energy_percent 50",
    ),
    ("Fotografía todos los árboles excepto los amarillos.", "for Excluding(Where(leaf_color, eq, yellow)): [picture]"),
    ("Fotografía diez árboles al azar.", "for RandomSample(10): [picture]"),
    ("Mide el CO2 en el árbol 20 dos veces.", "co2 x2 @ TreeIs(20)"),
    (
        "Ve al centro de la fila 5 y mide el CO2. Si es mayor de 450 ppm, toma una foto.",
        "go Middle(of Rows(5, 5)); co2 = r1; if r1 > 450 ppm: [picture]",
    ),
    ("Fotografía el árbol que está al lado del árbol 12.", "picture @ Nearest(TreeIs(12), True)"),
    (
        "Si la temperatura del aire en el árbol 10 supera los 35 °C, mide el CO2 allí.",
        "air @ TreeIs(10) = r1; if r1 > 35 degC: [co2]",
    ),
    ("Saca fotos en el borde norte.", "for Edge(north): [picture]"),
    ("Fotografía la fila 2, cada tercer árbol.", "for EveryNth(3, of Rows(2, 2)): [picture]"),
    ("Fotografía los árboles Nonpareil de la fila 3.", "for Where(variety, eq, Nonpareil, of Rows(3, 3)): [picture]"),
    ("Toma fotos de los árboles que tienen más de diez años.", "for Where(age_years, gt, 10): [picture]"),
    (
        "Fotografía los árboles 10 a 20 y vuelve al punto de partida.",
        "for UnionOf(TreeIs(10)+TreeIs(11)+TreeIs(12)+TreeIs(13)+TreeIs(14)+TreeIs(15)+TreeIs(16)+TreeIs(17)+TreeIs(18)+TreeIs(19)+TreeIs(20)): [picture] | return_to_start",
    ),
    (
        "Fotografía los árboles del 10 al 20.",
        "for UnionOf(TreeIs(10)+TreeIs(11)+TreeIs(12)+TreeIs(13)+TreeIs(14)+TreeIs(15)+TreeIs(16)+TreeIs(17)+TreeIs(18)+TreeIs(19)+TreeIs(20)): [picture]",
    ),
    ("Mide el CO2 en la esquina suroeste y regresa a la base.", "co2 @ Corners(sw) | return_to_start"),
    ("Fotografía 3 de cada 5 árboles de la fila 2.", "for Evenly(3, 5, of Rows(2, 2)): [picture]"),
    (
        "Mide el CO2 en el árbol 7. Si es alto, toma dos fotos; en caso contrario, mide la temperatura del aire.",
        "co2 @ TreeIs(7) = r1; if r1 high: [picture x2] else [air]",
    ),
    (
        "Primero fotografía el árbol 3, luego el árbol 8 y por último el árbol 2.",
        "picture @ TreeIs(3); picture @ TreeIs(8); picture @ TreeIs(2)",
    ),
    (
        "Fotografía los árboles amarillos que están en la mitad norte.",
        "for Where(leaf_color, eq, yellow, of Half(north)): [picture]",
    ),
    ("Toma una foto cada 10 metros a lo largo de la fila 3.", "for Spaced(10, of Rows(3, 3)): [picture]"),
    ("Fotografiar el árbol 33 y medir el CO2.", "picture @ TreeIs(33); co2"),
    ("Fotografíe el árbol 33 y mida el CO2.", "picture @ TreeIs(33); co2"),
    ("Fotografíen los árboles de la fila 9.", "for Rows(9, 9): [picture]"),
    ("Fotografía los árboles de las hileras 2 a la 4.", "for Rows(2, 4): [picture]"),
    ("El robot debe tomar una foto del árbol 4.", "picture @ TreeIs(4)"),
    ("Toma una foto del penúltimo árbol de la fila 3.", "picture @ InRow(-2, -2, of Rows(3, 3))"),
    (
        "Fotografía el árbol situado más al sur y el árbol situado más al norte.",
        "for UnionOf(Extreme(south)+Extreme(north)): [picture]",
    ),
    (
        "Fotografía cada árbol amarillo a menos de 30,5 metros del inicio.",
        "for Within(30.5, Marker(start), of Where(leaf_color, eq, yellow)): [picture]",
    ),
    (
        "Toma fotos de los árboles de la fila 3 y guarda al menos un 30 % de batería.",
        "for Rows(3, 3): [picture] | reserve 30",
    ),
    (
        "Mide el CO2 en los árboles 5 y 6, y mide la temperatura del aire en el árbol 7.",
        "for UnionOf(TreeIs(5)+TreeIs(6)): [co2]; air @ TreeIs(7)",
    ),
]

#: Requests that have to be asked about or refused, and none of which is planned.
NOT_PLANNED: list[str] = [
    "Fotografía la fila 3.",
    "Toma una foto en el árbol 4 mañana.",
    "No fotografíes el árbol 4.",
    "Toma una foto en el árbol 4 en lugar del árbol 5.",
    "Fotografía 12 esquinas.",
    "Fotografía algunos árboles de la fila 3.",
    "Fotografía unos árboles de la fila 3.",
    "Espera 5 minutos en el árbol 4 y toma una foto.",
    "Fotografía los tres árboles amarillos.",
    "Conduce despacio por la fila 3 y fotografía cada árbol.",
    "Fotografía todos los árboles a menos de 1.500 metros del cargador.",
    "Toma una foto del árbol 4 si la batería está por debajo del 30 %.",
    "Fotografía la fila más al norte.",
    "Fotografía el árbol 4 o el árbol 5.",
    "Cada mañana, fotografía el árbol 4.",
    "Toma 2 fotos en las esquinas.",
    "Fotografía el árbol 5 de la fila 1.",
    "Mide el CO2 cada 20 m.",
    "Si es bajo, toma una foto del árbol 4.",
    "Fotografía el árbol 9999.",
    "Repite el proceso.",
    "Fotografía el árbol 4, no el árbol 5.",
    "Fotografía las filas 2 y 3 excepto el lunes.",
    "Toma una foto del árbol 4 y del robot.",
    "Fotografía la mitad norte.",
    "Fotografía el árbol 4,5.",
    "Fotografía el árbol 3 a 5 metros.",
    "Mide el CO2 en el árbol 4. Si es bajo o no, toma una foto.",
    "Toma una foto del árbol 4 sin el árbol 5.",
    "Fotografía el árbol 4 y riégalo.",
    "Mide el CO2 en el árbol 4 dentro de 5 minutos.",
    "Toma fotos de todos los árboles de la fila 3, pero solo si son amarillos y jóvenes.",
    "Mide la temperatura de los árboles más calientes.",
    "Mide el pH del suelo en el árbol 4.",
    "Fotografía este árbol.",
    "Vuelve al árbol 4 cuando llueva.",
    "Fotografía el árbol cuatro de cada fila mas no el quinto.",
    "Mide el CO2 en el árbol 4 hasta que sea bajo.",
    "Fotografía el árbol 4 nunca.",
    "Mide el CO2 en la calle 3.",
    "Fotografía los árboles de la fila 2 del bloque 7.",
    "Fotografía casi todos los árboles.",
    "Toma una foto del árbol 4 a las 10.",
]

#: The requests of the published experiments in Spanish, with the outlines of the plans of the English ones: the
#: built-in orchard's site with the robot ``husky`` where nothing else is said.
EXPERIMENTS: list[tuple[str, str, str]] = [
    (
        "three-of-five",
        "Recorre una fila de 5 árboles y toma una foto en 3 de ellos.",
        "for Evenly(3, of Successive(5)): [picture]",
    ),
    (
        "four-trees-two-sensors",
        "Toma una foto de 2 árboles contiguos y luego haz 2 lecturas de CO2 de dos árboles contiguos.",
        "for Adjacent(Here): [picture]; for Adjacent(Here): [co2]",
    ),
    (
        "reward",
        "Visita los 10 árboles con la mayor recompensa y toma una foto en cada uno de ellos.",
        "for Top(reward, 10): [picture]",
    ),
    (
        "five-nested-ifs",
        "En el primer árbol, toma una foto. Si esa foto muestra menos de 33 °C, haz una lectura de temperatura. Si esa lectura es inferior a 30 °C, toma una muestra de CO2. Si esa lectura es inferior a 400 ppm, conduce hasta un árbol lejano y repite el proceso. Si la primera lectura no es baja, termina.",
        "go First; picture = r1; if r1 < 33 degC: [air = r2; if r2 < 30 degC: [co2 = r3; if r3 < 400 ppm: [go Farthest(Here); picture = r4; if r4 < 33 degC: [air = r5; if r5 < 30 degC: [co2 = r6]]]]]; if not r1 low: [stop]",
    ),
    (
        "if-else-nested",
        "Toma una foto del primer árbol. Si la lectura es menor de 33 °C, toma una muestra de CO2. De lo contrario, haz una lectura de temperatura. Después, mide otro árbol distinto tomando una foto. Si es menor de 33 °C, mide el CO2. Si esa lectura es menor de 400 ppm, vuelve a medir el CO2 para confirmar. Si sigue siendo menor de 400 ppm, continúa hasta otro árbol y toma otra muestra de CO2.",
        "picture @ First = r1; if r1 < 33 degC: [co2] else [air]; picture @ Take(1, of NotVisited) = r2; if r2 < 33 degC: [co2 = r3; if r3 < 400 ppm: [co2 = r4; if r4 < 400 ppm: [go Take(1, of NotVisited); co2]]]",
    ),
    (
        "corners-relative",
        "Considerando esta finca como un rectángulo, toma fotos de los árboles de las cuatro esquinas de la finca en cualquier orden.",
        "for Corners: [picture]",
    ),
    (
        "corners-absolute",
        "Toma una foto en la esquina noroeste, luego en la noreste, luego en la sureste y luego en la suroeste de la finca.",
        "picture @ Corners(nw); picture @ Corners(ne); picture @ Corners(se); picture @ Corners(sw)",
    ),
    (
        "hundred-metres",
        "Toma fotos de tantos árboles como puedas sin recorrer más de 100 metros.",
        "for Trees optional: [picture] | distance_m 100 | stay",
    ),
    (
        "north-center-east",
        "Toma una foto del árbol más al norte. Ve al centro del huerto y toma otra. Ve al centro del extremo este y toma una foto de dos árboles contiguos.",
        "picture @ Extreme(north); go Middle; picture; go EdgeMiddle(east); for Adjacent(Here): [picture]",
    ),
    (
        "relative-conditionals",
        "Desde el punto de partida, ve al centro del campo y toma una foto de un árbol. Si su temperatura media está por debajo de 33 °C, toma una muestra de CO2. Después, ve a otro punto al azar 5 árboles más adelante y haz lo mismo.",
        "go Middle; picture @ Take(1, of Trees) = r1; if r1 < 33 degC: [co2]; go AlongRow(5); picture = r2; if r2 < 33 degC: [co2]",
    ),
    (
        "relative-absolute",
        "Desde el punto de partida, busca un árbol en algún lugar del centro del huerto y mide el CO2. Si es menos de 400 ppm, ve y toma una foto de un árbol cercano. Desde allí, mide el CO2 de otro árbol lo más lejos posible y repite el mismo proceso. Una vez terminado, haz una lectura de temperatura en cualquiera de los árboles más al norte.",
        "go Middle; co2 = r1; if r1 < 400 ppm: [picture @ Nearest(Here, True)]; co2 @ Farthest(Here, of NotVisited) = r2; if r2 < 400 ppm: [picture @ Nearest(Here, True)]; air @ Take(1, of AmongExtreme(north))",
    ),
    (
        "two-different-trees",
        "Desde el punto de partida, busca un árbol en algún lugar del centro del huerto y mide el CO2. Si la lectura es baja, ve a 2 árboles distintos cercanos y toma una foto de cada uno de ellos. Desde allí, mide el CO2 de otro árbol lo más lejos posible y repite el mismo proceso. Una vez terminado, haz una lectura de temperatura en cualquiera de los árboles más al norte. Por último, vuelve al final.",
        "go Middle; co2 = r1; if r1 low: [for Nearest(Here, 2, True, of NotVisited): [picture]]; co2 @ Farthest(Here, of NotVisited) = r2; if r2 low: [for Nearest(Here, 2, True, of NotVisited): [picture]]; air @ Take(1, of AmongExtreme(north))",
    ),
    (
        "two-nearby-trees",
        "Desde el punto de partida, busca un árbol en algún lugar del centro del huerto y mide el CO2. Si la lectura es baja, ve y toma 2 fotos de árboles cercanos. Desde allí, mide el CO2 de otro árbol lo más lejos posible y repite el mismo proceso. Una vez terminado, haz una lectura de temperatura en cualquiera de los árboles más al norte. Por último, vuelve al final.",
        "go Middle; co2 = r1; if r1 low: [for Nearest(Here, 2, True): [picture]]; co2 @ Farthest(Here, of NotVisited) = r2; if r2 low: [for Nearest(Here, 2, True): [picture]]; air @ Take(1, of AmongExtreme(north))",
    ),
    (
        "yellow-north",
        "Envía el robot a tomar fotos de los árboles amarillos de la mitad norte de la finca.",
        "for Where(leaf_color, eq, yellow, of Half(north)): [picture]",
    ),
    (
        "moisture-15m",
        "Haz tres mediciones de humedad del suelo a 15 metros de distancia entre sí.",
        "for Spaced(15, 3): [moisture]",
    ),
    (
        "nitrate-east",
        "Mide el nivel de nitrato del suelo en cuatro árboles del lado este del huerto.",
        "for Take(4, of Half(east)): [nitrate]",
    ),
]
