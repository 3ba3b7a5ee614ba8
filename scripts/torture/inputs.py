"""Hostile inputs: each kind writes its files into an empty directory and returns the command to try."""

import json
import re
from collections.abc import Callable
from contextlib import suppress
from copy import deepcopy
from functools import partial
from pathlib import Path
from random import Random

import numpy as np

from torture import formats, mutations
from torture.specimens import MODEL, PLAN, Specimens

# Arguments of a command.
Command = list[str]
Kind = Callable[[Specimens, Path, Random], Command]

LINES_OF_LOGGERS = ("# bench 7", "% x", "Date;1.1.2024", "", "sep=;", "[s],[mm],[mm/s]", "s;mm;mm/s")
ENCODINGS = ("utf-8", "utf-8-sig", "utf-16", "utf-16-le", "latin-1", "utf-32")
FIGURES = ("amplitude-ratio", "bifurcation", "peak-to-peak", "phase-portrait", "response", "stick-map")
FIGURES += ("friction-laws",)
OF_A_DIAGNOSIS = ("misfit", "candidates", "ladder", "gain")
PICKS = ("--beta", "--frequency", "--amplitude", "--law", "--format")
WORDS = (
    *("0", "-1", "1", "1e200", "1e-200", "1e9", "nan", "inf", "-inf", "99", "0.3", "1.2", "x"),
    *("", "\0", "ü", "9" * 400),
    *("coulomb", "COULOMB", "png", "pdf", "config.toml", "out", "out/x.nc", "/dev/null", "/dev/zero"),
    *("/", ".", "-", "--"),
)


def _toml(document: dict, draw: Random) -> bytes:
    """Write a document with mutations of its values, its text or its bytes."""
    kind = draw.random()
    if kind < 0.75:
        text = mutations.toml(mutations.document(document, draw))
        return text.encode("utf-8", "replace")
    text = mutations.toml(document)
    if kind < 0.92:
        return mutations.text(text, draw).encode("utf-8", "surrogatepass")
    return mutations.raw(text.encode(), draw)


def config(given: Specimens, place: Path, draw: Random) -> Command:
    """A config, checked."""
    (place / "config.toml").write_bytes(_toml(draw.choice(given.configs), draw))
    return ["check", "config.toml"]


def run(given: Specimens, place: Path, draw: Random) -> Command:
    """A config, run."""
    (place / "config.toml").write_bytes(_toml(draw.choice(given.configs), draw))
    return ["run", "config.toml", "-o", "out.nc", "--n-jobs", "1"]


def measured(given: Specimens, place: Path, draw: Random) -> Command:
    """The declaration of measured data."""
    _measurement(given, place)
    (place / "measured.toml").write_bytes(_toml(draw.choice(given.measured), draw))
    return ["check", "measured.toml"]


def model(given: Specimens, place: Path, draw: Random) -> Command:
    """The model of measured data."""
    document = draw.choice(given.measured)
    _measurement(given, place)
    (place / "measured.toml").write_text(mutations.toml(document))
    (place / "model.toml").write_bytes(_toml(MODEL, draw))
    return ["check", "measured.toml"]


def csv(given: Specimens, place: Path, draw: Random) -> Command:
    """A CSV file in any dialect, encoding and state."""
    document = draw.choice(given.measured)
    _measurement(given, place)
    (place / "measured.toml").write_text(mutations.toml(document))
    name = document["measurement"]["test"][0]["file"]
    text = _dialect(given.csv[name], draw)
    if draw.random() < 0.7:
        text = mutations.text(text, draw)
    content = text.encode(draw.choice(ENCODINGS), "replace")
    (place / name).write_bytes(mutations.raw(content, draw) if draw.random() < 0.3 else content)
    return ["check", "measured.toml"]


