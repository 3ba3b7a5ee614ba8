"""Tables of keys for an oscillator that turns, made of those for a translation."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass, replace
from math import pi
from typing import Any

from wedgesweep import rotation
from wedgesweep.config.axes import ZIP, Varied
from wedgesweep.config.declarations import numbers, root
from wedgesweep.config.keys import Key, Number
from wedgesweep.config.series import Series
from wedgesweep.config.tables import Table

# Limits of a quantity, in the unit of its key.
LIMITS = ("default", "minimum", "above", "maximum", "below")
DEGREE = pi / 180.0
# Coefficients of friction of a rotation, by default: they are factors of the friction torque.
COEFFICIENTS = ("dynamic", "static")


def turned_root(transient: bool = False) -> tuple["Turned", Table]:
    """The whole config of an oscillator that turns; see ``declarations.root``."""
    turned = Turned()
    table: Table = turned.table(root(transient))
    for name in COEFFICIENTS:
        table = _with_default(table, ("friction", name), 1.0)
    return turned, table


@dataclass(frozen=True)
class Turned:
    """Tables with the keys of a rotation; ``names``: key of a translation, and its number over theirs."""

    names: dict[str, tuple[str, float]] = field(default_factory=dict)

    def table(self, key: Any) -> Any:
        """A table, or another key that holds keys, with its numbers in rad, N m and kg m^2.

        Beside each angle in rad stands the same one in deg.
        """
        if isinstance(key, Number | Series):
            return self._number(key, rotation.turned_key(key.key))
        if isinstance(key, tuple):
            return tuple(other for each in key for other in (self.table(each), *self._in_degrees(each)))
        if isinstance(key, Mapping):
            return {
                # Of a number the name is a dotted key.
                name.removesuffix(each.key) + other.key if isinstance(each, Number) else name: other
                for name, each in key.items()
                for other in (self.table(each), *self._in_degrees(each))
            }
        if not isinstance(key, Key) or not is_dataclass(key):
            return key
        changed = {each.name: getattr(key, each.name) for each in fields(key)}
        inner = {
            name: self.table(each)
            for name, each in changed.items()
            if isinstance(each, Key | tuple | Mapping)
        }
        return replace(key, **inner)

    def _in_degrees(self, key: Any) -> tuple[Key, ...]:
        own = key.item if isinstance(key, Series) else key
        if not isinstance(own, Number) or own.quantity.suffix != rotation.LENGTH:
            return ()
        degrees = self._number(key, (key.key.removesuffix(rotation.LENGTH) + "_deg", 1e-3 / DEGREE))
        return (replace(degrees, default=None, optional=True),)

    def _number(self, key: Any, name: tuple[str, float]) -> Any:
        called, factor = name
        if called == key.key:
            return key
        self.names[called] = key.key, 1.0 / factor
        own = key.item if isinstance(key, Series) else key
        limits = {limit: factor * getattr(own.quantity, limit) for limit in LIMITS}
        quantity = replace(own.quantity, key=called, **limits)
        item = replace(own, key=called, default=rotation.scaled(own.default, factor), quantity=quantity)
        if not isinstance(key, Series):
            return item
        return replace(key, key=called, default=rotation.scaled(key.default, factor), item=item)

    def back(self, document: Any) -> Any:
        """A document that was read by the tables, with the keys and numbers of a translation."""
        if isinstance(document, list):
            return [self.back(each) for each in document]
        if not isinstance(document, Mapping):
            return document
        found = {}
        for key, value in document.items():
            own, factor = self.path_back(key)
            found[own] = rotation.scaled(value, factor) if own != key else self.back(value)
        if ZIP in found:
            found[ZIP] = [[self.path_back(key)[0] for key in group] for group in found[ZIP]]
        return found

    def path_back(self, key: str) -> tuple[str, float]:
        """A key, dotted or not, in a translation, and its number over that of the rotation."""
        table, dot, name = key.rpartition(".")
        name, factor = self.names.get(name, (name, 1.0))
        return f"{table}{dot}{name}", factor


def turned_numbers() -> dict[str, Varied]:
    """The numbers of an oscillator that turns that a sweep may vary, by dotted key."""
    turned: dict[str, Varied] = Turned().table(numbers())
    return turned


def numbers_back(given: Mapping[str, Any]) -> dict[str, Any]:
    """Numbers by dotted key of an oscillator that turns, as those of a translation."""
    turned, _ = turned_root()
    back: dict[str, Any] = turned.back(given)
    return back


def _with_default(key: Any, path: tuple[str, ...], default: float) -> Any:
    """A table in which the number at a path of keys has another default."""
    if not path:
        return replace(key, default=default)
    groups = tuple(
        tuple(_with_default(each, path[1:], default) if each.key == path[0] else each for each in group)
        for group in key.groups
    )
    return replace(key, groups=groups)
