"""Listens to the ground truth of a running virtual factory (`madori sim`, WebSocket on loopback)."""

import base64
import json
import os
import socket
import threading
import time


def come_first():
    """What stands for wires and measuring takes no time, however busy the computer is: the calling thread comes before
    ordinary work where that is permitted. Programs and threads that it starts do not."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, os.sched_param(12))
    except PermissionError:
        pass


class TruthListener:
    """Keeps every message with the wall clock at which it came: dictionaries with x_m, y_m, yaw_rad, linear_mps,
    angular_radps, collisions, and `received`."""

    def __init__(self, port):
        self.lock = threading.Lock()
        self.messages = []
        self.wire = socket.create_connection(("127.0.0.1", port), timeout=10)
        key = base64.b64encode(os.urandom(16)).decode()
        self.wire.sendall(
            f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
        )
        self.rest = b""
        while b"\r\n\r\n" not in self.rest:
            self.rest += self.wire.recv(4096)
        self.rest = self.rest.split(b"\r\n\r\n", 1)[1]
        self.wire.settimeout(None)
        self.said = time.time()
        threading.Thread(target=self.listen, daemon=True).start()

    def take(self, count):
        while len(self.rest) < count:
            more = self.wire.recv(65536)
            if not more:
                raise ConnectionError("the virtual factory has gone")
            self.rest += more
        head, self.rest = self.rest[:count], self.rest[count:]
        return head

    def say(self, kind, payload):
        """One masked control frame (the mask is zero)."""
        self.said = time.time()
        self.wire.sendall(bytes([0x80 | kind, 0x80 | len(payload)]) + b"\0\0\0\0" + payload)

    def listen(self):
        come_first()
        try:
            while True:
                first, second = self.take(2)
                size = second & 127
                if size == 126:
                    size = int.from_bytes(self.take(2), "big")
                elif size == 127:
                    size = int.from_bytes(self.take(8), "big")
                payload = self.take(size)
                if first & 15 == 9:
                    self.say(10, payload)  # a pong
                if time.time() - self.said > 30.0:
                    self.say(9, b"")  # the server hangs up on who says nothing for 300 s
                if first & 15 == 1:
                    message = json.loads(payload)
                    message["received"] = time.time()
                    with self.lock:
                        self.messages.append(message)
        except (ConnectionError, OSError):
            pass

    def since(self, moment):
        with self.lock:
            first = len(self.messages)
            while first > 0 and self.messages[first - 1]["received"] >= moment:
                first -= 1
            return self.messages[first:]

    def newest(self):
        with self.lock:
            return self.messages[-1] if self.messages else None