def _dialect(text: str, draw: Random) -> str:
    kind = draw.random()
    if kind < 0.3:
        text = text.replace(",", draw.choice(";\t ")).replace(".", draw.choice(".,"))
    elif kind < 0.5:
        factor = draw.choice((0.0, 1e-200, 1e-20, 1e20, 1e200, float("nan")))
        lines = (line.split(",") for line in text.splitlines()[1:])
        text = "t,d,v\n" + "".join(f"{t},{float(d) * factor:.6g},{v}\n" for t, d, v in lines)
    if draw.random() < 0.3:
        text = f"{draw.choice(LINES_OF_LOGGERS)}\n{text}"
    if draw.random() < 0.2:
        first, _, rest = text.partition("\n")
        text = f"{first}\n{draw.choice(LINES_OF_LOGGERS)}\n{rest}"
    return text.replace("\n", draw.choice(("\n", "\r\n", "\r"))) if draw.random() < 0.3 else text


def _stored(given: Specimens, place: Path, draw: Random, *, name: str) -> Command:
    """A file of another format, in any state."""
    _measurement(given, place)
    # A loop takes a tenth of the time that a steady record takes.
    measurement = deepcopy(given.measured[-1]["measurement"])
    measurement["test"][0]["file"] = name
    columns = measurement["columns"]
    columns["force"]["scale"] = 0.1  # so that the unit that some files name is no fault
    if name.endswith((".wav", ".uff")):  # these have a clock of their own
        del columns["time"]
    for number, column in enumerate(columns.values(), 1 + name.endswith(".wav")):
        if name.endswith((".npy", ".wav", ".uff")):
            column["column"] = number
        elif name.endswith((".tdms", ".h5")):
            column["column"] = f"bench/{column['column']}"
    (place / "measured.toml").write_text(mutations.toml({"measurement": measurement}))
    if name.endswith(".nc") and draw.random() < 0.3:
        _netcdf(place / name, given.stored[name], draw)
    else:
        formats.spoil(place / name, given.stored[name], draw)
    # Most files are read by their columns, some are looked at as a whole.
    return ["check", "measured.toml"] if draw.random() < 0.8 else ["init", "first.toml", "--data", name]


def first(given: Specimens, place: Path, draw: Random) -> Command:
    """A file of any format, or two, in any state, of which a first measured.toml is written."""
    files = []
    for number in range(draw.choice((1, 1, 1, 2))):
        name, content = _any_format(given, draw)
        (place / f"{number}{name}").write_bytes(
            mutations.raw(content, draw) if draw.random() < 0.6 else content
        )
        files.append(f"{number}{name}")
    return ["init", "measured.toml", "--data", *files]


def _any_format(given: Specimens, draw: Random) -> tuple[str, bytes]:
    """Name and content of a file; text may lack its header, or be in any dialect and encoding."""
    name = draw.choice(["one.csv", "one.csv", *given.stored])
    if name in given.stored:
        return name, given.stored[name]
    text = _dialect(given.csv[draw.choice(list(given.csv))], draw)
    text = text.partition("\n")[2] if draw.random() < 0.3 else text
    text = mutations.text(text, draw) if draw.random() < 0.7 else text
    return name, text.encode(draw.choice(ENCODINGS), "replace")


def clock(given: Specimens, place: Path, draw: Random) -> Command:
    """A CSV file whose clock is odd: scatter, gaps, doubled stamps, missing cells, other units."""
    document = draw.choice(given.measured)
    _measurement(given, place)
    name = document["measurement"]["test"][0]["file"]
    header, *lines = given.csv[name].splitlines()
    rows = [line.split(",") for line in lines]
    unit, size = draw.choice(
        (("s", 1.0), ("ms", 1e3), ("us", 1e6), ("min", 1 / 60), ("excel", 1 / 86400), ("epoch", 1.0))
    )
    start, scatter = draw.choice((0.0, -3.0, 1e9, 45592.0)), draw.choice((0.0, 1e-5, 1e-4, 1e-3, 0.1))
    for row in rows:
        time = start + size * (float(row[0]) + scatter * draw.gauss(0.0, 1.0))
        row[0] = f"{time:.{draw.choice((3, 6, 12)) if scatter > 0.01 else 9}f}"
    for _ in range(draw.choice((0, 1, 3, 40))):
        place_of_fault = draw.randrange(len(rows))
        kind = draw.randrange(4)
        if kind == 0:
            del rows[place_of_fault : place_of_fault + draw.choice((1, 2, 30, 200))]
        elif kind == 1:
            rows.insert(place_of_fault, list(rows[place_of_fault]))
        else:
            rows[place_of_fault][draw.randrange(3)] = draw.choice(("", "NA", "-9999", "1e30", rows[0][0]))
        rows = rows or [["0", "0", "0"]]
    (place / name).write_text("\n".join([header, *(",".join(row) for row in rows)]) + "\n")
    text = mutations.toml(document).replace('unit = "s"', f'unit = "{unit}"')
    (place / "measured.toml").write_text(text)
    return ["check", "measured.toml"]


