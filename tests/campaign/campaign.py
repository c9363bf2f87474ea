"""Faults of the running system, from one table (faults.py): `madori run` drives orders at 1 m/s in the virtual factory on
real sockets; each fault is done to it while it drives. It must stand within the limit or go on as the table says, tell
the operator why, stay on its route, collide with nothing, and deliver again by itself.

    campaign.py MADORI DATA [--lidar vlp16|lms1xx|s300,lms1xx] [--seeds 5] [--first-seed 1] [--only PATTERN] [--short]
                [--table FILE.md] [--keep FOLDER]
"""

import argparse
import contextlib
import pathlib
import re
import signal
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "end_to_end")]

from faults import FAULTS, DriveWire, LidarWire, Scene  # noqa: E402
from more_faults import MORE_FAULTS  # noqa: E402
from truth_listener import come_first  # noqa: E402
from running import STANDS_MPS, Factory, Routes, Run, free_port, wait_for  # noqa: E402
from sample_site import make_site, mount  # noqa: E402
from scanner_faults import SCANNER_FAULTS, SCANNERS, mounted  # noqa: E402

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
parser.add_argument("madori")
parser.add_argument("data", type=pathlib.Path)
parser.add_argument("--lidar", default="vlp16", choices=["vlp16", *SCANNERS], help="what it sees with; each has a table of its own")
parser.add_argument("--seeds", type=int, default=1)
parser.add_argument("--first-seed", type=int, default=1, help="seeds are shared out to several processes by it")
parser.add_argument("--only", default="", help="faults whose name has this pattern")
parser.add_argument("--short", action="store_true", help="ten of them, for ./test")
parser.add_argument("--table", type=pathlib.Path, help="writes what was measured as a table")
parser.add_argument("--keep", type=pathlib.Path, help="an empty folder for sites, logs and recordings, to look at afterwards")
arguments = parser.parse_args()
signal.signal(signal.SIGHUP, signal.SIG_DFL)  # under nohup `madori run` would inherit that it is ignored
OFF_ROUTE_M = 0.3
ASKS_AFTER_S = 30
STATES = {"localizing", "driving", "detouring", "waiting", "paused", "emergency_stop", "fault", "idle", "manual"}


def stands_after(factory, moment, end):
    for truth in factory.truth.since(moment):
        if truth["received"] <= end and abs(truth["linear_mps"]) < STANDS_MPS:
            return truth["received"] - moment
    return None


def try_fault(scene, routes, fault):
    """One fault; what was seen, and what of it is wrong."""
    name, expected, words, limit_s = fault.name, fault.expected, fault.told, fault.limit_s
    factory, run = scene.factory, scene.run
    wait_for(lambda: factory.truth.newest()["linear_mps"] > 0.9 or run.process.poll() is not None,
             f"{name}: it does not drive:\n{run.log.read_text()[-2000:]}", 90)
    before, done, moment = run.last_event(), run.stops_done(), time.time()
    fault.act(scene)
    acted_s = time.time() - moment
    run = scene.run  # it may be another life
    if fault.then:
        wait_for(lambda: factory.speed() < STANDS_MPS, f"{name}: it does not come to stand", 30)
        time.sleep(1.0)
        for word in fault.then:
            run.say(word)
            time.sleep(0.3)
    begun = time.monotonic()
    end = begun + 120

    def goes_on():
        """Delivers again; in the short form: drives again."""
        return run.stops_done() > done or (arguments.short and factory.truth.newest()["linear_mps"] > 0.9)

    asked = False
    while not (went_on := goes_on()) and run.process.poll() is None and time.monotonic() < end:
        time.sleep(0.05)
        # A person who reads it does what it says.
        if time.monotonic() - begun > ASKS_AFTER_S and not asked and run.newest_event().endswith("then press Resume"):
            asked = run.say("resume") or True
    stood_s = stands_after(factory, moment, moment + acted_s)
    detours = run.detours_after(before)
    off_m = max((routes.distance_m(t["x_m"], t["y_m"]) for t in factory.truth.since(moment)
                 if not any(begun <= t["received"] <= ended for begun, ended in detours)), default=0.0)
    log = run.events_after(before)
    told = [word for word in words if any(word in event for event in log)]
    wrong = []
    if not went_on:
        wrong.append("does not go on:\n" + "\n".join(run.log.read_text().splitlines()[-12:]))
    if run.process.poll() is not None:
        wrong.append(f"the program ended: {run.log.read_text()[-500:]}")
    if expected == "stands" and (stood_s is None or stood_s > limit_s):
        wrong.append(f"stood after {stood_s}, not within {limit_s} s")
    if expected == "goes on" and any("silent" in event or "does not answer" in event for event in log):
        wrong.append(f"was disturbed: {log}")
    if words and not told:
        wrong.append(f"nobody was told: {log}")
    if off_m > OFF_ROUTE_M:
        wrong.append(f"{off_m:.2f} m off its route")
    # Every line that an operator reads of a standstill says what to do: cause - remedy.
    silent = [event for event in log if event.split(":")[0] in STATES and " - " not in event]
    if silent:
        wrong.append(f"without a remedy: {silent}")
    if factory.truth.newest()["collisions"]:
        wrong.append("collided")
    return {"fault": name, "stood_s": stood_s, "told": told, "off_m": off_m, "again_s": time.monotonic() - begun,
            "around": bool(detours), "asked": asked, "wrong": wrong}


