#!/usr/bin/env python3
"""The vehicle's cycle while its panel is attacked: the real program (`madori run --hmi`) with the virtual factory
driving, an honest panel that looks on, and one attack after the other, each between two quiet spells of the same run.

    cmake --build build/release --target madori panel panel_attacker
    tests/bench/panel_attack.py build/release [--seconds 20] [--json FILE]

The figure is the answer time of a step: from when it was due to when its command has gone out (late + step). Undisturbed
means: its p99 stays below the cycle's period of 20 ms, no answer takes 200 ms (where the drive stops by itself), no
attack is taken, the honest panel still gets states. Exits 1 otherwise.
"""
import argparse
import csv
import http.client
import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PERIOD_MS, SILENCE_MS = 20.0, 200.0
PINS = {"viewer": "1111", "operator": "2222", "integrator": "3333"}
ATTACKS = {"wrong-origin": "operator", "no-pin": None, "wrong-role": "viewer", "traversal": "viewer",
           "upload": "integrator", "half-open": None, "bad-json": "operator", "bad-frames": "operator"}


def free_port(kind):
    with socket.socket(socket.AF_INET, kind) as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def wait_for(process, text):
    for line in process.stdout:
        if text in line:
            return
    sys.exit(f"{process.args[:2]} ended before it said \"{text}\"")


def login(port, role):
    link = http.client.HTTPConnection("127.0.0.1", port)
    link.request("POST", "/api/session", json.dumps({"pin": PINS[role]}), {"Origin": f"http://127.0.0.1:{port}"})
    answer = link.getresponse()
    return answer.getheader("Set-Cookie").split("=")[1].split(";")[0]


def call(port, session, method, path, body=None):
    link = http.client.HTTPConnection("127.0.0.1", port)
    link.request(method, path, None if body is None else json.dumps(body),
                 {"Origin": f"http://127.0.0.1:{port}", "Cookie": f"madori_session={session}"})
    answer = link.getresponse()
    text = answer.read()
    if answer.status != 200:
        sys.exit(f"{method} {path}: {answer.status} {text[:200]}")
    return json.loads(text)


