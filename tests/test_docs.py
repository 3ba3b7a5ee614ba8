"""The documentation and the wheel: links lead somewhere, tables are those of the code, none is left out."""

import json
import re
import tomllib
from pathlib import Path

import pytest

import wedgesweep
from tests import latex
from wedgesweep import config, equations
from wedgesweep.effects import EFFECTS, REGISTERED

ROOT = Path(__file__).parents[1]
PAGES = sorted([ROOT / "README.md", ROOT / "CHANGELOG.md", *(ROOT / "docs").glob("*.md")])
PHYSICS = ROOT / "docs" / "physics.md"


def anchors(page):
    """Anchors that GitHub gives to the headings of a page."""
    headings = re.findall(r"^#+ (.+)$", page.read_text(), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def rows(heading, page=PHYSICS):
    """Cells of the first table below a text of a page."""
    _, _, below = page.read_text().partition(heading)
    table = re.search(r"(^\|.*\n)+", below, re.MULTILINE)[0].splitlines()[2:]
    return [[cell.strip() for cell in row.strip("|").split("|")] for row in table]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page):
    for target in re.findall(r"\]\(([^)\s]+)\)", page.read_text()):
        if target.startswith("http"):
            continue
        path, _, anchor = target.partition("#")
        file = page.parent / path if path else page
        assert file.exists(), target
        assert not anchor or anchor in anchors(file), target


def test_every_effect_is_defined_in_its_family():
    families = [cells[0].strip("*") for cells in rows("## The effects") if cells[0].startswith("**")]
    names = [
        re.match(r"`(\w+)`", cells[0])[1] for cells in rows("## The effects") if cells[0].startswith("`")
    ]
    assert names == list(EFFECTS)
    expected = dict.fromkeys(effect.family.replace("-", " ") for effect in EFFECTS.values())
    assert [family.lower().replace("-", " ") for family in families] == list(expected)


def test_equations_are_those_of_the_effects():
    written = {
        re.match(r"`(\w+)`", cells[0])[1]: cells[1] for cells in rows("## The effects") if cells[0][0] == "`"
    }
    for name, effect in EFFECTS.items():
        for line in equations.of(REGISTERED[name], effect.quantities, effect.systems[0]).lines:
            assert f"${latex.line(line)}$" in written[name]


def test_steady_responses_are_those_of_the_test_data():
    data = json.loads((ROOT / "tests" / "data" / "steady.json").read_text())
    keys = ("beta", "amplitude_mm", "amplitude_ratio", "stick_fraction", "peak_velocity_mm_per_s")
    expected = {
        (row["friction_law"], *(row[key] for key in keys), row["minimum_normal_force_N"]) for row in data
    }
    assert {(row[0], *map(float, row[1:])) for row in rows("**Steady responses**")} == expected


PACKAGE = ROOT / "wedgesweep"
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())


def test_every_file_of_the_package_is_in_a_wheel():
    (patterns,) = PROJECT["tool"]["setuptools"]["package-data"].values()
    packed = {path for pattern in patterns for path in PACKAGE.glob(pattern)}
    files = {path for path in PACKAGE.rglob("*") if path.is_file() and "__pycache__" not in path.parts}
    data = {path for path in files if path.suffix != ".py"}
    assert {path.suffix for path in data} >= {".html", ".css", ".typed"}
    assert data == packed
    # setuptools finds a folder if it and those around it are packages.
    folders = {path.parent for path in files}
    assert [folder for folder in folders if not (folder / "__init__.py").exists()] == []


def test_nothing_of_a_test_is_needed_to_run():
    extras = PROJECT["project"]["optional-dependencies"]
    required = {re.split(r"[><=\[]", each)[0].lower() for each in PROJECT["project"]["dependencies"]}
    imported = {
        name.lower()
        for path in PACKAGE.rglob("*.py")
        for name in re.findall(r"^(?:import|from) ([A-Za-z0-9_]+)", path.read_text(), re.MULTILINE)
    }
    optional = {re.split(r"[><=\[]", each)[0].lower() for names in extras.values() for each in names}
    assert imported & (optional - required) <= {"distributed", "wedgesweep"}


def test_the_citation_is_that_of_this_version():
    text = (ROOT / "CITATION.cff").read_text()
    stated = dict(re.findall(r"^([a-z-]+): (.+)$", text, re.MULTILINE))
    assert stated["version"] == wedgesweep.__version__
    assert stated["license"] == PROJECT["project"]["license"]
    assert re.fullmatch(r"\d{4}-\d\d-\d\d", stated["date-released"].strip('"'))
    for key in ("cff-version", "message", "title", "abstract", "authors", "keywords", "type"):
        assert re.search(rf"^{key}:", text, re.MULTILINE), key


def test_the_schema_says_whose_it_is():
    schema = config.schema()
    assert schema["$id"] == f"urn:wedgesweep:config:{wedgesweep.__version__}"
    assert schema["version"] == wedgesweep.__version__
