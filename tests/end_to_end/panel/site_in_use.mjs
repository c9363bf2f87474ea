// A finished site in use, before the real server and the virtual factory: the answers keep to the schema; the camera's
// picture comes; the walls get the colours of what the lidar saw; touches in quick succession all count; what is not
// saved survives a crash of the vehicle's program. Usage: site_in_use.mjs MADORI PAGE DATA SHOTS WIDTHxHEIGHT
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { expect, mapReady, touch, touchMap } from "./browser.mjs";
import { freeUdpPort, startComputer, startFactoryWithCamera, temporaryFolder } from "./processes.mjs";
import { expectQuietConsole, given, openGivenPanel, picture, run } from "./program.mjs";
import { misfits } from "./schema.mjs";

const { madori, page, data } = given;
const kAnswers = {
  "/api/session": "Session", "/api/setup": "Setup", "/api/site": "Site", "/api/site/walls": "Walls", "/api/site/walls/seen": "WallPiece[]", "/api/site/walls/doubted": "DoubtedWall[]", "/api/site/days": "KeptDays",
  "/api/site/routes": "Routes", "/api/site/routes/csv": "RoutesCsv", "/api/site/tiles": "TileInfo", "/api/site/tiles/sources": "TileSourceInfo[]",
  "/api/devices": "FoundDevice[]", "/api/devices/views": "LidarView[]", "/api/mounting": "MountingState", "/api/vehicle/braking": "Braking", "/api/locate": "Locate", "/api/orders": "Order[]", "/api/orders/history": "Order[]", "/api/events": "Event[]",
  "/api/statistics": "Statistics", "/api/recordings": "Recording[]", "/api/job": "Job",
};

const getJson = async (panel, path) => (await panel.context.request.get(new URL(path, panel.page.url()).href)).json();

async function expectSchema(panel) {
  const wrong = [];
  for (const [path, type] of Object.entries(kAnswers)) wrong.push(...misfits(type, await getJson(panel, path)).map((one) => `${path}: ${one}`));
  wrong.push(...misfits("ApiError", await getJson(panel, "/api/nothing")));
  const message = await panel.page.evaluate(() => new Promise((done) => {
    const socket = new WebSocket(`ws://${location.host}/api/live`);
    socket.onmessage = ({ data: text }) => { if (typeof text === "string") { done(JSON.parse(text)); socket.close(); } };
  }));
  wrong.push(...misfits("LiveMessage", message));
  expect(wrong.length === 0, `answers that are not what hmi/schema says:\n${wrong.slice(0, 20).join("\n")}`);
}

async function seeCamera(panel) {
  await touch(panel, "Drive");
  await touch(panel, "Camera", { role: "tab" });
  const image = panel.page.locator(".camera img");
  await image.waitFor();
  await panel.page.waitForFunction(() => document.querySelector(".camera img")?.naturalWidth > 0);
  expect((await image.evaluate((one) => one.naturalWidth)) === 320, "the camera's picture has another width");
  const first = await image.getAttribute("src");
  await panel.page.waitForFunction((old) => document.querySelector(".camera img").src !== old, first);
  await picture(panel, "drive-camera");
}

/** A machine that is too busy may silence the virtual drive for longer than the cycle allows: then a person confirms. */
async function goOn(panel) {
  const state = await panel.page.locator("[data-state]").getAttribute("data-state");
  if (state === "fault") await touch(panel, "Confirm");
  if (state === "paused") await touch(panel, "Resume");
}

async function driveAndSeeWalls(panel) {
  await touch(panel, "Orders", { role: "tab" });
  await touch(panel, "New order");
  await touch(panel, "Press 1", { exact: true });
  await touch(panel, "Send");
  const deadline = Date.now() + 120_000;
  let confirmed = 0;
  while (Date.now() < deadline) {
    await goOn(panel);
    const seen = await getJson(panel, "/api/site/walls/seen");
    confirmed = seen.filter((piece) => piece.state === "confirmed").length;
    if (confirmed >= 20) break;
    await panel.page.waitForTimeout(500);
  }
  expect(confirmed >= 20, `only ${confirmed} pieces of wall are confirmed`);
  await panel.page.locator(".legend").waitFor();
  await panel.page.waitForTimeout(300);
  await picture(panel, "drive-walls");
}

