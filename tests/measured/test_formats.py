"""The same vibration in every form that people have it in is the same record, and its form is told."""

import json
import sys
from zipfile import ZipFile

import numpy as np
import pytest
from scipy.io import savemat, wavfile

from tests import fixture_formats, fixture_measured
from tests.command import invoke
from tests.fixture_measured import MEASURED, csv_lines, lines, vibration
from wedgesweep import measured, readers
from wedgesweep.measured.build import shortened
from wedgesweep.readers.survey import survey
from wedgesweep.readers.table import seconds_of_dates
from wedgesweep.units import usual


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    return measured.read(fixture_measured.write(tmp_path_factory.mktemp("plain"))).tests[0]


def units_row(rows):
    return [rows[0], "[s],[mm],(mm/s)", *rows[1:]]


def decimal_commas(rows):
    return [row.replace(",", ";").replace(".", ",") for row in rows]


FORMS = {
    "semicolons": (lambda rows: [row.replace(",", ";") for row in rows], "utf-8", "semicolon-separated"),
    "tabs": (lambda rows: [row.replace(",", "\t") for row in rows], "utf-8", "tab-separated"),
    "spaces": (lambda rows: [row.replace(",", "  ") for row in rows], "utf-8", "space-separated"),
    "decimal commas": (decimal_commas, "utf-8", "semicolon-separated, decimal commas"),
    "quoted": (lambda rows: [f'"{row.replace(",", chr(34) + "," + chr(34))}"' for row in rows], "utf-8", ""),
    "byte order mark": (list, "utf-8-sig", ""),
    "UTF-16": (list, "utf-16", "utf-16"),
    "Latin-1": (lambda rows: ["# Prüfstand", *rows], "latin-1", "latin-1, header in line 2"),
    "comments": (
        lambda rows: ["# bench", "% 12", *rows[:9], "# pause", *rows[9:]],
        "utf-8",
        "header in line 3",
    ),
    "header is a comment": (lambda rows: [f"# {rows[0]}", *rows[1:]], "utf-8", ""),
    "head of a logger": (lambda rows: ["Date;1.1.", "", "Rate,1000", *rows], "utf-8", "header in line 4"),
    "units": (units_row, "utf-8", "a row of units"),
    "micro": (lambda rows: [rows[0], "sec,mm,mm/s", *rows[1:]], "utf-8", "a row of units"),
    "carriage returns": (lambda rows: [f"{row}\r" for row in rows], "utf-8", ""),
}


@pytest.mark.parametrize("form", FORMS)
def test_text_is_read_as_it_was_meant(tmp_path, plain, form):
    edit, encoding, told = FORMS[form]
    path = fixture_measured.write(tmp_path)
    (tmp_path / "one.csv").write_bytes("\n".join(edit(lines())).encode(encoding))
    found = measured.read(path).tests[0]
    for name in ("time", "displacement", "velocity"):
        assert np.array_equal(getattr(found, name), getattr(plain, name))
    assert found.remarks == ((told,) if told else ())
    assert (f"one.csv: {told}\n" in invoke("check", path)) == bool(told)


def stated(keys):
    return MEASURED.replace("[[measurement.test]]", f"[measurement.csv]\n{keys}\n[[measurement.test]]")


def test_what_is_stated_is_not_guessed(tmp_path, plain):
    rows = ["t,d,v", *(f'{i};"{1000 + i},5";"{i},25"' for i in range(3)), *decimal_commas(lines())]
    keys = 'skip_rows = 4\ndelimiter = "semicolon"\ndecimal = "comma"\nencoding = "cp1252"'
    found = measured.read(fixture_measured.write(tmp_path, stated(keys), csv=rows)).tests[0]
    assert np.array_equal(found.displacement, plain.displacement)


