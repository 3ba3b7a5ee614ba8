"""Equations as LaTeX, which docs/physics.md holds: tests compare it with the equations of the code."""

from itertools import pairwise

from wedgesweep.equations import notation
from wedgesweep.equations.notation import Call, Fraction, Group, Name, Node, Number, Operator, Power, Row

SIGNS = {"->": r"\to", "<=": r"\le", ">=": r"\ge", "!=": r"\ne", "+-": r"\pm", ".": r"\cdot"}
FUNCTIONS = {name: rf"\{name}" for name in notation.FUNCTIONS} | {"sign": r"\operatorname{sign}"}
# Bars that do not end a cell of a table.
FENCES = {"(": ("(", ")"), "[": ("[", "]"), "|": (r"\lvert ", r"\rvert")}


def line(text: str) -> str:
    """A line, with its condition behind it."""
    read = notation.line(text)
    condition = "" if read.condition is None else rf" \quad\text{{for }} {_row(read.condition)}"
    return _row(read.equation) + condition


def _row(row: Row) -> str:
    found = "".join(map(_node, row.nodes[:1]))
    for before, node in pairwise(row.nodes):
        factors = not (isinstance(before, Operator) or isinstance(node, Operator))
        apart = factors and (_is_word(before) or _is_word(node))
        found += (r"\, " if apart else " ") + _node(node)
    return found


def _is_word(node: Node) -> bool:
    return isinstance(node, Name) and len(node.stem) > 1 and node.stem not in notation.GREEK


def _node(node: Node) -> str:
    match node:
        case Number():
            return node.text
        case Name():
            return _name(node)
        case Operator():
            return SIGNS.get(node.text, node.text)
        case Group():
            return _bracketed(node.bracket, node.content)
        case Call(function=notation.ROOT):
            return rf"\sqrt{{{_row(node.argument)}}}"
        case Call():
            return f"{FUNCTIONS[node.function]}{_bracketed('(', node.argument)}"
        case Fraction():
            return rf"\frac{{{_node(node.above)}}}{{{_node(node.below)}}}"
        case Power():
            base = _node(node.base)
            return f"{base if len(base) == 1 else f'{{{base}}}'}^{{{_node(node.exponent)}}}"
        case _:
            return _row(node)


def _bracketed(opening: str, content: Row) -> str:
    before, after = FENCES[opening]
    return f"{before}{_row(content)}{after}"


def _name(name: Name) -> str:
    stem = rf"\{name.stem}" if name.stem in notation.GREEK else _upright(name.stem)
    index = f"_{{{_upright(name.index)}}}" if name.index else ""
    return f"{stem}{index}{name.primes * chr(39)}"


def _upright(text: str) -> str:
    """A letter, or words that are none of its products."""
    return text if len(text) == 1 else rf"\mathrm{{{text.replace(' ', '~')}}}"
