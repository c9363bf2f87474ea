"""What can be done to a running `madori run`: wires that a test holds in its hand, and the table of faults."""

import binascii
import http.client
import json
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
from dataclasses import dataclass, field
from typing import Callable

from truth_listener import come_first


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
        come_first()
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

    def __init__(self, sim_device, name="wire"):
        self.fault, self.name = None, sim_device.with_name(name)
        self.sim_end = os.open(sim_device, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(self.sim_end)
        self.plug_in()
        threading.Thread(target=self.pass_on, daemon=True).start()

    def plug_in(self):
        """The program's end, by a name that stays."""
        run_end, far = pty.openpty()
        tty.setraw(run_end)
        tty.setraw(far)
        self.name.unlink(missing_ok=True)
        self.name.symlink_to(os.ttyname(far))
        self.run_end, self.kept = run_end, far

    def unplug(self):
        """The device is gone, as a USB adapter whose plug is pulled."""
        ends, self.run_end = (self.run_end, self.kept), None
        self.name.unlink()
        for end in ends:
            os.close(end)

    def pass_on(self):
        come_first()
        while True:
            ends = [end for end in (self.run_end, self.sim_end) if end is not None]
            try:
                for ready in select.select(ends, [], [], 0.05)[0]:
                    data = os.read(ready, 4096)
                    if not data:
                        return  # the virtual drive has gone
                    to_drive = ready != self.sim_end
                    data = self.fault(data, to_drive) if self.fault else data
                    out = self.sim_end if to_drive else self.run_end
                    if data and out is not None:
                        os.write(out, data)
            except (OSError, ValueError):
                if self.run_end in ends:  # not the end that was unplugged
                    raise


def unstuffed(frame):
    """A frame of the drive's link without its closing zero, as it was before byte stuffing (COBS); None: damaged."""
    raw, i = bytearray(), 0
    while i < len(frame):
        code = frame[i]
        if code == 0 or i + code > len(frame):
            return None
        raw += frame[i + 1:i + code]
        i += code
        if i < len(frame) and code != 0xFF:
            raw.append(0)
    return raw


def stuffed(raw):
    """The same back, with its checksum made anew and its closing zero."""
    raw[-2:] = binascii.crc_hqx(bytes(raw[:-2]), 0xFFFF).to_bytes(2, "little")
    out, block = bytearray(), bytearray()
    for byte in raw:
        if byte == 0:
            out += bytes([len(block) + 1]) + block
            block = bytearray()
        else:
            block.append(byte)
    return bytes(out + bytes([len(block) + 1]) + block + b"\0")


class Frames:
    """Cuts one direction of the drive's link into frames; `edit(raw)` may change one in place, or return False: lost."""

    def __init__(self, edit, to_drive):
        self.edit, self.to_drive, self.rest = edit, to_drive, b""

    def __call__(self, data, to_drive):
        if to_drive != self.to_drive:
            return data
        *frames, self.rest = (self.rest + data).split(b"\0")
        out = b""
        for frame in frames:
            raw = unstuffed(frame)
            if raw is None or len(raw) < 6:
                out += frame + b"\0"
            elif self.edit(raw) is not False:
                out += stuffed(raw)
        return out


def number(raw, at, size=2, signed=False, order="little"):
    return int.from_bytes(raw[at:at + size], order, signed=signed)


def put(raw, at, value, size=2, order="little"):
    raw[at:at + size] = (value % (1 << 8 * size)).to_bytes(size, order)


def wire_does(wire, fault, seconds):
    wire.fault = fault
    time.sleep(seconds)
    wire.fault = None


def unplugged(wire, seconds):
    wire.unplug()
    time.sleep(seconds)
    wire.plug_in()


class Scene:
    """What a fault acts on."""

    def __init__(self, madori, site, factory, run, lidar, drive, seed, again):
        """`again()`: the program begun anew."""
        self.madori, self.site, self.factory, self.run, self.again = madori, site, factory, run, again
        self.lidar, self.drive, self.chance = lidar, drive, random.Random(seed)

    def lidar_does(self, fault, seconds):
        wire_does(self.lidar, fault, seconds)

    def drive_does(self, fault, seconds):
        wire_does(self.drive, fault, seconds)

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


    def statuses(self, edit, seconds):
        """What the drive says is edited (docs/reference/drive-link.md)."""
        self.drive_does(Frames(edit, to_drive=False), seconds)

    def commands(self, edit, seconds):
        self.drive_does(Frames(edit, to_drive=True), seconds)

    def drive_is(self, edit, seconds):
        """The drive holds its motors and says why."""
        said, held = Frames(edit, to_drive=False), Frames(lambda raw: put(raw, 4, 0, 1), to_drive=True)
        self.drive_does(lambda data, to_drive: held(data, True) if to_drive else said(data, False), seconds)

    def file_is(self, name, content, seconds):
        """A file of the site is another for a while; `content` None: it is gone."""
        path = self.site / name
        before = path.read_bytes()
        path.unlink() if content is None else path.write_bytes(content(before))
        time.sleep(seconds)
        path.write_bytes(before)

    def busy(self, seconds, programs=4):
        """Other programs of ordinary priority want every core."""
        others = [subprocess.Popen(["python3", "-c", "while True: pass"]) for _ in range(programs)]
        time.sleep(seconds)
        for other in others:
            other.kill()
            other.wait()

    def half_open(self, seconds, connections=300):
        """Connections to the panel that say half a request and no more."""
        held = []
        for _ in range(connections):
            try:
                wire = socket.create_connection(("127.0.0.1", self.run.port), timeout=1)
                wire.sendall(b"GET /api/session HTTP/1.1\r\nHost: ")
                held.append(wire)
            except OSError:
                break
        time.sleep(seconds)
        for wire in held:
            wire.close()

    def post(self, path, body):
        wire = http.client.HTTPConnection("127.0.0.1", self.run.port, timeout=3)
        wire.request("POST", path, json.dumps(body), {"Origin": f"http://127.0.0.1:{self.run.port}",
                                                      "Content-Type": "application/json"})
        return wire.getresponse().status

    def words(self, words, pause_s=0.5):
        for word in words:
            self.run.say(word)
            time.sleep(pause_s)

    def tap_beside(self, metres):
        """A person says that it stands `metres` from where it is; the answer's status."""
        truth = self.factory.truth.newest()
        return self.post("/api/vehicle/pose", {"x": truth["x_m"] + metres, "y": truth["y_m"], "yaw": truth["yaw_rad"]})

    def tap_while_driving(self):
        status = self.tap_beside(3.0)
        assert status == 409, f"a vehicle that drives takes another place: {status}"
        time.sleep(1.0)

    def tap_while_paused(self, metres):
        self.run.say("pause")
        time.sleep(2.0)
        status = self.tap_beside(metres)
        assert status == 200, f"a vehicle that stands takes no place: {status}"
        time.sleep(1.0)

    def end(self):
        self.run.kill()
        self.factory.end()

    def killed(self):
        """Power goes; the program begins anew, and a person looks around and presses Resume."""
        self.run.kill()
        time.sleep(0.5)
        self.run = self.again()
        self.run.resume()


def delayed(seconds):
    """Every packet comes so much later."""
    def of(scene):
        waiting = []

        def pass_on(packet):
            now = time.monotonic()
            waiting.append((now + seconds, packet))
            out = [p for due, p in waiting if due <= now]
            waiting[:] = [w for w in waiting if w[0] > now]
            return out
        return pass_on
    return of


def shuffled(depth):
    def of(scene):
        held = []

        def pass_on(packet):
            held.append(packet)
            if len(held) < depth:
                return []
            out = held[:]
            scene.chance.shuffle(out)
            held.clear()
            return out
        return pass_on
    return of


def repeated():
    """The packets of one revolution again and again, as from a lidar that has hung itself up."""
    kept = []

    def pass_on(packet):
        if len(kept) < 76:
            kept.append(packet)
            return [packet]
        kept.append(kept.pop(0))
        return [kept[-1]]
    return pass_on


def edited(edit):
    def pass_on(packet):
        out = bytearray(packet)
        edit(out)
        return [bytes(out)]
    return pass_on


def its_clock(microseconds):
    """The lidar's own clock (microseconds in the hour) is so far off."""
    return edited(lambda p: put(p, 1200, (number(p, 1200, 4) + microseconds) % 3_600_000_000, 4))


def ranges(new, sector=(0, 36000)):
    """Other ranges (in 2 mm) in a sector of azimuths (0.01 degrees)."""
    def edit(p):
        for block in range(12):
            at = 100 * block
            if not sector[0] <= number(p, at + 2) < sector[1]:
                continue
            for channel in range(32):
                put(p, at + 4 + 3 * channel, new(number(p, at + 4 + 3 * channel)))
    return edited(edit)


def drop(share):
    return lambda scene: lambda packet: [] if scene.chance.random() < share else [packet]


def frozen(at, size=2):
    """A number of the status stays what it was."""
    kept = []

    def edit(raw):
        kept.append(number(raw, at, size)) if not kept else put(raw, at, kept[0], size)
    return edit


def both(first, second):
    def edit(raw):
        first(raw)
        second(raw)
    return edit


def jumping(scene, at, by):
    """A number of one status in five is another: an encoder that loses its magnet."""
    return lambda raw: put(raw, at, (number(raw, at) + by) % 16384) if scene.chance.random() < 0.2 else None


def state_is(state, flags=0, faults=0):
    def edit(raw):
        raw[6] = state
        raw[7] |= flags
        put(raw, 8, number(raw, 8) | faults)
    return edit


def speeds(left, right):
    """The wheels get other shares of what was commanded: a weak motor, or one that does nothing."""
    def edit(raw):
        put(raw, 6, int(number(raw, 6, 4, True) * left), 4)
        put(raw, 10, int(number(raw, 10, 4, True) * right), 4)
    return edit


@dataclass
class Fault:
    """`expected`: "stands" within the limit, "goes on", or "any". `told`: what the operator reads, any of. `then`: what a
    person does once it stands, where it may not go on by itself."""

    name: str
    act: Callable
    expected: str = "any"
    limit_s: float = 0.0
    told: list = field(default_factory=list)
    then: list = field(default_factory=list)
    short: bool = False  # one of the ten of ./test


SILENT, DRIVE = ["the lidar is silent"], ["the drive does not answer"]
RESUME = ["confirm", "resume"]
ESTOP, BUMPER, FAULT = 3, 4, 5
WIDE = (9000, 27000)

# The virtual drive brakes from 1 m/s within 0.44 s; the cycle needs 0.35 s to miss a lidar and 0.3 s to miss the drive, the
# drive 0.2 s to miss the cycle.
LIDAR_FAULTS = [
    Fault("lidar silent for 2 s", lambda s: s.lidar_does(lambda p: [], 2.0), "stands", 1.0, SILENT, short=True),
    Fault("lidar silent for 15 s", lambda s: s.lidar_does(lambda p: [], 15.0), "stands", 1.0, SILENT),
    Fault("lidar silent for 0.2 s, ten times", lambda s: [(s.lidar_does(lambda p: [], 0.2), time.sleep(0.3)) for _ in range(10)]),
    Fault("1 % of the lidar's packets lost", lambda s: s.lidar_does(drop(0.01)(s), 3.0), "goes on"),
    Fault("10 % of the lidar's packets lost", lambda s: s.lidar_does(drop(0.1)(s), 3.0), "goes on", short=True),
    Fault("50 % of the lidar's packets lost", lambda s: s.lidar_does(drop(0.5)(s), 3.0)),
    Fault("95 % of the lidar's packets lost", lambda s: s.lidar_does(drop(0.95)(s), 5.0)),
    Fault("lidar's packets 0.2 s late", lambda s: s.lidar_does(delayed(0.2)(s), 4.0)),
    Fault("lidar's packets 1 s late", lambda s: s.lidar_does(delayed(1.0)(s), 4.0)),
    Fault("every packet of the lidar twice", lambda s: s.lidar_does(lambda p: [p, p], 3.0), "goes on"),
    Fault("pairs of packets change places", lambda s: s.lidar_does(shuffled(2)(s), 3.0), "goes on"),
    Fault("packets shuffled, 20 at a time", lambda s: s.lidar_does(shuffled(20)(s), 4.0)),
    Fault("one revolution again and again", lambda s: s.lidar_does(repeated(), 4.0)),
    Fault("one packet again and again", lambda s: s.lidar_does((lambda kept: lambda p: [kept.setdefault(0, p)])({}), 3.0),
          "stands", 1.0, SILENT, short=True),
    Fault("5 % of the lidar's packets damaged", lambda s: s.lidar_does(lambda p: [s.damaged(p, 0.05)], 3.0)),
    Fault("all of the lidar's packets damaged", lambda s: s.lidar_does(lambda p: [s.damaged(p, 1.0)], 3.0)),
    Fault("packets of a wrong length in between", lambda s: s.lidar_does(lambda p: [p[:1000], p, p + b"x"], 3.0), "goes on"),
    Fault("noise in place of the lidar's packets", lambda s: s.lidar_does(lambda p: [s.chance.randbytes(1206)], 3.0),
          "stands", 1.0, SILENT),
    Fault("another model on the lidar's port", lambda s: s.lidar_does(edited(lambda p: put(p, 1205, 0x28, 1)), 3.0),
          "stands", 1.0, ["lidar"]),
    Fault("packets of another sender, turned by 90 degrees", lambda s: s.lidar_does(s.lidar.spoof, 5.0), "goes on", short=True),
    Fault("noise of another sender beside", lambda s: s.lidar_does(
        lambda p: (s.lidar.stranger.sendto(s.chance.randbytes(1206), ("127.0.0.1", s.lidar.run_port)), [p])[1], 4.0), "goes on"),
    Fault("the lidar's clock jumps 10 s ahead and back", lambda s: s.lidar_does(its_clock(10_000_000), 3.0)),
    Fault("the lidar's clock jumps 10 s back and on", lambda s: s.lidar_does(its_clock(-10_000_000), 3.0)),
    Fault("the lidar's clock goes over the hour", lambda s: s.lidar_does(
        (lambda off: edited(lambda p: put(p, 1200, (number(p, 1200, 4) + off.setdefault(
            0, 3_598_500_000 - number(p, 1200, 4))) % 3_600_000_000, 4)))({}), 3.0)),
    Fault("the lidar sees nothing (covered)", lambda s: s.lidar_does(ranges(lambda r: 0), 4.0)),
    Fault("half of the lidar's view is covered", lambda s: s.lidar_does(ranges(lambda r: 0, WIDE), 4.0)),
    Fault("a plate 0.5 m before half of the lidar", lambda s: s.lidar_does(ranges(lambda r: 250, WIDE), 4.0)),
    Fault("all ranges 5 % too long", lambda s: s.lidar_does(ranges(lambda r: int(r * 1.05)), 4.0)),
    Fault("ranges with 0.2 m of noise", lambda s: s.lidar_does(
        ranges(lambda r: max(0, r + int(s.chance.gauss(0, 100))) if r else 0), 3.0)),
]

DRIVE_FAULTS = [
    Fault("drive silent for 1 s", lambda s: s.drive_does(lambda d, to: d if to else b"", 1.0), "stands", 1.0, DRIVE, short=True),
    Fault("drive silent for 10 s", lambda s: s.drive_does(lambda d, to: d if to else b"", 10.0), "stands", 1.0, DRIVE),
    Fault("no command reaches the drive for 1 s", lambda s: s.drive_does(lambda d, to: b"" if to else d, 1.0), "stands", 0.85, short=True),
    Fault("every checksum of the drive wrong for 2 s", lambda s: s.drive_does(
        lambda d, to: d if to else bytes(b ^ 0x55 if b not in (0, 0x55) else b for b in d), 2.0), "stands", 1.0, DRIVE),
    Fault("10 % of the drive's frames lost", lambda s: s.statuses(lambda raw: s.chance.random() > 0.1, 3.0), "goes on"),
    Fault("10 % of the commands lost", lambda s: s.commands(lambda raw: s.chance.random() > 0.1, 3.0), "goes on"),
    Fault("noise on the drive's line", lambda s: s.drive_does(
        lambda d, to: d + s.chance.randbytes(3) if s.chance.random() < 0.2 else d, 3.0)),
    # Whoever notices first: the watch on the wheels, or the localizer, whose next scan contradicts them.
    Fault("left encoder stuck for 3 s", lambda s: s.statuses(both(frozen(14), frozen(18)), 3.0), "stands", 1.0,
          ["left wheel", "where the vehicle is"], RESUME),
    Fault("left encoder jumps", lambda s: s.statuses(jumping(s, 14, 5000), 3.0)),
    Fault("the controller's clock stands still", lambda s: s.statuses(frozen(10, 4), 3.0), then=RESUME),
    Fault("the controller's clock jumps 60 s ahead", lambda s: s.statuses(
        lambda raw: put(raw, 10, number(raw, 10, 4) + 60_000_000, 4), 3.0), then=RESUME),
    Fault("right motor at half its speed", lambda s: s.commands(speeds(1.0, 0.5), 3.0), "stands", 1.0, ["right wheel"], RESUME),
    Fault("right motor does nothing", lambda s: s.commands(speeds(1.0, 0.0), 2.0), "stands", 1.0, ["right wheel"], RESUME),
    Fault("both motors a fifth too fast", lambda s: s.commands(speeds(1.2, 1.2), 3.0)),
    Fault("emergency stop pressed for 2 s", lambda s: s.drive_is(state_is(ESTOP, 1), 2.0), "stands", 1.0, ["emergency stop"],
          RESUME, short=True),
    Fault("bumper pressed for 2 s", lambda s: s.drive_is(state_is(BUMPER, 2), 2.0), "stands", 1.0, ["bumper"], RESUME),
    Fault("the drive reports a hot left motor for 2 s", lambda s: s.drive_is(state_is(FAULT, 0, 4 | 32), 2.0), "stands", 1.0,
          ["motor", "hot", "drive"], RESUME),
]

COMPUTER_FAULTS = [
    Fault("program stopped for 0.15 s (SIGSTOP), ten times", lambda s: [(s.stopped(0.15), time.sleep(0.3)) for _ in range(10)]),
    Fault("program stopped for 2 s (SIGSTOP)", lambda s: s.stopped(2.0), "stands", 0.85, ["the program stood still"], short=True),
    Fault("program stopped for 20 s (SIGSTOP)", lambda s: s.stopped(20.0), "stands", 0.85, ["the program stood still"]),
    Fault("program killed (SIGKILL) and begun anew", lambda s: s.killed(), "stands", 0.85),
    Fault("four programs want every core for 5 s", lambda s: s.busy(5.0), "goes on"),
    Fault("database locked for 3 s", lambda s: s.database_locked(3.0)),
    Fault("no file may grow for 3 s (full disk)", lambda s: s.limited(resource.RLIMIT_FSIZE, 1000, 3.0), short=True),
    Fault("no new file handle for 3 s", lambda s: s.limited(resource.RLIMIT_NOFILE, 3, 3.0)),
    Fault("no new memory for 3 s", lambda s: s.limited(resource.RLIMIT_AS, 1 << 20, 3.0)),
    Fault("a second program on the site", lambda s: s.second_program(), "goes on", short=True),
    Fault("site.yaml damaged for 3 s", lambda s: s.file_is("site.yaml", lambda text: text[:100] + b"\xff{{", 3.0), "goes on"),
    Fault("walls.csv gone for 3 s", lambda s: s.file_is("walls.csv", None, 3.0), "goes on"),
    Fault("routes damaged for 3 s", lambda s: s.file_is("routes/path.csv", lambda text: text[:len(text) // 2] + b'"', 3.0),
          "goes on"),
    Fault("300 half-open connections to the panel", lambda s: s.half_open(4.0), "goes on"),
    Fault("Stop pressed, then Resume", lambda s: s.words(["halt"], 1.5), "stands", 0.85, then=RESUME),
    Fault("Pause and Resume, five times a second", lambda s: s.words(["pause", "resume"] * 10, 0.1), then=RESUME),
    Fault("a person taps 3 m beside the true place while it drives", lambda s: s.tap_while_driving(), "goes on"),
    Fault("paused, a person taps 3 m beside the true place", lambda s: s.tap_while_paused(3.0), "stands", 0.85, then=RESUME),
    Fault("paused, a person taps 20 m beside the true place", lambda s: s.tap_while_paused(20.0), "stands", 0.85, then=RESUME),
]
FAULTS = LIDAR_FAULTS + DRIVE_FAULTS + COMPUTER_FAULTS
