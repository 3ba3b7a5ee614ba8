"""Entry point of the validation campaign: ``PYTHONPATH=scripts python -m validation``.

Finished sets stay in the output directory: rerun the same command to resume an interrupted campaign, which
takes hours in full. Writes validation.txt (the tables), validation-records.jsonl and validation-recovery.png.
"""

import argparse
import json
from collections.abc import Sequence
from pathlib import Path

import joblib

from validation import figure, judge, tables
from validation.goals import Sets
from validation.judge import Record
from validation.run import RECORD, run_chain, write
from validation.sets import KINDS, DataSet, chains
from wedgesweep import __version__, figures

NAME = "validation"


def arguments(given: Sequence[str] | None = None) -> argparse.Namespace:
    """Read the options of the command line."""
    parser = argparse.ArgumentParser(prog="python -m validation", description=__doc__, allow_abbrev=False)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--size", type=float, default=1.0, help="fraction of the sets of each kind")
    parser.add_argument("--only", action="append", choices=KINDS, default=[], help="kind of sets; repeatable")
    parser.add_argument("--ablate", default="", help="stage (diagnosis.json lists them) to leave out")
    parser.add_argument("--jobs", type=int, default=2, help="sets at the same time")
    parser.add_argument("-o", "--output", type=Path, help="directory; default: out/validation-SEED")
    parser.add_argument("--records", type=Path, help="records (.jsonl) of sets that are not to be run again")
    parser.add_argument("--tables", action="store_true", help="run nothing; print the tables of the records")
    parser.add_argument("--picture", type=Path, help="file for the picture of how often effects are found")
    return parser.parse_args(given)


def main(given: Sequence[str] | None = None) -> None:
    """Run a campaign, or print the tables of its records."""
    options = arguments(given)
    out = options.output or Path("out") / f"{NAME}-{options.seed}"
    if options.ablate:
        out = out.with_name(f"{out.name}-without-{options.ablate.replace(' ', '-')}")
    wanted = chains(options.seed, options.size, tuple(options.only), options.ablate)
    finished = _read(options.records, options.seed) if options.records else []
    if options.tables:
        names = {one.name for chain in wanted for one in chain}
        records = [record for record in finished or _stored(out) if record["name"] in names]
    else:
        _store(finished, out)
        records = _run(wanted, out, options.jobs)
    if not records:
        raise SystemExit(f"{out}: no finished sets")
    records.sort(key=lambda record: (KINDS.index(record["kind"]), record["index"]))
    sets = Sets([r for r in records if "failure" not in r], [r for r in records if "failure" in r])
    heading = f"Validation of wedgesweep {__version__}, seed {options.seed}, size {options.size:g}"
    text = tables.text(sets, heading, sum(map(len, wanted)))
    print(text, end="")
    if options.picture:
        _draw(sets, options.picture)
    if not options.tables:
        _write(sets, text, out)


def _read(file: Path, seed: int) -> list[Record]:
    records = [json.loads(line) for line in file.read_text().splitlines()]
    for record in records:
        if record["seed"] != seed:
            raise SystemExit(f"{file}: {record['name']} has the seed {record['seed']}, not {seed}")
    return records


def _stored(out: Path) -> list[Record]:
    return [json.loads(file.read_text()) for file in out.glob(f"*/{RECORD}")]


def _store(records: list[Record], out: Path) -> None:
    """Place records from elsewhere beside those of sets that finished here, which take precedence."""
    for record in records:
        file = out / record["name"] / RECORD
        if not file.exists():
            file.parent.mkdir(parents=True, exist_ok=True)
            write(file, record)


def _run(wanted: list[list[DataSet]], out: Path, jobs: int) -> list[Record]:
    """Records of all sets, each announced as it is finished."""
    pool = joblib.Parallel(n_jobs=jobs, return_as="generator_unordered")
    records: list[Record] = []
    total = sum(map(len, wanted))
    for chain in pool(joblib.delayed(run_chain)(each, out) for each in wanted):
        for record in chain:
            records.append(record)
            print(f"{len(records):3d}/{total} {_line(record)}", flush=True)
    print()
    return records


def _line(record: Record) -> str:
    if "failure" in record:
        return f"{record['name']:12} failed: {record['failure'].strip().splitlines()[-1]}"
    seconds = sum(record["seconds"].values())
    return (
        f"{record['name']:12} {tables.outcome(record)} (excess {judge.excess(record):.0f}, {seconds:.0f} s)"
    )


def _write(sets: Sets, text: str, out: Path) -> None:
    (out / f"{NAME}.txt").write_text(text)
    (out / f"{NAME}-records.jsonl").write_text("".join(json.dumps(record) + "\n" for record in sets.all))
    _draw(sets, out / f"{NAME}-recovery.png")


def _draw(sets: Sets, file: Path) -> None:
    bins = tables.recovery(sets)
    if any(share.n >= figure.FEWEST for found in bins for share in found.shares.values()):
        figures.save(figure.draw(bins), file)


if __name__ == "__main__":
    main()
