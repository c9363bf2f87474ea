#!/usr/bin/python3
"""The wires to lidar and drive, in a test's hand: both pass everything on until "lidar off" or "drive off" comes on stdin.
Usage: wires.py SIM_LIDAR_PORT RUN_LIDAR_PORT SIM_DRIVE_DEVICE; prints the name of the device to drive through."""
import pathlib
import sys

TESTS = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(TESTS / "campaign"), str(TESTS / "end_to_end")]

from faults import DriveWire, LidarWire  # noqa: E402


def silence(*_):
    return []


def main():
    sim_port, run_port, device = sys.argv[1:]
    lidar, drive = LidarWire(int(sim_port), int(run_port)), DriveWire(device)
    print(f"wires {drive.name}", flush=True)
    for line in sys.stdin:
        which, state = line.split()
        fault = silence if state == "off" else None
        if which == "lidar":
            lidar.fault = fault
        else:
            drive.fault = fault
        print(f"{which} is {state}", flush=True)


main()
