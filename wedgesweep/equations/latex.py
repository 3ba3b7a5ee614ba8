"""Equations as LaTeX, which the documentation holds."""

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
    return " ".join(map(_node, row.nodes))


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
            return f"{{{_node(node.base)}}}^{{{_node(node.exponent)}}}"
        case _:
            return _row(node)


def _bracketed(opening: str, content: Row) -> str:
    before, after = FENCES[opening]
    return f"{before}{_row(content)}{after}"


def _name(name: Name) -> str:
    if name.stem in notation.GREEK:
        stem = rf"\{name.stem}"
    else:
        stem = name.stem if len(name.stem) == 1 else rf"\mathrm{{{name.stem.replace(' ', '~')}}}"
    index = f"_{{{name.index}}}" if name.index else ""
    return f"{stem}{index}{name.primes * chr(39)}"
