"""Units of a robot's messages, their conversion, and the value fields of standard message types.

ROS uses SI units (REP 103): a temperature driver may send kelvin or degrees Celsius, a fraction is usually 0 to 1.
"""

from __future__ import annotations

from collections.abc import Mapping

#: Dimension of each unit, with scale and offset to the reference unit of that dimension: ``value * scale + offset``.
_UNITS: Mapping[str, tuple[str, float, float]] = {
    "degC": ("temperature", 1.0, 0.0),
    "K": ("temperature", 1.0, -273.15),
    "degF": ("temperature", 5.0 / 9.0, -160.0 / 9.0),
    "fraction": ("share", 1.0, 0.0),
    "percent": ("share", 1e-2, 0.0),
    "ppm": ("share", 1e-6, 0.0),
    "ppb": ("share", 1e-9, 0.0),
    "m": ("length", 1.0, 0.0),
    "cm": ("length", 1e-2, 0.0),
    "mm": ("length", 1e-3, 0.0),
    "Pa": ("pressure", 1.0, 0.0),
    "hPa": ("pressure", 1e2, 0.0),
    "kPa": ("pressure", 1e3, 0.0),
    "bar": ("pressure", 1e5, 0.0),
    "S/m": ("conductivity", 1.0, 0.0),
    "dS/m": ("conductivity", 1e-1, 0.0),
    "mS/cm": ("conductivity", 1e-1, 0.0),
    "uS/cm": ("conductivity", 1e-4, 0.0),
    "m/s": ("speed", 1.0, 0.0),
    "km/h": ("speed", 1.0 / 3.6, 0.0),
    "V": ("voltage", 1.0, 0.0),
    "mV": ("voltage", 1e-3, 0.0),
    "lx": ("illuminance", 1.0, 0.0),
}

#: Path and unit of the number in a standard message type; the unit is empty if its definition gives none.
STANDARD_FIELDS: Mapping[str, tuple[str, str]] = {
    "sensor_msgs/msg/BatteryState": ("percentage", "fraction"),
    "sensor_msgs/msg/Temperature": ("temperature", "degC"),
    "sensor_msgs/msg/RelativeHumidity": ("relative_humidity", "fraction"),
    "sensor_msgs/msg/FluidPressure": ("fluid_pressure", "Pa"),
    "sensor_msgs/msg/Illuminance": ("illuminance", "lx"),
    "std_msgs/msg/Float32": ("data", ""),
    "std_msgs/msg/Float64": ("data", ""),
}


def known_units() -> tuple[str, ...]:
    """Return every unit that can be converted."""
    return tuple(_UNITS)


def conversion(unit: str, wanted: str) -> tuple[float, float] | None:
    """Return scale and offset that convert a value from one unit to another: ``value * scale + offset``.

    >>> conversion("fraction", "percent")
    (100.0, 0.0)

    Args:
        unit: Unit of the value.
        wanted: Unit to convert to.

    Returns:
        Scale and offset; None if the units measure different dimensions or are unknown.
    """
    if unit == wanted:
        return 1.0, 0.0
    if unit not in _UNITS or wanted not in _UNITS or _UNITS[unit][0] != _UNITS[wanted][0]:
        return None
    _, scale, offset = _UNITS[unit]
    _, wanted_scale, wanted_offset = _UNITS[wanted]
    return _tidy(scale / wanted_scale), _tidy((offset - wanted_offset) / wanted_scale)


def _tidy(value: float) -> float:
    """Return a value without binary rounding noise: 1 / 0.01 is 100."""
    return float(f"{value:.15g}")
