"""Configs of oscillators, and files of their tests."""

import json

import numpy as np

HEAD = '[measurement]\nmodel = "model.toml"\n[measurement.columns]\ntime = { column = "t", unit = "s" }\n'
PLACE = 'displacement = { column = "x", unit = "mm" }\n'
FORCE = 'force = { column = "F", unit = "N" }\n'
# A test, and what it is.
TEST = '[[measurement.test]]\nfile = "{}.csv"\n'
TRANSIENT, LOOP = 'kind = "transient"\n', 'kind = "loop"\n'
MOVED = "frequency_hz = 1.0\namplitude_mm = 1.0\n"
FORCED = 'excitation = "force"\nfrequency_hz = 10.0\namplitude_N = 40.0\n'


def oscillator(friction=0.3, sweep=MOVED, **keys) -> str:
    """The config of an oscillator with some keys, and with Coulomb friction."""
    own = "".join(f"{key} = {json.dumps(value)}\n" for key, value in keys.items())
    rubs = f"[friction]\nstatic = {friction}\ndynamic = {friction}\n"
    return f'[oscillator]\n{own}{rubs}[sweep]\nfriction_law = "coulomb"\n{sweep}'


def saved(folder, model, head, header, tests):
    """Write the files of a measurement, and return the path of measured.toml.

    ``header``: names of the columns; ``tests``: columns and keys of each test, by the name of its file.
    """
    for name, (columns, keys) in tests.items():
        path = folder / f"{name}.csv"
        np.savetxt(path, np.column_stack(columns), "%.12g", ",", header=header, comments="")
        head += TEST.format(name) + keys
    (folder / "model.toml").write_text(model)
    (folder / "measured.toml").write_text(head)
    return folder / "measured.toml"
