"""Which column is which channel: by unit, by name, and where neither speaks by what the numbers do."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise, permutations

import numpy as np

from wedgesweep.measured.clock import continued
from wedgesweep.measured.declarations import MOTIONS, QUANTITIES
from wedgesweep.measured.signals import stand_ins
from wedgesweep.readers.survey import Column
from wedgesweep.readers.table import DATETIME, OF_A_MATRIX, split_unit
from wedgesweep.units import DATES, DAY, EPOCH, FOREIGN, UNITS, angular, is_unit, usual

FORCE, INPUT, TIME = "force", "input", "time"
# Parts of names, and whole names, of each quantity; the first quantity with a match has the column.
STEMS = {
    TIME: r"time|\bdate|zeit|temps\b|tempo\b|tiempo|stamp|seconds|clock|时间|時間",
    "acceleration": r"acc|acel|beschl|ddot|\bimu|加速度",
    "velocity": r"(?<!tra)vel|speed|geschw|vitesse|rpm|omega|tacho|qdot|xdot|gyro|drehzahl|速度|转速|回転",
    FORCE: r"force|friction|reibung|torque|trq|kraft|moment|thrust|effort|load|traction|\btau"
    r"|forza|fuerza|br(ü|ue)cke|\bdms\b|copp?ia\b|couple\b|力|载荷|荷重|扭矩|トルク",
    "displacement": r"disp|pos|ang[lu]|weg\b|winkel|laser|lvdt|stroke|encod|deflect|travel|rotation|extens"
    r"|distance|hub\b|theta|plate|mass|auslenk|verschieb|cors[ae]\b|course|d[ée]plac|desplaz|string.?pot"
    r"|位移|变位|変位|角度",
}
SYMBOLS = {
    TIME: r"t|ts|sec|s\.?e\.?c|s",
    "acceleration": r"a|[axyz]?dd[xyzq]?|[xyq]dd|a[xyz]|[xyq]''",
    "velocity": r"v|w|[xyq]d|d[xyq]|v[xyz]|d[xyq]/?dt|[xyq]'",
    FORCE: r"f|m|tq|f[xyznt]|tau|mot",
    "displacement": r"d|x|y|z|q|s|phi|th|alpha|l|h",
    INPUT: r"u|in|exc",
}
# Words of what a rig stands on, of all that drives it, and of what it was told to do, or is of no use here.
PLACES = r"base|ground|table|fuss|support|wall|side.?frame|axle|wheel|floor|foundation"
DRIVES = rf"input|excit|shaker|hammer|driv(er|ing)|exciter|source|anreg|{PLACES}"
# A count of samples, which is no time.
COUNTS = r"n|nr\.?|no\.?|#|index|samples?|points?|count(er)?|row|scan|sequence"
NOT_MEASURED = (
    r"ref|supply|ambient|desired|target|set.?p|command|cmd|soll|_des|error|not selected|status|trigger|limit"
    r"|coeff|\bcof\b|temp(?![os]\b)|温度"
)
# Names of the load that presses two faces together, and the std over the mean below which it is set, not
# a response: control of a tribometer's load holds it to a few per cent.
PRESSES, SET = r"load|normal|clamp|\bf_?[nz]\b|last\b|kraft_?n\b|载荷|法向|正压", 0.3
# A motor's current may stand for its torque, a pressure for the force of its piston.
STANDS_FOR_FORCE = r"curr|\bamp|strom|pwm|duty|press|druck|volt"
STANDING_UNITS = ("A", "mA", "bar", "mbar", "psi", "kPa", "MPa")
# Share of it that the motion explains from which it does (a convention): of a supply, or of a sensor that
# shows noise, it explains nothing. What does best, less what it explains the other way round, is the force.
STANDS = 0.5
# Points of a column for a quantity.
OF_UNIT, OF_NAME, OF_FOREIGN, OF_COMMAND, OF_SHARED, OF_PROXY = 4.0, 3.0, -1.5, -4.0, 0.3, 1.0
# Correlation from which two columns are one signal in two units, and one is the derivative of another.
SAME, DERIVED = 0.9995, 0.9
# Difference of a velocity without a name from the slope of the displacement, in some unit.
UNLIKE = 0.05
# A velocity is computed if it differs from the slope of the displacement by less than this share.
COMPUTED = 0.02
# What has no name is time if this share of its steps differs from the median one by less than so much of it.
EVEN, UNEVEN = 0.9, 0.75
# Lines of a cross-spectrum that count, over its highest one: below is noise, and drift of sensors.
LINES = 1e-3
# Power of the frequency by which a cross-spectrum of two rates is one of powers.
RATES = {"velocity": 1.0, "acceleration": -1.0}
# Points at which columns are compared.
POINTS = 3000
# Numbers beyond it are damage: their differences and squares may be no numbers.
HUGE = 1e100
# A time in seconds has steps (s) between these.
STEPS = (1e-7, 0.5)
# Angles (in the file) beyond which they are degrees; displacements that are metres.
DEGREES, METRES = 13.0, 0.05
DAYS = (2e4, 8e4)
RUN = re.compile(r"(?:run|trial|versuch|messung|repeat|rep|cycle)\W*(\d+)", re.IGNORECASE)
# Units and names of angles and torques.
ANGULAR = re.compile(
    r"rad|deg|rpm|\brev\b|N m|N cm|lbf |ang[lu]|winkel|theta|phi|\bq|rotat|joint|torsion|pendul|torque|omega"
    r"|\btau|encod|gyro"
)
BRACKETS, WORDS = re.compile(r"[\[(]([^\[\]()]*)[\])]"), re.compile(r"[a-zA-ZäöüÄÖÜß/']+|\d+")


@dataclass(frozen=True, eq=False)
class Chosen:
    """A column as a channel, its unit, further keys of it, and what is to be asked."""

    column: Column
    unit: str
    keys: Mapping[str, object] = field(default_factory=dict)
    questions: tuple[str, ...] = ()

    @property
    def values(self) -> np.ndarray:
        return self.column.channel.values


@dataclass(frozen=True, eq=False)
class Run:
    """Columns of a run: its time, its channels by name, all columns, and the load of its faces."""

    time: Chosen | None
    channels: Mapping[str, Chosen]
    columns: Sequence[Column] = ()
    load: Column | None = None

    @property
    def left(self) -> list[Column]:
        """Columns that are not used."""
        used = [self.load, *(each.column for each in (self.time, *self.channels.values()) if each)]
        return [column for column in self.columns if all(column is not each for each in used)]


def unit_of(column: Column, quantities: Sequence[str]) -> str:
    """The unit that a file names, of one of the quantities or else foreign; empty if there is none."""
    label = OF_A_MATRIX.sub(r"\1", column.label)
    rates = [pair for pair in map("/".join, pairwise(label.split("_"))) if is_unit(usual(pair))]
    within = rates or re.split(r"[_\s,:]+", label)[1:]  # velocity_in_s is no length
    written = [column.channel.unit, *BRACKETS.findall(label), *within]
    known = [usual(each.strip()) for each in written if each.strip()]
    if re.search(STEMS[FORCE], column.label.lower()):  # no torque is a length, however its unit is written
        known = ["N m" if each == "nm" else each for each in known]
    valid = {unit for each in quantities for unit in UNITS[each]}
    return next((each for each in known if each in valid), "") or next(
        (each for each in known if is_unit(each)), ""
    )


def runs_of(columns: Sequence[Column]) -> list[list[Column]]:
    """Columns of each run of a file: in groups with the same names, or side by side."""
    return [run for group in _groups(columns) for run in _side_by_side(group)]


def _groups(columns: Sequence[Column]) -> list[list[Column]]:
    """Columns of each group of a file, where several hold the same names in the same units.

    A group of one channel must have its clock. Other columns that are as long belong to all groups.
    """
    groups: dict[str, list[Column]] = {}
    for column in columns:
        groups.setdefault(column.group, []).append(column)
    held = {group: {(*c.words[:1], c.channel.unit) for c in inside} for group, inside in groups.items()}
    last = columns[-1]
    alike = [group for group in groups if held[group] == held[last.group]]
    if len(alike) < 2 or (len(held[last.group]) == 1 and last.channel.clock is None):
        return [list(columns)]
    others = [
        c for c in columns if c.group not in alike and c.channel.values.size == last.channel.values.size
    ]
    return [[*groups[group], *others] for group in alike]


def _side_by_side(columns: Sequence[Column]) -> list[list[Column]]:
    """Columns of each run where several stand side by side, each with a time of its own or a number."""
    starts = [columns.index(column) for column in _times(columns)]
    if len(starts) < 2:
        return _numbered_runs(columns)
    edges = [0, *starts[1:], len(columns)]
    parts = [list(columns[first:last]) for first, last in pairwise(edges)]
    patterns = {tuple(re.sub(r"\d+", "", column.label) for column in part) for part in parts}
    first = parts[0][0].channel.values
    same = all(np.array_equal(first, part[0].channel.values, equal_nan=True) for part in parts)
    marked = all(RUN.search(part[-1].label) for part in parts)
    if len(patterns) == 1 and len(parts[0]) > 1 and (marked or not same):
        return parts
    own = [each for part in parts[1:] for each in _on_own_clock(part, columns[starts[0]])]
    return [[*parts[0], *own]]


def _on_own_clock(part: Sequence[Column], first: Column) -> list[Column]:
    """Columns behind a further time, which has other numbers of samples if it is another clock."""
    time, *channels = part
    stamps, others, unit = _numbers(time), _numbers(first), _clock(time).unit
    step = UNITS[TIME][unit] * float(np.median(np.diff(stamps)))
    if stamps.size == others.size or not step > 0.0:
        return channels
    start = UNITS[TIME][unit] * (stamps[0] - (others[0] if unit in DATES else 0.0))
    return [replace(each, rate=float(f"{1.0 / step:.6g}"), start=float(start)) for each in channels]


def _numbered_runs(columns: Sequence[Column]) -> list[list[Column]]:
    """Columns by the number of a run in their names; those without belong to all runs."""
    numbers = [found[1] if (found := RUN.search(column.label)) else None for column in columns]
    runs = [number for number in dict.fromkeys(numbers) if number is not None]
    if len(runs) < 2:
        return [list(columns)]
    return [[c for c, n in zip(columns, numbers, strict=True) if n in (None, run)] for run in runs]


def is_time(column: Column) -> bool:
    """Whether a column may be time: by its name or dates, and because it goes on."""
    values = _numbers(column)
    if values.size < 3 or not values[0] < values[-1]:
        return False
    if _is_count(column):
        return False
    named = column.channel.unit == DATETIME or _names(column, TIME) or unit_of(column, [TIME]) in UNITS[TIME]
    onward = float((np.diff(values) >= 0.0).mean())
    if named:
        return onward > 0.9
    known = _names_anything(column) or unit_of(column, [TIME, *QUANTITIES])
    return not known and _goes_evenly(column)


def _times(columns: Sequence[Column]) -> list[Column]:
    """Columns that may be time, without the numbers of rows unless nothing else goes on."""
    found = [column for column in columns if is_time(column)]
    rows = [each for each in found if not _names_anything(each) and (np.diff(_numbers(each)) == 1.0).all()]
    return [each for each in found if each not in rows] or found


def _is_count(column: Column) -> bool:
    return any(re.fullmatch(COUNTS, words.strip().lower()) for words in (column.label, *column.words))


def _goes_evenly(column: Column) -> bool:
    """Whether numbers rise in even steps, as time does and no motion that turns back; runs may begin anew."""
    steps = np.diff(continued(_numbers(column))[0])
    even = (np.abs(steps / max(float(np.median(steps)), 1e-300) - 1.0) < UNEVEN).mean() if steps.size else 0.0
    return bool((steps >= 0.0).all()) and even > EVEN


def _is_abscissa(column: Column) -> bool:
    """Whether a column may be time although its letter is that of a motion, as x of a plot; no count is."""
    label = column.label.strip().lower()
    named = _is_count(column) or any(re.search(stem, label) for stem in STEMS.values())
    whole = not np.mod(_numbers(column), 1.0).any()
    return not (named or whole or unit_of(column, [TIME, *QUANTITIES])) and _goes_evenly(column)


def known_samples(columns: Sequence[Column]) -> list[Column]:
    """Columns without numbers that stand for missing samples."""
    found = []
    for column in columns:
        values, texts = column.channel.values, tuple(stand_ins(column.channel.values))
        known = np.where(np.isin(values, [float(text) for text in texts]), np.nan, values)
        without = replace(column, channel=replace(column.channel, values=known), missing=texts)
        found.append(without if texts else column)
    return found


def choose(columns: Sequence[Column]) -> Run:
    """The channels among the columns of a run."""
    time = next(iter(_times(columns)), None) or next(filter(_is_abscissa, columns), None)
    stamps = None if time is None else time.channel.values
    rest = [column for column in columns if column is not time and not is_time(column) and _varies(column)]
    rest = [column for column in rest if not (_is_count(column) and _goes_evenly(column))]
    load = next(filter(_presses, columns), None)
    channels = _by_name([column for column in rest if column is not load])
    if FORCE not in channels:
        load, channels = None, _by_name(rest)
    if not any(name in channels for name in MOTIONS):
        unnamed = [column for column in rest if not _names_anything(column)]
        found = _by_numbers(unnamed, stamps)
        channels = {name: each for name, each in channels.items() if each not in found.values()} | found
    if FORCE in channels and "displacement" in channels and unit_of(channels[FORCE], [FORCE]) in FOREIGN:
        signals = [_thinned(channels[name], stamps) for name in ("displacement", FORCE)]
        if _share(*signals) < STANDS:
            del channels[FORCE]
    if _turns(channels):  # on what turns an accelerometer shows gravity
        units = {name: each.unit for name, each in with_units(channels).items()}
        channels = {name: channels[name] for name in channels if name not in MOTIONS or angular(units[name])}
    for quantity in RATES:
        if set(channels) == {quantity}:
            channels = _of_base_and_mass(quantity, channels[quantity], rest)
    chosen = with_units(channels)
    if "velocity" in chosen and "displacement" in chosen:
        chosen["velocity"] = _derived(chosen, time)
    return Run(None if time is None else _clock(time), chosen, columns, load)


def is_relative(column: Column) -> bool:
    """Whether a column is named as a motion against the base."""
    return re.search(r"(?<![a-z])rel(?![a-z])|relativ|drift", column.label.lower()) is not None


def _of_base_and_mass(quantity: str, found: Column, columns: Sequence[Column]) -> dict[str, Column]:
    """Channels of two sensors of a velocity or of an acceleration: the input is that of the base.

    From it power flows to the mass: the base moves that by its force, which is in proportion to the mass's
    acceleration.
    """
    alike = [c for c in columns if _points(c, quantity) >= _points(found, quantity)]
    if len(alike) != 2 or alike[0].channel.values.size != alike[1].channel.values.size:
        return {quantity: found}
    first, second = (np.fft.rfft(_centred(c) * np.hanning(c.channel.values.size)) for c in alike)
    lines = (first.conj() * second)[1:]
    lines[np.abs(lines) < LINES * np.abs(lines).max()] = 0.0
    to_first = float(np.sum(lines.imag * np.arange(1, lines.size + 1.0) ** RATES[quantity]))
    base, mass = alike[::-1] if to_first > 0.0 else alike
    return {quantity: mass, INPUT: base}


def _centred(column: Column) -> np.ndarray:
    return np.nan_to_num(column.channel.values - np.mean(_numbers(column)))


def _presses(column: Column) -> bool:
    """Whether a column may be the load that presses two faces together: it hardly varies."""
    unit, values = unit_of(column, [FORCE]), _numbers(column)
    is_force = unit in UNITS[FORCE] and not angular(unit)
    named = re.search(PRESSES, column.label.lower()) and not re.search(NOT_MEASURED, column.label.lower())
    return bool(is_force and named and values.size and values.std() < SET * values.mean())


def mean_load(column: Column) -> float:
    """Mean (N) of a column of loads."""
    return float(_numbers(column).mean()) * UNITS[FORCE][unit_of(column, [FORCE])]


def _numbers(column: Column) -> np.ndarray:
    return column.channel.values[np.abs(column.channel.values) < HUGE]


def _varies(column: Column) -> bool:
    values = _numbers(column)
    return bool(values.size and np.ptp(values) > 1e-12 * np.abs(values).max())


def _names(column: Column, quantity: str) -> bool:
    """Whether the words above a column name a quantity."""
    stem, symbol = STEMS.get(quantity, DRIVES), SYMBOLS[quantity]
    unit = unit_of(column, [TIME, *QUANTITIES]).lower()
    for words in [each for each in column.words if not is_unit(usual(each.strip(" ()[]")))] or column.words:
        bare = BRACKETS.sub(" ", split_unit(words)[0]).strip().lower()
        short = re.sub(r"[_\s]*\d*$", "", bare.removesuffix(f"_{unit}"))
        if re.search(stem, bare) or re.fullmatch(symbol, re.sub(r"^.*[./]", "", short)):
            return True
    return False


def _names_anything(column: Column) -> bool:
    return any(_names(column, each) for each in SYMBOLS)


def _points(column: Column, quantity: str) -> float:
    """How well name and unit of a column go with a quantity; not positive if they do not."""
    label, unit = column.label.lower(), unit_of(column, [quantity])
    points = 0.0
    if unit in UNITS[quantity]:
        points += OF_UNIT
    elif unit in FOREIGN:
        points += OF_FOREIGN
    elif unit:
        return 0.0
    first = next((each for each in STEMS if _names(column, each)), None)
    points += OF_NAME if first == quantity else 0.0
    if quantity == FORCE and (re.search(STANDS_FOR_FORCE, label) or unit in STANDING_UNITS):
        points += OF_PROXY - (OF_FOREIGN if unit in FOREIGN else 0.0)
    if re.search(NOT_MEASURED, label):
        points += OF_COMMAND
    return points


def _by_name(columns: Sequence[Column]) -> dict[str, Column]:
    """Channels by names and units."""
    drives = [c for c in columns if _names(c, INPUT)]
    # Of a building that stands on what is recorded, too, a floor is a mass.
    drives = [c for c in drives if "floor" not in c.label.lower()] or drives
    channels: dict[str, Column] = {}
    for quantity in (*MOTIONS, FORCE):
        found = _best(quantity, columns, drives, channels)
        if found is not None:
            channels[quantity] = found
    others = [c for c in drives if all(c is not each for each in channels.values())]
    # What nothing names but that it drives the rig is a force, unless its unit is another one's.
    able = [(max(_points(c, q) for q in QUANTITIES), c) for c in others if _quantity(c)]
    if able:
        channels[INPUT] = max(able, key=lambda pair: pair[0])[1]
    return channels


def _best(
    quantity: str, columns: Sequence[Column], drives: Sequence[Column], taken: Mapping[str, Column]
) -> Column | None:
    """The column that goes best with a quantity and with those that are taken; what drives is none."""
    free = [c for c in columns if all(c is not each for each in (*taken.values(), *drives))]
    words = {word for each in taken.values() for word in WORDS.findall(each.label.lower())}

    def rank(column: Column) -> tuple[float, float]:
        shared = len(words & set(WORDS.findall(column.label.lower())))
        return _points(column, quantity) + OF_SHARED * shared, float(np.nanstd(column.channel.values))

    able = [column for column in free if _points(column, quantity) > 0.0]
    if not able:
        return None
    top = max(rank(column)[0] for column in able)
    alike = [column for column in able if rank(column)[0] >= top - 1e-9]
    units = {unit_of(column, [quantity]) for column in alike}
    return max(alike, key=rank) if len(units) == 1 else alike[0]


def _quantity(column: Column) -> str:
    """What an input is: by its unit, its name, or the letter before it, as in x_base; empty if it is none.

    Without any of these a place moves, and all else is a force.
    """
    unit, label = unit_of(column, QUANTITIES), column.label.lower()
    for quantity in QUANTITIES:
        if unit in UNITS[quantity]:
            return quantity
    named = next((each for each in STEMS if each in QUANTITIES and _names(column, each)), "")
    letter = re.split(r"[_\s]", label)[0]
    named = named or next((each for each in QUANTITIES if re.fullmatch(SYMBOLS[each], letter)), "")
    return named or ("" if unit else "displacement" if re.search(PLACES, label) else FORCE)


def _by_numbers(columns: Sequence[Column], time: np.ndarray | None) -> dict[str, Column]:
    """Channels by what their numbers do: one is the slope of another, or a force that a motion explains."""
    signals = {i: _thinned(column, time) for i, column in enumerate(columns)}
    kept: list[int] = []
    for i in reversed(signals):  # a sensor's volts stand before what was computed of them
        if all(abs(_correlation(signals[i], signals[j])) < SAME for j in kept):
            kept.insert(0, i)
    if not kept:
        return {}
    found: dict[str, int] = {}
    span = float(np.ptp(time[np.isfinite(time)])) if time is not None else 0.0
    pairs = {
        (a, b): _slope_of(signals[a] * _size(columns[a]), signals[b] * _size(columns[b]), span)
        for a, b in permutations(kept, 2)
    }
    best = max(pairs, key=lambda pair: pairs[pair], default=None)
    if best is not None and pairs[best] > DERIVED**2:
        found = {"displacement": best[0], "velocity": best[1]}
    rest = [i for i in kept if i not in found.values()]
    moves = [found["displacement"]] if found else rest
    pairs_of_force = [(a, b) for a in moves for b in rest if a != b]
    explained = {
        (a, b): forth - _share(signals[b], signals[a])
        for a, b in pairs_of_force
        if (forth := _share(signals[a], signals[b])) > STANDS
    }
    if explained:
        best = max(explained, key=lambda pair: explained[pair])
        found |= {"displacement": best[0], FORCE: best[1]}
    return {name: columns[i] for name, i in (found or {"displacement": kept[0]}).items()}


def _thinned(column: Column, time: np.ndarray | None) -> np.ndarray:
    """At most POINTS means of a column over even times, over their standard deviation."""
    values = column.channel.values
    place = np.arange(values.size, dtype=float) if time is None or time.size != values.size else time
    good = np.isfinite(values) & np.isfinite(place)
    order = np.argsort(place[good], kind="stable")
    size = min(POINTS, int(good.sum()))
    even = np.interp(
        np.linspace(place[good].min(), place[good].max(), size * max(1, good.sum() // size)),
        place[good][order],
        values[good][order],
    )
    means = even.reshape(size, -1).mean(axis=1)
    return (means - means.mean()) / max(float(means.std()), 1e-300)


def _size(column: Column) -> float:
    return float(np.nanstd(column.channel.values))


def _slope_of(displacement: np.ndarray, velocity: np.ndarray, span: float) -> float:
    """Share of the slope of a displacement over a span of time that is a velocity; 0 if sizes differ."""
    size = min(displacement.size, velocity.size)
    ratio, left = slope(displacement[:size], velocity[:size], np.linspace(0.0, span, size))
    units = (1.0, 1e3, 1e-3, 180.0 / np.pi, np.pi / 180.0, 30.0 / np.pi)
    return 1.0 - left**2 if any(abs(ratio * unit - 1.0) < UNLIKE for unit in units) else 0.0


def _correlation(first: np.ndarray, second: np.ndarray) -> float:
    size = min(first.size, second.size)
    if not (first[:size].std() and second[:size].std()):
        return 0.0
    return float(np.corrcoef(first[:size], second[:size])[0, 1])


def _share(x: np.ndarray, f: np.ndarray) -> float:
    """Share of a force (n,) that place and direction of a motion (n,) explain."""
    size = min(x.size, f.size)
    x, f = x[:size], f[:size]
    v = np.gradient(np.convolve(x, np.ones(9) / 9.0, mode="same"))
    speed = max(float(np.abs(v).std()), 1e-300)
    parts = np.column_stack([np.ones(size), x, v, np.tanh(5.0 * v / speed), np.gradient(v)])
    if not (np.isfinite(parts).all() and np.isfinite(f).all()):
        return 0.0
    left = f - parts @ np.linalg.lstsq(parts, f, rcond=None)[0]
    return 1.0 - float(left.var() / max(f.var(), 1e-300))


def _derived(chosen: Mapping[str, Chosen], time: Column | None) -> Chosen:
    """The velocity, marked if it is but the slope of the displacement."""
    d, v = (chosen[name].values for name in ("displacement", "velocity"))
    _, left = slope(d, v, None if time is None else time.channel.values)
    return replace(chosen["velocity"], keys={"derived": True}) if left < COMPUTED else chosen["velocity"]


def slope(
    displacement: np.ndarray, velocity: np.ndarray, time: np.ndarray | None = None
) -> tuple[float, float]:
    """What a velocity (n,) is multiplied by as the slope of a displacement (n,), and the share that is left.

    ``time`` (n,): the number of the sample without one. All is left where it does not go on.
    """
    t = np.arange(displacement.size) if time is None else time
    if not velocity.size == displacement.size == t.size:
        return 1.0, 1.0
    good = np.isfinite(displacement) & np.isfinite(t)
    if good.sum() < 8 or (np.diff(t[good]) <= 0.0).any():
        return 1.0, 1.0
    slope, v = np.gradient(displacement[good], t[good]), np.nan_to_num(velocity[good])
    size = float(slope @ v) / max(float(v @ v), 1e-300)
    return size, float(np.std(slope - size * v)) / max(float(slope.std()), 1e-300)


def with_units(channels: Mapping[str, Column]) -> dict[str, Chosen]:
    """Channels and their units: of angles and torques, or of lengths and forces, in all of them."""
    turns = _turns(channels)
    return {name: _with_unit(name, column, turns) for name, column in channels.items()}


def _turns(channels: Mapping[str, Column]) -> bool:
    """Whether channels are angles and torques: by a unit, else by a name."""
    units = [unit_of(column, QUANTITIES) for column in channels.values()]
    known = [unit for unit in units if any(unit in UNITS[quantity] for quantity in QUANTITIES)]
    return any(map(ANGULAR.search, known or [column.label.lower() for column in channels.values()]))


def _with_unit(name: str, column: Column, turns: bool) -> Chosen:
    """A channel and its unit; what is no unit of it, or is not known, is asked."""
    quantity = _quantity(column) or FORCE if name == INPUT else name
    keys: dict[str, object] = {"quantity": quantity} if name == INPUT else {}
    keys |= {"missing": list(column.missing)} if column.missing else {}
    keys |= {"rate_hz": column.rate} if column.rate else {}
    keys |= {"delay_ms": float(f"{-1e3 * column.start:.6g}")} if column.start else {}
    unit = unit_of(column, [quantity])
    if unit in UNITS[quantity]:
        return Chosen(column, unit, keys)
    largest = float(np.nanmax(np.abs(column.channel.values)))
    likely = _likely(quantity, column, largest, turns)
    if unit in FOREIGN:
        question = f"the file holds {unit}: how many {likely} are 1 {unit}? Write that as scale"
        return Chosen(column, likely, {"scale": 1.0, **keys}, (question,))
    question = f"unit? The file names none, and {likely} is a guess by its size (up to {largest:.3g})"
    return Chosen(column, likely, keys, (question,))


def _likely(quantity: str, column: Column, largest: float, turns: bool) -> str:
    """A unit where the file names none, by the size."""
    if quantity == FORCE:
        return "N m" if turns else "N"
    if quantity == "acceleration":
        return "rad/s^2" if turns else "m/s^2"
    if "rpm" in column.label.lower():
        return "rpm"
    unit = ("deg" if largest > DEGREES else "rad") if turns else ("m" if largest < METRES else "mm")
    return unit if quantity == "displacement" else f"{unit}/s"


def _clock(column: Column) -> Chosen:
    """The time and its unit: dates, what the file names, or what makes plausible steps."""
    if column.channel.unit == DATETIME:
        return Chosen(column, DATETIME)
    unit = unit_of(column, [TIME])
    values = column.channel.values[np.isfinite(column.channel.values)]
    step, first = float(np.median(np.diff(values))), float(values[0])
    if DAYS[0] < first < DAYS[1] and step < STEPS[0] * DAY / 10.0:
        return Chosen(column, "excel", {}, ("days of Excel?",))
    if unit in UNITS[TIME]:
        return Chosen(column, unit)
    for unit, size in {"epoch": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}.items():
        if EPOCH[0] < size * first < EPOCH[1] and size * step < 10.0:
            return Chosen(column, unit)
    likely = "s" if step < STEPS[1] else "ms"
    if step > 1e3 * STEPS[1]:
        likely = "us"
    return Chosen(column, likely, {}, (f"unit? {likely} makes steps of {step:.3g} {likely}",))
