"""Equations as MathML, which browsers set as mathematics."""

from html import escape

from wedgesweep.equations import notation
from wedgesweep.equations.notation import Call, Fraction, Group, Name, Node, Number, Operator, Power, Row

SIGNS = {"->": "→", "<=": "≤", ">=": "≥", "!=": "≠", "-": "−", "+-": "±", ".": "⋅"}
PRIMES = ("", "′", "″")
# Invisible, but read aloud: a product, and a function of what follows.
TIMES, APPLY = "<mo>&#x2062;</mo>", "<mo>&#x2061;</mo>"
APART = '<mspace width="0.2em"/>'
# What is higher than a line, so that brackets around it grow.
HIGH = (Fraction, Power)


def display(text: str) -> str:
    """A line as an equation of its own, with its condition beside it."""
    line = notation.line(text)
    content = _row(line.equation)
    if line.condition is not None:
        content += f'<mspace width="2em"/><mtext>for&nbsp;</mtext>{_row(line.condition)}'
    return _math(content, text, ' display="block"')


def inline(text: str) -> str:
    """A row of symbols inside a sentence."""
    return _math(_row(notation.row(text)), text, "")


def symbol(name: str) -> str:
    """One symbol."""
    return _math(_name(Name(name)), name, "")


def prose(text: str) -> str:
    """A sentence with equations between $ signs, as HTML."""
    parts = text.split("$")
    return "".join(inline(part) if i % 2 else escape(part) for i, part in enumerate(parts))


def _math(content: str, text: str, attributes: str) -> str:
    return f'<math{attributes} alttext="{escape(text)}">{content}</math>'.replace("&nbsp;", "\u00a0")


def _row(row: Row) -> str:
    found = []
    for before, node in zip((None, *row.nodes), row.nodes, strict=False):
        if before is not None and not isinstance(before, Operator) and not isinstance(node, Operator):
            found.append(TIMES + APART * (_is_word(before) or _is_word(node)))
        found.append(_node(node))
    return f"<mrow>{''.join(found)}</mrow>"


def _is_word(node: Node) -> bool:
    """Whether a node is written as a word, which a factor beside it must not run into."""
    return isinstance(node, Call) or (
        isinstance(node, Name) and len(notation.GREEK.get(node.stem, node.stem)) > 1
    )


def _node(node: Node) -> str:
    match node:
        case Number():
            return f"<mn>{node.text}</mn>"
        case Name():
            return _name(node)
        case Operator():
            return f"<mo>{escape(SIGNS.get(node.text, node.text))}</mo>"
        case Group():
            return _bracketed(node.bracket, node.content)
        case Call(function=notation.ROOT):
            return f"<msqrt>{_row(node.argument)}</msqrt>"
        case Call():
            return f"<mrow><mi>{node.function}</mi>{APPLY}{_bracketed('(', node.argument)}</mrow>"
        case Fraction():
            return f"<mfrac>{_node(node.above)}{_node(node.below)}</mfrac>"
        case Power():
            return f"<msup><mrow>{_node(node.base)}</mrow>{_node(node.exponent)}</msup>"
        case _:
            return _row(node)


def _bracketed(opening: str, content: Row) -> str:
    closing = notation.BRACKETS[opening]
    high = any(isinstance(node, HIGH) for node in content.nodes)
    fences = (f'<mo form="{form}" stretchy="{str(high).lower()}">' for form in ("prefix", "postfix"))
    before, after = (
        f"{fence}{bracket}</mo>" for fence, bracket in zip(fences, (opening, closing), strict=True)
    )
    return f"<mrow>{before}{_row(content)}{after}</mrow>"


def _name(name: Name) -> str:
    stem = f"<mi>{notation.GREEK.get(name.stem, name.stem)}</mi>"
    index = f"<mi>{name.index}</mi>"
    primes = f"<mo>{PRIMES[name.primes]}</mo>"
    if name.index and name.primes:
        return f"<msubsup>{stem}{index}{primes}</msubsup>"
    if name.index:
        return f"<msub>{stem}{index}</msub>"
    return f"<msup>{stem}{primes}</msup>" if name.primes else stem
