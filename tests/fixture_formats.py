"""Writers of specimens of every binary format: columns by name, three of them: time, length and velocity."""

import json

import netCDF4
import numpy as np
import pytest
from scipy.io import savemat


def hdf5(path, columns):
    h5py = pytest.importorskip("h5py")
    with h5py.File(path, "w") as file:
        for name, values in columns.items():
            file["bench/" + name if path.suffix == ".h5" else name] = values[None]
        if path.suffix == ".mat":  # a cell array of characters
            for name in columns:
                file[f"#refs#/{name}"] = np.array([[ord(letter)] for letter in name], "u2")
                file[f"#refs#/{name}"].attrs["MATLAB_class"] = np.bytes_("char")
            file["names"] = np.array([[file[f"#refs#/{name}"].ref] for name in columns], h5py.ref_dtype)
            file["names"].attrs["MATLAB_class"] = np.bytes_("cell")


def parquet(path, columns):
    arrow = pytest.importorskip("pyarrow")
    pytest.importorskip("pyarrow.parquet").write_table(arrow.table(columns), path)


def netcdf(path, columns):
    with netCDF4.Dataset(path, "w", format="NETCDF3_CLASSIC" if path.stem == "old" else "NETCDF4") as root:
        root.createDimension("sample", columns["t"].size)
        for (name, values), unit in zip(columns.items(), ("s", "mm", "mm s-1"), strict=True):
            variable = root.createVariable(name, "f8", ("sample",))
            variable.setncattr("units", unit.replace(" s-1", "/s"))
            variable[:] = values


def xlsx(path, columns):
    book = pytest.importorskip("openpyxl").Workbook()
    book.active.append(list(columns))
    book.active.append(["s", "mm", "mm/s"])
    for row in zip(*columns.values(), strict=True):
        book.active.append([float(value) for value in row])
    book.save(path)


def tdms(path, columns):
    nptdms = pytest.importorskip("nptdms")
    with nptdms.TdmsWriter(path) as writer:
        writer.write_segment([nptdms.ChannelObject("bench", name, each) for name, each in columns.items()])


def mdf(path, columns):
    asammdf = pytest.importorskip("asammdf")
    with asammdf.MDF(version="4.10") as file:
        file.append(
            [asammdf.Signal(values, columns["t"], name=name) for name, values in columns.items()],
            common_timebase=True,
        )
        file.save(path)


def uff(path, columns):
    pyuff = pytest.importorskip("pyuff")
    file = pyuff.UFF(str(path))
    t, *others = columns.values()
    for values in others:
        entry = pyuff.prepare_58(
            binary=0, func_type=1, ver_num=0, load_case_id=0, rsp_node=1, rsp_dir=1, ref_node=1, ref_dir=1,
            ord_data_type=4, num_pts=t.size, abscissa_spacing=1, abscissa_min=0.0, abscissa_inc=0.001,
            z_axis_value=0.0, data=values, x=t, id1="record", id2="b", id3="c", id4="d", id5="e",
            rsp_ent_name="r", ref_ent_name="s", abscissa_spec_data_type=17, ordinate_spec_data_type=8,
            orddenom_spec_data_type=0, z_axis_spec_data_type=0,
        )  # fmt: skip
        file.write_sets(entry, "add")


def npz(path, columns):
    np.savez(path, **columns)


def json_text(path, columns):
    lists = {name: [*map(float, values)] for name, values in columns.items()}
    rows = [dict(zip(columns, row, strict=True)) for row in zip(*lists.values(), strict=True)]
    lines = [json.dumps({"rig": "A"} | lists)] if path.suffix == ".json" else map(json.dumps, rows)
    path.write_text("\n".join(lines))


# Names of files and their writers.
SPECIMENS = (
    ("one.mat", savemat),
    ("new.mat", hdf5),
    ("one.h5", hdf5),
    ("one.parquet", parquet),
    ("one.npz", npz),
    ("one.nc", netcdf),
    ("old.nc", netcdf),
    ("one.xlsx", xlsx),
    ("one.tdms", tdms),
    ("one.mf4", mdf),
    ("one.json", json_text),
    ("one.jsonl", json_text),
)
