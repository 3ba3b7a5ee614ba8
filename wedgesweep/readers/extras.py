"""Libraries that are installed as extras."""

import importlib
from typing import Any

# Module, and the extra that installs it.
EXTRAS = {
    "h5py": "hdf5",
    "pyarrow.parquet": "parquet",
    "openpyxl": "xlsx",
    "nptdms": "tdms",
    "pyuff": "uff",
    "asammdf": "mdf",
}


def module(name: str) -> Any:
    """Import a library; raises OSError with the command that installs it."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise OSError(f"needs {name.partition('.')[0]}: pip install 'wedgesweep[{EXTRAS[name]}]'") from error
