"""Saves, restores of versions and of a backup, each killed (kill -9) at a random moment, on a site of the sample's drawing.

After every kill: every version that was ever seen is there as it was, none is half-written (each object holds what its
version named when it was first seen), the numbers have no gap, what lies in the site is the newest version, and scale,
walls and routes belong together.

    versions_kill_test.py MADORI DATA [--kills 200] [--seed 1]
"""

import argparse
import collections
import csv
import hashlib
import json
import pathlib
import random
import subprocess
import sys
import tempfile
import time

import yaml

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
parser.add_argument("madori")
parser.add_argument("data", type=pathlib.Path)
parser.add_argument("--kills", type=int, default=200)
parser.add_argument("--seed", type=int, default=1)
arguments = parser.parse_args()
chance = random.Random(arguments.seed)


def madori(*words, **more):
    return subprocess.run([arguments.madori, *map(str, words)], check=True, stdout=subprocess.DEVNULL, **more)


def make_site(folder):
    site = folder / "site"
    sample = arguments.data / "sample_factory"
    madori("import", sample / "factory.dxf", "--site", site)
    (site / "routes").mkdir(exist_ok=True)
    for name in ("tree.csv", "path.csv"):
        (site / "routes" / name).write_bytes((sample / "routes_factory" / name).read_bytes())
    return site


class Site:
    """The site, and every version that was ever seen of it."""

    def __init__(self, folder):
        self.folder, self.known, self.faults = folder, {}, []
        self.shape = self.belongs_together()
        self.width = yaml.safe_load((folder / "site.yaml").read_text())["drawing"]["width_px"]

    def versions(self):
        madori("versions", self.folder)  # whoever opens the site next finishes a change that was committed
        return [json.loads(f.read_text()) for f in sorted((self.folder / "versions").glob("*.json"))]

    def contents(self, version):
        objects = self.folder / "versions/objects"
        return {name: hashlib.sha256((objects / o).read_bytes()).hexdigest() for name, o in version["files"].items()}

    def belongs_together(self):
        """Metres a pixel by site.yaml, and the width of walls and routes in it: the same drawing whatever its scale."""
        unit = yaml.safe_load((self.folder / "site.yaml").read_text())["scale"]["m_per_px"]
        right = lambda name, keys: max(float(r[k]) for r in csv.DictReader(open(self.folder / name)) for k in keys) / unit
        routes = (self.folder / "routes/path.csv").exists()  # the first version had none
        return round(right("walls.csv", ("x1", "x2"))), round(right("routes/path.csv", ("x",))) if routes else None

    def check(self, kill):
        try:
            found = self.versions()
            seen = {(v["stamp_s"], v["sentence"]): self.contents(v) for v in found}
        except (OSError, ValueError, subprocess.CalledProcessError) as error:
            self.faults.append(f"kill {kill}: {error}")
            return
        lost = [key for key, files in self.known.items() if seen.get(key) != files]
        if lost:
            self.faults.append(f"kill {kill}: versions lost or changed: {lost}")
        if [v["number"] for v in found] != list(range(1, len(found) + 1)):
            self.faults.append(f"kill {kill}: numbers {[v['number'] for v in found]}")
        self.known = seen
        now = {name: hashlib.sha256((self.folder / name).read_bytes()).hexdigest() for name in found[-1]["files"]}
        if now != self.contents(found[-1]):
            self.faults.append(f"kill {kill}: the site is not its newest version")
        walls, routes = self.belongs_together()
        if walls != self.shape[0] or routes not in (self.shape[1], None):
            self.faults.append(f"kill {kill}: {walls}, {routes} instead of {self.shape}")


def changes(site, backup):
    """What is done and killed: name, words of the command line."""
    metres = chance.choice([18, 19, 20, 21, 22])
    versions = len(list((site.folder / "versions").glob("*.json")))
    yield "save", ["scale", site.folder, "--known", f"0,0,{site.width},0={metres}", "--apply", "--force"]
    yield "restore", ["versions", site.folder, "--restore", chance.randint(1, versions)]
    yield "backup", ["import", backup, "--site", site.folder, "--force"]


def how_long(words):
    begun = time.monotonic()
    madori(*words)
    return time.monotonic() - begun


def main():
    with tempfile.TemporaryDirectory() as name:
        site = Site(make_site(pathlib.Path(name)))
        spent = {"save": how_long(next(changes(site, None))[1])}
        backup = pathlib.Path(name) / "backup.tar"
        madori("export", site.folder, "--backup", backup)
        for what, words in changes(site, backup):
            spent[what] = how_long(words)
        site.check(0)
        done = collections.Counter()
        for kill in range(1, arguments.kills + 1):
            what, words = chance.choice(list(changes(site, backup)))
            before = len(site.known)
            process = subprocess.Popen([arguments.madori, *map(str, words)], stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            time.sleep(chance.uniform(0.0, 2.0 * spent[what]))  # also after its end: the machine may be busy
            process.kill()
            process.wait()
            site.check(kill)
            done[f"{what}, {'a version more' if len(site.known) > before else 'as before'}"] += 1
    print(f"{arguments.kills} kills ({', '.join(f'{n} {what}' for what, n in sorted(done.items()))}); "
          f"{len(site.known)} versions at the end; {len(site.faults)} faults")
    for fault in site.faults:
        print("  " + fault)
    sys.exit(1 if site.faults else 0)


main()
