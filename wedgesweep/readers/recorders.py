"""Files of data loggers: TDMS, universal files (UFF 58) and MDF 4."""

import logging
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

from wedgesweep.processes import apart
from wedgesweep.readers.extras import module
from wedgesweep.readers.table import Channel, Wanted

# Type of the data sets of samples over time.
SAMPLES = 58


def tdms(file: Path, wanted: Wanted) -> dict[str, Channel | None]:
    """Channels as ``group/channel``, with the clock of their waveform."""
    found: dict[str, Channel | None] = {}
    nptdms = module("nptdms")
    # It prints warnings of a file that ends early, of which it reads what is there.
    nptdms.log.log_manager.set_level(logging.CRITICAL)
    with file.open("rb") as stream, nptdms.TdmsFile.open(stream) as opened:
        for number, channel in enumerate((each for group in opened.groups() for each in group.channels()), 1):
            name = f"{channel.group_name}/{channel.name}"
            step = channel.properties.get("wf_increment")
            start = channel.properties.get("wf_start_offset", 0.0)
            clock = start + step * np.arange(len(channel)) if step else None
            unit = str(
                channel.properties.get("unit_string", channel.properties.get("NI_UnitDescription", ""))
            )
            found[name] = Channel(channel[:], unit, clock) if wanted(name, number) else None
    return found


def uff(file: Path, wanted: Wanted) -> dict[str, Channel | None]:
    """Data sets 58 by number, with the clock of an even or uneven abscissa."""
    opened = module("pyuff").UFF(str(file))
    sets = [number for number, kind in enumerate(opened.get_set_types()) if int(kind) == SAMPLES]
    found: dict[str, Channel | None] = {}
    for number, place in enumerate(sets, 1):
        name = f"set {number}"
        found[name] = None
        if wanted(name, number):
            data = opened.read_sets(place)
            unit = str(data.get("ordinate_axis_units_lab", ""))
            label = str(data.get("id1", "")).strip().removeprefix("NONE")
            clock = np.asarray(data["x"])
            found[name] = Channel(data["data"], "" if unit == "NONE" else unit.strip(), clock, label=label)
    return found


def mdf(file: Path, wanted: Wanted) -> dict[str, Channel | None]:
    """Channels by name, each with the clock of its raster; several of a name as ``name#2``."""
    return apart(_mdf, module("asammdf"), file, wanted)


def _mdf(asammdf: Any, file: Path, wanted: Wanted) -> dict[str, Channel | None]:
    found: dict[str, Channel | None] = {}
    times = Counter[str]()
    with asammdf.MDF(file) as opened:
        places = [
            (group, index, channel.name)
            for group, members in enumerate(opened.groups)
            for index, channel in enumerate(members.channels)
        ]
        for number, (group, index, name) in enumerate(places, 1):
            times[name] += 1
            name = name if times[name] == 1 else f"{name}#{times[name]}"
            found[name] = None
            if wanted(name, number):
                signal = opened.get(group=group, index=index)
                found[name] = Channel(signal.samples, str(signal.unit or ""), signal.timestamps)
    return found
