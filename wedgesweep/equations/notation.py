"""The notation of equations, read into MathML, which browsers set as mathematics.

    mu = (mu_s + peak) v/v_t  for |v| <= v_t

Words of several letters are names, Greek letters are written out, ``_`` begins an index and ``'`` is a rate.
What stands side by side is multiplied; ``/`` divides the one thing before it by the one after it, and ``^``
raises the one before it. A function takes what is in the brackets behind it. ``for`` begins a condition.
"""

import re
from collections.abc import Iterator, Sequence
from html import escape
from itertools import pairwise
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

GREEK = {
    **{"alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "zeta": "ζ", "theta": "θ", "mu": "μ"},
    **{"pi": "π", "rho": "ρ", "sigma": "σ", "tau": "τ", "phi": "φ", "omega": "ω"},
}
FUNCTIONS = ("sign", "exp", "ln", "sin", "cos")
ROOT = "sqrt"
RELATIONS = ("->", "<=", ">=", "!=", "=", "<", ">")
OPERATORS = (*RELATIONS, "+-", "+", "-", ".", ",")
BRACKETS = {"(": ")", "[": "]", "|": "|"}
FOR = " for "
TOKEN = re.compile(
    r"\s*(?:(?P<number>\d+(?:\.\d+)?)|(?P<name>[A-Za-z]\w*)(?P<primes>'*)"
    r"|(?P<sign>->|<=|>=|!=|\+-|[-+=<>.,/^()\[\]|]))"
)
SIGNS = {"->": "→", "<=": "≤", ">=": "≥", "!=": "≠", "-": "−", "+-": "±", ".": "⋅"}
PRIMES = ("", "′", "″")
# Invisible, but read aloud: a product, and a function of what follows.
TIMES, APPLY = "\u2062", "\u2061"


def display(text: str) -> str:
    """A line as an equation of its own, with its condition beside it.

    Raises
    ------
    ValueError
        The text is not in this notation; the message says where.
    """
    equation, _, condition = text.partition(FOR)
    content = [_read(equation)]
    if condition:
        content += [_element("mspace", width="2em"), _element("mtext", "for\u00a0"), _read(condition)]
    return _math(text, *content, display="block")


def symbol(name: str) -> str:
    """One symbol."""
    return _math(name, _name(name))


def prose(text: str) -> str:
    """A sentence with equations between $ signs, as HTML."""
    parts = text.split("$")
    return "".join(_math(part, _read(part)) if i % 2 else escape(part) for i, part in enumerate(parts))


def names(text: str) -> Iterator[str]:
    """Names of the symbols of a line, each as often as it occurs."""
    for match in TOKEN.finditer(text.replace(FOR, " , ")):
        name = match["name"]
        if name and name not in (*FUNCTIONS, ROOT):
            yield name


def _math(text: str, *content: Element, **attributes: str) -> str:
    made = _element("math", *content, **attributes, alttext=text)
    return ElementTree.tostring(made, encoding="unicode")


def _element(tag: str, *content: Element | str, **attributes: str) -> Element:
    made = Element(tag, attributes)
    for part in content:
        if isinstance(part, str):
            made.text = part
        else:
            made.append(part)
    return made


def _read(text: str) -> Element:
    """Read what stands side by side."""
    reader = _Reader(text)
    found = reader.row("")
    if reader.sign:
        raise ValueError(f"{text!r}: nothing opens the '{reader.sign}'")
    return found


def _row(nodes: Sequence[Element]) -> Element:
    """Nodes side by side, with the signs of products between factors."""
    made = _element("mrow", *nodes[:1])
    for before, node in pairwise(nodes):
        if "mo" not in (before.tag, node.tag):
            made.append(_element("mo", TIMES))
            if _is_word(before) or _is_word(node):
                made.append(_element("mspace", width="0.2em"))
        made.append(node)
    return made


def _is_word(node: Element) -> bool:
    """Whether a node is written as a word, which a factor beside it must not run into."""
    if node.tag in ("msqrt", "mfrac"):
        return node.tag == "msqrt"
    first = next(iter(node), node)
    return first.tag == "mi" and len(str(first.text)) > 1


def _bracketed(opening: str, content: Element) -> Element:
    """A row in brackets, which grow with fractions and powers in it."""
    high = any(node.tag == "mfrac" or _is_power(node) for node in content)
    before, after = (
        _element("mo", bracket, form=form, stretchy=str(high).lower())
        for form, bracket in (("prefix", opening), ("postfix", BRACKETS[opening]))
    )
    return _element("mrow", before, content, after)


def _is_power(node: Element) -> bool:
    return node.tag == "msup" and node[0].tag == "mrow"


def _bare(node: Element) -> Element:
    """What is in round brackets, without them: a fraction or an index holds it together."""
    bracketed = node.tag == "mrow" and node[0].get("form") == "prefix" and node[0].text == "("
    return node[1] if bracketed else node


def _name(text: str, primes: int = 0) -> Element:
    """A symbol with its index and its rates: a letter, a Greek one in English, or words without index."""
    stem, _, index = text.partition("_")
    if len(stem) > 1 and stem not in GREEK:
        stem, index = text.replace("_", " "), ""
    letter, rates = _element("mi", GREEK.get(stem, stem)), _element("mo", PRIMES[primes])
    if index and primes:
        return _element("msubsup", letter, _element("mi", index), rates)
    if index:
        return _element("msub", letter, _element("mi", index))
    return _element("msup", letter, rates) if primes else letter


class _Reader:
    """Goes through the tokens of a text, one ahead."""

    def __init__(self, text: str) -> None:
        self.text, self.place = text, 0
        self.advance()

    def advance(self) -> None:
        """Go on to the next token."""
        self.token = TOKEN.match(self.text, self.place) if self.text[self.place :].strip() else None
        if self.token is None and self.text[self.place :].strip():
            raise ValueError(f"{self.text!r}: cannot read {self.text[self.place :].strip()!r}")
        if self.token is not None:
            self.place = self.token.end()

    @property
    def sign(self) -> str:
        return (self.token["sign"] or "") if self.token else ""

    def row(self, closing: str) -> Element:
        """Everything up to a closing bracket, or the end."""
        found: list[Element] = []
        while self.token and (not self.sign or self.sign not in (closing, ")", "]")):
            if self.sign in OPERATORS:
                found.append(_element("mo", SIGNS.get(self.sign, self.sign)))
                self.advance()
            else:
                found.append(self.product())
        return _row(found)

    def product(self) -> Element:
        """One thing, or a quotient of two."""
        found = self.power()
        while self.sign == "/":
            self.advance()
            found = _element("mfrac", _bare(found), _bare(self.power()))
        return found

    def power(self) -> Element:
        base = self.single()
        if self.sign != "^":
            return base
        self.advance()
        return _element("msup", _element("mrow", base), _bare(self.single()))

    def single(self) -> Element:
        token = self.token
        if token is None or (self.sign and self.sign not in BRACKETS):
            raise ValueError(f"{self.text!r}: something is missing before {self.sign or 'the end'!r}")
        if self.sign:
            return self.group()
        self.advance()
        if token["number"]:
            return _element("mn", token["number"])
        if token["name"] == ROOT:
            return _element("msqrt", self.group()[1])
        if token["name"] in FUNCTIONS:
            return _element("mrow", _element("mi", token["name"]), _element("mo", APPLY), self.group())
        return _name(token["name"], len(token["primes"]))

    def group(self) -> Element:
        opening = self.sign
        closing = BRACKETS.get(opening)
        if closing is None:
            raise ValueError(f"{self.text!r}: a bracket is missing")
        self.advance()
        content = self.row(closing)
        if self.sign != closing:
            raise ValueError(f"{self.text!r}: '{opening}' is not closed")
        self.advance()
        return _bracketed(opening, content)
