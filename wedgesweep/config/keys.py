"""Kinds of config keys: how each checks its value and describes itself to editors.

``read`` returns the value for the resolved config, in the unit of the key. If the value is wrong, it appends
the TOML path, the fault and a valid alternative to ``problems``, and returns None, which also stands for
"absent" (TOML has no null).
"""

from abc import ABC, abstractmethod
from collections.abc import Collection
from dataclasses import KW_ONLY, dataclass
from math import inf, isfinite, nan
from typing import Any, Self

from wedgesweep import toml
from wedgesweep.hints import hint, show
from wedgesweep.quantity import Quantity
from wedgesweep.units import usual

# No rig has larger or smaller numbers (0 aside), whose products would overflow or vanish.
LARGEST, SMALLEST = 1e15, 1e-15


@dataclass(frozen=True)
class Key(ABC):
    """A key of the config.

    An absent key takes its ``default``; without a default it must be given, unless it is ``optional``. The
    template shows ``example`` for a key without default; the example of a table is its full path.
    """

    key: str
    meaning: str
    _: KW_ONLY
    default: Any = None
    optional: bool = False
    example: Any = None

    @abstractmethod
    def read(self, value: Any, path: str, problems: list[str]) -> Any:
        """Check a value given at the TOML path."""

    @abstractmethod
    def shape(self) -> dict[str, Any]:
        """JSON schema of the value alone."""

    @property
    def limits(self) -> str:
        """The range of the value, for the template."""
        return ""

    @property
    def required(self) -> bool:
        return self.default is None and not self.optional

    @property
    def written(self) -> str:
        """The key as a config would write it."""
        value = self.example if self.default is None else self.default
        return f"{self.key} = {'...' if value is None else toml.inline(value)}"

    def schema(self) -> dict[str, Any]:
        """JSON schema of the value, with the key's meaning and default."""
        about = {"description": self.meaning}
        if self.default is not None:
            about["default"] = self.default
        return about | self.shape()


@dataclass(frozen=True, kw_only=True)
class Text(Key):
    """A string."""

    def read(self, value: Any, path: str, problems: list[str]) -> str | None:
        if not isinstance(value, str):
            problems.append(f'{path}: {show(value)} is not a string; write it in "quotes"')
        elif "\0" in value:
            problems.append(f"{path}: {show(value)} holds a null character; leave it out")
        else:
            return value
        return None

    def shape(self) -> dict[str, Any]:
        return {"type": "string"}


@dataclass(frozen=True, kw_only=True)
class Flag(Key):
    """true or false."""

    def read(self, value: Any, path: str, problems: list[str]) -> bool | None:
        if isinstance(value, bool):
            return value
        problems.append(f"{path}: {show(value)} is neither true nor false; write one, unquoted")
        return None

    def shape(self) -> dict[str, Any]:
        return {"type": "boolean"}


@dataclass(frozen=True, kw_only=True)
class Choice(Key):
    """One name out of a list."""

    choices: Collection[str]

    def read(self, value: Any, path: str, problems: list[str]) -> str | None:
        if isinstance(value, str) and value in self.choices:
            return value
        problems.append(f"{path}: unknown name {show(value)}; {hint(str(value), self.choices)}")
        return None

    def shape(self) -> dict[str, Any]:
        return {"enum": list(self.choices)}

    @property
    def limits(self) -> str:
        return f"one of {', '.join(self.choices)}" if len(self.choices) > 1 else ""


@dataclass(frozen=True, kw_only=True)
class Unit(Choice):
    """A unit in any spelling; an unknown one is answered by all valid ones: similar names are other units."""

    def read(self, value: Any, path: str, problems: list[str]) -> str | None:
        if isinstance(value, str) and usual(value) in self.choices:
            return usual(value)
        problems.append(f"{path}: unknown unit {show(value)}; valid here: {', '.join(self.choices)}")
        return None

    def shape(self) -> dict[str, Any]:
        without_sign = [unit.replace("^", "") for unit in self.choices if "^" in unit]
        return {"enum": [*self.choices, *without_sign]}


@dataclass(frozen=True, kw_only=True)
class Number(Key):
    """A finite number within the range of its quantity."""

    quantity: Quantity

    @classmethod
    def of(cls, quantity: Quantity, **more: Any) -> Self:
        """Key of a quantity, but for what ``more`` says; a default that is not finite (a limit) is none."""
        default = quantity.default if isfinite(quantity.default) else None
        own = {"key": quantity.key, "meaning": quantity.meaning, "default": default}
        return cls(quantity=quantity, **(own | more))

    @classmethod
    def new(
        cls,
        key: str,
        meaning: str,
        default: float = nan,
        *,
        optional: bool = False,
        example: float | None = None,
        **limits: Any,
    ) -> Self:
        """Key of a quantity that nothing else needs, with its ``limits``."""
        return cls.of(Quantity(key, default, meaning, **limits), optional=optional, example=example)

    @property
    def limits(self) -> str:
        own = self.quantity
        ends = ((">=", own.minimum), (">", own.above), ("<=", own.maximum), ("<", own.below))
        return ", ".join(f"{sign} {end:g}" for sign, end in ends if isfinite(end))

    def read(self, value: Any, path: str, problems: list[str]) -> float | None:
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        if not is_number or not abs(value) < inf:
            problems.append(f"{path}: {show(value)} is not a finite number; write one, unquoted")
            return None
        if value and not SMALLEST <= abs(value) <= LARGEST:
            limits = f"between {SMALLEST:g} and {LARGEST:g} in size, or 0"
            problems.append(f"{path}: {show(value)} is out of range; it must be {limits}")
            return None
        if fault := self.quantity.fault(value):
            problems.append(f"{path}: {show(value)} is out of range; it {fault}")
            return None
        return float(value)

    def shape(self) -> dict[str, Any]:
        bounds = {
            "minimum": self.quantity.minimum,
            "exclusiveMinimum": self.quantity.above,
            "maximum": self.quantity.maximum,
            "exclusiveMaximum": self.quantity.below,
        }
        return {"type": "number"} | {name: end for name, end in bounds.items() if isfinite(end)}


@dataclass(frozen=True, kw_only=True)
class Whole(Number):
    """A whole number, a multiple of ``step``."""

    step: int = 1

    def read(self, value: Any, path: str, problems: list[str]) -> int | None:
        if isinstance(value, float):
            problems.append(f"{path}: {show(value)} is not a whole number; write one without a decimal point")
            return None
        if super().read(value, path, problems) is None:
            return None
        if value % self.step:
            problems.append(f"{path}: {value} is out of range; it must be a multiple of {self.step}")
            return None
        return value

    def shape(self) -> dict[str, Any]:
        return super().shape() | {"type": "integer", "multipleOf": self.step}
