"""Files of measured data in every format: damaged bytes, damaged members of archives, and odd arrays."""

import logging
import warnings
import zipfile
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from io import BytesIO
from pathlib import Path
from random import Random
from typing import Any

import numpy as np

from tests import fixture_formats
from torture import mutations
from torture.specimens import RATE, vibration

Writer = Callable[[Path, dict[str, Any]], object]


def _npy(path: Path, columns: dict[str, Any]) -> None:
    np.save(path, np.column_stack([np.asarray(each) for each in columns.values()]))


def _wav(path: Path, columns: dict[str, Any]) -> None:
    from scipy.io import wavfile

    tracks = np.column_stack([np.asarray(each) for each in columns.values()])
    wavfile.write(path, int(RATE), (tracks / 200.0).astype("f4"))


# Writers of named columns by the name of their file.
WRITERS: dict[str, Writer] = {
    **dict(fixture_formats.SPECIMENS),
    "one.npy": _npy,
    "one.wav": _wav,
    "one.uff": fixture_formats.uff,
}


def stored(directory: Path) -> dict[str, bytes]:
    """The vibration in every format whose library is here, by the name of the file."""
    import pytest

    columns = dict(zip("tdv", vibration().T, strict=True))
    for name, write in WRITERS.items():
        with suppress(pytest.skip.Exception):
            write(directory / name, columns)
    return {name: (directory / name).read_bytes() for name in WRITERS if (directory / name).exists()}


def spoil(path: Path, content: bytes, draw: Random) -> None:
    """Write a file of damaged bytes, or of odd arrays, where its format takes them."""
    ways: list[Callable[[], object]] = [lambda: path.write_bytes(mutations.raw(content, draw))]
    if zipfile.is_zipfile(BytesIO(content)):
        ways += [lambda: _spoil_member(path, content, draw)]
    ways.append(partial(_odd, path, draw))
    # The library of a format refuses some arrays, in any way.
    logging.disable()
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            draw.choice(ways)()
    except Exception:
        path.unlink(missing_ok=True)
        ways[0]()
    finally:
        logging.disable(logging.NOTSET)


def _spoil_member(path: Path, content: bytes, draw: Random) -> None:
    """Damage one file of an archive, whose checksums are right."""
    with zipfile.ZipFile(BytesIO(content)) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    name = draw.choice(list(members))
    text = members[name].decode("latin-1")
    members[name] = (
        mutations.raw(members[name], draw)
        if draw.random() < 0.5
        else mutations.text(text, draw).encode("latin-1", "replace")
    )
    with zipfile.ZipFile(path, "w") as archive:
        for each, data in members.items():
            archive.writestr(zipfile.ZipInfo(each), data)  # without the time of day


def _odd(path: Path, draw: Random) -> None:
    columns = {name: _array(samples, draw) for name, samples in zip("tdv", vibration().T, strict=True)}
    if draw.random() < 0.1:
        del columns[draw.choice("tdv")]
    WRITERS[path.name](path, columns)


def _array(samples: np.ndarray, draw: Random) -> object:
    """A channel, mostly as it should be."""
    if draw.random() < 0.6:
        return samples
    odd = samples.copy()
    odd[draw.randrange(odd.size)] = draw.choice(mutations.NUMBERS)
    odd_ones = (
        odd,
        samples[:, None],
        samples[None, None],
        samples.reshape(-1, 2, 2),
        samples[:-1],
        samples[::-1],
        samples.astype("f4"),
        samples.astype(complex),
        np.stack([samples, samples]),
        np.zeros((0, 0)),
        "text",
        {"a": 1},
        [[1]],
        samples * 0.0,
        samples > 0.0,
        (1e3 * samples).astype("datetime64[us]"),
        samples.astype(str),
        samples.astype(object),
        np.round(samples),
        samples * draw.choice((1e-200, 1e200)),
    )
    return draw.choice(odd_ones)
