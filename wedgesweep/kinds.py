"""What kind of file a user gave; the message on one of the wrong kind says what it is."""

import re
from pathlib import Path

from wedgesweep.files import read_bytes, regular
from wedgesweep.processes import apart

CONFIG, MEASURED, SWEEP, DIAGNOSIS, DATASET = "config", "measured", "sweep", "diagnosis", "dataset"
# What `check` takes.
CONFIG_OR_MEASURED = "config or measured"
# What each is, and what it is good for.
WORDS = {
    CONFIG: ("a config", "'wedgesweep run' runs it, and a measured.toml names it as its model"),
    MEASURED: ("measured data", "'wedgesweep check' and 'wedgesweep diagnose' read them"),
    SWEEP: ("the dataset of a run", "'wedgesweep status', 'plot' and 'export' read it"),
    DATASET: ("a dataset", "'wedgesweep status' tells whether a run wrote it"),
    DIAGNOSIS: ("the result of a diagnosis", "'wedgesweep plot' draws it, and its extended.toml is a config"),
}
WANTED = {
    CONFIG: "a config (TOML)",
    MEASURED: "a measurement",
    CONFIG_OR_MEASURED: "a config (TOML) or a measurement",
    SWEEP: "the dataset of a run",
}
# netCDF 4 is HDF5.
NETCDF = (b"\x89HDF\r\n\x1a\n", b"CDF\x01", b"CDF\x02", b"CDF\x05")
# Also found in a file that is not valid TOML, so that its errors are those of measured data.
MEASURED_TABLE = rb"""^(?:\xef\xbb\xbf)?\s*(\[+\s*["']?measurement\b|["']?measurement["']?\s*[.=])"""
TABLES = {MEASURED: MEASURED_TABLE, CONFIG: rb"^(?:\xef\xbb\xbf)?\s*\[\[?sweep\b"}


def confusion(path: Path, wanted: str) -> str | None:
    """A message if a file is one of this package, but of another kind than is wanted."""
    found = kind_of(path)
    readable = found == DATASET and wanted != CONFIG
    if found is None or found == wanted or readable:
        return None
    what, use = WORDS[found]
    return f"{path}: {what}, where {WANTED[wanted]} is wanted; {use}"


def is_measured(path: Path) -> bool:
    """Whether a file holds measured data and not a config, by its table [measurement]."""
    try:
        return re.search(MEASURED_TABLE, read_bytes(path), re.MULTILINE) is not None
    except OSError:
        return False


def kind_of(path: Path) -> str | None:
    """Kind of a file or directory of this package; None for everything else."""
    if (path / "diagnosis.json").is_file():
        return DIAGNOSIS
    try:
        content = regular(path).open("rb")
    except OSError:
        return None
    with content:
        start = content.read(8)
        if start.startswith(NETCDF):
            return _kind_of_netcdf(path)
        if path.suffix != ".toml":
            return None
        text = start + content.read()
    return next((kind for kind, table in TABLES.items() if re.search(table, text, re.MULTILINE)), None)


def _kind_of_netcdf(path: Path) -> str | None:
    import netCDF4

    def of_a_sweep() -> bool:
        with netCDF4.Dataset(path) as found:
            return "beta" in found.variables

    try:
        return SWEEP if apart(of_a_sweep) else DATASET
    except (OSError, RuntimeError, AttributeError):  # netCDF4 raises any of them
        return DATASET
