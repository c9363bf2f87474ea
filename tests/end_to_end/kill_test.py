"""`madori run` killed (kill -9) at random moments while it works off orders against `madori sim` on real sockets.

After every kill: the database is intact, no order is lost, none is done twice or out of sequence, and nothing drives
until the operator confirms. At the end the ground truth must show the vehicle at each stop that was counted, in that
sequence, and nowhere else.

    kill_test.py MADORI DATA [--kills 200] [--seed 1] [--json FILE]
"""

import argparse
import json
import math
import pathlib
import random
import signal
import socket
import sqlite3
import subprocess
import sys
import tempfile
import time

from running import say
from sample_site import make_site
from truth_listener import TruthListener

STATIONS = {13: (54.0, 3.0), 15: (64.0, 3.0), 20: (49.5, 13.0), 21: (49.5, 19.0)}
STANDS_MPS = 0.003
ARRIVED_MPS = 0.02  # at a stop of an order the vehicle may turn at once
AT_STATION_M = 0.06

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
parser.add_argument("madori")
parser.add_argument("data", type=pathlib.Path)
parser.add_argument("--kills", type=int, default=200)
parser.add_argument("--seed", type=int, default=1)
parser.add_argument("--longest", type=float, default=9.0, help="seconds from a start to its kill")
parser.add_argument("--json", type=pathlib.Path)
parser.add_argument("--log", type=pathlib.Path, help="keeps what the killed programs printed")
arguments = parser.parse_args()
chance = random.Random(arguments.seed)


def free_port(kind):
    with socket.socket(socket.AF_INET, kind) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def wait_for(condition, limit_s, what):
    end = time.time() + limit_s
    while time.time() < end:
        if condition():
            return
        time.sleep(0.02)
    raise SystemExit(f"timed out: {what}")


class Factory:
    """`madori sim` with the vehicle beside the stations, nobody about."""

    def __init__(self, folder, site):
        scenario = (site / "scenario.yaml").read_text().splitlines()
        start = "start: {x_m: 53.6, y_m: 10.0, yaw_deg: -90}"
        (site / "scenario.yaml").write_text(
            "\n".join(start if line.startswith("start:") else line for line in scenario) + "\n")
        self.lidar_port, self.devices = free_port(socket.SOCK_DGRAM), folder / "devices"
        self.output = open(folder / "sim.txt", "w+")
        self.process = subprocess.Popen(
            [arguments.madori, "sim", site, "--devices", self.devices, "--lidar-port", str(self.lidar_port)],
            stdout=self.output, stderr=subprocess.STDOUT)
        wait_for(lambda: "ws://127.0.0.1:" in (folder / "sim.txt").read_text(), 120, "madori sim does not start")
        self.truth = TruthListener(int((folder / "sim.txt").read_text().split("ws://127.0.0.1:")[1].split()[0]))

    def end(self):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(20)


class Vehicle:
    """One life of `madori run`."""

    def __init__(self, site, factory, page, log):
        self.port = free_port(socket.SOCK_STREAM)
        self.begun = time.time()
        self.process = subprocess.Popen(
            [arguments.madori, "run", site, "--hmi", f"127.0.0.1:{self.port}", "--no-record", "--lidar", "127.0.0.1"]
            + ["--lidar-port", str(factory.lidar_port), "--position-port", str(free_port(socket.SOCK_DGRAM))]
            + ["--drive", factory.devices / "drive", "--panel-folder", page],
            stdout=log, stderr=subprocess.STDOUT)

    def command(self, word):
        """Whether the panel's server took the operator's word."""
        return say(self.port, word)

    def kill(self):
        self.process.kill()
        self.process.wait()


class Ledger:
    """What was ordered, against what the database says."""

    def __init__(self, site):
        self.site, self.given, self.progress, self.faults = site, {}, {}, []

    def order(self):
        """Orders as an operator does, from another program; counts only once it is acknowledged."""
        last = next(reversed(self.given.values()))[-1] if self.given else None
        stops = []
        for _ in range(chance.choice([1, 2])):
            stops.append(chance.choice([s for s in STATIONS if s != (stops[-1] if stops else last)]))
        done = subprocess.run(
            [arguments.madori, "order", self.site, "--to", ",".join(map(str, stops)), "--json", "-"],
            capture_output=True, text=True)
        if done.returncode != 0:
            raise SystemExit(f"madori order failed: {done.stderr}")
        self.given[json.loads(done.stdout)["added"]] = stops

    def check(self, when):
        """Looks at the database as the kill left it; returns how many orders are open."""
        def blame(text):
            self.faults.append(f"kill {when}: {text}")

        with sqlite3.connect(self.site / "madori.db") as database:
            intact = database.execute("PRAGMA integrity_check").fetchone()[0]
            orders = {i: (s, n) for i, s, n in database.execute("SELECT id, state, next_stop FROM orders")}
            done = database.execute("SELECT order_id, position, done_ns FROM stops_done ORDER BY done_ns, order_id, position").fetchall()
        database.close()
        if intact != "ok":
            blame(f"integrity_check: {intact}")
        for order, stops in self.given.items():
            if order not in orders:
                blame(f"order {order} is lost")
                continue
            state, next_stop = orders[order]
            count = len(stops) if state == "done" else next_stop
            if state not in ("queued", "running", "done"):
                blame(f"order {order} is {state}")
            if count < self.progress.get(order, 0):
                blame(f"order {order} went back from stop {self.progress[order]} to {count}")
            self.progress[order] = count
            if [position for o, position, _ in done if o == order] != list(range(count)):
                blame(f"order {order}: stops counted are not its first {count}")
        if sum(state == "running" for state, _ in orders.values()) > 1:
            blame("two orders run at once")
        self.done = [(self.given[o][position], at / 1e9) for o, position, at in done]
        return sum(state != "done" for state, _ in orders.values())


