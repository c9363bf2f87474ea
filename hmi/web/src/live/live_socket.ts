import type { Live, LiveMessage, Notice } from "../api_types";
import { Store } from "../store";
import { noScan, parseScan, type Scan } from "./scan_frame";

export interface Frame {
  received_ms: number;
  live: Live;
  scan: Scan;
}

/** What a page may be editing; other panels are told. */
export type Editing = "drawing" | "scale" | "walls" | "routes" | "vehicle" | "";

const REPLAY_S = 30;
const RETRY_MS = [250, 500, 1000, 2000];

/** /api/live: the newest state and scan, the last 30 seconds, and hold-to-run jogging. Reconnects by itself. */
export class LiveSocket {
  readonly newest = new Store<Frame | null>(null);
  readonly connected = new Store(false);
  /** counts how often the connection was lost or not made */
  readonly lost = new Store(0);
  readonly refusal = new Store<Notice | null>(null);
  readonly history: Frame[] = [];
  private socket: WebSocket | null = null;
  private scan = noScan;
  private failures = 0;
  private closed = false;
  private edited: Editing = "";

  constructor(private readonly url = `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/api/live`) {}

  open(): void {
    this.closed = false;
    if (this.socket && this.socket.readyState <= WebSocket.OPEN) return;
    const socket = new WebSocket(this.url);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.failures = 0;
      this.connected.set(true);
      if (this.edited !== "") this.send({ editing: this.edited });
    };
    socket.onmessage = (event) => this.take(event.data as string | ArrayBuffer);
    socket.onclose = () => {
      if (this.socket !== socket) return;
      this.connected.set(false);
      this.lost.set(this.lost.value + 1);
      const wait = RETRY_MS[Math.min(this.failures++, RETRY_MS.length - 1)] ?? 2000;
      if (!this.closed) setTimeout(() => this.open(), wait);
    };
    this.socket = socket;
  }

  close(): void {
    this.closed = true;
    this.socket?.close();
    this.socket = null;
    this.connected.set(false);
  }

  /** Metres and radians a second. The vehicle stops when no call follows within 250 ms. */
  jog(linear: number, angular: number): void {
    this.send({ jog: { linear, angular } });
  }

  /** Tells the other panels what is being edited here. */
  editing(what: Editing): void {
    if (what === this.edited) return;
    this.edited = what;
    this.send({ editing: what });
  }

  private send(message: object): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  private take(data: string | ArrayBuffer): void {
    if (typeof data !== "string") {
      this.scan = parseScan(data) ?? this.scan;
      return;
    }
    const message = JSON.parse(data) as LiveMessage;
    if (message.refused) this.refusal.set(message.refused);
    const now = performance.now();
    const frame = { received_ms: now, live: message.live, scan: this.scan };
    this.history.push(frame);
    while (this.history[0] && now - this.history[0].received_ms > REPLAY_S * 1000) this.history.shift();
    this.newest.set(frame);
  }
}

export const live = new LiveSocket();
