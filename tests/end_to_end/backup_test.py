"""A site's backup made on one machine drives on an empty one: `madori export --backup`, the site and its folder gone,
`madori import`, then `madori run` against `madori sim` on real sockets delivers an order of two stations.

    backup_test.py MADORI DATA
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile

from running import Factory, Run, wait_for
from sample_site import make_site

madori, data = sys.argv[1], pathlib.Path(sys.argv[2])
STOPS = [13, 15]


def contents(site):
    """Every file that a backup holds, by name; the scenario is the virtual factory's."""
    names = [p for p in site.rglob("*") if p.is_file() and p.name not in ("scenario.yaml", ".staging.lock")]
    return {str(p.relative_to(site)): p.read_bytes() for p in names}


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        first, again = folder / "first", folder / "empty" / "again"
        make_site(madori, data, first, quiet=True)
        subprocess.run([madori, "export", first, "--backup", folder / "site.tar"], check=True, stdout=subprocess.DEVNULL)
        before = contents(first)
        scenario = (first / "scenario.yaml").read_text()
        shutil.rmtree(first)
        subprocess.run([madori, "import", folder / "site.tar", "--site", again], check=True, stdout=subprocess.DEVNULL)
        after = contents(again)
        lost = sorted(name for name in before if after.get(name) != before[name])
        more = sorted(name for name in after.keys() - before.keys() if not name.startswith("versions/"))
        if lost or more:
            sys.exit(f"differs: {lost + more}")
        (again / "scenario.yaml").write_text(scenario)
        factory = Factory(madori, folder, again)
        run = Run(madori, folder, again, factory, more=["--no-record"])
        try:
            run.order(STOPS)
            run.resume()
            wait_for(lambda: run.stops_done() == len(STOPS) or run.say("confirm") and run.say("resume") and False,
                     f"the restored site does not deliver: {run.log}", 300)
            collisions = factory.truth.newest()["collisions"]
        finally:
            run.process.kill()
            factory.end()
    if collisions:
        sys.exit(f"{collisions} collisions")
    print(f"{len(after)} files restored as they were; {len(STOPS)} stops delivered")


main()
