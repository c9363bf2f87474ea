"""What a factory or somebody in it does to a running vehicle besides faults.py: networks, drives, people, the panel."""

import http.client
import json
import math
import os
import shutil
import signal
import socket
import subprocess
import threading
import time

from faults import DRIVE, RESUME, SILENT, Fault, Frames, both, edited, number, put, ranges, state_is, unplugged

TURN = 76  # packets of a revolution
FIRING_US = 55.296
COUNTS = 1 << 30  # of an encoder: 14 bits of angle, 16 of turns
LATE = ["commands reach the drive late"]


def echo(behind):
    """Every packet once more, so many packets later."""
    kept = []

    def pass_on(packet):
        kept.append(packet)
        return [packet] + ([kept.pop(0)] if len(kept) > behind else [])
    return pass_on


def old_bursts(behind, burst):
    """Every `burst` packets as many that are older, in a row: a switch that empties a buffer."""
    kept = []

    def pass_on(packet):
        kept.append(packet)
        if len(kept) % burst or len(kept) < behind + burst:
            return [packet]
        old = kept[-behind - burst:-behind]
        del kept[:-behind - 2 * burst]
        return [packet] + old
    return pass_on


def bursts(seconds):
    """Nothing for so long, then all of it at once."""
    waiting, since = [], [time.monotonic()]

    def pass_on(packet):
        waiting.append(packet)
        if time.monotonic() - since[0] < seconds:
            return []
        out, since[0] = waiting[:], time.monotonic()
        waiting.clear()
        return out
    return pass_on


def azimuth_lost(first, last):
    """Packets that begin in that sector never come."""
    def pass_on(packet):
        azimuth = number(packet, 2)
        inside = first <= azimuth < last if first < last else azimuth >= first or azimuth < last
        return [] if inside else [packet]
    return pass_on


def dual(packet):
    """As a lidar set to dual return sends: two packets of six pairs, each block twice."""
    out = []
    for half in range(2):
        blocks = [bytes(packet[100 * b:100 * b + 100]) for b in range(6 * half, 6 * half + 6)]
        tail = bytearray(packet[1200:])
        put(tail, 0, (number(packet, 1200, 4) + round(12 * FIRING_US * half)) % 3_600_000_000, 4)
        tail[4] = 0x39
        out.append(b"".join(b + b for b in blocks) + bytes(tail))
    return out


def clock_rate(rate):
    """The lidar's clock runs so much faster."""
    first = []

    def edit(p):
        now = number(p, 1200, 4)
        first or first.append(now)
        put(p, 1200, int(first[0] + (now - first[0]) * rate) % 3_600_000_000, 4)
    return edited(edit)


def from_zero():
    """The lidar counts from its power-up."""
    first = []

    def edit(p):
        now = number(p, 1200, 4)
        first or first.append(now)
        put(p, 1200, (now - first[0]) % 3_600_000_000, 4)
    return edited(edit)


def turned(degrees):
    """The lidar twists on its mast."""
    def edit(p):
        for block in range(12):
            put(p, 100 * block + 2, (number(p, 100 * block + 2) + round(100 * degrees)) % 36000)
    return edited(edit)


def frozen_picture():
    """The same picture for ever, with stamps and azimuths that go on."""
    kept = {}

    def pass_on(packet):
        out = bytearray(packet)
        for block in range(12):
            at = 100 * block
            slot = number(packet, at + 2) // 40
            if slot in kept:
                out[at + 4:at + 100] = kept[slot]
            elif len(kept) < 900:
                kept[slot] = bytes(packet[at + 4:at + 100])
        if len(kept) < 890:
            return [packet]
        return [bytes(out)]
    return pass_on


def rain(scene, share, nearest_m=0.5, farthest_m=6.0):
    """So many of the beams end at a drop."""
    def new(r):
        if scene.chance.random() >= share:
            return r
        drop = int(scene.chance.uniform(nearest_m, farthest_m) * 500)
        return min(r, drop) if r else drop
    return ranges(new)


def one_laser(channel):
    def edit(p):
        for block in range(12):
            for k in range(32):
                if k % 16 != channel:
                    put(p, 100 * block + 4 + 3 * k, 0)
    return edited(edit)