def scene_of(seed, folder):
    """A factory and a program that drives in it."""
    folder.mkdir(parents=True)
    site = folder / "site"
    make_site(arguments.madori, arguments.data, site, quiet=True)
    if arguments.lidar in SCANNERS:
        mount(site, SCANNERS[arguments.lidar])
    factory, run_port, lives = Factory(arguments.madori, folder, site), free_port(), iter(range(1, 1000))
    lidar, drive = LidarWire(factory.lidar_port, run_port), DriveWire(factory.devices / "drive")

    def life(more=(), **others):
        return Run(arguments.madori, folder, site, factory, name=f"run{next(lives)}", lidar_port=run_port, drive=drive.name,
                   more=(*scanners, *more), **others)

    scene = Scene(arguments.madori, site, factory, None, lidar, drive, seed, life)
    scanners = mounted(scene, factory)
    scene.run = life()
    scene.run.order([13, 15], repeat=900)
    scene.run.resume()
    return scene


def end_well(run):
    """Status 0; or 1, and that is said, where what it printed was lost while no file could grow."""
    run.process.send_signal(signal.SIGINT)
    status = run.process.wait(60)
    if status != 0 and not (status == 1 and "standard output: could not be written" in run.log.read_text()):
        raise SystemExit(f"{run.name} ended with {status}:\n{run.log.read_text()}")


def how(rows):
    """What else was done until it drove again."""
    return (", a way around" if any(row["around"] for row in rows) else "") + (
        ", a person was asked" if any(row["asked"] for row in rows) else "")


def tell(row):
    stood = f"stood after {row['stood_s']:.2f} s" if row["stood_s"] is not None else "drove on"
    print(f"{row['fault']:>50}: {stood}; {row['off_m']:.2f} m off{how([row])}; {'; '.join(row['wrong']) or 'good'}", flush=True)


def campaign(seed, rows):
    """Every fault of the table; one that left something wrong is the last of its scene."""
    scene = None
    with contextlib.nullcontext(arguments.keep) if arguments.keep else tempfile.TemporaryDirectory() as name:
        try:
            for number, fault in enumerate(SCANNER_FAULTS.get(arguments.lidar, FAULTS + MORE_FAULTS)):
                if not re.search(arguments.only, fault.name) or (arguments.short and not fault.short):
                    continue
                scene = scene or scene_of(seed, pathlib.Path(name) / f"{seed}-{number}")
                try:
                    row = try_fault(scene, Routes(scene.site), fault)
                except (SystemExit, AssertionError) as error:  # what never came, or was answered otherwise
                    row = {"fault": fault.name, "stood_s": None, "told": [], "off_m": 0.0, "around": False,
                           "asked": False, "wrong": [str(error)]}
                rows.append({**row, "seed": seed})
                tell(rows[-1])
                if arguments.table:  # after each: a run that is ended early leaves what it has
                    arguments.table.write_text(table(rows))
                if rows[-1]["wrong"]:
                    scene.end()
                    scene = None
            if scene:
                scene.run.cancel_orders()
                end_well(scene.run)
        finally:
            if scene:
                scene.end()


def table(rows):
    text = "| fault | stands after (longest) | told | off its route (farthest) | as expected |\n| --- | --- | --- | --- | --- |\n"
    for name in dict.fromkeys(row["fault"] for row in rows):
        of = [row for row in rows if row["fault"] == name]
        stood = [row["stood_s"] for row in of if row["stood_s"] is not None]
        text += (f"| {name} | {f'{max(stood):.2f} s' if stood else 'drives on'}{how(of)} | {', '.join(of[0]['told']) or '-'} "
                 f"| {max(row['off_m'] for row in of):.2f} m | {sum(not row['wrong'] for row in of)} of {len(of)} |\n")
    return text


come_first()  # it shares its interpreter with the wires
rows = []
for seed in range(arguments.first_seed, arguments.first_seed + arguments.seeds):
    campaign(seed, rows)
wrong = [f"{row['fault']}: {'; '.join(row['wrong'])}" for row in rows if row["wrong"]]
if wrong:
    raise SystemExit("\n".join(wrong))
print(f"{len(rows)} faults, each as expected")
