"""What a diagnosis leaves behind: diagnosis.json, diagnosis.nc and extended.toml."""

import json
import os
from pathlib import Path

from wedgesweep.diagnose.diagnosis import Diagnosis
from wedgesweep.diagnose.result.arrays import dataset
from wedgesweep.diagnose.result.document import document
from wedgesweep.diagnose.result.extended_config import extended

JSON, DATASET, EXTENDED = "diagnosis.json", "diagnosis.nc", "extended.toml"


def write(found: Diagnosis, directory: Path) -> None:
    """Write all three files; each is whole or not there, and none beside those of another diagnosis."""
    text = json.dumps(document(found), indent=2, allow_nan=False) + "\n"
    directory.mkdir(parents=True, exist_ok=True)
    (directory / JSON).unlink(missing_ok=True)
    dataset_file = directory / f".{DATASET}.partial"
    dataset(found).to_netcdf(dataset_file)
    dataset_file.replace(directory / DATASET)
    _write_text(directory / EXTENDED, extended(found))
    _write_text(directory / JSON, text)


def _write_text(file: Path, text: str) -> None:
    partial = file.with_name(f".{file.name}.partial")
    partial.write_text(text, encoding="utf-8")
    os.replace(partial, file)
