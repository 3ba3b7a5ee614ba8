"""The notation of equations, and the tree that it is read into.

    mu = (mu_s + peak) v/v_t  for |v| <= v_t

Words of several letters are names, Greek letters are written out, ``_`` begins an index and ``'`` is a rate.
What stands side by side is multiplied; ``/`` divides the one thing before it by the one after it, and ``^``
raises the one before it. A function takes what is in the brackets behind it. ``for`` begins a condition.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass

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


@dataclass(frozen=True)
class Number:
    """A number."""

    text: str


@dataclass(frozen=True)
class Name:
    """A symbol with its index and its rates; ``stem`` is a letter, a Greek one in English, or words."""

    text: str
    primes: int = 0

    @property
    def stem(self) -> str:
        return self._parts[0]

    @property
    def index(self) -> str:
        return self._parts[1]

    @property
    def _parts(self) -> tuple[str, str]:
        stem, _, index = self.text.partition("_")
        return (stem, index) if len(stem) == 1 or stem in GREEK else (self.text.replace("_", " "), "")


@dataclass(frozen=True)
class Operator:
    """A relation or an operator."""

    text: str


@dataclass(frozen=True)
class Group:
    """What stands in brackets of a kind."""

    bracket: str
    content: "Row"


@dataclass(frozen=True)
class Call:
    """A function of what is in the brackets behind it."""

    function: str
    argument: "Row"


@dataclass(frozen=True)
class Fraction:
    """A quotient."""

    above: "Node"
    below: "Node"


@dataclass(frozen=True)
class Power:
    """A power."""

    base: "Node"
    exponent: "Node"


@dataclass(frozen=True)
class Row:
    """Nodes side by side."""

    nodes: tuple["Node", ...]


Node = Number | Name | Operator | Group | Call | Fraction | Power | Row


@dataclass(frozen=True)
class Line:
    """An equation with the condition under which it holds."""

    equation: Row
    condition: Row | None


def line(text: str) -> Line:
    """Read a line.

    Raises
    ------
    ValueError
        The text is not in this notation; the message says where.
    """
    equation, _, condition = text.partition(FOR)
    return Line(row(equation), row(condition) if condition else None)


def row(text: str) -> Row:
    """Read what stands side by side."""
    reader = _Reader(text)
    found = reader.row("")
    if reader.sign:
        message = f"{text!r}: nothing opens the '{reader.sign}'"
        raise ValueError(message)
    return found


def names(text: str) -> Iterator[str]:
    """Names of the symbols of a line, each as often as it occurs."""
    for match in TOKEN.finditer(text.replace(FOR, " , ")):
        name = match["name"]
        if name and name not in (*FUNCTIONS, ROOT):
            yield name


class _Reader:
    """Goes through the tokens of a text, one ahead."""

    def __init__(self, text: str) -> None:
        self.text, self.place = text, 0
        self.advance()

    def advance(self) -> None:
        """Go on to the next token."""
        self.token = TOKEN.match(self.text, self.place) if self.text[self.place :].strip() else None
        if self.token is None and self.text[self.place :].strip():
            message = f"{self.text!r}: cannot read {self.text[self.place :].strip()!r}"
            raise ValueError(message)
        if self.token is not None:
            self.place = self.token.end()

    @property
    def sign(self) -> str:
        return (self.token["sign"] or "") if self.token else ""

    def row(self, closing: str) -> Row:
        """Everything up to a closing bracket, or the end."""
        found: list[Node] = []
        while self.token and (not self.sign or self.sign not in (closing, ")", "]")):
            if self.sign in OPERATORS:
                found.append(Operator(self.sign))
                self.advance()
            else:
                found.append(self.product())
        return Row(tuple(found))

    def product(self) -> Node:
        """One thing, or a quotient of two."""
        found = self.power()
        while self.sign == "/":
            self.advance()
            found = Fraction(bare(found), bare(self.power()))
        return found

    def power(self) -> Node:
        base = self.single()
        if self.sign != "^":
            return base
        self.advance()
        return Power(base, bare(self.single()))

    def single(self) -> Node:
        token = self.token
        if token is None or (self.sign and self.sign not in BRACKETS):
            message = f"{self.text!r}: something is missing before {self.sign or 'the end'!r}"
            raise ValueError(message)
        if self.sign:
            return self.group()
        self.advance()
        if token["number"]:
            return Number(token["number"])
        if token["name"] in (*FUNCTIONS, ROOT):
            return Call(token["name"], self.group().content)
        return Name(token["name"], len(token["primes"]))

    def group(self) -> Group:
        opening = self.sign
        closing = BRACKETS.get(opening)
        if closing is None:
            message = f"{self.text!r}: a bracket is missing"
            raise ValueError(message)
        self.advance()
        content = self.row(closing)
        if self.sign != closing:
            message = f"{self.text!r}: '{opening}' is not closed"
            raise ValueError(message)
        self.advance()
        return Group(opening, content)


def bare(node: Node) -> Node:
    """What is in round brackets, without them: a fraction or an index holds it together."""
    return node.content if isinstance(node, Group) and node.bracket == "(" else node
