"""What happens to a vehicle of planar scanners: an LMS1xx (TCP, CoLa B) and an S300 (serial), instead of a VLP-16."""

import binascii
import select
import socket
import struct
import threading
import time
from functools import partial

from faults import RESUME, DriveWire, Fault, both, delayed, frozen, number, put, unplugged, wire_does
from more_faults import bursts
from truth_listener import come_first

LMS = "type: lms1xx, x_m: 0.65, z_m: 0.18, settings: {cola: B}"
S300 = "type: s300, x_m: 0.68, z_m: 0.15, protective_m: 0.7, protective_side_m: 0.05"
SCANNERS = {"lms1xx": [LMS], "s300,lms1xx": [S300, LMS]}


class ColaWire:
    """Between the virtual LMS1xx and the program, which calls it; `fault(telegram, to_scanner)` gives what is sent instead."""

    def __init__(self, sim_port):
        self.fault, self.sim_port, self.held, self.answers = None, sim_port, [], True
        self.server = socket.create_server(("127.0.0.1", 0))
        self.port = self.server.getsockname()[1]
        threading.Thread(target=self.serve, daemon=True).start()

    def serve(self):
        come_first()
        while True:
            client = self.server.accept()[0]
            if not self.answers:
                client.close()
                continue
            client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            device = socket.create_connection(("127.0.0.1", self.sim_port))
            self.held = [client, device]
            threading.Thread(target=self.pass_on, args=(client, device), daemon=True).start()

    def pass_on(self, client, device):
        come_first()
        rest = {client: b"", device: b""}
        try:
            while True:
                for ready in select.select([client, device], [], [], 0.02)[0]:
                    data = ready.recv(65536)
                    if not data:
                        raise OSError("closed")
                    telegrams, rest[ready] = split(rest[ready] + data)
                    for telegram in telegrams:
                        to_scanner = ready is client
                        for out in self.fault(telegram, to_scanner) if self.fault else [telegram]:
                            (device if to_scanner else client).sendall(out)
        except (OSError, ValueError):
            client.close()
            device.close()

    def close(self):
        for end in self.held:
            hang_up(end)


def hang_up(end):
    try:
        end.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        end.shutdown(socket.SHUT_RDWR)
    except OSError:
        pass  # the program closed it first


def split(data):
    """Whole CoLa B telegrams, and the rest."""
    telegrams = []
    while len(data) >= 8 and len(data) >= 9 + (size := int.from_bytes(data[4:8], "big")):
        telegrams.append(data[:9 + size])
        data = data[9 + size:]
    return telegrams, data


def framed(payload):
    check = 0
    for byte in payload:
        check ^= byte
    return b"\2\2\2\2" + len(payload).to_bytes(4, "big") + payload + bytes([check])


def scans(edit):
    """Each scan's payload may be changed in place (False: it is lost), its checksum made anew; answers pass."""
    def pass_on(telegram, to_scanner):
        payload = bytearray(telegram[8:-1])
        if to_scanner or not payload.startswith(b"sSN LMDscandata"):
            return [telegram]
        return [framed(bytes(payload))] if edit(payload) is not False else []
    return pass_on


def raw(edit):
    """What comes from the scanner, as bytes."""
    return lambda telegram, to_scanner: [telegram] if to_scanner else edit(telegram)


big, set_big = partial(number, order="big"), partial(put, order="big")
COUNTER, SINCE_START, TRANSMITTED, SCALE, START, STEP, COUNT, DATA = 26, 30, 34, 61, 69, 73, 75, 77


def lms_ranges(new):
    def edit(payload):
        for i in range(big(payload, COUNT)):
            set_big(payload, DATA + 2 * i, new(big(payload, DATA + 2 * i), i))
    return scans(edit)


