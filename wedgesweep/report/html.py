"""HTML elements. Text is passed in as text and escaped here."""

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import NamedTuple


class Markup(str):
    """Text that is HTML already."""

    __slots__ = ()


class Spanning(NamedTuple):
    """A cell of text that fills what is left of its row."""

    content: object


def text(value: object) -> Markup:
    """Escape what is not markup."""
    return value if isinstance(value, Markup) else Markup(escape(str(value)))


def join(parts: Iterable[object], between: str = "\n") -> Markup:
    """Join parts into markup."""
    return Markup(between.join(text(part) for part in parts))


def element(name: str, *content: object, **attributes: object) -> Markup:
    """An element; an attribute ``class_`` becomes class, one that is None is left out."""
    return Markup(f"<{name}{_attributes(attributes)}>{join(content, '')}</{name}>")


def image(**attributes: object) -> Markup:
    """A picture."""
    return Markup(f"<img{_attributes(attributes)}>")


def _attributes(given: Mapping[str, object]) -> str:
    return "".join(
        f' {key.rstrip("_").replace("_", "-")}="{escape(str(value))}"'
        for key, value in given.items()
        if value is not None
    )


def paragraph(*content: object, **attributes: object) -> Markup:
    """A paragraph of text."""
    return element("p", *content, **attributes)


def items(rows: Iterable[object]) -> Markup:
    """Unordered list."""
    return element("ul", *(element("li", row) for row in rows))


def table(
    caption: str, head: Sequence[str], rows: Iterable[Sequence[object]], text_columns: int = 1
) -> Markup:
    """Table whose first column heads its rows; the first ``text_columns`` are text, the others numbers."""
    headers = (element("th", name, scope="col", class_=_kind(i, text_columns)) for i, name in enumerate(head))
    body = (
        element("tr", *(_cell(i, cell, text_columns, len(head)) for i, cell in enumerate(row)))
        for row in rows
    )
    whole = element(
        "table",
        element("caption", caption),
        element("thead", element("tr", *headers)),
        element("tbody", join(body)),
    )
    # Wide tables scroll within themselves, by keyboard, too.
    return element("div", whole, class_="scroll", tabindex=0, role="region", aria_label=caption)


def _kind(column: int, text_columns: int) -> str | None:
    return None if column < text_columns else "number"


def _cell(column: int, cell: object, text_columns: int, columns: int) -> Markup:
    if column == 0:
        return element("th", cell, scope="row")
    if isinstance(cell, Spanning):
        return element("td", cell.content, colspan=columns - column)
    return element("td", cell, class_=_kind(column, text_columns))


def details(summary: str, *content: object) -> Markup:
    """Content that stays folded until a reader opens it."""
    return element("details", element("summary", summary), *content)


def section(identity: str, heading: str, *content: object) -> Markup:
    """A part of the page with its heading, which links find by ``identity``."""
    inner = (element("h2", heading, id=identity), *content)
    return element("section", join(inner), aria_labelledby=identity)
