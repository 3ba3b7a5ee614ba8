"""Blind campaign: hides effects in synthetic measurements and sees whether a diagnosis finds them.

Every set is made and diagnosed through the command line; the truth is compared afterwards. Finished sets are
kept in the directory, so that a campaign can be stopped (Ctrl-C) and goes on where it was. At full size it
takes hours. Writes blind_campaign.txt, .jsonl (the records) and blind-recovery.png into the directory and, if
every set of the full size is there (or with --publish), into docs.
"""

import argparse
import json
from pathlib import Path

import blind_judge as judge
import blind_picture
import joblib
from blind_goals import Sets, goals
from blind_run import RECORD, ROOT, run_chain, write
from blind_sets import KINDS, SIZES, chains
from blind_tables import compared, confusion, mistakes, recovery

from wedgesweep import __version__


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--size", type=float, default=1.0, help="fraction of each kind's sets")
    parser.add_argument(
        "--only", action="append", choices=KINDS, default=[], help="kinds of sets; may be repeated"
    )
    parser.add_argument("--jobs", type=int, default=2, help="sets at the same time")
    parser.add_argument("-o", "--output", type=Path, help="directory; default: out/blind-SEED")
    parser.add_argument(
        "--aic-every", type=int, default=5, help="sets of a kind per one with forward AIC (slow); 0: none"
    )
    parser.add_argument("--records", type=Path, help="sets finished elsewhere (.jsonl): not made again")
    parser.add_argument("--publish", action="store_true", help="write to docs, whatever is missing")
    parser.add_argument("--tables", action="store_true", help="no new sets: the tables of those there are")
    return parser.parse_args()


def unpack(file, seed, out):
    """Put records of sets that were finished elsewhere where those of sets finished here are."""
    for line in file.read_text().splitlines():
        record = json.loads(line)
        if record["seed"] != seed:
            message = f"{file}: {record['name']} is of seed {record['seed']}, not {seed}"
            raise SystemExit(message)
        directory = out / record["name"]
        if not (directory / RECORD).exists():
            directory.mkdir(parents=True, exist_ok=True)
            write(directory / RECORD, record)


def run(wanted, out, jobs, aic_every):
    """Records of all sets, told one by one as they are finished."""
    out.mkdir(parents=True, exist_ok=True)
    pool = joblib.Parallel(n_jobs=jobs, return_as="generator_unordered")
    records, total = [], sum(map(len, wanted))
    for chain in pool(joblib.delayed(run_chain)(each, out, aic_every) for each in wanted):
        for record in chain:
            records.append(record)
            print(f"{len(records):3d}/{total} {told(record)}", flush=True)
    return records


def told(record):
    """One line on a set."""
    if "failure" in record:
        return f"{record['name']:12} failed: {record['failure'].strip().splitlines()[-1]}"
    named = "+".join(judge.causes(record))
    numbers = f"excess {record['excess']:.0f}, {sum(record['seconds'].values()):.0f} s"
    truth = "+".join(record["truth"]) or "nothing"
    return f"{record['name']:12} {truth}: {record['verdict']} {named} ({numbers})"


def report(sets, seed, size, total):
    """The whole text; ``total``: how many sets it would have."""
    rows = recovery(sets)
    seconds = [sum(record["seconds"].values()) for record in sets.all]
    diagnoses = sorted(record["seconds"]["diagnose"] for record in sets.all)
    methods = list(rows[0][2]) if rows else []
    hiding = ", ".join(f"{record['name']} ({'+'.join(record['truth'])})" for record in sets.hiding)
    parts = [
        f"Blind campaign of wedgesweep {__version__}, seed {seed}, size {size:g}: {len(sets.all)} sets, "
        f"{len(sets.failures)} failed.",
        *([f"Stopped before its end: {total} sets were wanted."] if len(sets.all) < total else []),
        *([f"Not counted, as the effect does not show (excess < 100): {hiding}."] if hiding else []),
        "12 tests x 8 periods, noise 4 % of four kinds, three laws; shares with 95 % Wilson intervals.",
        f"{sum(seconds) / 3600:.1f} hours of one core, all told; a diagnosis takes "
        f"{diagnoses[len(diagnoses) // 2]:.0f} s (median), {diagnoses[-1]:.0f} s (longest) with --n-jobs 1.",
        f"\n{'':52} {'asked':18} {'reached':28}",
        *map(str, goals(sets)),
        "\nBeside simpler methods, on the same files:",
        compared(sets),
        "\nOne hidden effect (rows) and what was named (columns), then many effects, nothing-missing,",
        "tied, data-insufficient, none-of-mine.",
        confusion(sets),
        "\nOne hidden effect: share with the truth over the excess chi-squared of the base model:",
        f"{'excess':16}" + "".join(f"{name:24}" for name in methods),
        *(
            f"{low:6.0f} to {high:<6.0f}" + "".join(f"{found[m]!s:24}" for m in methods)
            for low, high, found in rows
        ),
        "\nSets whose truth was not named (unknown effects and the paper's two tests: that did not abstain):",
        mistakes(sets),
    ]
    return "\n".join(parts) + "\n"


def main():
    given = arguments()
    out = given.output or ROOT / "out" / f"blind-{given.seed}"
    wanted = chains(given.seed, given.size, tuple(given.only))
    if given.records:
        unpack(given.records, given.seed, out)
    if given.tables:
        names = [one.name for chain in wanted for one in chain]
        files = [out / name / RECORD for name in names]
        records = [json.loads(file.read_text()) for file in files if file.exists()]
    else:
        records = run(wanted, out, given.jobs, given.aic_every)
    if not records:
        message = f"{out}: no finished sets"
        raise SystemExit(message)
    records.sort(key=lambda record: (list(SIZES).index(record["kind"]), record["index"]))
    sets = Sets([r for r in records if "failure" not in r], [r for r in records if "failure" in r])
    text = report(sets, given.seed, given.size, sum(map(len, wanted)))
    print("\n" + text)
    whole = given.size >= 1.0 and len(sets.all) == sum(map(len, wanted)) and not given.only
    for directory in (out, ROOT / "docs") if whole or given.publish else (out,):
        (directory / "blind_campaign.txt").write_text(text)
        (directory / "blind_campaign.jsonl").write_text("".join(json.dumps(r) + "\n" for r in sets.all))
        if rows := recovery(sets):
            blind_picture.draw(rows, directory / "blind-recovery.png")


if __name__ == "__main__":
    main()