async function stopHere(panel) {
  await touch(panel, "Stop");
  await panel.page.locator("[data-state=paused]").waitFor();
}

const points = async (panel) => Number((await panel.page.locator(".facts").first().innerText()).match(/(\d+) points/)?.[1]);

/** Touches as fast as fingers (or a browser test) can: each sets its point. */
async function drawQuickly(panel) {
  await touch(panel, "Set up");
  await panel.page.locator(".steps button").nth(2).tap();
  await panel.page.getByText("Touch to set points").waitFor();
  await mapReady(panel);
  const before = await points(panel);
  // further apart, and from what is drawn, than a finger reaches on the smaller panel
  const places = [[56, 52], [63, 54], [69.5, 53.5], [71, 46.9], [57, 36], [74, 30], [33, 40], [25, 42]];
  const pixels = [];
  for (const place of places)
    pixels.push(await panel.page.evaluate((at) => {
      const target = document.querySelector(".map-canvas");
      const [u, v] = target.olMap.getPixelFromCoordinate(at);
      const { x, y } = target.getBoundingClientRect();
      return { x: x + u, y: y + v };
    }, place));
  const session = await panel.context.newCDPSession(panel.page);
  const sent = [];
  for (const pixel of pixels) {
    sent.push(session.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: [pixel] }));
    sent.push(session.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] }));
  }
  await Promise.all(sent);
  await panel.page.waitForFunction((wanted) => document.querySelector(".facts")?.textContent.includes(`${wanted} points`), before + places.length, { timeout: 10_000 })
    .catch(async () => { throw new Error(`${places.length} quick touches set ${(await points(panel)) - before} points`); });
  return before + places.length;
}

async function surviveCrash(panel, computer, site, drawn) {
  const shownPoints = `${drawn} points`;
  await computer.kill();
  await panel.page.getByText("Not saved yet").waitFor();
  expect((await points(panel)) === drawn, "the crash of the server lost what was drawn");
  panel.errors.length = 0;  // of the requests that nobody answered
  await computer.again();
  await panel.page.waitForFunction(async () => (await fetch("/api/session").catch(() => ({ ok: false }))).ok);
  await panel.page.reload();  // the browser may have gone too
  panel.errors.length = 0;
  await touch(panel, "Set up");
  await panel.page.locator(".steps button").nth(2).tap();
  await panel.page.getByText(shownPoints).waitFor();
  await panel.page.getByText("Not saved yet").waitFor();
  await mapReady(panel);
  await picture(panel, "3-routes-after-crash");
  await touch(panel, "Save, next");
  await panel.page.getByText("Sensors and drive").waitFor();
  const rows = readFileSync(join(site, "routes/path.csv"), "utf8").trim().split("\n").length - 1;
  expect(rows === drawn, `path.csv holds ${rows} points, not ${drawn}`);
}

async function main(browser) {
  const folder = temporaryFolder();
  const lidar = await freeUdpPort();
  const site = join(folder, "site");
  const { drive, camera } = await startFactoryWithCamera(madori, data, site, lidar, join(data, "scenarios/demo.yaml"));
  const computer = await startComputer(madori, page, site, lidar, drive, ["--camera", camera, "--no-record"]);
  const panel = await openGivenPanel(browser, computer.address);
  await seeCamera(panel);
  await driveAndSeeWalls(panel);
  await expectSchema(panel);
  await stopHere(panel);
  const drawn = await drawQuickly(panel);
  await surviveCrash(panel, computer, site, drawn);
  expectQuietConsole(panel);
}

await run(main);
