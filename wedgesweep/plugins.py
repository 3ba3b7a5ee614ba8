"""Effects in files outside of the package: ``--plugin my_effect.py``.

A file is checked when it is loaded, its compiled functions included, so that an error is told with its file
and line, not in the middle of a run. Processes that solve cases load the same files.
"""

import ast
import re
import sys
import traceback
from collections.abc import Callable, Iterator
from importlib.util import module_from_spec, spec_from_file_location
from inspect import signature
from math import isnan
from pathlib import Path
from types import ModuleType
from typing import Any

from wedgesweep import effects, equations
from wedgesweep.compiled import function_of
from wedgesweep.effects import hooks, states
from wedgesweep.effects.base import EXPERIMENTAL, NUMERICAL, OSCILLATOR, SYSTEMS, Effect
from wedgesweep.equations import notation
from wedgesweep.equations.symbols import Meaning
from wedgesweep.errors import InputError
from wedgesweep.hints import hint
from wedgesweep.kernels import KNOWN

# What a file must declare.
EFFECT = "EFFECT"
# Hooks that add to a sum, which is 0 without the effect; the others change their first argument.
SUMS = ("force_on_mass", "damping", "power")
RATES = "rates"
HOOKS: dict[str, Callable] = {
    name: each
    for name, each in vars(hooks).items()
    if callable(each) and each.__module__ == hooks.__name__ and not name.startswith("_")
}
# Values (SI) of the arguments of hooks in a trial call; others are 0.5.
TRIED = {"z": 1e-3, "velocity": 0.1, "column_slip": 0.1, "speed": 0.1, "clock": 1}

_loaded: dict[Path, ModuleType] = {}


def loaded() -> tuple[Path, ...]:
    """The files that this process has loaded."""
    return tuple(_loaded)


def load_all(files: tuple[Path, ...]) -> None:
    """Load the files that another process has loaded."""
    for file in files:
        load(file)


def load(path: Path) -> None:
    """Register the effect of a file; a file that is loaded already stays as it is.

    Raises
    ------
    InputError
        The file cannot be read or run, or what it declares is no effect; with file and line.
    """
    file = path.resolve()
    if file in _loaded:
        return
    module = _module(file, str(path))
    source = _Source(str(path), ast.parse(file.read_text(encoding="utf-8")))
    problems = list(_problems(module, source))
    if not problems:
        name = module.EFFECT.name
        effects.REGISTERED[name], effects.EFFECTS[name] = module, module.EFFECT
        problems = [*_equation_problems(module, source), *_trial_problems(module, source)]
        if problems:
            del effects.REGISTERED[name], effects.EFFECTS[name]
    if problems:
        del sys.modules[module.__name__]
        raise InputError(problems)
    effects.register(module)
    _loaded[file] = module


def described(error: BaseException) -> str | None:
    """An error that a function of a loaded file has raised, with file and line; None for any other error."""
    for frame in reversed(traceback.extract_tb(error.__traceback__)):
        if Path(frame.filename) in _loaded:
            return f"{frame.filename}:{frame.lineno}: {type(error).__name__}: {error}"
    return None


class _Source:
    """Where a file declares what."""

    def __init__(self, name: str, tree: ast.Module) -> None:
        self._name, self._lines = name, dict(_declared(tree))

    def at(self, declared: str, problem: str) -> str:
        """A problem with something that the file declares."""
        line = self._lines.get(declared)
        return f"{self._name}{f':{line}' if line else ''}: {declared}: {problem}"

    def in_line(self, line: int, problem: str) -> str:
        return f"{self._name}:{line}: {problem}"


def _declared(tree: ast.Module) -> Iterator[tuple[str, int]]:
    for node in tree.body:
        if isinstance(node, ast.FunctionDef):
            yield node.name, node.lineno
        for target in getattr(node, "targets", ()):
            if isinstance(target, ast.Name):
                yield target.id, node.lineno


def _module(file: Path, shown: str) -> ModuleType:
    """Run a file as a module of its own name."""
    name = file.stem
    if not name.isidentifier() or name in sys.modules or name in KNOWN:
        raise InputError([f"{shown}: {name} is no free name of a Python module; rename the file"])
    spec = spec_from_file_location(name, file)
    if spec is None or spec.loader is None:
        raise InputError([f"{shown}: not a Python file; its name must end with .py"])
    module = sys.modules[name] = module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        del sys.modules[name]
        raise InputError([f"{shown}{_where(error, file)}: {type(error).__name__}: {error}"]) from error
    return module


def _where(error: Exception, file: Path) -> str:
    if isinstance(error, SyntaxError):
        return f":{error.lineno}" if error.filename == str(file) else ""
    lines = [each.lineno for each in traceback.extract_tb(error.__traceback__) if each.filename == str(file)]
    return f":{lines[-1]}" if lines else ""


def _problems(module: ModuleType, source: _Source) -> Iterator[str]:
    """What is wrong with the declarations of a module."""
    effect = getattr(module, EFFECT, None)
    if not isinstance(effect, Effect):
        yield source.at(EFFECT, "missing or no Effect of wedgesweep.effects.base; see docs/extending.md")
        return
    if not effect.name.isidentifier() or effect.name in effects.EFFECTS:
        yield source.at(EFFECT, f"name: {effect.name!r} is taken or no identifier; choose another name")
    yield from _choices(effect, source)
    for kind in getattr(module, "STATES", ()):
        if kind not in states.SIZES:
            yield source.at("STATES", f"unknown kind {kind!r}; {hint(str(kind), states.SIZES)}")
    for name, hook in HOOKS.items():
        own = getattr(module, name, None)
        if own is None:
            continue
        expected, given = _arguments(hook), _arguments(getattr(own, "py_func", own))
        if given != expected:
            problem = f"arguments ({', '.join(given)}); the hook has ({', '.join(expected)})"
            yield source.at(name, problem)
    if getattr(module, "STATES", ()) and not hasattr(module, "acts"):
        yield source.at("STATES", "an effect with states needs acts(p), whether they move")
    if getattr(module, "LINEAR", False) and (getattr(module, "STATES", ()) or hasattr(module, "sliding")):
        yield source.at(
            "LINEAR", "an effect with states or a sliding friction of its own is not; leave LINEAR out"
        )


