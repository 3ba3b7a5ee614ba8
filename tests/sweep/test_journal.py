"""The journal keeps what was whole when a run was killed, and nothing that belongs to another."""

import errno

import numpy as np
import pytest

from wedgesweep.errors import MismatchError, SweepError
from wedgesweep.sweep import journal
from wedgesweep.sweep.journal import Journal

DTYPE = np.dtype([("index", "i8"), ("value", "f8", (3,)), ("message", "S5")])
HEADER = {"config": "", "config_sha256": "abc", "wedgesweep": "1.0", "numpy": "2.0"}
STRIDE = DTYPE.itemsize + 4


def records(*indices):
    filled = np.zeros(len(indices), DTYPE)
    filled["index"] = indices
    filled["value"] = np.arange(3) + np.array(indices)[:, None]
    filled["message"] = b"a\nb"  # a line end within a record is not the end of the header
    return filled


@pytest.fixture
def path(tmp_path):
    """Journal of four cases, written in two runs."""
    path = tmp_path / "x.nc.partial"
    with Journal(path, DTYPE, HEADER) as first:
        assert first.records.size == 0
        first.append(records(7))
        first.append(records(0, 3))
    with Journal(path, DTYPE, HEADER) as second:
        second.append(records(5))
    return path


def kept(path):
    with Journal(path, DTYPE, HEADER) as opened:
        return opened.records["index"].tolist()


def test_keeps_all_records_of_earlier_runs(path):
    with Journal(path, DTYPE, HEADER) as opened:
        assert np.array_equal(opened.records, records(7, 0, 3, 5))
    assert np.array_equal(journal.read(path, DTYPE), records(7, 0, 3, 5))
    assert journal.header(path) == HEADER


@pytest.mark.parametrize("torn_by", [1, 4, STRIDE - 1])
def test_drops_a_torn_record_and_goes_on_in_its_place(path, torn_by):
    path.write_bytes(path.read_bytes()[:-torn_by])
    with Journal(path, DTYPE, HEADER) as opened:
        assert opened.records["index"].tolist() == [7, 0, 3]
        opened.append(records(9))
    assert kept(path) == [7, 0, 3, 9]
    # What follows a damaged record is dropped.
    content = bytearray(path.read_bytes())
    content[-2 * STRIDE - 10] ^= 1
    path.write_bytes(bytes(content))
    assert kept(path) == [7]
    # After a torn header it begins anew.
    for length in (20, 1, 0):
        path.write_bytes(path.read_bytes()[:length])
        with Journal(path, DTYPE, HEADER) as opened:
            assert opened.records.size == 0
            opened.append(records(1))
        assert kept(path) == [1]


def test_the_last_record_of_a_case_counts(path):
    again = records(0)
    again["value"] = -1.0
    with Journal(path, DTYPE, HEADER) as opened:
        opened.append(again)
    found = journal.read(path, DTYPE)
    assert sorted(found["index"]) == [0, 3, 5, 7]
    assert (found["value"][found["index"] == 0] == -1.0).all()


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("numpy", "3.0", "numpy: 2.0 there, 3.0 now"),
        ("wedgesweep", "1.1", "wedgesweep: 1.0 there, 1.1 now"),
        ("config_sha256", "abd", "the config has changed"),
        ("source_sha256", "1", "the code of wedgesweep or of a plug-in has changed"),
    ],
)
def test_refuses_the_journal_of_another_set_up_and_leaves_it_alone(path, key, value, words):
    before = path.read_bytes()
    with pytest.raises(MismatchError, match=words) as caught:
        Journal(path, DTYPE, HEADER | {key: value})
    assert str(path) in str(caught.value)
    assert path.read_bytes() == before
    assert len(kept(path)) == 4


def test_names_the_keys_of_the_config_that_changed(path):
    old, new = ("[sweep]\nbeta = [0.5, 1.0]\nx = 1\n", "[sweep]\nbeta = [0.5, 1.5]\ny = 1\n")
    path.unlink()
    Journal(path, DTYPE, HEADER | {"config": old}).close()
    with pytest.raises(MismatchError) as caught:
        Journal(path, DTYPE, HEADER | {"config": new, "config_sha256": "abd"})
    for words in (
        "sweep.beta: [0.5, 1.0] there, [0.5, 1.5] now",
        "sweep.x: 1 there, absent now",
        "sweep.y: absent there, 1 now",
    ):
        assert words in str(caught.value)


def test_refuses_what_is_no_journal(path):
    for content in ("some text\nof mine\n", "[1, 2]\n", "mine", "{}\n", '{"config": 1}\n', "[" * 5000 + "\n"):
        path.write_text(content)
        with pytest.raises(SweepError, match="not the journal of a sweep"):
            Journal(path, DTYPE, HEADER)
        with pytest.raises(SweepError, match="not the journal of a sweep"):
            journal.discard(path)
        assert path.read_text() == content


def test_one_run_at_a_time(path):
    with Journal(path, DTYPE, HEADER):
        with pytest.raises(SweepError, match="another run is writing it"):
            Journal(path, DTYPE, HEADER)
        with pytest.raises(SweepError, match="another run is writing it"):
            journal.discard(path)
        assert journal.read(path, DTYPE).size == 4  # reading disturbs nobody
    journal.discard(path)
    assert not path.exists()
    journal.discard(path)


def test_a_file_system_without_locks_will_do(path, monkeypatch):
    def fails(*arguments):
        raise OSError(errno.ENOLCK, "no locks available")

    monkeypatch.setattr(journal.fcntl, "flock", fails)
    with Journal(path, DTYPE, HEADER) as kept:
        assert kept.records.size == 4