def dataset(given: Specimens, place: Path, draw: Random) -> Command:
    """The dataset of a sweep, for status."""
    _netcdf(place / "out.nc", given.dataset, draw)
    return ["status", "out.nc"]


def figure(given: Specimens, place: Path, draw: Random) -> Command:
    """The dataset of a sweep, to be drawn."""
    if draw.random() < 0.7:
        _netcdf(place / "out.nc", given.dataset, draw)
    else:
        (place / "out.nc").write_bytes(given.dataset)
    picks = [word for name in PICKS if draw.random() < 0.3 for word in (name, draw.choice(WORDS))]
    return ["plot", draw.choice(FIGURES), "out.nc", *picks]


def _netcdf(path: Path, content: bytes, draw: Random) -> None:
    """Write a netCDF file with odd bytes, or with odd attributes, names and numbers."""
    if draw.random() < 0.4:
        path.write_bytes(mutations.raw(content, draw))
        return
    import netCDF4

    path.write_bytes(content)
    with np.errstate(all="ignore"), suppress(RuntimeError), netCDF4.Dataset(path, "a") as root:
        root.set_auto_mask(False)
        for _ in range(draw.choice((1, 1, 2, 4))):
            _change_group(draw.choice(list(_groups(root))), draw)


def _groups(group):
    yield group
    for each in group.groups.values():
        yield from _groups(each)


def _change_group(group, draw: Random) -> None:
    """Change something of a group; a name that is taken stays."""
    kind, names = draw.random(), list(group.variables)
    try:
        if kind < 0.4 or not names:
            target = group if draw.random() < 0.5 or not names else group.variables[draw.choice(names)]
            _change_attribute(target, draw)
        elif kind < 0.7:
            variable = group.variables[draw.choice(names)]
            values = variable[...]
            if values.dtype.kind in "fiu" and values.size:
                odd = (
                    draw.choice(mutations.NUMBERS) if values.dtype.kind == "f" else draw.choice((-99, 0, 99))
                )
                values = values * 0 + odd if draw.random() < 0.3 else values
                values.flat[draw.randrange(values.size)] = odd
                variable[...] = values
        elif kind < 0.85:
            group.renameVariable(draw.choice(names), draw.choice(("x", "beta", "time", "status")))
        elif group.dimensions:
            group.renameDimension(draw.choice(list(group.dimensions)), draw.choice(("x", "beta", "case")))
    except (RuntimeError, OverflowError, ValueError, TypeError, AttributeError):
        return


def _change_attribute(target, draw: Random) -> None:
    names = target.ncattrs()
    if not names or draw.random() < 0.2:
        target.setncattr("x", 1)
        return
    name = draw.choice(names)
    if draw.random() < 0.3:
        target.delncattr(name)
        return
    found = target.getncattr(name)
    if isinstance(found, str) and draw.random() < 0.5:
        target.setncattr(name, mutations.text(found, draw).replace("\0", "?"))
        return
    target.setncattr(name, draw.choice((0, -1, 1.5, 1e200, float("nan"), "", "x", "ü", [1.0, 2.0], 2**40)))


