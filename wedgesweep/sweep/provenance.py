"""Provenance: the global attributes of a dataset."""

import json
import subprocess
from datetime import datetime
from functools import cache
from importlib.metadata import version
from pathlib import Path

from wedgesweep import __version__
from wedgesweep.config import Config
from wedgesweep.sweep.fingerprint import fingerprint

PACKAGE = Path(__file__).parents[1]
PACKAGES = ("numpy", "scipy", "numba", "xarray", "netCDF4", "joblib")
SOURCES = {
    "suspension": "wedgesweep: friction wedge suspension of a three-piece bogie, half model",
    "oscillator": "wedgesweep: mass on a spring that rubs on a surface",
}
REFERENCES = (
    "Numerical investigation on the friction wedge damper dynamics - a comparative study; "
    "Den Hartog (1930), Forced vibrations with combined Coulomb and viscous friction"
)


def attributes(config: Config, started: datetime, command: str) -> dict[str, str]:
    """Return title, config, versions and time of a run as text, the only type that all of netCDF takes."""
    stamp = started.strftime("%Y-%m-%dT%H:%M:%SZ")
    commit = git_commit()
    return {
        "title": config.title,
        "source": f"{SOURCES[config.system]}, version {__version__}",
        "references": REFERENCES,
        "history": f"{stamp}: {command}",
        "start_time": stamp,
        "config": config.to_toml(),
        "config_sha256": config.sha256,
        "fingerprint": json.dumps(fingerprint(config)),
        "wedgesweep_version": __version__,
        "package_versions": _package_versions(),
        **({"comment": config.remark} if config.remark else {}),
        **({"git_commit": commit} if commit else {}),
    }


@cache
def _package_versions() -> str:
    """Versions of the packages that a result depends on, as JSON."""
    return json.dumps({name: version(name) for name in PACKAGES})


@cache  # of the code as it was loaded; asking git and the packages takes longer than a small sweep
def git_commit(package: Path = PACKAGE) -> str | None:
    """Return the commit of the checkout that holds the package, with "-dirty" appended if files have changed.

    None for an installed package, even if its environment lies within a checkout.
    """
    if _git(package, "ls-files", "__init__.py") is None:
        return None
    return _git(package, "describe", "--always", "--dirty", "--abbrev=40", "--exclude=*")


def _git(directory: Path, *arguments: str) -> str | None:
    command = ["git", "-C", str(directory), *arguments]
    try:
        result = subprocess.run(command, capture_output=True, text=True, check=False, timeout=5)
    except (OSError, subprocess.TimeoutExpired):
        return None
    return result.stdout.strip() or None
