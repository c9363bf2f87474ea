"""`madori sim` and `madori run` on real sockets, for tests that do something to the running program."""

import csv
import http.client
import math
import os
import re
import signal
import socket
import sqlite3
import subprocess
import time

from truth_listener import TruthListener

STANDS_MPS = 0.02


def free_port(kind=socket.SOCK_DGRAM):
    with socket.socket(socket.AF_INET, kind) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def wait_for(condition, what, limit_s=120.0):
    """Waits by the steady clock; SystemExit names what did not happen."""
    end = time.monotonic() + limit_s
    while not (found := condition()):
        if time.monotonic() > end:
            raise SystemExit(f"timed out: {what}")
        time.sleep(0.01)
    return found


def say(port, word):
    """Whether the panel's server at the port took the operator's word."""
    origin = f"http://127.0.0.1:{port}"
    try:
        wire = http.client.HTTPConnection("127.0.0.1", port, timeout=2)
        wire.request("POST", f"/api/vehicle/{word}", headers={"Origin": origin, "Content-Type": "application/json"})
        return wire.getresponse().status < 300
    except OSError:
        return False


class Factory:
    """`madori sim` with the vehicle beside stations 13 (54, 3) and 15 (64, 3), nobody about."""

    def __init__(self, madori, folder, site):
        text = (site / "scenario.yaml").read_text()
        (site / "scenario.yaml").write_text(
            re.sub(r"(?m)^start:.*$", "start: {x_m: 53.6, y_m: 10.0, yaw_deg: -90}", text))
        self.lidar_port, self.devices, self.log = free_port(), folder / "devices", folder / "sim.txt"
        self.process = subprocess.Popen(
            [madori, "sim", site, "--devices", self.devices, "--lidar-port", str(self.lidar_port),
             "--lms-port", "0"], stdout=open(self.log, "w"), stderr=subprocess.STDOUT)
        wait_for(lambda: "ws://127.0.0.1:" in self.log.read_text(), "madori sim does not start")
        self.truth = TruthListener(int(self.log.read_text().split("ws://127.0.0.1:")[1].split()[0]))

    def speed(self):
        now = self.truth.newest()
        return abs(now["linear_mps"]) + abs(now["angular_radps"]) if now else 0.0

    def end(self):
        self.process.kill()
        self.process.wait(20)


class Run:
    """One life of `madori run`. `env`: what is added to its environment."""

    def __init__(self, madori, folder, site, factory, name="run", env=None, more=(), lidar_port=None,
                 drive=None):
        self.madori, self.site, self.log, self.name = madori, site, folder / f"{name}.txt", name
        self.port = free_port(socket.SOCK_STREAM)
        page = folder / "page"
        page.mkdir(exist_ok=True)
        (page / "index.html").write_text("<p>panel</p>")
        self.process = subprocess.Popen(
            [madori, "run", site, "--hmi", f"127.0.0.1:{self.port}", "--lidar", "127.0.0.1", "--lidar-port",
             str(lidar_port or factory.lidar_port), "--position-port", str(free_port()), "--drive",
             drive or factory.devices / "drive", "--panel-folder", page, *more],
            stdout=open(self.log, "w"), stderr=subprocess.STDOUT, env={**os.environ, **(env or {})})

    def say(self, word):
        """Whether the panel's server took the operator's word."""
        return say(self.port, word)

    def resume(self):
        wait_for(lambda: self.say("confirm") | self.say("resume"), f"{self.name}: the panel does not answer")

    def order(self, stations, repeat=1):
        subprocess.run([self.madori, "order", self.site, "--to", ",".join(map(str, stations)), "--repeat", str(repeat)],
                       check=True, stdout=subprocess.DEVNULL)

    def cancel_orders(self):
        for (number,) in self.ask("SELECT id FROM orders WHERE state IN ('queued', 'running')"):
            subprocess.run([self.madori, "order", self.site, "--cancel", str(number)], check=True,
                           stdout=subprocess.DEVNULL)

    def ask(self, sql):
        database = sqlite3.connect(self.site / "madori.db", timeout=5)
        try:
            return database.execute(sql).fetchall()
        except sqlite3.OperationalError:  # the program has only just begun
            return []
        finally:
            database.close()

    def stops_done(self):
        return len(self.ask("SELECT 1 FROM stops_done"))

    def last_event(self):
        rows = self.ask("SELECT max(id) FROM events")
        return rows[0][0] or 0 if rows else 0

    def newest_event(self):
        rows = self.ask("SELECT text FROM events ORDER BY id DESC LIMIT 1")
        return rows[0][0] if rows else ""

    def events_after(self, number):
        return [text for (text,) in self.ask(f"SELECT text FROM events WHERE id > {number} ORDER BY id")]

    def detours_after(self, number):
        """When it left its route on purpose and when it was back: pairs of times of day in seconds."""
        pairs, begun = [], None
        for stamp_ns, text in self.ask(f"SELECT stamp_ns, text FROM events WHERE id > {number} ORDER BY id"):
            if "-> detouring" in text and begun is None:
                begun = stamp_ns / 1e9
            elif "-> driving" in text and begun is not None:
                pairs.append((begun, stamp_ns / 1e9))
                begun = None
        return pairs + ([(begun, math.inf)] if begun is not None else [])

    def end(self, limit_s=60):
        self.process.send_signal(signal.SIGINT)
        status = self.process.wait(limit_s)
        if status != 0:
            raise SystemExit(f"{self.name} ended with {status}:\n{self.log.read_text()}")

    def kill(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait(20)


class Routes:
    """The legs of a site's routes, as drawn."""

    def __init__(self, site):
        with open(site / "routes/path.csv", encoding="utf-8-sig") as file:
            at = {row["ID"]: (float(row["x"]), float(row["y"])) for row in csv.DictReader(file)}
        with open(site / "routes/tree.csv", encoding="utf-8-sig") as file:
            self.legs = [(at[row["ID"]], at[to]) for row in csv.DictReader(file) for to in row["EDA"].split()]

    def distance_m(self, x, y):
        """To the nearest leg."""
        nearest = math.inf
        for (ax, ay), (bx, by) in self.legs:
            length = (bx - ax) ** 2 + (by - ay) ** 2
            share = max(0.0, min(1.0, ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / length)) if length else 0.0
            nearest = min(nearest, math.hypot(x - ax - share * (bx - ax), y - ay - share * (by - ay)))
        return nearest