def visits_of(messages):
    """Stations at which the vehicle really stood, repetitions in a row taken as one."""
    visits = []
    for m in messages:
        if abs(m["linear_mps"]) > ARRIVED_MPS:
            continue
        for station, (x, y) in STATIONS.items():
            if math.hypot(m["x_m"] - x, m["y_m"] - y) < AT_STATION_M and (not visits or visits[-1] != station):
                visits.append(station)
    return visits


def one_life(vehicle, factory, moved):
    """Starts, looks that nothing drives, confirms, drives; killed at a random moment, a quarter of the time of the
    start itself. Returns whether the operator had confirmed."""
    early = chance.random() < 0.25
    until = chance.uniform(0.0, arguments.longest)
    look_until, told = chance.uniform(0.5, 1.2), 0.0
    resumed = None
    while True:
        now = time.time()
        if now > (vehicle.begun if early else resumed or now) + until:
            break
        if vehicle.process.poll() is not None:
            raise SystemExit("madori run ended by itself")
        stands = all(abs(m["linear_mps"]) + abs(m["angular_radps"]) < STANDS_MPS for m in factory.truth.since(now - 4.0))
        if now > vehicle.begun + look_until and (not resumed or stands) and now - told > (4.0 if resumed else 0.2):
            # said again where it still stands: a busy machine may silence the drive, which is a fault
            if not resumed:
                moved += [m for m in factory.truth.since(vehicle.begun) if abs(m["linear_mps"]) > STANDS_MPS]
            told = now
            if vehicle.command("confirm") and vehicle.command("resume"):
                resumed = resumed or time.time()
        if now > vehicle.begun + 120.0 and not resumed:
            raise SystemExit("the panel of madori run does not answer")
        time.sleep(0.02)
    vehicle.kill()
    if not resumed:
        moved += [m for m in factory.truth.since(vehicle.begun) if abs(m["linear_mps"]) > STANDS_MPS]
    return resumed is not None


def wait_until_stopped(factory, ledger, kill):
    """The drive's own watchdog stops the vehicle, within a second by the virtual factory's clock: on a busy machine that
    may lag behind ours, and what it says late must not be taken for a movement after the next start."""
    killed = factory.truth.newest()["time_s"]

    def newest_stands():
        m = factory.truth.newest()
        return m["time_s"] > killed + 0.5 and abs(m["linear_mps"]) + abs(m["angular_radps"]) < STANDS_MPS

    wait_for(newest_stands, 60, "the vehicle does not stop")
    if factory.truth.newest()["time_s"] > killed + 2.0:
        ledger.faults.append(f"kill {kill}: the vehicle went on for {factory.truth.newest()['time_s'] - killed:.1f} s")
    time.sleep(0.5)


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        site = folder / "site"
        (folder / "page").mkdir()  # the panel's server wants a page, whatever stands in it
        (folder / "page/index.html").write_text("<!doctype html><title>none</title>")
        x_m, y_m = make_site(arguments.madori, arguments.data, site, quiet=True)
        for station, (x, y) in STATIONS.items():
            STATIONS[station] = (x + x_m, y + y_m)
        factory, ledger, moved, confirmed = Factory(folder, site), Ledger(site), [], 0
        log = open(folder / "run.txt", "w")
        ledger.order()
        try:
            for kill in range(1, arguments.kills + 1):
                vehicle = Vehicle(site, factory, folder / "page", log)
                confirmed += one_life(vehicle, factory, moved)
                open_orders = ledger.check(kill)
                wait_until_stopped(factory, ledger, kill)
                while open_orders < 2:
                    ledger.order()
                    open_orders += 1
            time.sleep(0.5)
            if arguments.log:
                arguments.log.with_suffix(".truth").write_text(json.dumps(factory.truth.since(0.0)))
            visits, counted = visits_of(factory.truth.since(0.0)), [station for station, _ in ledger.done]
            collisions = factory.truth.newest()["collisions"]
        finally:
            factory.end()
            log.close()
            if arguments.log:
                arguments.log.write_bytes((folder / "run.txt").read_bytes())
    if visits[: len(counted)] != counted or len(visits) > len(counted) + 1:
        ledger.faults.append(f"the vehicle stood at {visits}, the database counted {counted}")
    if moved:
        ledger.faults.append(f"the vehicle moved {len(moved)} times before anybody confirmed")
    if time.time() - factory.truth.newest()["received"] > 30.0:
        ledger.faults.append("the ground truth was lost on the way")
    if collisions:
        ledger.faults.append(f"{collisions} collisions")
    print(f"{arguments.kills} kills, {confirmed} of them after the operator had confirmed; {len(ledger.given)} orders, "
          f"{len(counted)} stops counted, {len(visits)} seen; {len(ledger.faults)} faults")
    for fault in ledger.faults:
        print("  " + fault)
    if arguments.json:
        arguments.json.write_text(json.dumps({"kills": arguments.kills, "confirmed": confirmed, "orders": len(ledger.given),
                                              "stops": len(counted), "faults": ledger.faults}))
    sys.exit(1 if ledger.faults or (not counted and arguments.kills > 20) else 0)


main()
