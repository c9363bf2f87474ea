"""`madori run` ended and started again against one `madori sim` on real sockets.

What the first life learned is kept with the site: the wall reliability, and the pose together with the wheels'
counters. The second life stands where the first one stopped, says so, and delivers. A third one, after the stored pose was
made to lie about the wheels, looks for the place anew and finds it by what the others remembered; its recording is replayed
bit for bit.

    restart_test.py MADORI DATA
"""

import argparse
import csv
import http.client
import math
import pathlib
import re
import signal
import socket
import sqlite3
import subprocess
import tempfile
import time

from sample_site import make_site
from truth_listener import TruthListener

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
parser.add_argument("madori")
parser.add_argument("data", type=pathlib.Path)
arguments = parser.parse_args()
LIMIT_S = 240  # generous: the machine may be busy


def free_port(kind):
    with socket.socket(socket.AF_INET, kind) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def wait_for(condition, what):
    end = time.time() + LIMIT_S
    while not condition():
        if time.time() > end:
            raise SystemExit(f"timed out: {what}")
        time.sleep(0.1)


running = []


def demand(condition, what):
    if not condition:
        raise SystemExit(what)


class Life:
    """One life of `madori run`."""

    def __init__(self, folder, site, devices, port, name, record=False):
        self.log = folder / f"{name}.txt"
        self.site, self.port, self.told = site, free_port(socket.SOCK_STREAM), 0.0
        page = folder / "page"
        page.mkdir(exist_ok=True)
        (page / "index.html").write_text("<p>panel</p>")
        self.process = subprocess.Popen(
            [arguments.madori, "run", site, "--hmi", f"127.0.0.1:{self.port}", "--lidar", "127.0.0.1"]
            + ([] if record else ["--no-record"])
            + ["--lidar-port", str(port), "--position-port", str(free_port(socket.SOCK_DGRAM))]
            + ["--drive", devices / "drive", "--panel-folder", page], stdout=open(self.log, "w"), stderr=subprocess.STDOUT)
        running.append(self.process)

    def say(self, word):
        origin = f"http://127.0.0.1:{self.port}"
        try:
            wire = http.client.HTTPConnection("127.0.0.1", self.port, timeout=2)
            wire.request("POST", f"/api/vehicle/{word}", headers={"Origin": origin, "Content-Type": "application/json"})
            wire.getresponse().read()
        except OSError:
            pass  # not there yet

    def has_delivered(self, before):
        """An operator who confirms whatever stops the vehicle: a busy machine may silence the drive."""
        if time.time() > self.told + 4.0:
            self.told = time.time()
            self.say("confirm")
            self.say("resume")
        return self.stops_done() > before

    def deliver(self, station):
        before = self.stops_done()
        subprocess.run([arguments.madori, "order", self.site, "--to", str(station)], check=True, stdout=subprocess.DEVNULL)
        wait_for(lambda: self.has_delivered(before), f"station {station} is not reached")

    def stops_done(self):
        database = sqlite3.connect(self.site / "madori.db")
        try:
            return database.execute("SELECT count(*) FROM stops_done").fetchone()[0]
        except sqlite3.OperationalError:  # the program has only just begun
            return 0
        finally:
            database.close()

    def end(self):
        time.sleep(2)  # it stands, and keeps its pose
        self.process.send_signal(signal.SIGINT)
        demand(self.process.wait(60) == 0, f"madori run failed:\n{self.log.read_text()}")
        return self.log.read_text()


def main():
    with tempfile.TemporaryDirectory() as name:
        folder, site = pathlib.Path(name), pathlib.Path(name) / "site"
        make_site(arguments.madori, arguments.data, site, quiet=True)
        scenario = (site / "scenario.yaml").read_text()
        (site / "scenario.yaml").write_text(
            re.sub(r"(?m)^start:.*$", "start: {x_m: 53.6, y_m: 10.0, yaw_deg: -90}", scenario))
        port, devices = free_port(socket.SOCK_DGRAM), folder / "devices"
        sim = subprocess.Popen([arguments.madori, "sim", site, "--devices", devices, "--lidar-port", str(port)],
                               stdout=open(folder / "sim.txt", "w"), stderr=subprocess.STDOUT)
        running.append(sim)
        wait_for(lambda: "ws://127.0.0.1:" in (folder / "sim.txt").read_text(), "madori sim does not start")
        truth = TruthListener(int((folder / "sim.txt").read_text().split("ws://127.0.0.1:")[1].split()[0]))

        first = Life(folder, site, devices, port, "first")
        first.deliver(15)
        first.deliver(13)
        first.end()
        stored = dict(re.findall(r"(?m)^(x_m|y_m|yaw_rad): (\S+)$", (site / "last_pose.yaml").read_text()))
        with truth.lock:
            there = truth.messages[-1]
        off_m = math.hypot(float(stored["x_m"]) - there["x_m"], float(stored["y_m"]) - there["y_m"])
        demand(off_m < 0.05, f"the stored pose is {off_m:.3f} m off")
        with open(site / "reliability.csv") as file:
            pieces = list(csv.DictReader(line for line in file if not line.startswith("#")))
        confirmed = sum(piece["state"] == "confirmed" for piece in pieces)
        missing = sum(piece["state"] == "missing" for piece in pieces)
        demand(confirmed > 20 and missing <= confirmed / 10,
               f"of {len(pieces)} pieces of exact walls {confirmed} are confirmed and {missing} missing")

        first_map = (site / "learned" / "living_map.bin").read_bytes()
        demand(len(first_map) > 100_000, f"the living map holds {len(first_map)} bytes")

        second = Life(folder, site, devices, port, "second")
        second.deliver(15)
        said = second.end()
        second_map = (site / "learned" / "living_map.bin").read_bytes()
        demand(len(second_map) >= 0.9 * len(first_map) and "living_map.bin is not used" not in said,
               f"the living map was begun anew: {len(first_map)} bytes, then {len(second_map)}")
        subprocess.run([arguments.madori, "export", site, "--map-layers", folder / "layers"], check=True)
        for layer in ("static", "semi_static", "free"):
            for kind in ("pgm", "yaml", "tif"):
                demand((folder / "layers" / f"{layer}.{kind}").stat().st_size > 50, f"no layer {layer}.{kind}")
        demand("nothing has moved since the last run" in said, f"the pose was not restored:\n{said}")

        text = (site / "last_pose.yaml").read_text()
        (site / "last_pose.yaml").write_text(re.sub(r"left_turns: (-?\d+)", "left_turns: 32000", text))
        remembered = (site / "memory.bin").stat().st_size
        demand(remembered > 100_000, f"it remembers {remembered} bytes")
        third = Life(folder, site, devices, port, "third", record=True)
        third.deliver(13)
        said = third.end()
        run = next((site / "runs").iterdir())
        demand((run / "memory.bin").stat().st_size == remembered, "the recording does not hold what the run began with")
        subprocess.run([arguments.madori, "replay", site, run], check=True, stdout=subprocess.DEVNULL)
        demand("the wheels have turned" in said, f"a lying pose was believed:\n{said}")
        sim.send_signal(signal.SIGINT)
        sim.wait(20)
        print(f"stored pose off by {off_m:.4f} m; {confirmed} of {len(pieces)} pieces confirmed, {missing} missing")


try:
    main()
finally:
    for process in running:
        process.kill()