def _choices(effect: Effect, source: _Source) -> Iterator[str]:
    """Names in an effect that are none of those it may have."""
    numbers = [each.name for each in effect.quantities]
    choices = (
        ("family", [effect.family], effects.FAMILIES),
        ("branch", [effect.branch], (NUMERICAL, EXPERIMENTAL)),
        ("systems", effect.systems, SYSTEMS),
        ("extends", effect.extends, numbers),
    )
    if not numbers:
        yield source.at(EFFECT, "quantities: none; an effect has at least one number")
    for key, given, possible in choices:
        for each in given:
            if each not in possible:
                yield source.at(EFFECT, f"{key}: unknown name {each!r}; {hint(str(each), possible)}")
    try:
        effect.described()
    except (KeyError, IndexError, ValueError) as error:
        yield source.at(EFFECT, f"meaning: no such part {error}; see PARTS in wedgesweep/effects/base.py")


def _arguments(function: Callable) -> list[str]:
    return list(signature(function).parameters)


def _equation_problems(module: ModuleType, source: _Source) -> Iterator[str]:
    """Equations that cannot be read, or with a symbol that nothing explains."""
    for line in getattr(module, "EQUATIONS", ()):
        try:
            notation.display(line)
        except ValueError as error:
            yield source.at("EQUATIONS", f"{line!r}: {error}")
            return
    symbols = getattr(module, "SYMBOLS", {})
    for name in symbols:
        if not isinstance(symbols[name], Meaning):
            yield source.at("SYMBOLS", f"{name!s}: must be a Meaning(text, unit), not {symbols[name]!r}")
            return
    for system in module.EFFECT.systems:
        try:
            equations.of(module, module.EFFECT.quantities, system)
        except KeyError as error:
            yield source.at("EQUATIONS", f"symbol {error} is not explained; add it to SYMBOLS")
            return


def _trial_problems(module: ModuleType, source: _Source) -> Iterator[str]:
    """Hooks that do not compile, or do not leave a system alone at the neutral value."""
    for system in module.EFFECT.systems:
        row, mode = _neutral(system)
        arguments = {"y": (0.0,) * len(states.kinds(dict.fromkeys(row.dtype.names))), "p": row, "mode": mode}
        for name in HOOKS:
            if hasattr(module, name) and (problem := _tried(module, name, arguments, source)):
                yield problem
                return


def _neutral(system: str) -> tuple[Any, Any]:
    """A record of a system without effects, and a mode of it."""
    from wedgesweep.systems import records
    from wedgesweep.systems.oscillator import parameters as oscillator
    from wedgesweep.systems.oscillator.modes import Mode
    from wedgesweep.systems.suspension import parameters as suspension
    from wedgesweep.systems.suspension.modes import ContactMode

    own, kind = (oscillator, Mode) if system == OSCILLATOR else (suspension, ContactMode)
    row = records.blank(own.record_type(), own.effect_names())[0]
    row["input"]["omega"], row["friction"]["v_t"] = 1.0, 1e-3
    return row, kind(*[0] * len(kind._fields))


def _tried(module: ModuleType, name: str, known: dict[str, Any], source: _Source) -> str | None:
    """Why a hook fails on a record in which the effect is off, or None."""
    import numba

    arguments = _arguments(HOOKS[name])
    values = [known[each] if each in known else TRIED.get(each, 0.5) for each in arguments]
    call = function_of(arguments, f"own({', '.join(arguments)})", own=getattr(module, name))
    try:
        found = numba.njit(error_model="numpy")(call)(*values)
    except Exception as error:  # whatever numba raises
        line, reason = _told_by_compiler(str(error), Path(str(module.__file__)).name)
        return source.in_line(line, f"{name}: {reason}") if line else source.at(name, reason)
    if name == RATES:
        count = len(getattr(module, "STATES", ()))
        if not isinstance(found, tuple) or len(found) != count:
            return source.at(name, f"must return a tuple of {count}, a rate for each of STATES")
        return None
    neutral = 0.0 if name in SUMS else values[0]
    if not isinstance(found, (int, float)):
        return source.at(name, f"must return one number, not {found!r}")
    if any(map(isnan, module.EFFECT.off.values())) or found == neutral:
        return None
    return source.at(name, f"is {found:g} at the neutral value of the effect, must be {neutral:g}")


def _told_by_compiler(text: str, file: str) -> tuple[int, str]:
    """The line of a file that a compiler's error is about, 0 if it names none, and what it says."""
    lines = re.findall(rf'File "[^"]*{re.escape(file)}", line (\d+)|{re.escape(file)} \((\d+)\)', text)
    told = (re.sub(r"\x1b\[\d+m", "", each).strip() for each in text.splitlines())
    skipped = ("Failed in", "During:", "File ", "- ", "There are", "<source")
    reasons = [each for each in told if each and not each.startswith(skipped)]
    return int(next(filter(None, lines[-1]))) if lines else 0, _complete(reasons[0]) if reasons else text


def _complete(reason: str) -> str:
    """A missing field of a record is told by its name alone."""
    return f"p has no part or number {reason}" if reason.startswith("'") else reason
