#!/usr/bin/python3
"""The wires to lidar and drive, in a test's hand: both pass everything on until "lidar off", "drive off" or "motors off" (the
drive answers as ever, and does nothing that it is told) comes on stdin.
Usage: wires.py SIM_LIDAR_PORT RUN_LIDAR_PORT SIM_DRIVE_DEVICE; prints the name of the device to drive through."""
import pathlib
import sys

TESTS = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(TESTS / "campaign"), str(TESTS / "end_to_end")]

from faults import DriveWire, Frames, LidarWire, speeds  # noqa: E402


def silence(*_):
    return []


def main():
    sim_port, run_port, device = sys.argv[1:]
    lidar, drive = LidarWire(int(sim_port), int(run_port)), DriveWire(pathlib.Path(device))
    print(f"wires {drive.name}", flush=True)
    for line in sys.stdin:
        which, state = line.split()
        fault = None
        if state == "off":
            fault = Frames(speeds(0.0, 0.0), to_drive=True) if which == "motors" else silence
        if which == "lidar":
            lidar.fault = fault
        else:
            drive.fault = fault
        print(f"{which} is {state}", flush=True)


main()
