"""The computer's clocks jump and drift under a `madori run` that drives at 1 m/s against a `madori sim`.

Debian's faketime moves the time of day of `madori run` alone, or the monotonic clock with it; the virtual factory keeps
the true time. After each change the vehicle stays on its route and either drives on or stands within 0.5 s, the event
log says what the clock did, nobody has to confirm anything, and it goes on delivering.

    clock_test.py MADORI DATA [--all] [--only WORD]
"""

import argparse
import pathlib
import tempfile
import time

from running import STANDS_MPS, Factory, Routes, Run, wait_for
from sample_site import make_site

FAKE = "/usr/lib/x86_64-linux-gnu/faketime/libfaketimeMT.so.1"
STEP, RUNS, BACK, GAP = "time of day was set", "time of day runs", "monotonic clock went back", "the program stood still"
# what faketime is told, which clocks, what the log must say (one of), whether it is in the short form
CHANGES = [
    ("+3600", "day", [STEP], False), ("-7200", "day", [STEP], True), ("-3600", "day", [STEP], False),
    ("+0", "day", [STEP], False), ("+0.2", "day", [STEP], False), ("-0.2", "day", [STEP], False),
    ("+10y", "day", [STEP], False), ("-10y", "day", [STEP], False), ("+0", "day", [STEP], False),
    ("+0 x1.2", "day", [RUNS, STEP], False), ("+0 x0.8", "day", [RUNS, STEP], False), ("+0", "day", [RUNS, STEP], False),
    ("+3600", "both", [GAP], True), ("+0", "both", [BACK], True), ("-3600", "both", [BACK], False),
    ("+0", "both", [GAP], False), ("+0.15", "both", None, False), ("+1", "both", [GAP], False),
    ("-1", "both", [BACK], False), ("-1 x1.05", "both", None, False), ("-1 x0.95", "both", None, False),
    ("+86400", "both", [GAP], False),
]
parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
parser.add_argument("madori")
parser.add_argument("data", type=pathlib.Path)
parser.add_argument("--all", action="store_true", help="every change, not the short form")
parser.add_argument("--only", choices=["day", "both"])
arguments = parser.parse_args()
OFF_ROUTE_M = 0.25


def stood_after(factory, moment, end):
    """Seconds after `moment` until the vehicle first stood; None where it never did until `end`."""
    for truth in factory.truth.since(moment):
        if truth["received"] > end:
            return None
        if abs(truth["linear_mps"]) < STANDS_MPS:
            return truth["received"] - moment
    return None


def change(factory, run, routes, file, told, words):
    """One change while it drives at full speed; returns a line of the report, or raises SystemExit."""
    wait_for(lambda: factory.truth.newest()["linear_mps"] > 0.9, f"{told}: it does not drive; log:\n{run.log.read_text()}")
    before, done = run.last_event(), run.stops_done()
    moment = time.time()
    file.write_text(told + "\n")
    wait_for(lambda: run.stops_done() > done, f"{told}: it does not go on; log:\n{run.log.read_text()}", 90)
    path = factory.truth.since(moment)
    off_m = max(routes.distance_m(t["x_m"], t["y_m"]) for t in path)
    events = run.events_after(before)
    said = [word for word in words or [] if any(word in event for event in events)]
    stood_s = stood_after(factory, moment, moment + 3.0)
    line = (f"{told:>9}: " + (f"stood after {stood_s:.2f} s" if stood_s is not None else "drove on")
            + f", {off_m:.3f} m off the route at most; said: {said[0] if said else '-'}")
    print(line, flush=True)
    for fault, text in ((off_m > OFF_ROUTE_M, "left its route"), (words and not said, "did not say what the clock did"),
                        (any("emergency" in event for event in events), "told an emergency stop"),
                        (factory.truth.newest()["collisions"], "collided")):
        if fault:
            raise SystemExit(f"{told}: {text}\n" + "\n".join(events))
    if words and GAP in words and (stood_s is None or stood_s > 0.5):
        raise SystemExit(f"{told}: it did not stand within 0.5 s")


def main():
    with tempfile.TemporaryDirectory() as name:
        folder, site = pathlib.Path(name), pathlib.Path(name) / "site"
        make_site(arguments.madori, arguments.data, site, quiet=True)
        routes = Routes(site)
        factory = Factory(arguments.madori, folder, site)
        try:
            for clocks in ("day", "both"):
                if arguments.only in (None, clocks):
                    drive(folder, site, factory, routes, clocks)
        finally:
            factory.end()


def drive(folder, site, factory, routes, clocks):
    file = folder / f"{clocks}.faketime"
    file.write_text("+0\n")
    env = {"LD_PRELOAD": FAKE, "FAKETIME_TIMESTAMP_FILE": str(file), "FAKETIME_NO_CACHE": "1",
           "FAKETIME_DONT_FAKE_MONOTONIC": "1" if clocks == "day" else "0"}
    run = Run(arguments.madori, folder, site, factory, clocks, env, ["--no-record"])
    try:
        run.order([13, 15], repeat=500)
        run.resume()
        for told, which, words, short in CHANGES:
            if which == clocks and (short or arguments.all):
                change(factory, run, routes, file, told, words)
        run.cancel_orders()
        run.end()
    finally:
        run.kill()


main()
