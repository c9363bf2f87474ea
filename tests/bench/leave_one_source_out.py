#!/usr/bin/python3
"""Scores the drawing import on every drawing of the corpus by a model that saw none of its source (nor of some others).

  tests/bench/train_walls.py --leave-out MODELS && tests/bench/leave_one_source_out.py MODELS

Prints a row a drawing, and means by the kind of truth (faces and lines: both are complete; contours lack most outer
faces, so read their recall). Needs build/release/madori. The scores are those of ../shared/score/corpus.py."""
import argparse
import json
import pathlib
import subprocess
import tempfile

import yaml

from train_walls import ROOT, groups, source_of


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", type=pathlib.Path)
    parser.add_argument("--shared", type=pathlib.Path, default=ROOT.parent / "shared", help="default ../shared")
    parser.add_argument("--options", default="", help="of madori import")
    args = parser.parse_args()
    sources = {}
    for file in sorted(args.shared.glob("data/corpus/*/meta.yaml")):
        meta = yaml.safe_load(file.read_text(encoding="utf-8"))
        sources.setdefault(source_of(meta), []).append(meta)
    kinds = {}
    for number, group in enumerate(groups(args.shared / "data")):
        metas = [meta for source in group for meta in sources[source]]
        with tempfile.NamedTemporaryFile(suffix=".json") as answer:
            subprocess.run(["/usr/bin/python3", args.shared / "score/corpus.py", args.shared / "data/corpus",
                            ROOT / "build/release/madori", "--only", ",".join(meta["name"] for meta in metas), "--options",
                            f"--model {args.models / str(number)}.ubj {args.options}", "--json", answer.name],
                           check=True, stdout=subprocess.DEVNULL)
            rows = json.load(open(answer.name, encoding="utf-8"))
        truth = {meta["name"]: meta["truth"] for meta in metas}
        for row in rows:
            kinds.setdefault(truth[row["name"]], []).append(row)
            print(f"{row['name']:24s} {truth[row['name']]:9s} F1 {row['f1']:.3f}  precision {row['precision']:.3f}  "
                  f"recall {row['recall']:.3f}  {row['seconds']:.1f} s  {row['wrong']}", flush=True)
    for kind in (["faces"], ["lines"], ["faces", "lines"], ["contours"]):
        rows = [row for name in kind for row in kinds.get(name, [])]
        if rows:
            mean = {key: sum(row[key] for row in rows) / len(rows) for key in ("f1", "precision", "recall")}
            print(f"{' and '.join(kind)} ({len(rows)}): F1 {mean['f1']:.3f}  precision {mean['precision']:.3f}  "
                  f"recall {mean['recall']:.3f}  least F1 {min(row['f1'] for row in rows):.2f}")


if __name__ == "__main__":
    main()
