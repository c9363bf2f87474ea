// Two panels look on while the vehicle drives for half an hour. One has a debugger and a processor throttled to a quarter: heap
// of the page, bytes a second, frames a second, beside a page that holds nothing but two canvases as large. The other has no
// debugger, whose log of every message would be counted as the page's memory: what its process holds (resident, without the
// program's own files). Usage: half_hour.mjs MADORI PAGE DATA SHOTS WIDTHxHEIGHT [MINUTES]
import { readdirSync, readFileSync } from "node:fs";
import { getPriority, setPriority } from "node:os";
import { join } from "node:path";
import { askServer as api, expect, kChromium, kQuiet, touch } from "./browser.mjs";
import { freeUdpPort, start, startFactory, startVehicle, temporaryFolder } from "./processes.mjs";
import { given, openGivenPanel, picture, run } from "./program.mjs";

const { madori, page, data } = given;
const minutes = Number(process.argv[7] ?? "30");
const kThrottle = 4;
const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];

/** Counts what comes over the wire and what is painted, from now on. */
async function measure(panel, throttle) {
  const session = await panel.context.newCDPSession(panel.page);
  for (const domain of ["Network", "Performance", "HeapProfiler"]) await session.send(`${domain}.enable`);
  if (throttle > 1) await session.send("Emulation.setCPUThrottlingRate", { rate: throttle });
  const seen = { bytes: 0, throttle, session, rows: [] };
  session.on("Network.webSocketFrameReceived", ({ response }) => { seen.bytes += response.opcode === 2 ? Math.floor((response.payloadData.length * 3) / 4) : response.payloadData.length; });
  session.on("Network.dataReceived", ({ encodedDataLength }) => { seen.bytes += encodedDataLength; });
  await panel.page.evaluate(() => {
    window.painted = 0;
    const tick = () => { ++window.painted; requestAnimationFrame(tick); };
    requestAnimationFrame(tick);
  });
  return seen;
}

/** What a minute was like: heap after a collection, what came, what was painted. */
async function minuteOf(panel, seen) {
  const [bytes, begun, painted] = [seen.bytes, performance.now(), await panel.page.evaluate(() => window.painted)];
  await panel.page.waitForTimeout(55_000);
  const spent_s = (performance.now() - begun) / 1000;
  const frames = (await panel.page.evaluate(() => window.painted)) - painted;
  const row = { kB_s: (seen.bytes - bytes) / spent_s / 1000, fps: frames / spent_s };
  await seen.session.send("HeapProfiler.collectGarbage");
  const { metrics } = await seen.session.send("Performance.getMetrics");
  const value = (name) => metrics.find((metric) => metric.name === name).value;
  seen.rows.push({ ...row, heap_MB: value("JSHeapUsedSize") / 1e6, nodes: value("Nodes") });
}

/** Frames a second of a page with nothing but the map's two canvases, drawn as often, throttled alike: what the machine can do. */
async function emptyPage(browser, map) {
  const page = await (await browser.newContext({ viewport: { width: given.width, height: given.height } })).newPage();
  await page.setContent(`<canvas width=${map.width} height=${map.height} style="position:absolute"></canvas>`.repeat(2));
  const session = await page.context().newCDPSession(page);
  await session.send("Emulation.setCPUThrottlingRate", { rate: kThrottle });
  await samePriority(browser);
  const fps = await page.evaluate(() => new Promise((done) => {
    const contexts = [...document.querySelectorAll("canvas")].map((canvas) => canvas.getContext("2d"));
    const [{ canvas: { width, height } }] = contexts;
    let painted = 0;
    let drawn = 0;
    const tick = () => { ++painted; requestAnimationFrame(tick); };
    requestAnimationFrame(tick);
    const timer = setInterval(() => requestAnimationFrame(() => {
      if (++drawn % 2) contexts[0].putImageData(new ImageData(width, height), 0, 0);
      contexts[1].clearRect(0, 0, width, height);
      contexts[1].fillRect((7 * drawn) % width, height / 2, 30, 30);
    }), 100);
    setTimeout(() => { clearInterval(timer); done(painted / 10); }, 10_000);
  }));
  await page.context().close();
  return fps;
}

async function processes(browser) {
  const session = await browser.newBrowserCDPSession();
  const { processInfo } = await session.send("SystemInfo.getProcessInfo");
  await session.detach();
  return processInfo;
}

