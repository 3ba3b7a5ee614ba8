"""The examples of docs/extending.md, taken from the page and run."""

import re
import sys
from pathlib import Path

import pytest

from tests import fixture_dataset
from wedgesweep import figures
from wedgesweep.figures import catalogue

PAGE = Path(__file__).parents[1] / "docs" / "extending.md"


def example(file):
    """Code of the page's example for a file of the package."""
    block = re.search(rf"```python\n# {re.escape(file)}\n(.*?)```", PAGE.read_text(), re.DOTALL)
    assert block, file
    return block[1]


@pytest.fixture
def package(tmp_path, monkeypatch):
    """An empty package that can be imported, gone after the test: its name and its folder."""
    folder = tmp_path / "extension"
    folder.mkdir()
    (folder / "__init__.py").touch()
    monkeypatch.syspath_prepend(tmp_path)
    yield "extension", folder
    for name in [name for name in sys.modules if name.split(".")[0] == "extension"]:
        del sys.modules[name]


def test_figure(package, monkeypatch):
    name, folder = package
    (folder / "normal_force.py").write_text(example("wedgesweep/figures/normal_force.py"))
    kind = catalogue.declared(folder, name)["normal-force"]
    assert kind.description
    monkeypatch.setitem(figures.FIGURES, kind.name, kind)
    figure = figures.draw(fixture_dataset.build(), kind.name)
    figure.draw_without_rendering()
    assert len(figure.axes) == 3
    assert figure.axes[0].get_ylabel() == "smallest normal force [N]"
    assert kind.picks == ("law",)
    figures.draw(fixture_dataset.build(), kind.name, law="coulomb")
    with pytest.raises(ValueError, match="minimum_normal_force"):
        figures.draw(fixture_dataset.build().drop_vars("minimum_normal_force"), kind.name)
