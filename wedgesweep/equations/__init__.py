"""Equations of effects, laws and systems: stated once, in plain text, and set as MathML.

A module states its own as ``EQUATIONS``, lines in the notation of ``notation.py``, the symbols that only it
uses as ``SYMBOLS``, and what else there is to say as ``REMARK``, with equations between $ signs.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from types import ModuleType

from wedgesweep.equations import notation, symbols
from wedgesweep.equations.symbols import Meaning
from wedgesweep.quantity import Quantity


@dataclass(frozen=True)
class Equations:
    """Equations of one module as a system has them, and the meaning of the symbols in them by name."""

    lines: Sequence[str]
    remark: str
    meanings: dict[str, Meaning]


def of(module: ModuleType, quantities: Sequence[Quantity] = (), system: str = "suspension") -> Equations:
    """Equations of a module; its quantities are symbols by their names.

    Raises
    ------
    KeyError
        A symbol is explained neither by the module nor for the system.
    """
    lines = [symbols.as_named(line, system) for line in getattr(module, "EQUATIONS", ())]
    remark = symbols.as_named(getattr(module, "REMARK", ""), system)
    known = {
        **symbols.SYSTEMS[system],
        **{each.name: Meaning(each.meaning, each.symbol) for each in quantities},
        **getattr(module, "SYMBOLS", {}),
    }
    written = [*lines, *remark.split("$")[1::2]]
    named = dict.fromkeys(name for line in written for name in notation.names(line))
    return Equations(lines, remark, {name: known[name] for name in named if name not in symbols.CONSTANTS})
