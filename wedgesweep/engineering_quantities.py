"""The engineer's quantities of a suspension, from the dataset of a sweep: loads, friction, losses, unloading.

They follow from the model and from what a sweep stores, so that no solver computes them. Equations:
docs/physics.md.
"""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
import xarray as xr

from wedgesweep import config as configs
from wedgesweep.config import Case, Config
from wedgesweep.effects import EFFECTS
from wedgesweep.effects.base import SUSPENSION
from wedgesweep.systems.suspension.parameters import driven_mass, rise_by_wear, spring_at_rest

# Units and long name of each quantity, by name. The first ones follow from the model,
OF_MODEL = {
    "static_load": ("N", "weight on the springs: bolster and both wedges"),
    "wedge_rise": ("m", "rise of the wedges by wear"),
    "wedge_load_share": ("1", "force of both wedge springs at frictionless rest over static_load"),
    "friction_force_up": ("N", "friction against a bolster that rises slowly at the rest position"),
    "friction_force_down": ("N", "friction against a bolster that sinks slowly at the rest position"),
    "snubbing_ratio": ("1", "mean of friction_force_up and friction_force_down over static_load"),
}
# these from the energy that a period takes,
OF_CYCLE = {
    "relative_friction": ("1", "energy lost per forcing period over 4 x half peak-to-peak x static_load"),
    "equivalent_damping_ratio": ("1", "energy lost per forcing period over 4 pi x largest spring energy"),
}
# and this one from waveforms.
OF_WHEEL = {"minimum_load_ratio": ("1", "smallest force under the side frame over its mean")}
WAVEFORMS = "waveforms (keep_waveforms = true) of a sine, held joints, and no effects on input or sensors"
QUANTITIES = OF_MODEL | OF_CYCLE | OF_WHEEL
# Families of effects with which the acceleration under the side frame does not follow from what is stored.
MOVED_OTHERWISE = ("excitation", "sensor", "two-dimensional")

# A travel below this share of the input amplitude is no cycle, but the end of a transient: 1,000 times what
# periods of a steady response may differ by.
LEAST_TRAVEL = 1e-4


def engineering(ds: xr.Dataset) -> xr.Dataset:
    """The dataset of a sweep with those of QUANTITIES that it has data for; see ``api.engineering``."""
    config = configs.parse(ds.attrs["config"])
    if config.system != SUSPENSION:
        raise ValueError("load, snubbing and unloading are those of a suspension; this is an oscillator")
    models = _Models.of(ds, config)
    found = _of_model(models)
    if "scale" not in ds.coords:
        found |= _of_cycle(ds, models, found["static_load"])
    if "phase" in ds.dims and "velocity" in ds and not _moved_otherwise(ds, config):
        found["minimum_load_ratio"] = _minimum_load_ratio(ds, models)
    dims = ds["status"].dims
    for name, values in found.items():
        units, about = QUANTITIES[name]
        found[name] = values.broadcast_like(ds["status"]).transpose(*dims).drop_vars(values.coords)
        found[name].attrs = {"units": units, "long_name": about}
    return ds.assign(found)


def with_quantities(ds: xr.Dataset, names: Iterable[str]) -> xr.Dataset:
    """The dataset with those of its engineer's quantities that some names ask for; others stay unknown.

    Raises ValueError for one that these data do not give.
    """
    asked = [name for name in names if name in QUANTITIES and name not in ds]
    found = engineering(ds) if asked else ds
    for name in asked:
        if name not in found:
            needs = "an input that repeats" if name in OF_CYCLE else WAVEFORMS
            raise ValueError(f"{name}: needs {needs}")
    return found


class _Models(NamedTuple):
    """Parameter records of the models of a dataset, shape (n,), over ``dims`` of ``shape``."""

    records: np.ndarray
    dims: tuple[str, ...]
    shape: tuple[int, ...]

    @classmethod
    def of(cls, ds: xr.Dataset, config: Config) -> "_Models":
        keys = {str(name): ds[name].attrs["key"] for name in ds.coords if "key" in ds[name].attrs}
        law, *numbers = xr.broadcast(ds["friction_law"], *(ds[name] for name in keys))
        rows = zip(law.values.ravel(), *(each.values.ravel() for each in numbers), strict=True)
        cases = [
            Case(str(one), 1.0, 1.0, tuple(zip(keys.values(), rest, strict=True))) for one, *rest in rows
        ]
        records = np.concatenate([config.record(case) for case in cases])
        return cls(records, tuple(map(str, law.dims)), law.shape)

    def array(self, values: np.ndarray) -> xr.DataArray:
        """Numbers of the models, shape (n,), with dimensions."""
        return xr.DataArray(np.reshape(values, self.shape), dims=self.dims)


