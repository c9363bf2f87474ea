#!/usr/bin/python3
"""Four deliveries with a kidnapping and a drop-out of the lidar: all made, nothing run into, nobody helps; and the living
map of that day shows what stands there."""
import json
import pathlib
import subprocess
import sys
import tempfile

MADORI, SOAK, DATA = sys.argv[1:4]


def main():
    with tempfile.TemporaryDirectory() as folder:
        site, figures = f"{folder}/site", pathlib.Path(folder) / "days.json"
        subprocess.run([MADORI, "demo", "--import-only", "--site", site, "--data", DATA], check=True,
                       stdout=subprocess.DEVNULL)
        soak = subprocess.run([SOAK, site, f"{DATA}/scenarios/soak/scenario.yaml", "--routes",
                               f"{DATA}/scenarios/soak/routes", "--orders", "4", "--kidnappings", "1",
                               "--dropouts", "1", "--pallets", "0", "--living-map", f"{folder}/map", "--json", str(figures)],
                              stdout=subprocess.PIPE, text=True)
        print(soak.stdout)
        day = json.loads(figures.read_text().splitlines()[0])
        assert day["delivered"] == day["asked"] == 4, day["undelivered"]
        assert day["kidnapped"] == 1 and len(day["found_after_s"]) == 1, day["found_after_s"]
        assert day["dropouts"] == day["dropouts_survived"] == 1
        assert not day["collisions_moving"] and not day["collisions_standing"]
        assert soak.returncode == 0, day["help"]
        found = day["living_map"]
        print(json.dumps(found))
        assert found["static"]["precision"] > 0.95 and found["static"]["cells"] > 500, found
        assert found["phantoms"] < 0.005 * found["known"], found


main()
