"""Packages that only an extra of this distribution installs, and the error that names the extra."""

from __future__ import annotations

from fieldhand.errors import InputError

#: Extra by package, for packages that modules import without asking.
EXTRAS = {
    "jinja2": "plan",
    "joblib": "plan",
    "matplotlib": "plan",
    "mcap": "plan",
    "rapidfuzz": "plan",
    "numba": "solver",
    "fastapi": "serve",
    "uvicorn": "serve",
    "sqlalchemy": "serve",
    "alembic": "serve",
    "argon2": "serve",
}


def missing_package(error: ImportError) -> InputError | None:
    """Return the error that names the extra to install; None if no extra installs the package that is missing."""
    package = (error.name or "").partition(".")[0]
    extra = EXTRAS.get(package)
    if extra is None:
        return None
    return InputError(
        f"this needs {package}, which is not installed", advice=f'install it with: pip install "fieldhand[{extra}]"'
    )