class Wheels:
    """Edits the wheels of a status: `of(left, right)` gives what is told instead of the counts since it began."""

    def __init__(self, of, more=None):
        self.of, self.more, self.begun = of, more, None

    def __call__(self, raw):
        counts = [(number(raw, 18 + 2 * k) << 14) | number(raw, 14 + 2 * k) for k in range(2)]
        self.begun = self.begun or counts
        since = [(c - b + COUNTS // 2) % COUNTS - COUNTS // 2 for c, b in zip(counts, self.begun)]
        for k, told in enumerate(self.of(*since)):
            value = (self.begun[k] + round(told)) % COUNTS
            put(raw, 14 + 2 * k, value & 16383)
            put(raw, 18 + 2 * k, value >> 14)
        if self.more:
            self.more(raw)


def moves(left, right):
    """The motors turn whatever they are told, mrad/s: somebody pushes."""
    def edit(raw):
        raw[4] = 1
        put(raw, 6, left * 1000, 4)
        put(raw, 10, right * 1000, 4)
    return edit


class Latency:
    """Both directions of the drive's line later and later, up to `most_s` within `over_s`."""

    def __init__(self, wire, most_s, over_s, to_drive=True, to_pc=True):
        self.wire, self.most_s, self.over_s, self.begun = wire, most_s, over_s, time.monotonic()
        self.late = {True: to_drive, False: to_pc}
        self.waiting, self.lock, self.last, self.ended = [], threading.Lock(), 0.0, False
        threading.Thread(target=self.pass_on, daemon=True).start()

    def __call__(self, data, to_drive):
        if not self.late[to_drive]:
            return data
        now = time.monotonic()
        late = self.most_s * min(1.0, (now - self.begun) / self.over_s)
        with self.lock:  # a line overtakes nothing
            self.last = max(self.last, now + late)
            self.waiting.append((self.last, data, to_drive))
        return b""

    def pass_on(self):
        while not self.ended or self.waiting:
            time.sleep(0.002)
            now = time.monotonic()
            with self.lock:
                due = [w for w in self.waiting if w[0] <= now]
                self.waiting = [w for w in self.waiting if w[0] > now]
            for _, data, to_drive in due:
                os.write(self.wire.sim_end if to_drive else self.wire.run_end, data)


def latency(scene, most_s, over_s, seconds, **which):
    late = Latency(scene.drive, most_s, over_s, **which)
    scene.drive.fault = late
    time.sleep(seconds)
    late.most_s = 0.0
    while late.waiting:
        time.sleep(0.001)
    scene.drive.fault, late.ended = None, True


def stalls(scene, on_s, off_s, times):
    """A half-duplex line that is held by somebody else."""
    for _ in range(times):
        scene.drive_does(lambda d, to: b"", on_s)
        time.sleep(off_s)


def both_ways(said, told):
    """`said` edits what the drive says, `told` what it is told."""
    said, told = Frames(said, to_drive=False), Frames(told, to_drive=True)
    return lambda data, to_drive: told(data, True) if to_drive else said(data, False)


def once_in(n):
    """One status in so many comes."""
    count = [0]

    def edit(raw):
        count[0] += 1
        return count[0] % n == 0
    return edit


def power_cycled():
    """The controller's clock, numbers and turns begin anew."""
    first = {}

    def edit(raw):
        for at, size in ((2, 2), (10, 4), (18, 2), (20, 2)):
            first.setdefault(at, number(raw, at, size))
            put(raw, at, number(raw, at, size) - first[at], size)
    return edit


def pushed(scene, seconds, left, right, felt):
    """Somebody pushes the standing vehicle; `felt`: the wheels turn with it, else it is carried."""
    told = moves(left, right)
    said = state_is(0) if felt else both(Wheels(lambda a, b: (0, 0)), state_is(0))
    scene.run.say("pause")
    time.sleep(2.0)
    scene.drive_does(both_ways(said, told), seconds)


def live_socket(port, receive_buffer=None):
    wire = socket.socket()
    if receive_buffer:
        wire.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
    wire.settimeout(3)
    wire.connect(("127.0.0.1", port))
    wire.sendall(f"GET /api/live HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nOrigin: http://127.0.0.1:{port}\r\nUpgrade: websocket\r\n"
                 "Connection: Upgrade\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n\r\n".encode())
    return wire


def text_frame(text):
    data = text.encode()
    head = bytes([0x81]) + (bytes([0x80 | len(data)]) if len(data) < 126 else bytes([0xFE]) + len(data).to_bytes(2, "big"))
    return head + b"\0\0\0\0" + data


def slow_readers(scene, count, seconds):
    """Panels that open the live socket and never read."""
    wires = [live_socket(scene.run.port, 2048) for _ in range(count)]
    time.sleep(seconds)
    for wire in wires:
        wire.close()


def flooding_socket(scene, seconds):
    """A panel that sends nonsense as fast as it can, and reads nothing."""
    wires = [live_socket(scene.run.port) for _ in range(4)]
    frames = [text_frame('{"editing": "walls"}'), text_frame("{" * 100),
              text_frame('{"jog": {"linear": 1e999, "angular": null}}')]
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        for wire in list(wires):
            try:
                wire.setblocking(False)
                wire.send(b"".join(frames))
            except BlockingIOError:
                pass
            except OSError:
                wires.remove(wire)
        time.sleep(0.001)
    for wire in wires:
        wire.close()


def two_tablets(scene, seconds):
    """One person presses Pause, another Resume, at once."""
    end = time.monotonic() + seconds
    threads = [threading.Thread(target=lambda w=word: [scene.run.say(w) for _ in iter(lambda: time.monotonic() < end, False)])
               for word in ("pause", "resume")]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def ask(scene, method, path, body=None, raw=None, kind="application/json"):
    """Status and text of the panel's answer."""
    wire = http.client.HTTPConnection("127.0.0.1", scene.run.port, timeout=20)
    data = raw if raw is not None else json.dumps(body) if body is not None else None
    try:
        wire.request(method, path, data, {"Origin": f"http://127.0.0.1:{scene.run.port}", "Content-Type": kind})
    except ConnectionError:  # refused before its bytes were taken: the answer is there all the same
        pass
    answer = wire.getresponse()
    return answer.status, answer.read()


def refused(scene, method, path, body=None, raw=None, kind="application/json"):
    status, text = ask(scene, method, path, body, raw, kind)
    assert 400 <= status < 500, f"{method} {path} of a vehicle that drives: {status} {text[:200]!r}"


def backup_while_driving(scene):
    status, tar = ask(scene, "GET", "/api/site/download")
    assert status == 200, status
    refused(scene, "POST", "/api/site/backup", raw=tar, kind="application/x-tar")


def folder_gone(scene, name, seconds):
    path = scene.site / name if name else scene.site
    away = path.with_name(path.name + ".away")
    path.rename(away)
    time.sleep(seconds)
    if path.exists():
        shutil.rmtree(path)
    away.rename(path)


def stranger_flood(scene, make, seconds, rate=20000):
    wire = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        for _ in range(rate // 200):
            try:
                wire.sendto(make(), ("127.0.0.1", scene.lidar.run_port))
            except OSError:
                pass
        time.sleep(0.005)
    wire.close()


def other_port(scene, seconds):
    """The lidar sends from another port, as after its restart."""
    def pass_on(packet):
        scene.lidar.stranger.sendto(packet, ("127.0.0.1", scene.lidar.run_port))
        return []
    scene.lidar_does(pass_on, seconds)


def begun_anew(scene, how, **more):
    """The program ends in that way and begins anew with that environment."""
    scene.run.process.send_signal(how)
    scene.run.process.wait(30)
    time.sleep(0.5)  # it may be there again before the vehicle has braked
    scene.run = scene.again(**more)
    scene.run.resume()


MORE_FAULTS = [
    # network
    Fault("every packet once more a turn later", lambda s: s.lidar_does(echo(TURN), 4.0), "goes on"),
    Fault("every packet once more 1.5 s later", lambda s: s.lidar_does(echo(15 * TURN), 5.0), "goes on"),
    Fault("bursts of packets that are 1.5 s old in between",
          lambda s: s.lidar_does(old_bursts(15 * TURN, 2 * TURN), 6.0), "goes on"),
    Fault("packets in bursts of 0.3 s", lambda s: s.lidar_does(bursts(0.3), 5.0)),
    Fault("packets in bursts of 0.8 s", lambda s: s.lidar_does(bursts(0.8), 5.0)),
    Fault("packets in bursts of 2 s", lambda s: s.lidar_does(bursts(2.0), 6.5), "stands", 1.0, SILENT),
    Fault("all packets cut short", lambda s: s.lidar_does(lambda p: [p[:1100]], 3.0), "stands", 1.0, SILENT),
    Fault("packets of the front half lost", lambda s: s.lidar_does(azimuth_lost(27000, 9000), 4.0), "stands", 1.0, ["lidar"]),
    Fault("packets of the rear half lost", lambda s: s.lidar_does(azimuth_lost(9000, 27000), 4.0)),
    Fault("packets of the left half lost", lambda s: s.lidar_does(azimuth_lost(18000, 36000), 4.0), "stands", 1.0, ["lidar"]),
    Fault("lidar set to last return", lambda s: s.lidar_does(edited(lambda p: put(p, 1204, 0x38, 1)), 3.0), "goes on"),
    Fault("lidar set to dual return", lambda s: s.lidar_does(dual, 4.0), "goes on"),
    Fault("lidar begins anew: clock at 0 after 0.5 s",
          lambda s: (s.lidar_does(lambda p: [], 0.5), s.lidar_does(from_zero(), 4.0))),
    Fault("lidar begins anew: clock at 0 after 8 s",
          lambda s: (s.lidar_does(lambda p: [], 8.0), s.lidar_does(from_zero(), 4.0)),
          "stands", 1.0, SILENT),
    Fault("lidar's clock 1 % fast", lambda s: s.lidar_does(clock_rate(1.01), 6.0), "goes on"),
    Fault("lidar's clock 1 % slow", lambda s: s.lidar_does(clock_rate(0.99), 8.0), "goes on"),
    Fault("lidar's clock 5 % slow", lambda s: s.lidar_does(clock_rate(0.95), 8.0)),
    Fault("lidar twisted by 3 degrees", lambda s: s.lidar_does(turned(3), 5.0)),
    Fault("lidar twisted by 10 degrees", lambda s: s.lidar_does(turned(10), 5.0)),
    Fault("lidar twisted by 90 degrees", lambda s: s.lidar_does(turned(90), 5.0), "stands", 1.5),
    Fault("lidar twisted by 180 degrees", lambda s: s.lidar_does(turned(180), 5.0), "stands", 1.5),
    Fault("the lidar sends from another port", lambda s: other_port(s, 5.0)),
    Fault("20,000 packets of noise a second from elsewhere",
          lambda s: stranger_flood(s, lambda: s.chance.randbytes(1206), 4.0)),
    Fault("empty and huge packets from elsewhere", lambda s: stranger_flood(
        s, lambda: b"" if s.chance.random() < 0.5 else bytes(60000), 4.0, 2000), "goes on"),
    Fault("the same picture for ever, stamped anew", lambda s: s.lidar_does(frozen_picture(), 5.0), "stands", 3.0),
    Fault("a twentieth of the beams ends in rain", lambda s: s.lidar_does(rain(s, 0.05), 4.0)),
    Fault("0.2 % of the beams end in rain", lambda s: s.lidar_does(rain(s, 0.002), 4.0)),
    Fault("no returns beyond 8 m (fog)", lambda s: s.lidar_does(ranges(lambda r: r if r < 4000 else 0), 5.0)),
    Fault("a wall of people around it for 5 s",
          lambda s: s.lidar_does(ranges(lambda r: min(r or 600, 600)), 5.0), "stands", 1.0),
    Fault("a trailer behind it", lambda s: s.lidar_does(ranges(lambda r: min(r or 600, 600), (13500, 22500)), 6.0)),
    Fault("a mirror: twice the range on the left",
          lambda s: s.lidar_does(ranges(lambda r: min(2 * r, 50000), (24000, 32000)), 5.0)),
    Fault("every range 131 m", lambda s: s.lidar_does(ranges(lambda r: 65535), 4.0), "stands", 2.5),
    Fault("every range 2 mm", lambda s: s.lidar_does(ranges(lambda r: 1), 4.0), "stands", 1.0),
    Fault("one laser of 16 is left (1 degree up)", lambda s: s.lidar_does(one_laser(1), 4.0)),
    Fault("one laser of 16 is left (15 degrees down)", lambda s: s.lidar_does(one_laser(0), 4.0)),
    # drive
    Fault("both encoders stuck, time goes on",
          lambda s: s.statuses(Wheels(lambda a, b: (0, 0)), 6.0), "stands", 4.0, ["wheel ran at"], RESUME),
    Fault("impossible wheel angles", lambda s: s.statuses(
        Wheels(lambda a, b: (a + s.chance.randrange(100000), b - s.chance.randrange(100000))), 3.0), "stands", 1.0,
          ["what it tells of its wheels"]),
    Fault("left wheel told reversed",
          lambda s: s.statuses(Wheels(lambda a, b: (-a, b)), 3.0), "stands", 1.0, ["left wheel"], RESUME),
    Fault("both wheels told reversed",
          lambda s: s.statuses(Wheels(lambda a, b: (-a, -b)), 3.0), "stands", 1.0, ["wheel"], RESUME),
    Fault("encoders swapped", lambda s: s.statuses(Wheels(lambda a, b: (b, a)), 20.0), "stands", 20.0, ["wheel"], RESUME),
    Fault("oil: wheels turn 30 % too far", lambda s: s.statuses(Wheels(lambda a, b: (1.3 * a, 1.3 * b)), 4.0)),
    Fault("oil: one wheel loses 10 % of its way", lambda s: s.drive_does(both_ways(
        Wheels(lambda a, b: (a, b / 0.9)), lambda raw: put(raw, 10, int(number(raw, 10, 4, True) * 0.9), 4)), 4.0)),
    Fault("left encoder jumps once by 5000 counts and stays", lambda s: s.statuses(Wheels(lambda a, b: (a + 5000, b)), 3.0)),
    Fault("drive later and later, to 1 s, both ways", lambda s: latency(s, 1.0, 8.0, 10.0), "stands", 10.0, LATE, RESUME),
    Fault("commands later and later, to 0.6 s",
          lambda s: latency(s, 0.6, 6.0, 8.0, to_pc=False), "stands", 8.0, LATE, RESUME),
    Fault("statuses later and later, to 0.6 s", lambda s: latency(s, 0.6, 6.0, 8.0, to_drive=False), "stands", 8.0, LATE, RESUME),
    Fault("commands 0.3 s late at once", lambda s: latency(s, 0.3, 0.01, 5.0, to_pc=False), "stands", 1.5, LATE, RESUME),
    Fault("zeros and noise between the drive's frames", lambda s: s.drive_does(
        lambda d, to: b"\0\0" + d + s.chance.randbytes(s.chance.randrange(40)) + b"\0", 3.0)),
    Fault("the drive's plug pulled for 3 s", lambda s: unplugged(s.drive, 3.0), "stands", 1.0, DRIVE, RESUME),
    Fault("the drive's plug pulled for 0.1 s", lambda s: unplugged(s.drive, 0.1)),
    Fault("the line stalls for 0.15 s, ten times", lambda s: stalls(s, 0.15, 0.3, 10)),
    Fault("the line stalls for 0.5 s, five times", lambda s: stalls(s, 0.5, 0.5, 5)),
    Fault("commands come back as an echo", lambda s: s.drive_does(lambda d, to: (
        os.write(s.drive.run_end, d), d)[1] if to else d, 3.0), "goes on"),
    Fault("every status twice", lambda s: s.drive_does(lambda d, to: d if to else d + d, 3.0), "goes on"),
    Fault("one status in 50", lambda s: s.statuses(once_in(50), 4.0)),
    Fault("the drive stays idle and says no more", lambda s: s.drive_is(state_is(0), 4.0), "stands", 1.0,
          ["does not start although it is told to"]),
    Fault("the drive hears nothing (watchdog stop)",
          lambda s: s.drive_is(state_is(2, 4), 3.0), "stands", 1.0, ["hears no commands"]),
    Fault("unknown state of the drive", lambda s: s.drive_is(state_is(9), 3.0), "stands", 1.0, DRIVE),
    Fault("the drive's power dips", lambda s: s.statuses(power_cycled(), 3.0), "stands", 1.0, ["loss of power"], RESUME),
    Fault("battery at 0 V", lambda s: s.statuses(lambda raw: put(raw, 22, 0), 3.0)),
    Fault("it stopped for a moment that nobody saw",
          lambda s: s.statuses(lambda raw: put(raw, 7, raw[7] + 8, 1) if raw[7] < 248 else None, 1.0),
          "stands", 1.0, ["emergency stop"], RESUME),
    # people and the building
    Fault("paused, pushed 1 m by hand", lambda s: pushed(s, 4.0, 2500, 2500, True), "stands", 0.85, then=RESUME),
    Fault("paused, turned by 90 degrees by hand", lambda s: pushed(s, 4.0, -1200, 1200, True), "stands", 0.85, then=RESUME),
    Fault("paused, carried 1 m off, wheels still", lambda s: pushed(s, 4.0, 2500, 2500, False), "stands", 0.85, then=RESUME),
    Fault("paused, turned on a turntable, wheels still",
          lambda s: pushed(s, 4.0, -1200, 1200, False), "stands", 0.85, then=RESUME),
    # computer
    Fault("SIGSTOP for 0.3 s", lambda s: s.stopped(0.3)),
    Fault("SIGSTOP for 0.5 s", lambda s: s.stopped(0.5), told=["the program stood still"]),
    Fault("SIGSTOP for 1 s every 2 s", lambda s: [(s.stopped(1.0), time.sleep(1.0)) for _ in range(4)], "stands", 0.85),
    Fault("SIGTERM, and begun anew in Tokyo's time",
          lambda s: begun_anew(s, signal.SIGTERM, env={"TZ": "Asia/Tokyo"}), "stands", 0.85),
    Fault("SIGHUP (its terminal closes), and begun anew", lambda s: begun_anew(
        s, signal.SIGHUP, env={"TZ": "nowhere/at all", "LC_ALL": "xx_YY.UTF-8", "LANG": "tr_TR"}), "stands", 0.85),
    Fault("folder of the recordings away for 3 s", lambda s: folder_gone(s, "runs", 3.0), "goes on"),
    Fault("the site's folder away for 3 s", lambda s: folder_gone(s, "", 3.0), "goes on"),
    # panel
    Fault("two tablets: Pause and Resume at once", lambda s: two_tablets(s, 4.0), then=RESUME),
    Fault("30 panels that never read", lambda s: slow_readers(s, 30, 6.0), "goes on"),
    Fault("live sockets flooded with nonsense", lambda s: flooding_socket(s, 5.0), "goes on"),
    Fault("a backup restored while it drives", backup_while_driving, "goes on"),
    Fault("mapping, mounting and braking test begun while it drives", lambda s: (
        refused(s, "POST", "/api/mapping", {}), refused(s, "POST", "/api/mounting"),
        refused(s, "POST", "/api/vehicle/braking", {"loaded": False})), "goes on"),
    Fault("place searched anew 20 times while it drives", lambda s: [
        (ask(s, "POST", "/api/locate/search"), time.sleep(0.1)) for _ in range(20)]),
    Fault("PIN set while it drives", lambda s: subprocess.run(
        [s.madori, "pin", s.site, "operator"], input=b"493817\n493817\n", capture_output=True), "goes on"),
    Fault("five backups downloaded at once", lambda s: [t.join() for t in [
        (lambda t: (t.start(), t)[1])(threading.Thread(target=lambda: ask(s, "GET", "/api/site/download"))) for _ in range(5)]], "goes on"),
]
