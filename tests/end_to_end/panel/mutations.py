#!/usr/bin/python3
"""Undoes each mend of the operator page (mends.py) in a copy of the sources and runs the test that stands for it: it must be green
before and red without the mend. Writes the table of docs/reference/panel.md where it is named.

    mutations.py FOLDER [--only 1,2] [--table panel.md]      FOLDER: the copy and its build, kept for the next time"""
import argparse
import filecmp
import os
import pathlib
import re
import shutil
import subprocess
import sys

from mends import DEFECTS, MENDS, PAGE

ROOT = pathlib.Path(__file__).resolve().parents[3]
BEGIN, END = "<!-- written by tests/end_to_end/panel/mutations.py: begin -->", "<!-- end -->"


def copy_of(sources):
    """The files that git knows, where they differ; the page's packages are shared."""
    names = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    for name in names.split("\0"):
        source, copy = ROOT / name, sources / name
        if not source.is_file() or (copy.exists() and filecmp.cmp(source, copy, shallow=False)):
            continue
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source, copy)
    packages = sources / "hmi/web/node_modules"
    if not packages.exists():
        packages.symlink_to(ROOT / "hmi/web/node_modules")
    if not (sources / "build/release").exists():
        subprocess.run(["cmake", "--preset", "release"], cwd=sources, check=True, stdout=subprocess.DEVNULL)


def build(sources):
    done = subprocess.run(["cmake", "--build", "build/release", "--target", "madori", "panel"], cwd=sources, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stdout[-3000:] + done.stderr)


def red(sources, test, check):
    """What the test says where it is red, None where it is green."""
    dist = sources / "hmi/web/dist"
    given = [dist] if test == PAGE else [sources / "build/release/madori", dist, sources / "data", sources.parent / "pictures", "1024x600"]
    done = subprocess.run(["node", sources / test, *given], env={**os.environ, "TRUTHS": check, "PATIENCE_MS": "20000"}, capture_output=True, text=True, timeout=900)
    if done.returncode == 0:
        return None
    out = re.sub(r"\x1b\[[0-9;]*m", "", done.stdout + done.stderr)
    said = re.search(r"(?:FAILED|^Error:) (.*)(?:\n.*Call log:.*\n.*waiting for (.*))?", out, re.MULTILINE)
    return " ".join(filter(None, said.groups())) if said else out[-300:]


def without(sources, mend):
    """What its test says without a mend."""
    file = sources / mend.file
    before = file.read_text(encoding="utf-8")
    if before.count(mend.text) != 1:
        sys.exit(f"{mend.number}: {mend.file} holds its text {before.count(mend.text)} times")
    try:
        file.write_text(before.replace(mend.text, mend.instead), encoding="utf-8")
        build(sources)
        words = red(sources, mend.test, mend.check)
    finally:
        file.write_text(before, encoding="utf-8")
    print(f"{mend.number}, {mend.undone}: {'GREEN' if words is None else 'red: ' + words}", flush=True)
    return words


def write(table, rows):
    """One line a mutation; the words of the test are cut to what fits."""
    lines = ["| no. | what was untrue | with the mend undone | test, check | it says |", "| --- | --- | --- | --- | --- |"]
    for mend, words in rows:
        said = " ".join(re.sub(r"^\d+: ", "", words).split())[:90].replace("|", "/")
        lines.append(f"| {mend.number} | {DEFECTS[mend.number]} | {mend.undone} | `{pathlib.Path(mend.test).name}` {mend.check} | {said} |")
    before, rest = table.read_text(encoding="utf-8").split(BEGIN)
    table.write_text(before + BEGIN + "\n" + "\n".join(lines) + "\n" + rest[rest.index(END):], encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--only", type=lambda text: text.split(","))
    parser.add_argument("--table", type=pathlib.Path)
    given = parser.parse_args()
    sources = given.folder.resolve() / "tree"
    copy_of(sources)
    build(sources)
    mends = [mend for mend in MENDS if not given.only or mend.number in given.only]
    for test, check in dict.fromkeys((mend.test, mend.check) for mend in mends):
        if (words := red(sources, test, check)) is not None:
            sys.exit(f"{check}: red as it is: {words}")
    page_first = sorted(mends, key=lambda mend: not mend.file.startswith("hmi/web"))  # a program is built once for them
    said = {mend.undone: without(sources, mend) for mend in page_first}
    if given.table:
        write(given.table, [(mend, said[mend.undone]) for mend in mends if said[mend.undone] is not None])
    green = [f"{mend.number}, {mend.undone}" for mend in mends if said[mend.undone] is None]
    if green:
        sys.exit("green without the mend: " + "; ".join(green))


main()
