"""Equations as LaTeX, which docs/physics.md holds: tests compare it with the equations of the code."""

from itertools import pairwise
from xml.etree import ElementTree

from wedgesweep.equations import notation

SIGNS = {"→": r"\to", "≤": r"\le", "≥": r"\ge", "≠": r"\ne", "−": "-", "±": r"\pm", "⋅": r"\cdot"}
FUNCTIONS = {name: rf"\{name}" for name in notation.FUNCTIONS} | {"sign": r"\operatorname{sign}"}
# Bars that do not end a cell of a table.
FENCES = {"(": ("(", ")"), "[": ("[", "]"), "|": (r"\lvert ", r"\rvert")}
GREEK = {letter: rf"\{name}" for name, letter in notation.GREEK.items()}


def line(text):
    """A line, with its condition behind it."""
    equation, *condition = (
        each for each in ElementTree.fromstring(notation.display(text)) if each.tag == "mrow"
    )
    return _node(equation) + "".join(rf" \quad\text{{for }} {_node(each)}" for each in condition)


def _row(nodes):
    nodes = [each for each in nodes if each.tag != "mspace" and each.text != notation.TIMES]
    found = "".join(map(_node, nodes[:1]))
    for before, node in pairwise(nodes):
        factors = "mo" not in (before.tag, node.tag)
        found += (r"\, " if factors and (_is_word(before) or _is_word(node)) else " ") + _node(node)
    return found


def _is_word(node):
    first = node if node.tag == "mi" else node[0] if node.tag.startswith(("msub", "msup")) else node
    return first.tag == "mi" and len(first.text) > 1


def _node(node):
    match node.tag:
        case "mo":
            return SIGNS.get(node.text, node.text)
        case "mi":
            return GREEK.get(node.text) or _upright(node.text)
        case "mn":
            return node.text
        case "msqrt":
            return rf"\sqrt{{{_node(node[0])}}}"
        case "mfrac":
            return rf"\frac{{{_node(node[0])}}}{{{_node(node[1])}}}"
        case "msup" if node[0].tag == "mrow":
            base = _node(node[0])
            return f"{base if len(base) == 1 else f'{{{base}}}'}^{{{_node(node[1])}}}"
        case "mrow":
            return _of_row(list(node))
    stem, *rest = map(_node, node)
    index = f"_{{{rest[0]}}}" if "sub" in node.tag else ""
    return (
        f"{stem}{index}{node.tag.endswith('sup') * rest[-1].replace('″', 2 * chr(39)).replace('′', chr(39))}"
    )


def _of_row(nodes):
    if nodes[0].get("form"):
        before, after = FENCES[nodes[0].text]
        return f"{before}{_node(nodes[1])}{after}"
    if len(nodes) > 1 and nodes[1].text == notation.APPLY:
        return FUNCTIONS[nodes[0].text] + _node(nodes[2])
    return _row(nodes)


def _upright(text):
    """A letter, or words that are none of its products."""
    return text if len(text) == 1 else rf"\mathrm{{{text.replace(' ', '~')}}}"