def every_second_beam(payload):
    """As a scanner that was set to the other step."""
    count = big(payload, COUNT)
    values = b"".join(payload[DATA + 2 * i:DATA + 2 * i + 2] for i in range(0, count, 2))
    rest = payload[DATA + 2 * count:]
    set_big(payload, STEP, 2 * big(payload, STEP))
    set_big(payload, COUNT, len(values) // 2)
    payload[DATA:] = values + rest


def its_clock(by):
    """The scanner's own clock (microseconds) is so far off."""
    return scans(lambda p: [set_big(p, at, big(p, at, 4) + by, 4) for at in (SINCE_START, TRANSMITTED)])


def counted_from_zero(at, edited):
    """The number at that place counts from its first value; others of `edited` by the same."""
    first = []

    def edit(telegram):
        first or first.append(big(telegram, at, 4))
        for place in edited:
            set_big(telegram, place, big(telegram, place, 4) - first[0], 4)
    return edit


S300_SIZE, S300_SCAN, S300_DATA = 1108, 14, 24
S300_HEAD = bytes(6) + ((S300_SIZE - 4) // 2).to_bytes(2, "big") + b"\xff"


class Telegrams:
    """Cuts what an S300 sends; `edit(telegram)` may change one, its checksum is made anew, or return False: lost."""

    def __init__(self, edit):
        self.edit, self.rest = edit, b""

    def __call__(self, data, to_device):
        if to_device:
            return data
        self.rest += data
        out = b""
        while (begin := self.rest.find(S300_HEAD)) >= 0 and len(self.rest) >= begin + S300_SIZE:
            out += self.rest[:begin]  # the rest of one that had begun before this did
            telegram, self.rest = bytearray(self.rest[begin:begin + S300_SIZE]), self.rest[begin + S300_SIZE:]
            if self.edit(telegram) is False:
                continue
            put(telegram, S300_SIZE - 2, binascii.crc_hqx(bytes(telegram[4:-2]), 0xFFFF))
            out += telegram
        return out




def values(new):
    def edit(telegram):
        for i in range(541):
            put(telegram, S300_DATA + 2 * i, new(number(telegram, S300_DATA + 2 * i)))
    return edit


def the_same():
    kept = []

    def edit(telegram):
        kept.append(bytes(telegram)) if not kept else telegram.__setitem__(slice(None), kept[0])
    return edit


def entered(telegram):
    """One beam meets somebody in the protective field."""
    put(telegram, S300_DATA + 540, number(telegram, S300_DATA + 540) | 0x4000)


def refuses(scene, seconds):
    scene.lms.answers = False
    scene.lms.close()
    time.sleep(seconds)
    scene.lms.answers = True


def closes(scene, times, pause_s):
    for _ in range(times):
        scene.lms.close()
        time.sleep(pause_s)


def both_silent(scene, seconds):
    scene.lms.fault, scene.s300.fault = raw(lambda t: []), lambda d, to: b""
    time.sleep(seconds)
    scene.lms.fault = scene.s300.fault = None


QUIET = ["is silent"]
FIELD = ["protective field", "safety scanner"]
NOTHING = raw(lambda t: [])

# One scanner, which all depends on: 0.35 s until it counts as silent, half a second of braking.
LMS_FAULTS = [
    Fault("LMS1xx silent for 2 s", lambda s: wire_does(s.lms, NOTHING, 2.0), "stands", 1.0, QUIET),
    Fault("LMS1xx silent for 15 s", lambda s: wire_does(s.lms, NOTHING, 15.0), "stands", 1.0, QUIET),
    Fault("LMS1xx silent for 0.2 s, ten times", lambda s: [(wire_does(s.lms, NOTHING, 0.2), time.sleep(0.3)) for _ in range(10)]),
    Fault("LMS1xx closes the connection", lambda s: closes(s, 1, 3.0)),
    Fault("LMS1xx closes the connection five times", lambda s: closes(s, 5, 1.5)),
    Fault("LMS1xx refuses connections for 5 s", lambda s: refuses(s, 5.0), "stands", 1.0, QUIET),
    Fault("LMS1xx refuses to be set up", lambda s: (closes(s, 1, 0.0), wire_does(s.lms, raw(
        lambda t: [t] if t[8:].startswith(b"sSN") else [framed(b"sFA\0\3")]), 4.0)), "stands", 1.0, ["refuses SetAccessMode"]),
    Fault("a tenth of the scans lost", lambda s: wire_does(s.lms, scans(lambda p: s.chance.random() > 0.1), 3.0), "goes on"),
    Fault("half of the scans lost", lambda s: wire_does(s.lms, scans(lambda p: s.chance.random() > 0.5), 3.0), "goes on"),
    Fault("19 of 20 scans lost", lambda s: wire_does(s.lms, scans(lambda p: s.chance.random() > 0.95), 4.0)),
    Fault("every scan twice", lambda s: wire_does(s.lms, raw(lambda t: [t, t]), 3.0), "goes on"),
    Fault("scans 0.2 s late", lambda s: wire_does(s.lms, raw(delayed(0.2)(s)), 4.0)),
    Fault("scans 1 s late", lambda s: wire_does(s.lms, raw(delayed(1.0)(s)), 4.0)),
    Fault("scans in bursts of 0.3 s", lambda s: wire_does(s.lms, raw(bursts(0.3)), 4.0)),
    Fault("scans in bursts of 2 s", lambda s: wire_does(s.lms, raw(bursts(2.0)), 6.0)),
    Fault("every telegram in three pieces", lambda s: wire_does(s.lms, raw(lambda t: [t[:9], t[9:500], t[500:]]), 3.0), "goes on"),
    Fault("noise between the telegrams", lambda s: wire_does(s.lms, raw(lambda t: [s.chance.randbytes(37), t]), 3.0), "goes on"),
    Fault("noise in place of the scans", lambda s: wire_does(s.lms, raw(lambda t: [s.chance.randbytes(len(t))]), 3.0), "stands", 1.0, QUIET),
    Fault("a tenth of the checksums wrong", lambda s: wire_does(s.lms, raw(
        lambda t: [t[:-1] + bytes([t[-1] ^ 1])] if s.chance.random() < 0.1 else [t]), 3.0), "goes on"),
    Fault("every checksum wrong", lambda s: wire_does(s.lms, raw(lambda t: [t[:-1] + bytes([t[-1] ^ 1])]), 3.0), "stands", 1.0,
          QUIET),
    Fault("telegrams damaged within", lambda s: wire_does(s.lms, raw(lambda t: [s.damaged(t, 1.0)]), 3.0), "stands", 1.2, QUIET),
    Fault("telegrams cut short", lambda s: wire_does(s.lms, raw(lambda t: [t[:len(t) // 2]]), 3.0), "stands", 1.0, QUIET),
    Fault("telegrams that announce a gigabyte", lambda s: wire_does(s.lms, raw(lambda t: [t[:4] + b"\x40\0\0\0" + t[8:]]), 3.0),
          "stands", 1.0, QUIET),
    Fault("one scan again and again", lambda s: wire_does(s.lms, scans(the_same()), 3.0), "stands", 1.0, QUIET),
    Fault("the same picture for ever, counted on", lambda s: wire_does(s.lms, (lambda kept: scans(lambda p: p.__setitem__(
        slice(DATA, DATA + 2 * big(p, COUNT)), kept.setdefault(0, bytes(p[DATA:DATA + 2 * big(p, COUNT)])))))({}), 4.0),
        then=RESUME),
    Fault("its telegram counter stands still", lambda s: wire_does(s.lms, scans(frozen(COUNTER)), 3.0)),
    Fault("its clock stands still", lambda s: wire_does(s.lms, scans(
        both(frozen(SINCE_START, 4), frozen(TRANSMITTED, 4))), 3.0)),
    Fault("its clock jumps 10 s ahead and back", lambda s: wire_does(s.lms, its_clock(10_000_000), 3.0)),
    Fault("its clock begins anew", lambda s: wire_does(s.lms, scans(
        counted_from_zero(SINCE_START, (SINCE_START, TRANSMITTED))), 4.0)),
    Fault("set to another step", lambda s: wire_does(s.lms, scans(every_second_beam), 3.0), "stands", 1.0, ["the scanner measures every"]),
    Fault("its field of view turned by 90 degrees", lambda s: wire_does(s.lms, scans(
        lambda p: set_big(p, START, big(p, START, 4) + 900_000, 4)), 3.0), "stands", 1.0, ["the scanner sees from"]),
    Fault("all ranges doubled by its scale", lambda s: wire_does(s.lms, scans(
        lambda p: set_big(p, SCALE, 0x40000000, 4)), 3.0), then=RESUME),
    Fault("ranges that are no numbers (scale NaN)", lambda s: wire_does(s.lms, scans(
        lambda p: set_big(p, SCALE, 0x7FC00000, 4)), 3.0), "stands", 1.0, ["nonsensical scale"]),
    Fault("it reports an error of its own", lambda s: wire_does(s.lms, scans(lambda p: set_big(p, 24, 1)), 3.0), "stands", 1.0,
          ["reports a device error"]),
    Fault("it reports a dirty front screen", lambda s: wire_does(s.lms, scans(lambda p: set_big(p, 24, 2)), 3.0), "goes on",
          told=["clean it soon"]),
    Fault("its front screen is too dirty", lambda s: wire_does(s.lms, scans(lambda p: set_big(p, 24, 4)), 3.0), "stands", 1.0,
          ["too dirty to measure"]),
    Fault("LMS1xx covered", lambda s: wire_does(s.lms, lms_ranges(lambda r, i: 0), 4.0)),
    Fault("a hand before a third of it", lambda s: wire_does(s.lms, lms_ranges(lambda r, i: 60 if i < 180 else r), 4.0)),
    Fault("LMS1xx: half of its view sees nothing", lambda s: wire_does(s.lms, lms_ranges(lambda r, i: 0 if i < 270 else r), 4.0)),
    Fault("LMS1xx: ranges 5 % too long", lambda s: wire_does(s.lms, lms_ranges(lambda r, i: int(r * 1.05)), 4.0)),
    Fault("LMS1xx: ranges with 0.1 m of noise", lambda s: wire_does(s.lms, lms_ranges(
        lambda r, i: max(0, r + int(s.chance.gauss(0, 100))) if r > 15 else r), 3.0)),
    Fault("LMS1xx: a twentieth of the beams ends in rain", lambda s: wire_does(s.lms, lms_ranges(
        lambda r, i: s.chance.randrange(300, 5000) if s.chance.random() < 0.05 else r), 4.0)),
    Fault("LMS1xx: no returns beyond 8 m", lambda s: wire_does(s.lms, lms_ranges(lambda r, i: r if r < 8000 else 0), 4.0)),
]

# Both look ahead, the S300 with its protective field: the LMS1xx is missed by nobody, the S300 by everybody.
PAIR_FAULTS = [
    Fault("of two scanners the LMS1xx silent for 4 s", lambda s: wire_does(s.lms, NOTHING, 4.0)),
    Fault("of two scanners the LMS1xx refuses connections for 5 s", lambda s: refuses(s, 5.0)),
    Fault("both scanners silent for 3 s", lambda s: both_silent(s, 3.0), "stands", 1.0, QUIET + FIELD, short=True),
    Fault("S300 silent for 2 s", lambda s: wire_does(s.s300, lambda d, to: b"", 2.0), "stands", 1.0, QUIET + FIELD, short=True),
    Fault("S300 silent for 15 s", lambda s: wire_does(s.s300, lambda d, to: b"", 15.0), "stands", 1.0, QUIET + FIELD),
    Fault("S300: the line stalls for 0.15 s, ten times", lambda s: [
        (wire_does(s.s300, lambda d, to: b"", 0.15), time.sleep(0.3)) for _ in range(10)]),
    Fault("S300: its plug pulled for 3 s", lambda s: unplugged(s.s300, 3.0), "stands", 1.0, QUIET + FIELD),
    Fault("S300: its plug pulled for 0.1 s", lambda s: unplugged(s.s300, 0.1)),
    Fault("S300: a tenth of the telegrams lost", lambda s: wire_does(s.s300, Telegrams(lambda t: s.chance.random() > 0.1), 3.0)),
    Fault("S300: every checksum wrong", lambda s: wire_does(s.s300, lambda d, to: bytes(b ^ 0x55 if b not in (0, 0x55, 0xFF) else b
                                                                                  for b in d), 3.0), "stands", 1.0, FIELD),
    Fault("S300: noise in between", lambda s: wire_does(
        s.s300, lambda d, to: d + s.chance.randbytes(5) if s.chance.random() < 0.2 else d, 3.0)),
    Fault("S300: noise alone", lambda s: wire_does(s.s300, lambda d, to: s.chance.randbytes(len(d)), 3.0), "stands", 1.0, FIELD),
    Fault("S300 in standby for 2 s", lambda s: wire_does(s.s300, Telegrams(values(lambda v: 0x4004)), 2.0), "stands", 1.0, FIELD),
    Fault("S300 locks out for 2 s", lambda s: wire_does(s.s300, Telegrams(lambda t: set_big(t, 12, 1)), 2.0), "stands", 1.0, FIELD),
    Fault("somebody in its protective field for 2 s", lambda s: wire_does(s.s300, Telegrams(entered), 2.0), "stands", 1.0, FIELD, short=True),
    Fault("a flicker in its protective field, ten times", lambda s: [(wire_does(s.s300, Telegrams(entered), 0.08), time.sleep(0.4)) for _ in range(10)]),
    Fault("S300: one telegram again and again", lambda s: wire_does(s.s300, Telegrams(the_same()), 3.0), "stands", 1.0, QUIET + FIELD),
    Fault("S300 switched on anew", lambda s: wire_does(s.s300, Telegrams(counted_from_zero(S300_SCAN, (S300_SCAN,))), 4.0)),
    Fault("S300 covered", lambda s: wire_does(s.s300, Telegrams(values(lambda v: 0)), 3.0)),
    Fault("S300: half of its view sees nothing", lambda s: wire_does(s.s300, Telegrams(
        lambda t: [put(t, S300_DATA + 2 * i, 0) for i in range(270)]), 3.0)),
    Fault("S300: a telegram of another length", lambda s: wire_does(s.s300, lambda d, to: d[:-2] if len(d) > 500 else d, 3.0), "stands",
          1.0, QUIET + FIELD),
]
SCANNER_FAULTS = {"lms1xx": LMS_FAULTS, "s300,lms1xx": PAIR_FAULTS}


def mounted(scene, factory):
    """The wires of a vehicle's scanners, and what `madori run` is told of them."""
    said = []
    for line in factory.log.read_text().splitlines():
        words = line.split()
        if words[:2] == ["lms1xx", "tcp"]:
            scene.lms = ColaWire(int(words[2].rsplit(":", 1)[1]))
            said += ["--lms", f"127.0.0.1:{scene.lms.port}"]
        if words[:2] == ["s300", "pty"]:
            scene.s300 = DriveWire(factory.devices / "s300", "s300_wire")
            said += ["--scanner", str(scene.s300.name)]
    return said