/** A browser on its own before the Drive page, nobody's debugger on it. Answers how many MB its pages' processes hold. */
async function openUnwatched(address) {
  const { child } = await start(kChromium, [...kQuiet, "--headless=new", "--remote-debugging-port=0", `--user-data-dir=${temporaryFolder()}`, `--window-size=${given.width},${given.height}`, address], /DevTools listening/);
  const word = (id, file) => { try { return readFileSync(`/proc/${id}/${file}`, "utf8"); } catch { return ""; } };  // it may have ended
  const children = (id) => readdirSync("/proc").filter((other) => word(other, "status").match(/PPid:\s+(\d+)/)?.[1] === String(id));
  const family = (id) => [id, ...children(id).flatMap(family)];
  const kB = (id, name) => Number(word(id, "status").match(new RegExp(`${name}:\\s+(\\d+)`))?.[1] ?? 0);
  return () => family(child.pid).filter((id) => word(id, "cmdline").includes("--type=renderer")).reduce((sum, id) => sum + (kB(id, "VmRSS") - kB(id, "RssFile")) / 1000, 0);
}

/** Chromium sets the priority of its threads itself; here they get this program's (`nice -n -10 node half_hour.mjs` on a busy machine). */
async function samePriority(browser) {
  for (const { id } of await processes(browser))
    for (const thread of readdirSync(`/proc/${id}/task`)) setPriority(Number(thread), getPriority());
}

/** An order without end; a fault of a busy machine is confirmed. */
async function keepDriving(panel) {
  const orders = (await api(panel, "GET", "/api/orders")).json ?? [];
  if (!orders.some((order) => ["queued", "running"].includes(order.status))) {
    const { nodes } = (await api(panel, "GET", "/api/site/routes")).json;
    const stations = ["Press 1", "Machine M3"].map((name) => nodes.find((node) => node.name === name).id);
    await api(panel, "POST", "/api/orders", { stations, repeat: 1000 });
  }
  for (const word of ["confirm", "resume"]) await api(panel, "POST", `/api/vehicle/${word}`, {});
}

/** Medians of the first and of the last third. */
const thirds = (values) => [values.slice(0, Math.ceil(values.length / 3)), values.slice(-Math.ceil(values.length / 3))].map(median);

function report({ rows, throttle }) {
  const [first, last] = thirds(rows.map((row) => row.heap_MB));
  const rate = rows.reduce((sum, row) => sum + row.kB_s, 0) / rows.length;
  const [fps, least] = [median(rows.map((row) => row.fps)), Math.min(...rows.map((row) => row.fps))];
  console.log(`processor / ${throttle}: ${rate.toFixed(1)} kB/s; ${fps.toFixed(1)} frames/s (worst minute ${least.toFixed(1)}); heap ${first.toFixed(2)} MB in the first third, ${last.toFixed(2)} MB in the last; ${rows.at(-1).nodes} nodes`);
  return { rate, fps, first, last };
}

async function main(browser) {
  const folder = temporaryFolder();
  const lidar = await freeUdpPort();
  const drive = await startFactory(madori, data, join(folder, "site"), lidar, join(data, "scenarios/demo.yaml"));
  const address = await startVehicle(madori, page, join(folder, "site"), lidar, drive, ["--no-record"]);
  const unwatched = await openUnwatched(address);
  const panel = await openGivenPanel(browser, address);
  await touch(panel, "Drive", { exact: true });
  await panel.page.locator("[data-vehicle=shown]").waitFor({ timeout: 120_000 });
  await keepDriving(panel);
  await samePriority(browser);
  await panel.page.waitForTimeout(35_000);  // the page keeps 30 s to look back on: until then it grows
  const seen = await measure(panel, kThrottle);
  const map = await panel.page.locator(".map-canvas").first().boundingBox();
  const resident = [];
  const odometer = async () => (await api(panel, "GET", "/api/statistics")).json.distance_m;
  const begun_m = await odometer();
  for (let i = 0; i < minutes; ++i) {
    await minuteOf(panel, seen);
    await keepDriving(panel);
    resident.push(unwatched());
    const { kB_s, fps, heap_MB } = seen.rows.at(-1);
    console.log(`minute ${i + 1}: ${kB_s.toFixed(0)} kB/s ${fps.toFixed(1)} frames/s ${heap_MB.toFixed(2)} MB; the other panel holds ${resident.at(-1).toFixed(0)} MB`);
  }
  const empty = await emptyPage(browser, map);
  console.log(`a page with nothing but two canvases of ${map.width} x ${map.height}, processor / ${kThrottle}: ${empty.toFixed(1)} frames/s`);
  await picture(panel, "half-hour");
  console.log(`${minutes} minutes, ${((await odometer()) - begun_m).toFixed(0)} m driven`);
  const { rate, fps, first, last } = report(seen);
  const [held, holds] = thirds(resident);
  console.log(`the panel without a debugger: ${held.toFixed(1)} MB in the first third, ${holds.toFixed(1)} MB in the last`);
  expect(rate < 100, `${rate} kB/s`);
  expect(last < 1.05 * first, `the heap grew from ${first} to ${last} MB`);
  expect(holds < 1.05 * held, `the page's process grew from ${held} to ${holds} MB`);
  expect(fps >= 30, `${fps} frames/s on a throttled processor`);
}

await run(main);
