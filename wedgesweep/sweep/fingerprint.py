"""Fingerprint of a sweep: what its results depend on. Runs with different fingerprints are never mixed."""

import platform
from collections.abc import Iterator, Mapping
from functools import cache
from hashlib import sha256
from importlib.metadata import version
from pathlib import Path
from typing import Any

from wedgesweep import __version__, kernels, toml
from wedgesweep.config import Config
from wedgesweep.hints import show

PACKAGE = Path(__file__).parents[1]
SAME_RESULTS = ("numpy", "scipy", "numba")
# Folders that do not affect results.
PRESENTATION = ("cli", "figures")


def fingerprint(config: Config) -> dict[str, str]:
    """Return the digests and versions with which a sweep would run now."""
    return {
        "config_sha256": config.sha256,
        "wedgesweep": __version__,
        "source_sha256": _digest_with_plugins(),
        "python": platform.python_version(),
        **{name: version(name) for name in SAME_RESULTS},
    }


def differences(found: Mapping[str, str], expected: Mapping[str, str]) -> list[str]:
    """Describe how two fingerprints differ.

    Both may also hold the ``config`` as TOML text, so that changed keys can be named.
    """
    keys = [key for key in expected if found.get(key) != expected[key] and key != "config"]
    return [each for key in keys for each in _descriptions(key, found, expected)]


def _descriptions(key: str, found: Mapping[str, str], expected: Mapping[str, str]) -> list[str]:
    if key == "source_sha256":
        return ["the code of wedgesweep or of a plug-in has changed"]
    if key == "config_sha256":
        changed = _changed_keys(found.get("config", ""), expected.get("config", ""))
        return changed or ["the config has changed"]
    return [f"{key}: {found.get(key)} there, {expected[key]} now"]


def _changed_keys(there: str, now: str) -> list[str]:
    try:
        there_flat, now_flat = dict(_flat(toml.loads(there))), dict(_flat(toml.loads(now)))
    except ValueError:
        return []
    return [
        f"{key}: {_shown(there_flat, key)} there, {_shown(now_flat, key)} now"
        for key in there_flat | now_flat
        if there_flat.get(key) != now_flat.get(key)
    ]


def _shown(flat: dict[str, Any], key: str) -> str:
    return show(flat[key]) if key in flat else "absent"


def _flat(table: Mapping[str, Any], path: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{path}{key}.")
        else:
            yield path + key, value


def _digest_with_plugins() -> str:
    outside = kernels.outside_sources()
    parts = [name.encode() + b"\0" + source for name, source in outside]
    return sha256(_source_digest().encode() + b"".join(parts)).hexdigest() if parts else _source_digest()


@cache
def _source_digest() -> str:
    # Computed once: edits during a run do not affect the code that is already loaded.
    digest = sha256()
    for path in sorted(PACKAGE.rglob("*.py")):
        place = path.relative_to(PACKAGE)
        if place.parts[0] not in PRESENTATION:
            digest.update(place.as_posix().encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()
