"""Spanish requests with the outlines of their plans, on the built-in orchard with the robot ``husky``."""

from __future__ import annotations

PLANNED: list[tuple[str, str]] = [
    ("Fotografía cada tercer árbol de la fila 2", "for EveryNth(3, of Rows(2, 2)): [picture]"),
    ("Mide el CO2 en los árboles 4, 9 y 12.", "for UnionOf(TreeIs(4)+TreeIs(9)+TreeIs(12)): [co2]"),
    ("Por favor, fotografía todos los árboles de las filas 2 a 5.", "for Rows(2, 5): [picture]"),
    (
        "Fotografía los árboles de las filas 2, 4 y 7 en cualquier orden.",
        "for UnionOf(Rows(2, 2)+Rows(4, 4)+Rows(7, 7)): [picture]",
    ),
    ("Saca una foto del último árbol de la fila 3.", "picture @ InRow(-1, -1, of Rows(3, 3))"),
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
    ("Fotografía los tres primeros árboles de cada fila.", "for InRow(1, 3, of Rows): [picture]"),
    (
        "Fotografía todos los árboles de la fila 3 excepto los árboles 40 y 41.",
        "for Excluding(UnionOf(TreeIs(40)+TreeIs(41)), of Rows(3, 3)): [picture]",
    ),
    ("Recorre la fila 3 y fotografía cada segundo árbol.", "for EveryNth(2, of Rows(3, 3)): [picture]"),
    (
        "Mide el CO2 en el árbol 4. Si es bajo, toma una foto. Luego ve al árbol 9 y mide el CO2.",
        "co2 @ TreeIs(4) = r1; if r1 low: [picture]; go TreeIs(9); co2",
    ),
    ("Mide el CO2 en cuatro árboles de la segunda fila desde el este.", "for Take(4, of Rows(2, 2, east)): [co2]"),
    ("Fotografía hasta 6 árboles de la mitad norte.", "for Half(north) at most 6: [picture]"),
    (
        "Toma una foto en ambos extremos de la fila 4.",
        "for UnionOf(InRow(1, 1, of Rows(4, 4))+InRow(-1, -1, of Rows(4, 4))): [picture]",
    ),
    (
        "Mide la temperatura en el árbol 4 y, si está entre 20 y 30 °C, toma una foto.",
        "air @ TreeIs(4) = r1; if 20 <= r1 <= 30 degC: [picture]",
    ),
    ("Fotografía el árbol del medio de la fila 4.", "picture @ Middle(of Rows(4, 4))"),
    (
        "Fotografía cada árbol de las filas pares sin usar más del 40 % de la batería.",
        "for Rows(2, 2): [picture] | energy_percent 40",
    ),
]
