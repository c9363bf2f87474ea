import type { Live } from "../api_types";
import type { Frame } from "./live_socket";
import { noScan, parseScan } from "./scan_frame";

/**
 * The server's last 30 s: u32 n, n bytes of JSON (Live), u32 m, m bytes of a scan frame, repeated. `now_ms` is
 * performance.now() at the newest of them.
 */
export function parseReplay(bytes: ArrayBuffer, now_ms: number): Frame[] {
  const view = new DataView(bytes);
  const frames: Frame[] = [];
  const block = (at: number) => {
    const size = view.getUint32(at, true);
    return { data: bytes.slice(at + 4, at + 4 + size), next: at + 4 + size };
  };
  for (let at = 0; at + 8 <= bytes.byteLength; ) {
    const text = block(at);
    const scan = block(text.next);
    at = scan.next;
    const live = JSON.parse(new TextDecoder().decode(text.data)) as Live;
    frames.push({ received_ms: live.stamp, live, scan: parseScan(scan.data) ?? noScan });
  }
  const newest = frames.at(-1)?.received_ms ?? 0;
  return frames.map((frame) => ({ ...frame, received_ms: now_ms - 1000 * (newest - frame.received_ms) }));
}
