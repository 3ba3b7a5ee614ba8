"""Endings of file names: what is written in one format is not given the ending of another."""

from pathlib import Path

NETCDF, CSV, TOML, JSON = "netCDF", "CSV", "TOML", "JSON"
# The first of a format is its own; others that it may have follow.
ENDINGS = {
    NETCDF: (".nc", ".nc4", ".cdf", ".h5", ".hdf5"),
    CSV: (".csv", ".tsv", ".txt", ".dat"),
    TOML: (".toml", ".txt"),
    JSON: (".json", ".txt"),
    "a figure": (".png", ".pdf", ".svg", ".jpg", ".jpeg"),
    "a page": (".html", ".htm", ".md"),
    "MATLAB": (".mat",),
    "Parquet": (".parquet",),
    "a workbook": (".xlsx", ".xls", ".ods"),
}


def mismatch(path: Path, written: str) -> str | None:
    """A message if a file that a format is written to has the ending of another; any other name will do."""
    ending, own = path.suffix.lower(), ENDINGS[written]
    meant = next((name for name, endings in ENDINGS.items() if ending in endings), None)
    if meant is None or ending in own:
        return None
    return f"{path}: {written} is written, and {ending} is the ending of {meant}; end it in {own[0]}"