FAULTS = {
    "thousands": (
        ["t;d;v", *(f"{i};1,234;2,345" for i in range(600))],
        "",
        '"1,234" may be a decimal or thou',
    ),
    "unit": (units_row(lines()), None, 'the file says "mm", its unit is stated as "um"'),
    "micrometres": (
        [lines()[0], "s,µm,mm/s", *lines()[1:]],
        "",
        'the file says "um", its unit is stated as "mm"',
    ),
    "encoding": (lines(), 'encoding = "klingon"', 'no encoding "klingon"'),
    "not that encoding": ([*lines(), "ü"], 'encoding = "ascii"', "not ascii text (byte"),
    "binary": (["t,d,v", "\0\0\0"], 'encoding = "utf-8"', "null characters"),
    "stray quote": (
        [*lines()[:5], '"' + lines()[5], *lines()[6:]],
        "",
        'one.csv:6: t: "0.0040,5.21427,-218.618" is not a finite number',
    ),
    "huge": ([lines()[0], "0.0000,1e200,1", *lines()[2:]], "", "displacement: 1e+197 in SI"),
    "tiny": (["t,d,v", *(f"{i / 1000:.3f},{i % 7}e-200,{i % 5}" for i in range(600))], "", "is constant"),
    "huge, and twice": (
        [*lines()[:9], *(f"{i / 1000:.4f},{x}e307,1" for i, x in enumerate((9, -9, 9), 8)), *lines()[12:]],
        "",
        "displacement: 9e+304 in SI",
    ),
    "huge times": (["t,d,v", *(f"{i}e200,{i % 7},{i % 5}" for i in range(600))], "", "time: 5.99e+202 in SI"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_doubts_and_faults_are_named(tmp_path, fault):
    rows, keys, words = FAULTS[fault]
    text = stated(keys) if keys else MEASURED
    if keys is None:
        text = MEASURED.replace('unit = "mm" ', 'unit = "um" ')
    with pytest.raises(measured.MeasuredError) as caught:
        measured.read(fixture_measured.write(tmp_path, text, csv=rows))
    assert len(caught.value.problems) == 1, caught.value
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("beginning", "words"),
    [
        (b"PK\x03\x04\0\0", "a zip archive; a workbook of Excel must end in .xlsx"),
        (b"\x1f\x8b\0", "compressed by gzip; unpack it"),
        (b"\x89HDF\r\n\x1a\n\0", "end its name with .h5"),
        (b"\x89PNG\r\n\x1a\n\0\0\0\xff\xd8", "no text"),
    ],
)
def test_what_is_no_text_is_called_what_it_is(tmp_path, beginning, words):
    path = fixture_measured.write(tmp_path)
    (tmp_path / "one.csv").write_bytes(beginning + bytes(range(256)))
    with pytest.raises(measured.MeasuredError, match=words):
        measured.read(path)


@pytest.mark.parametrize(("name", "write"), fixture_formats.SPECIMENS)
def test_binary_files_hold_variables(tmp_path, plain, name, write):
    t, d, v = vibration()
    write(tmp_path / name, {"t": np.round(t, 4), "d": d, "v": v})
    text = MEASURED.replace("one.csv", name)
    if name.endswith((".h5", ".tdms")):
        for column in "tdv":
            text = text.replace(f'column = "{column}"', f'column = "bench/{column}"')
    path = fixture_measured.write(tmp_path, text)
    np.testing.assert_allclose(measured.read(path).tests[0].displacement, plain.displacement, rtol=1e-5)
    path.write_text(text.replace('d"', 'dd"', 1))
    with pytest.raises(measured.MeasuredError, match=r"no variable .*dd"):
        measured.read(path)
    (tmp_path / name).write_bytes((tmp_path / name).read_bytes()[:100])
    with pytest.raises(
        measured.MeasuredError, match=r"cannot be read|give the path|no variable .*valid here: $"
    ):
        measured.read(path)


@pytest.mark.parametrize(
    ("name", "inside"),
    [("one.mat", "bench."), ("one.json", "bench."), ("new.mat", "bench."), ("new.mat", "bench/")],
)
def test_channels_in_a_struct(tmp_path, plain, name, inside):
    columns = dict(zip("tdv", vibration(), strict=True))
    if name == "one.mat":
        savemat(tmp_path / name, {"bench": columns, "matrix": np.eye(3)})
    elif name == "one.json":
        rows = [
            dict(zip(columns, row, strict=True)) for row in zip(*map(list, columns.values()), strict=True)
        ]
        (tmp_path / name).write_text(json.dumps({"rig": {"kg": 0.7}, "bench": rows}))
    else:
        with pytest.importorskip("h5py").File(tmp_path / name, "w") as file:
            for each, values in columns.items():
                file[f"bench/{each}"] = values[:, None]
    text = MEASURED.replace("one.csv", name)
    for column in "tdv":
        text = text.replace(f'column = "{column}"', f'column = "{inside}{column}"')
    path = fixture_measured.write(tmp_path, text)
    np.testing.assert_allclose(measured.read(path).tests[0].displacement, plain.displacement, rtol=1e-5)


def test_an_object_that_lacks_a_key_lacks_a_sample(tmp_path):
    (tmp_path / "late.jsonl").write_text('{"t": 0.0}\n\n{"t": 0.1, "v": 2.0}\n')
    values = readers.read(tmp_path / "late.jsonl", ["v"]).channels["v"].values
    np.testing.assert_array_equal(values, [np.nan, 2.0])


def test_a_matrix_is_no_channel(tmp_path):
    savemat(tmp_path / "one.mat", {"t": np.eye(3), "d": np.arange(9.0), "v": np.arange(9.0)})
    path = fixture_measured.write(tmp_path, MEASURED.replace("one.csv", "one.mat"))
    with pytest.raises(measured.MeasuredError, match="holds 3 x 3 numbers; name one column of a matrix"):
        measured.read(path)


def read_with(path, *changes):
    text = MEASURED
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return measured.read(fixture_measured.write(path, text)).tests[0]


NUMBERED = [('"t"', "1"), ('"d"', "2"), ('"v"', "3")]


def test_columns_of_one_array_by_number_and_of_a_matrix_by_name(tmp_path, plain):
    columns = np.column_stack(vibration())
    np.save(tmp_path / "one.npy", columns)
    found = read_with(tmp_path, ("one.csv", "one.npy"), *NUMBERED)
    np.testing.assert_allclose(found.displacement, plain.displacement, rtol=1e-5)
    np.savez(tmp_path / "one.npz", t=columns[:, 0], q=columns)
    found = read_with(tmp_path, ("one.csv", "one.npz"), ('"d"', '"q[2]"'), ('"v"', '"q[3]"'))
    np.testing.assert_allclose(found.displacement, plain.displacement, rtol=1e-5)
    with pytest.raises(measured.MeasuredError, match=r'variable "q" holds \d+ x 3 numbers, and no column 4'):
        read_with(tmp_path, ("one.csv", "one.npz"), ('"d"', '"q[4]"'))


@pytest.mark.parametrize("name", ["one.mat", "new.mat"])
def test_arrays_of_three_dimensions_and_of_a_new_matlab(tmp_path, plain, name):
    """Simulink logs a signal as 1 x 1 x n and three as 3 x 1 x n; HDF5 has MATLAB's dimensions in reverse."""
    columns = np.array(vibration())
    arrays = {"t": columns[0][None, None], "q": columns[:, None], "m": columns.T}
    if name == "one.mat":
        savemat(tmp_path / name, arrays)
    else:
        with pytest.importorskip("h5py").File(tmp_path / name, "w") as file:
            for each, values in arrays.items():
                file[each] = values.T
                file[each].attrs["MATLAB_class"] = np.bytes_("double")
    found = read_with(tmp_path, ("one.csv", name), ('"d"', '"q[2]"'), ('"v"', '"m[3]"'))
    np.testing.assert_allclose(found.displacement, plain.displacement, rtol=1e-5)
    np.testing.assert_allclose(found.velocity, plain.velocity, rtol=1e-4)
    assert [column.name for column in survey(tmp_path / name).columns].count("q[2]") == 1
    savemat(tmp_path / "one.mat", {"t": columns[0], "d": np.zeros((5, 4, 3)), "v": columns[2]})
    with pytest.raises(measured.MeasuredError, match="holds 5 x 4 x 3 numbers; name one column"):
        read_with(tmp_path, ("one.csv", "one.mat"))


CLOCKLESS = ('time = { column = "t", unit = "s" }\n', "")


@pytest.mark.parametrize(("kind", "scale"), [("i2", 32768.0), ("f4", 1.0), ("u1", 128.0)])
def test_sound_has_a_clock_and_full_scale_is_one(tmp_path, kind, scale):
    _, d, v = vibration()
    full = np.abs(v).max()
    tracks = np.column_stack([(d - 5.0) / 2.0, v / full]) * (scale if kind == "f4" else 0.99 * scale)
    wavfile.write(tmp_path / "one.wav", 1000, (tracks + (128.0 if kind == "u1" else 0.0)).astype(kind))
    size = 1.0 if kind == "f4" else 1.0 / 0.99
    keys = [('"d", unit = "mm"', f'1, unit = "mm", scale = {2.0 * size}')]
    keys += [('"v", unit = "mm/s"', f'2, unit = "mm/s", scale = {full * size}')]
    found = read_with(tmp_path, ("one.csv", "one.wav"), CLOCKLESS, *keys)
    assert found.sampling_rate == pytest.approx(1000.0)
    np.testing.assert_allclose(
        found.displacement, 1e-3 * (d - 5.0), atol=2e-3 / min(scale, 128.0) + 1e-9 * scale
    )


def test_universal_files_hold_numbered_sets(tmp_path, plain):
    fixture_formats.uff(tmp_path / "one.uff", dict(zip("tdv", vibration(), strict=True)))
    found = read_with(tmp_path, ("one.csv", "one.uff"), CLOCKLESS, ('"d"', "1"), ('"v"', "2"))
    np.testing.assert_allclose(found.displacement, plain.displacement, rtol=1e-4)


def test_columns_of_a_workbook_by_letter_and_sheet(tmp_path, plain):
    book = pytest.importorskip("openpyxl").Workbook()
    book.create_sheet("Run 2")
    for row in zip(*vibration(), strict=True):
        book["Run 2"].append([None, *map(float, row)])
    book.save(tmp_path / "one.xlsx")
    sheet = [(f'"{name}"', f'"Run 2!{letter}"') for name, letter in zip("tdv", "BCD", strict=True)]
    found = read_with(tmp_path, ("one.csv", "one.xlsx"), *sheet)
    np.testing.assert_allclose(found.displacement, plain.displacement, rtol=1e-5)


def test_what_a_library_warns_of_is_not_printed(tmp_path):
    """Its warnings are errors here, as they are to the fuzz."""
    fixture_formats.xlsx(tmp_path / "whole.xlsx", dict(zip("tdv", vibration(), strict=True)))
    with ZipFile(tmp_path / "whole.xlsx") as whole, ZipFile(tmp_path / "one.xlsx", "w") as damaged:
        for name in whole.namelist():
            content = whole.read(name)
            damaged.writestr(
                name, content.replace(b" Id=", b" Jd=") if name.endswith("book.xml.rels") else content
            )
    with pytest.raises(measured.MeasuredError, match=r"one\.xlsx: cannot be read \('rId"):
        read_with(tmp_path, ("one.csv", "one.xlsx"))


@pytest.mark.parametrize(
    ("ending", "library", "extra"),
    [
        ("xlsx", "openpyxl", "xlsx"),
        ("tdms", "nptdms", "tdms"),
        ("uff", "pyuff", "uff"),
        ("mf4", "asammdf", "mdf"),
        ("h5", "h5py", "hdf5"),
        ("parquet", "pyarrow.parquet", "parquet"),
    ],
)
def test_a_library_that_is_absent_is_named(tmp_path, monkeypatch, ending, library, extra):
    monkeypatch.setitem(sys.modules, library, None)
    (tmp_path / f"one.{ending}").touch()
    with pytest.raises(measured.MeasuredError, match=rf"pip install 'wedgesweep\[{extra}\]'"):
        read_with(tmp_path, ("one.csv", f"one.{ending}"))


def cells_of(rows):
    return [row.split(",") for row in rows[1:]]


def headerless(rows):
    return [row.replace(",", "\t") for row in rows[1:]]


def of_a_logger(rows):
    """Lines of text, a repeated time column, units of which one is not known, and rows that end early."""
    head = [
        "Time,2020-03-16,Time,2020-03-16",
        "Interval,0.001,Interval,0.001",
        "Name,d,Name,v",
        "Unit,V,Unit,mm/s",
    ]
    cells = cells_of(rows)
    return head + [f"{t},{d},{t},{v}" for t, d, v in cells] + [f"{cells[-1][0]},{cells[-1][1]}"]


# Points between thousands, and decimal commas.
SWAPPED = str.maketrans(",.", ".,")
MORE_FORMS = {
    "headerless": (headerless, NUMBERED),
    "numbers behind a header": (list, NUMBERED),
    "trailing separators": (lambda rows: [f"{row},," for row in rows], []),
    "units behind names": (lambda rows: ["t [s],d (mm),v [mm/s]", *rows[1:]], []),
    "logger by number": (of_a_logger, [('"t"', "1"), ('"d"', "2"), ('"v"', "4")]),
    "logger by name": (of_a_logger, [('"t"', '"Name#2"')]),
    "two header rows": (lambda rows: ["t,-,-", "-,d,v", *rows[1:]], []),
    "thousands and decimals": (
        lambda rows: [
            "t;d;v",
            *(
                ";".join(f"{float(cell):,.6f}".translate(SWAPPED) for cell in (t, d, f"{1e3 * float(v)}"))
                for t, d, v in cells_of(rows)
            ),
        ],
        [('unit = "mm/s" ', 'unit = "um/s" ')],
    ),
    "days": (
        lambda rows: [rows[0], *(f"0 days 00:00:0{t}00,{d},{v}" for t, d, v in cells_of(rows))],
        [('unit = "s"', 'unit = "datetime"')],
    ),
    "thousands": (
        lambda rows: [
            rows[0],
            *(f"{t},{f'{1e3 * float(d):,.2f}'.replace(',', chr(39))},{v}" for t, d, v in cells_of(rows)),
        ],
        [
            ('unit = "mm" ', 'unit = "um" '),
            ("[[measurement.test]]", '[measurement.csv]\nthousands = "apostrophe"\n[[measurement.test]]'),
        ],
    ),
}


@pytest.mark.parametrize("form", MORE_FORMS)
def test_columns_are_found_in_any_layout(tmp_path, plain, form):
    edit, changes = MORE_FORMS[form]
    path = fixture_measured.write(tmp_path, csv=edit(lines()))
    text = MEASURED
    for old, new in changes:
        text = text.replace(old, new)
    path.write_text(text)
    found = measured.read(path).tests[0]
    assert np.abs(found.displacement - plain.displacement).max() < 1e-12
    assert np.abs(found.velocity - plain.velocity).max() < 1e-12


def test_headers_between_blocks_are_left_out(tmp_path):
    """A test stand begins each block with the names of its columns, and lines that tell when and how long."""
    rows = lines()
    block = len(rows) // 3
    blocks = [rows[1 + i * block : 1 + (i + 1) * block] for i in range(3)]
    text = [
        each
        for i, own in enumerate(blocks)
        for each in (f"Time,12:0{i}:22.5", f"Samples,{block},{block}", rows[0], "s,mm,-", *own)
    ]
    path = fixture_measured.write(tmp_path, MEASURED, csv=text)
    found, plain = measured.read(path).tests[0], rows[1 : 1 + 3 * block]
    assert "8 lines of further headers left out" in found.remarks[0]
    assert found.time.size == len(plain)
    assert [column.name for column in survey(tmp_path / "one.csv").columns] == ["t", "d", "v"]
    np.testing.assert_allclose(found.time, [float(row.split(",")[0]) for row in plain], atol=1e-12)
    text[block + 9] = "0.1,oops,0.2"
    with pytest.raises(measured.MeasuredError, match=rf"one.csv:{block + 10}: d: \"oops\" is not"):
        measured.read(fixture_measured.write(tmp_path, MEASURED, csv=text))


def test_a_unit_that_is_unknown_is_told(tmp_path):
    found = measured.read(fixture_measured.write(tmp_path, csv=["t [s],d (V),v", *lines()[1:]])).tests[0]
    assert found.remarks == ('displacement: unit "V" of the file is unknown, and not compared with mm',)
    with pytest.raises(measured.MeasuredError, match='the file says "in", its unit is stated as "mm"'):
        measured.read(fixture_measured.write(tmp_path, csv=["t [s],d (in),v", *lines()[1:]]))


@pytest.mark.parametrize(
    ("unit", "size"), [("in", 0.0254), ("cm", 0.01), ("mil", 2.54e-5), ("ft", 0.3048), ("nm", 1e-9)]
)
def test_units_have_their_sizes(tmp_path, unit, size):
    t, d, v = vibration()
    path = fixture_measured.write(
        tmp_path, MEASURED.replace('unit = "mm" ', f'unit = "{unit}" '), csv=csv_lines(t, 1e-3 * d / size, v)
    )
    np.testing.assert_allclose(measured.read(path).tests[0].displacement, 1e-3 * d, rtol=1e-4)


def test_long_records_are_decimated_and_their_harmonics_stay():
    """Amplitudes and phases of harmonics below a fifth of the new rate stay; noise above it goes."""
    frequency, most = 16.0, 4000
    t = np.arange(50_000) / 50_000.0
    signal = 3.0 + sum(np.cos(2.0 * np.pi * k * frequency * t + k) / k for k in (1, 3, 12))
    tone = np.cos(2.0 * np.pi * 3333.0 * t)  # would fold to another frequency
    found, times, told = shortened({"d": signal + tone}, t, frequency, most)
    assert told == "low-passed and decimated from 50000 samples to one in 13"
    assert times.size <= most
    expected = 3.0 + sum(np.cos(2.0 * np.pi * k * frequency * times + k) / k for k in (1, 3, 12))
    np.testing.assert_allclose(found["d"], expected, atol=2e-5)
    cut, times, told = shortened({"d": signal}, t, 400.0, most)
    assert told == "cut to the first 4000 of 50000 samples"
    assert np.array_equal(cut["d"], signal[:most])


def test_more_rows_than_are_used(tmp_path):
    t = np.arange(310_000) / 50_000.0
    rows = np.column_stack([t, np.cos(2.0 * np.pi * 20.0 * t), -np.sin(2.0 * np.pi * 20.0 * t) * 125.66])
    np.save(tmp_path / "one.npy", rows)
    test = read_with(tmp_path, ("one.csv", "one.npy"), *NUMBERED)
    assert test.remarks[-1] == "low-passed and decimated from 310000 samples to one in 2"
    assert abs(test.displacement[5000:9000].std() * np.sqrt(2.0) - 1e-3) < 1e-6


def test_a_long_free_motion_keeps_a_hundred_samples_per_period(tmp_path):
    t = np.arange(22_000) / 50_000.0
    swing = 1e-3 * np.exp(-3.0 * t) * np.cos(2.0 * np.pi * 50.0 * t)
    rows = np.column_stack([t, 1e3 * swing, np.gradient(1e3 * swing, t)])
    np.save(tmp_path / "one.npy", rows)
    free = ("frequency_hz = 20.0\namplitude_mm = 0.3\namplitude_std = 0.01", 'kind = "transient"')
    test = read_with(tmp_path, ("one.csv", "one.npy"), *NUMBERED, free)
    assert test.remarks[-1] == "low-passed and decimated from 22000 samples to one in 10"
    kept = test.time - test.time[0]
    begun = np.interp(kept + t[200], t, swing)  # the filter takes 20 of the samples that remain at either end
    np.testing.assert_allclose(test.displacement, begun, atol=2e-8)


@pytest.mark.parametrize(
    ("first", "second", "apart"),
    [
        ("05/06/2024 11:59:59.500 AM", "05/06/2024 12:00:00.250 PM", 0.75),
        ("31.12.23 23:59:59,5", "1.1.24 0:00:01,25", 1.75),
        ("05/06/2024 23:59:59", "06/06/2024 00:00:01", 2.0),
        ("05/06/2024 23:59:59", "05/07/2024 00:00:01", 2.0),
        ("12:59:59 PM", "01:00:01 PM", 2.0),
        ("2024/5/6 9:59:59", "2024/5/6 10:00:01", 2.0),
    ],
)
def test_dates_are_read_as_they_are_written(first, second, apart):
    seconds, faults = seconds_of_dates([first, second])
    assert np.diff(seconds)[0] == pytest.approx(apart)
    assert not faults


def test_structs_of_a_new_matlab_tell_names_and_units(tmp_path):
    with pytest.importorskip("h5py").File(tmp_path / "one.mat", "w") as file:
        for path, values, kind in (
            ("run/speed/Data", np.arange(20.0), "double"),
            ("run/speed/Unit", np.array([ord(letter) for letter in "1/min"], "u2"), "char"),
        ):
            file[path] = values
            file[path].attrs["MATLAB_class"] = np.bytes_(kind)
    (column,) = survey(tmp_path / "one.mat").columns
    assert (column.group, column.label, column.channel.unit) == ("run", "speed", "1/min")


@pytest.mark.parametrize("turned", [False, True])
def test_references_of_a_new_matlab_lead_to_texts_and_to_runs(tmp_path, turned):
    """Cell arrays and arrays of structs: a matrix with the names of its columns or rows, and two runs."""
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "one.mat", "w") as file:

        def put(path, values, kind):
            file[path] = values
            file[path].attrs["MATLAB_class"] = np.bytes_(kind)
            return file[path].ref

        def refer(path, targets):
            file[path] = np.array([[each] for each in targets], h5py.ref_dtype)

        matrix = np.arange(60.0).reshape(3, 20)
        put("rec/data", matrix.T if turned else matrix, "double")
        put("rec/gain", 3.0, "double")
        put("rec/nothing", np.zeros(2, "u8"), "double")
        file["rec/nothing"].attrs["MATLAB_empty"] = 1
        for path, texts in ("rec/names", ("Time", "x", "Force")), ("rec/units", ("s", "mm", "kN")):
            letters = [np.array([[ord(letter)] for letter in text], "u2") for text in texts]
            refer(path, [put(f"#refs#/{path}{i}", each, "char") for i, each in enumerate(letters)])
            file[path].attrs["MATLAB_class"] = np.bytes_("cell")
        refer("run/d", [put(f"#refs#/{i}", i + np.arange(20.0)[None], "double") for i in range(2)])
        letters = [np.array([[ord(letter)] for letter in text], "u2") for text in ("mm", "cm")]
        refer("run/unit", [put(f"#refs#/unit{i}", each, "char") for i, each in enumerate(letters)])
    found = readers.read(tmp_path / "one.mat", ["rec/data[3]", "run(2).d"]).channels
    np.testing.assert_array_equal(found["rec/data[3]"].values, np.arange(40.0, 60.0))
    np.testing.assert_array_equal(found["run(2).d"].values.ravel(), 1.0 + np.arange(20.0))
    assert [each.unit for each in found.values()] == ["kN", "cm"]
    columns = [each.name for each in survey(tmp_path / "one.mat").columns]
    assert columns == [*(f"rec/data[{i}]" for i in (1, 2, 3)), "run(1).d", "run(2).d"]


def test_lists_in_lines_that_some_lines_lack(tmp_path):
    lines = ['{"event": "start"}', *(f'{{"t": {i}, "imu": {{"gyro": [{i}, 1, 2]}}}}' for i in range(9))]
    (tmp_path / "one.jsonl").write_text("\n".join(lines))
    values = readers.read(tmp_path / "one.jsonl", ["imu.gyro[1]"]).channels["imu.gyro[1]"].values
    np.testing.assert_array_equal(values, [np.nan, *range(9)])


@pytest.mark.parametrize(
    ("written", "unit"), [("m s-2", "m/s^2"), ("rad·s⁻¹", "rad/s"), ("seconds since 2024-05-06", "s")]
)
def test_units_of_netcdf(written, unit):
    assert usual(written) == unit