def journal(given: Specimens, place: Path, draw: Random) -> Command:
    """The journal of a sweep that was stopped."""
    config_text = mutations.toml(given.configs[-1])
    (place / "config.toml").write_text(config_text)
    (place / "out.nc.partial").write_bytes(_journal(given.journal, draw))
    commands = (
        ["status", "out.nc"],
        ["status", "out.nc"],
        ["run", "config.toml", "-o", "out.nc", "--n-jobs", "1"],
    )
    return list(draw.choice(commands))


def _journal(content: bytes, draw: Random) -> bytes:
    """The journal with odd bytes, or an odd header."""
    if draw.random() < 0.5:
        return mutations.raw(content, draw)
    first, _, records = content.partition(b"\n")
    header = mutations.document(json.loads(first), draw)
    return json.dumps(header, sort_keys=True, default=str).encode() + b"\n" + records


def diagnosis(given: Specimens, place: Path, draw: Random) -> Command:
    """The directory of a diagnosis, to be drawn."""
    (place / "found").mkdir()
    files = dict(given.diagnosis)
    name = draw.choice(("diagnosis.json", "diagnosis.json", "diagnosis.nc"))
    for other, content in files.items():
        (place / "found" / other).write_bytes(content)
    if name == "diagnosis.nc":
        _netcdf(place / "found" / name, files[name], draw)
    elif draw.random() < 0.7:
        changed = mutations.document(json.loads(files[name]), draw)
        (place / "found" / name).write_text(json.dumps(changed, default=str))
    else:
        (place / "found" / name).write_bytes(mutations.raw(files[name], draw))
    return ["plot", draw.choice(OF_A_DIAGNOSIS), "found"]


def plan(given: Specimens, place: Path, draw: Random) -> Command:
    """The plan of tests to synthesize."""
    (place / "config.toml").write_text(mutations.toml(MODEL))
    (place / "tests.toml").write_bytes(_toml(PLAN, draw))
    return ["synthesize", "config.toml", "--tests", "tests.toml", "-o", "made", "--n-jobs", "1"]


def options(given: Specimens, place: Path, draw: Random) -> Command:
    """Any command with any options."""
    from wedgesweep.cli import cli

    (place / "config.toml").write_text(mutations.toml(given.configs[0]))
    (place / "out").write_bytes(given.dataset)
    name = draw.choice(("init", "schema", "check", "run", "status", "case", "plot", "synthesize", "diagnose"))
    command = [name]
    for each in cli.commands[name].params:
        flags = [flag for flag in each.opts if flag.startswith("-")]
        if flags and draw.random() < 0.6:
            continue
        word = draw.choice(WORDS) if draw.random() < 0.5 else _likely(each.human_readable_name, draw)
        command += ([draw.choice(flags)] if flags else []) + [word] * (not getattr(each, "is_flag", False))
    # Each of them takes time, or a cluster, as it should.
    return [name] if {"--backend", "--scheduler", "--calibrate"} & set(command) else command


def _likely(name: str, draw: Random) -> str:
    """A value that an argument might accept."""
    if re.search("path|config|measured|model|tests", name.lower()):
        return draw.choice(("config.toml", "out"))
    return draw.choice(("1", "0.3", "coulomb", "out"))


def _measurement(given: Specimens, place: Path) -> None:
    for name, content in given.csv.items():
        (place / name).write_text(content)
    (place / "model.toml").write_text(mutations.toml(MODEL))


# Measured data by the name of a file in formats.WRITERS; CSV is text.
FORMATS: dict[str, Kind] = {"csv": csv, **{name: partial(_stored, name=name) for name in formats.WRITERS}}
KINDS: dict[str, Kind] = {
    **{kind.__name__: kind for kind in (config, run, measured, model, first, clock, dataset, figure)},
    **{kind.__name__: kind for kind in (journal, diagnosis, plan, options)},
    **FORMATS,
}
# Shares of the inputs; those that take longest have the least.
SHARES = {"config": 20.0, "run": 6.0, "measured": 18.0, "csv": 20.0, "options": 3.0}
SHARES |= {"model": 5.0, "first": 5.0, "clock": 5.0, "dataset": 5.0, "journal": 5.0}
