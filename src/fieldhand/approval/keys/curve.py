"""Validation of Ed25519 public keys (RFC 8032, section 5.1).

Cryptographic libraries accept any point that they can decode. A point of small order admits signatures valid for
almost any message without a private key; other points outside the prime-order group, and non-canonical encodings,
give one key several representations. A key generated according to the standard is a point of order L.
"""

from __future__ import annotations

_P = 2**255 - 19
_L = 2**252 + 27742317777372353535851937790883648493
_D = -121665 * pow(121666, _P - 2, _P) % _P
_ROOT = pow(2, (_P - 1) // 4, _P)

#: Point in extended coordinates X, Y, Z, T with x = X/Z, y = Y/Z, x y = T/Z.
_Point = tuple[int, int, int, int]
_ZERO: _Point = (0, 1, 1, 0)


def is_sound(raw: bytes) -> bool:
    """Return True if the 32 bytes are the canonical encoding of a point of order L on the curve."""
    point = _decoded(raw)
    return point is not None and not _is_zero(point) and _is_zero(_times(_L, point))


def _decoded(raw: bytes) -> _Point | None:
    """Return the point with this encoding, or None if the encoding is invalid or not canonical."""
    if len(raw) != 32:
        return None
    number = int.from_bytes(raw, "little")
    y, sign = number & (2**255 - 1), number >> 255
    if y >= _P:
        return None
    u, v = (y * y - 1) % _P, (_D * y * y + 1) % _P
    x = u * pow(v, 3, _P) * pow(u * pow(v, 7, _P), (_P - 5) // 8, _P) % _P
    if (v * x * x - u) % _P:
        x = x * _ROOT % _P
    if (v * x * x - u) % _P or (x == 0 and sign):
        return None
    if x & 1 != sign:
        x = _P - x
    return x, y, 1, x * y % _P


def _sum(p: _Point, q: _Point) -> _Point:
    a, b = (p[1] - p[0]) * (q[1] - q[0]) % _P, (p[1] + p[0]) * (q[1] + q[0]) % _P
    c, d = 2 * p[3] * q[3] * _D % _P, 2 * p[2] * q[2] % _P
    e, f, g, h = b - a, d - c, d + c, b + a
    return e * f % _P, g * h % _P, f * g % _P, e * h % _P


def _times(number: int, point: _Point) -> _Point:
    found = _ZERO
    while number:
        if number & 1:
            found = _sum(found, point)
        point, number = _sum(point, point), number >> 1
    return found


def _is_zero(p: _Point) -> bool:
    return p[0] % _P == 0 and (p[1] - p[2]) % _P == 0
