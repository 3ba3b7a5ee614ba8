"""A wheel holds everything that the package needs, and the metadata agree with each other."""

import re
import tomllib
from pathlib import Path

import wedgesweep
from wedgesweep import config

ROOT = Path(__file__).parents[1]
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
