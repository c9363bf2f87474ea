#!/usr/bin/python3
"""Scores the drawing import on every drawing of the corpus by a model that saw none of its source (nor of some others).

  tests/bench/train_walls.py --leave-out MODELS && tests/bench/leave_one_source_out.py MODELS [--touches 2]

Prints a row a drawing, and means by the kind of truth (faces and lines: both are complete; contours lack most outer
faces, so read their recall). With --touches N somebody who knows the truth touches up to N lines of each drawing, always
the one that helps most of the longest wrong and the longest missed ones. Needs build/release/madori; the scores are those
of ../shared/score/corpus.py."""
import argparse
import concurrent.futures
import pathlib
import sys

import yaml
from PIL import Image

from train_walls import ROOT, groups, source_of

CANDIDATES = 3  # touches of each kind that are tried


class Drawing:
    def __init__(self, folder, meta, model, corpus, options):
        self.meta, self.model, self.corpus, self.options = meta, model, corpus, options
        self.picture = str(folder / meta["drawing"])
        self.height = Image.open(self.picture).height
        self.truth = corpus.read_segments(folder / "walls.csv", ["u1", "v1", "u2", "v2"])

    def score(self, touches):
        """Precision, recall, F1, walls, what went wrong."""
        options = ["--model", str(self.model), *self.options, *touches]
        walls, _, wrong = self.corpus.imported(str(ROOT / "build/release/madori"), self.picture,
                                               self.meta.get("m_per_px") or 0.02, self.height, options)
        walls = self.corpus.outside(walls, self.meta.get("ignore") or [])
        return (*self.corpus.scored(walls, self.truth, self.meta["tolerance_px"])[:3], walls, wrong)

    def stretches(self, segments, others):
        """The middles of the longest stretches of segments that have none of the others beside them."""
        found = []
        right = self.corpus.near_and_parallel(segments, others, self.meta["tolerance_px"], 10, 1.0) if len(others) else []
        for (a, b), flags in zip(segments, right):
            from_ = None
            for k, flag in enumerate([*flags, True]):
                if not flag and from_ is None:
                    from_ = k
                elif flag and from_ is not None:
                    found.append((k - from_, tuple(a + (b - a) * (from_ + k) / 2 / len(flags))))
                    from_ = None
        return [place for _, place in sorted(found, reverse=True)[:CANDIDATES]]

    def touched(self, touches, result):
        """The touch that helps most, and what it leads to."""
        tries = [("--unlike", place) for place in self.stretches(result[3], self.truth)]
        tries += [("--like", place) for place in self.stretches(self.truth, result[3])]
        best = (touches, result)
        for word, (u, v) in tries:
            more = [*touches, word, f"{u:.1f},{v:.1f}"]
            if (after := self.score(more))[2] > best[1][2]:
                best = (more, after)
        return best


def scored(drawing, count):
    touches, results = [], [drawing.score([])]
    for _ in range(count):
        touches, result = drawing.touched(touches, results[-1])
        results.append(result)
    return drawing.meta, results


def drawings(args, corpus):
    sources = {}
    for file in sorted(args.shared.glob("data/corpus/*/meta.yaml")):
        meta = yaml.safe_load(file.read_text(encoding="utf-8"))
        sources.setdefault(source_of(meta), []).append((file.parent, meta))
    for number, group in enumerate(groups(args.shared / "data")):
        for folder, meta in (pair for source in group for pair in sources[source]):
            yield Drawing(folder, meta, args.models / f"{number}.ubj", corpus, args.options.split())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", type=pathlib.Path)
    parser.add_argument("--shared", type=pathlib.Path, default=ROOT.parent / "shared", help="default ../shared")
    parser.add_argument("--options", default="", help="of madori import")
    parser.add_argument("--touches", type=int, default=0, help="of each drawing, default none")
    args = parser.parse_args()
    sys.path.insert(0, str(args.shared / "score"))
    import corpus  # pylint: disable=import-error,import-outside-toplevel
    kinds = {}
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for meta, results in pool.map(lambda drawing: scored(drawing, args.touches), drawings(args, corpus)):
            kinds.setdefault(meta["truth"], []).append(results)
            precision, recall, _, _, wrong = results[0]
            print(f"{meta['name']:24s} {meta['truth']:9s} F1 {' -> '.join(f'{r[2]:.3f}' for r in results)}  "
                  f"precision {precision:.3f}  recall {recall:.3f}  {wrong}", flush=True)
    for kind in (["faces"], ["lines"], ["faces", "lines"], ["contours"]):
        rows = [results for name in kind for results in kinds.get(name, [])]
        for touches in range(args.touches + 1) if rows else []:
            mean = [sum(results[touches][k] for results in rows) / len(rows) for k in range(3)]
            print(f"{' and '.join(kind)} ({len(rows)}), {touches} touches: F1 {mean[2]:.3f}  precision {mean[0]:.3f}  "
                  f"recall {mean[1]:.3f}  least F1 {min(results[touches][2] for results in rows):.2f}")


if __name__ == "__main__":
    main()