def _of_model(models: _Models) -> dict[str, xr.DataArray]:
    s = models.records["suspension"]
    load = (s["bolster_mass"] + 2.0 * s["wedge_mass"]) * s["gravity"]
    spring = spring_at_rest(models.records)
    guide = models.records["guide_friction"]["force"]
    rising, sinking = (_wedge_force(models.records, spring, sense) for sense in (1.0, -1.0))
    free = _wedge_force(models.records, spring, 0.0)
    up, down = free - rising + guide, sinking - free + guide
    found = {
        "static_load": load,
        "wedge_rise": rise_by_wear(s),
        "wedge_load_share": 2.0 * spring / load,
        "friction_force_up": up,
        "friction_force_down": down,
        "snubbing_ratio": 0.5 * (up + down) / load,
    }
    return {name: models.array(values) for name, values in found.items()}


def _wedge_force(records: np.ndarray, spring: np.ndarray, sense: float) -> np.ndarray:
    """Vertical force (N) of both wedges on a bolster that moves slowly, shape (n,).

    ``spring``: force (N) of each wedge's spring; ``sense``: 1 up, -1 down, 0 without friction. NaN where a
    face would have to pull, or where the wedges lock.
    """
    s, g, mu = records["suspension"], records["geometry"], records["friction"]["mu_d"]
    column, bolster = sense * mu, sense * mu * np.sign(g["bolster_ratio"])
    weight = spring - s["wedge_mass"] * s["gravity"]
    along = g["cos_included"] - bolster * g["sin_included"]
    determinant = g["sin_included"] + bolster * g["cos_included"] + column * along
    on_bolster = weight * (g["cos_column"] - column * g["sin_column"]) / determinant
    on_column = weight * g["sin_column"] + on_bolster * along
    force = 2.0 * on_bolster * (g["sin_wedge"] + bolster * g["cos_wedge"])
    return np.where((determinant > 0.0) & (on_bolster >= 0.0) & (on_column >= 0.0), force, np.nan)


def _of_cycle(ds: xr.Dataset, models: _Models, load: xr.DataArray) -> dict[str, xr.DataArray]:
    s, g = models.records["suspension"], models.records["geometry"]
    longer = g["column_ratio"] * g["cos_column"] - g["spring_on_bolster"]  # a wedge's spring, per z
    wedges = 2.0 * s["wedge_spring"] * longer**2
    stiffness = models.array(s["bolster_spring"] + wedges)
    lost = ds["dissipated_energy"] + ds.get("impact_energy", 0.0)
    travel = 0.5 * ds["peak_to_peak"]
    travel = travel.where(travel > LEAST_TRAVEL * ds["amplitude"])
    return {
        "relative_friction": lost / (4.0 * travel * load),
        "equivalent_damping_ratio": lost / (2.0 * np.pi * stiffness * travel**2),
    }


def _moved_otherwise(ds: xr.Dataset, config: Config) -> bool:
    """Whether effects, or joints that open, give the masses other accelerations than the stored ones."""
    varied = [ds[name].attrs.get("key", "").split(".") for name in ds.coords]
    names = {*config.effects, *(parts[1] for parts in varied if parts[0] == "effects")}
    return config.opens or any(EFFECTS[name].family in MOVED_OTHERWISE for name in names)


def _minimum_load_ratio(ds: xr.Dataset, models: _Models) -> xr.DataArray:
    """Smallest force under the side frame over the weight: inertia forces of all masses, from samples."""
    s = models.records["suspension"]
    mass = s["bolster_mass"] + 2.0 * s["wedge_mass"] + s["side_frame_mass"]
    omega = 2.0 * np.pi * ds["frequency"]
    base = -ds["amplitude"] * omega**2 * np.sin(ds["phase"])
    # z'' of the bolster against the side frame; the stored velocity is x' - y' = -z'.
    relative = -omega * ds["velocity"].astype(float).differentiate("phase")
    share = models.array(driven_mass(models.records) / mass)
    # Differences at both ends are those of one side; the kept periods hold the same phases once more.
    inner = (base + share * relative).isel(phase=slice(1, -1))
    return 1.0 + inner.min("phase", skipna=False) / models.array(s["gravity"])