class Vehicle:
    """The virtual factory and the vehicle's program in a folder of their own, driving one order again and again."""

    def __init__(self, build, data, folder, recorded):
        self.madori, self.site, self.times = build / "madori", folder / "site", folder / "times.csv"
        lidar, self.port = free_port(socket.SOCK_DGRAM), free_port(socket.SOCK_STREAM)
        subprocess.run([self.madori, "demo", "--import-only", "--site", self.site, "--data", data, "--json", folder / "i.json"],
                       check=True, stdout=subprocess.DEVNULL)
        for role, pin in PINS.items():
            subprocess.run([self.madori, "pin", self.site, role], input=pin, text=True, check=True, stdout=subprocess.DEVNULL)
        self.factory = subprocess.Popen([self.madori, "sim", self.site, "--scenario", data / "scenarios/demo.yaml",
                                         "--lidar-port", str(lidar)], stdout=subprocess.PIPE, text=True)
        wait_for(self.factory, "truth")
        stops = ["--to", "7,5", "--repeat", "1000"]
        subprocess.run([self.madori, "order", self.site, *stops], check=True, stdout=subprocess.DEVNULL)
        self.program = subprocess.Popen(
            [self.madori, "run", self.site, "--hmi", f"127.0.0.1:{self.port}", "--lidar-port", str(lidar), "--position-port",
             str(free_port(socket.SOCK_DGRAM)), "--drive", self.site / "devices/drive", "--resume", "--cycle-times",
             self.times, *([] if recorded else ["--no-record"])],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        wait_for(self.program, "panel at")
        self.log = []

    def end(self):
        self.program.send_signal(signal.SIGTERM)
        self.log = self.program.communicate(timeout=30)[0].splitlines()
        self.factory.send_signal(signal.SIGTERM)
        self.factory.communicate(timeout=30)
        with self.times.open() as file:
            return [(float(r["due_s"]), float(r["late_ms"]) + float(r["step_ms"]), float(r["step_ms"])) for r in csv.DictReader(file)]

    def kill(self):
        for process in (self.program, self.factory):
            if process.poll() is None:
                process.kill()


def wait_until_driving(vehicle, session):
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline:
        if call(vehicle.port, session, "GET", "/api/statistics")["distance_m"] > 1.0:
            return
        time.sleep(0.5)
    sys.exit("the vehicle did not begin to drive within 60 s")


def share(values, part):
    ordered = sorted(values)
    return ordered[int(part * (len(ordered) - 1))]


def figures(name, steps, begin, end):
    answer = [s[1] for s in steps if begin <= s[0] < end]
    step = [s[2] for s in steps if begin <= s[0] < end]
    return {"phase": name, "steps": len(answer), "expected": round((end - begin) / (PERIOD_MS / 1e3)),
            "median_ms": share(answer, 0.5), "p99_ms": share(answer, 0.99), "most_ms": max(answer), "step_p99_ms": share(step, 0.99)}


def attack(build, vehicle, kind, session, seconds, niceness):
    attacker = build / "tests/bench/panel_attacker"
    def run(what, cookie):
        return subprocess.Popen(["nice", "-n", str(niceness), attacker, what, str(vehicle.port), str(seconds), *([cookie] if cookie else [])],
                                stdout=subprocess.PIPE, text=True)
    before = call(vehicle.port, session["operator"], "GET", "/api/statistics")
    begin = time.monotonic()
    honest = run("look-on", session["viewer"])
    attacking = None if kind == "quiet" else run(kind, session[ATTACKS[kind]] if ATTACKS[kind] else None)
    time.sleep(seconds)
    end = time.monotonic()
    result = {"begin": begin, "end": end}
    for process in filter(None, (honest, attacking)):
        text = process.communicate(timeout=60)[0]
        result.update(json.loads(text) if text else {"states_a_second": 0.0})
    after = call(vehicle.port, session["operator"], "GET", "/api/statistics")
    result["driven_m"] = after["distance_m"] - before["distance_m"]
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=Path)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--record", action="store_true", help="record the run, 6 MB a second")
    parser.add_argument("--nice", type=int, default=10, help="of attacker and looker-on, which would be other machines")
    parser.add_argument("--only", nargs="*", choices=sorted(ATTACKS), default=list(ATTACKS))
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    build = arguments.build.resolve()
    data = Path(__file__).resolve().parents[2] / "data"
    rows = []
    with tempfile.TemporaryDirectory(prefix="madori-attack-") as folder:
        vehicle = Vehicle(build, data, Path(folder), arguments.record)
        try:
            session = {role: login(vehicle.port, role) for role in PINS}
            wait_until_driving(vehicle, session["operator"])
            phases = [phase for kind in arguments.only for phase in ("quiet", kind)] + ["quiet"]
            spells = [(kind, attack(build, vehicle, kind, session, arguments.seconds, arguments.nice)) for kind in phases]
            steps = vehicle.end()
        finally:
            vehicle.kill()
    for kind, spell in spells:
        rows.append({**spell, **figures(kind, steps, spell["begin"], spell["end"])})
    bad = False
    print(f"load {os.getloadavg()[0]:.1f}; answer time of a step, ms")
    print("phase          steps  median     p99    most  p99/quiet  tries  taken  panel Hz  silence s  driven m")
    for i, row in enumerate(rows):
        around = [rows[j]["p99_ms"] for j in (i - 1, i + 1) if 0 <= j < len(rows) and rows[j]["phase"] == "quiet"]
        row["ratio"] = 1.0 if row["phase"] == "quiet" else row["p99_ms"] / max(1e-9, sum(around) / len(around))
        good = row["p99_ms"] < PERIOD_MS and row["most_ms"] < SILENCE_MS and row.get("taken", 0) == 0 and row["states_a_second"] > 1.0
        bad |= row["phase"] != "quiet" and not good
        print(f"{row['phase']:13}{row['steps']:7}{row['median_ms']:8.2f}{row['p99_ms']:8.2f}{row['most_ms']:8.1f}{row['ratio']:11.2f}"
              f"{row.get('tries', 0):7}{row.get('taken', 0):7}{row['states_a_second']:10.1f}{row.get('longest_silence_s', 0):11.2f}"
              f"{row['driven_m']:10.1f}{'' if good else '  DISTURBED'}")
    faults = [line for line in vehicle.log if "fault" in line.lower()]
    print(f"faults said by the vehicle: {len(faults)}", *faults[:5], sep="\n  ")
    if arguments.json:
        arguments.json.write_text(json.dumps(rows, indent=1))
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
