"""What can be done to a running `madori run`: wires that a test holds in its hand, and the table of faults."""

import os
import pty
import random
import resource
import select
import signal
import socket
import sqlite3
import subprocess
import threading
import time
import tty

DATA_BYTES = 1206


class LidarWire:
    """Between the virtual lidar and the program; `fault(packet)` gives what is sent in its place."""

    def __init__(self, sim_port, run_port):
        self.fault, self.run_port = None, run_port
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        self.socket.bind(("127.0.0.1", sim_port))
        self.stranger = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        threading.Thread(target=self.pass_on, daemon=True).start()

    def pass_on(self):
        while True:
            packet = self.socket.recv(2048)
            for out in self.fault(packet) if self.fault else [packet]:
                self.socket.sendto(out, ("127.0.0.1", self.run_port))

    def spoof(self, packet):
        """Another sender's valid packets, turned by a quarter, beside the true ones."""
        turned = bytearray(packet)
        for block in range(12):
            at = 100 * block + 2
            azimuth = (int.from_bytes(turned[at:at + 2], "little") + 9000) % 36000
            turned[at:at + 2] = azimuth.to_bytes(2, "little")
        self.stranger.sendto(turned, ("127.0.0.1", self.run_port))
        return [packet]


class DriveWire:
    """Between the virtual drive and the program, a pseudo-terminal of its own; `fault(bytes, to_drive)` likewise."""

    def __init__(self, sim_device):
        self.fault = None
        self.run_end, far = pty.openpty()
        tty.setraw(self.run_end)
        tty.setraw(far)
        self.name, self.kept = os.ttyname(far), far
        self.sim_end = os.open(sim_device, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(self.sim_end)
        threading.Thread(target=self.pass_on, daemon=True).start()

    def pass_on(self):
        while True:
            for ready in select.select([self.run_end, self.sim_end], [], [])[0]:
                data = os.read(ready, 4096)
                to_drive = ready == self.run_end
                data = self.fault(data, to_drive) if self.fault else data
                if data:
                    os.write(self.sim_end if to_drive else self.run_end, data)


class Scene:
    """What a fault acts on."""

    def __init__(self, madori, site, factory, run, lidar, drive, seed):
        self.madori, self.site, self.factory, self.run = madori, site, factory, run
        self.lidar, self.drive, self.chance = lidar, drive, random.Random(seed)

    def lidar_does(self, fault, seconds):
        self.lidar.fault = fault
        time.sleep(seconds)
        self.lidar.fault = None

    def drive_does(self, fault, seconds):
        self.drive.fault = fault
        time.sleep(seconds)
        self.drive.fault = None

    def damaged(self, data, share):
        """Some bytes of some packets are others."""
        if self.chance.random() > share:
            return data
        out = bytearray(data)
        for _ in range(20):
            out[self.chance.randrange(len(out))] = self.chance.randrange(256)
        return bytes(out)

    def stopped(self, seconds):
        self.run.process.send_signal(signal.SIGSTOP)
        time.sleep(seconds)
        self.run.process.send_signal(signal.SIGCONT)

    def limited(self, what, value, seconds):
        before = resource.prlimit(self.run.process.pid, what)
        resource.prlimit(self.run.process.pid, what, (value, before[1]))
        time.sleep(seconds)
        resource.prlimit(self.run.process.pid, what, before)

    def database_locked(self, seconds):
        wire = sqlite3.connect(self.site / "madori.db", timeout=10, isolation_level=None)
        wire.execute("BEGIN EXCLUSIVE")
        time.sleep(seconds)
        wire.execute("ROLLBACK")
        wire.close()

    def second_program(self):
        answer = subprocess.run(
            [self.madori, "run", self.site, "--hmi", "off", "--no-record", "--lidar-port", "0", "--position-port", "0",
             "--drive", self.drive.name], capture_output=True, text=True, timeout=20)
        assert answer.returncode == 1 and "another program" in answer.stderr, answer.stderr


def drop(share):
    return lambda scene: lambda packet: [] if scene.chance.random() < share else [packet]


# The virtual drive brakes from 1 m/s within 0.44 s; the cycle needs 0.35 s to miss a lidar and 0.3 s to miss the drive, the
# drive 0.2 s to miss the cycle.
# name, what is done, expected: "stands" within the limit or "goes on", what the operator reads (any of), limit in s
FAULTS = [
    ("lidar silent for 2 s", lambda s: s.lidar_does(lambda p: [], 2.0), "stands", ["the lidar is silent"], 1.0),
    ("10 % of the lidar's packets lost", lambda s: s.lidar_does(drop(0.1)(s), 3.0), "goes on", [], 0.0),
    ("packets of another sender, turned by 90 degrees", lambda s: s.lidar_does(s.lidar.spoof, 5.0), "goes on", [], 0.0),
    ("packets of a wrong length in between", lambda s: s.lidar_does(lambda p: [p[:1000], p, p + b"x"], 3.0), "goes on",
     [], 0.0),
    ("5 % of the lidar's packets damaged", lambda s: s.lidar_does(lambda p: [s.damaged(p, 0.05)], 3.0), "any", [], 0.0),
    ("drive silent for 1 s", lambda s: s.drive_does(lambda d, to: d if to else b"", 1.0), "stands",
     ["the drive does not answer"], 1.0),
    ("no command reaches the drive for 1 s", lambda s: s.drive_does(lambda d, to: b"" if to else d, 1.0), "stands", [],
     0.85),
    ("program stopped for 2 s (SIGSTOP)", lambda s: s.stopped(2.0), "stands", ["the program stood still"], 0.85),
    ("database locked for 3 s", lambda s: s.database_locked(3.0), "any", [], 0.0),
    ("no file may grow for 3 s (full disk)", lambda s: s.limited(resource.RLIMIT_FSIZE, 1000, 3.0), "any", [], 0.0),
    ("no new file handle for 3 s", lambda s: s.limited(resource.RLIMIT_NOFILE, 3, 3.0), "any", [], 0.0),
    ("a second program on the site", lambda s: s.second_program(), "goes on", [], 0.0),
]
