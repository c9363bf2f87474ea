// What changed in the building, before the real server and the virtual factory: the vehicle keeps its own day; made-up days
// before it are shown in their place and compared; a wall that the lidar looks through is taken out by one touch, put back,
// and said to stand. Usage: changes.mjs MADORI PAGE DATA SHOTS WIDTHxHEIGHT
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { cellsOf, dayBefore } from "../../../hmi/web/tests/browser/made_up_days.mjs";
import { askServer as api, expect, mapReady, pixelOf, touch, until } from "./browser.mjs";
import { keepDay, placeOf } from "./day_files.mjs";
import { lengthOf } from "./pieces.mjs";
import { freeUdpPort, startComputer, startFactory, temporaryFolder } from "./processes.mjs";
import { expectQuietConsole, given, openGivenPanel, picture, run } from "./program.mjs";
import { misfits } from "./schema.mjs";

const { madori, page, data } = given;
const kMissed = 12; // looks through the pieces that are doubted
const kDoubted = [4, 2]; // pieces of two walls, about a metre each
const kShelf = [17, 34, 21, 37]; // stands on every day, metres of the Map frame
const kGone = [28, 22, 29.5, 23];
const kMoved = [[33, 28.5, 34.25, 29.5], [35, 28.5, 36.25, 29.5]]; // then and now
const kNew = [52, 40, 54, 41.5];

/** A machine that is too busy may silence the virtual drive for longer than the cycle allows: then a person confirms. */
async function goOn(panel) {
  const button = { fault: "confirm", paused: "resume" }[await panel.page.locator("[data-state]").getAttribute("data-state")];
  if (button) await panel.page.locator(`.command.${button}`).tap({ timeout: 1000 }).catch(() => undefined);
}

/** The first life: it drives until its place is sure and walls are confirmed, and what it saw becomes its day. Answers the walls and the day's frame. */
async function firstLife(panel, computer, site) {
  await touch(panel, "Drive", { exact: true });
  const { nodes } = (await api(panel, "GET", "/api/site/routes")).json;
  const order = await api(panel, "POST", "/api/orders", { stations: [nodes.find((node) => node.name === "Press 1").id], repeat: 1 });
  expect(order.status === 200, `the order was refused: ${JSON.stringify(order)}`);
  await until("walls are confirmed", async () => {
    await goOn(panel);
    return (await api(panel, "GET", "/api/site/walls/seen")).json.filter((piece) => piece.state === "confirmed").length >= 20;
  }, 120_000);
  const walls = (await api(panel, "GET", "/api/site/walls")).json.walls;
  await computer.end();
  const today = dayBefore(0);
  expect(existsSync(join(site, "learned/days", `${today}.png`)), `the vehicle kept no day ${today}`);
  const { version, day, frame, cell_m } = placeOf(site, today);
  expect(version === "1" && day === today && cell_m === 0.25 && /^[0-9a-f]{16}$/.test(frame), `its day says ${version} ${day} ${frame} ${cell_m}`);
  return { walls, frame };
}

/** Four days before today: a pallet that is gone since three days ago, one that moved and one that came. */
function makeUpDays(site, frame, walls) {
  const [width, height] = [0, 1].map((axis) => Math.ceil(Math.max(...walls.flatMap((wall) => [wall[axis], wall[axis + 2]]))) + 2);
  for (const ago of [16, 8, 3, 1]) {
    const day = cellsOf([0, 0, width, height]);
    day.fill([12, 10, width - 1, height - 1], "free");
    for (const wall of walls) day.line(wall, "static");
    day.fill(kShelf, "static");
    day.fill(kGone, ago > 3 ? "semi_static" : "taken_away");
    day.fill(kMoved[ago > 1 ? 0 : 1], "semi_static");
    if (ago <= 3) day.fill(kNew, "semi_static");
    keepDay(site, dayBefore(ago), frame, day);
  }
}

/** Pieces of two long walls that are far from the vehicle have been looked through; answers each as one stretch, the longer first. */
function doubtWalls(site, vehicle) {
  const file = join(site, "reliability.csv");
  const [header, ...rows] = readFileSync(file, "utf8").trim().split("\n").map((line) => line.split(","));
  const walls = new Map();
  for (const row of rows) walls.set(row[0], [...(walls.get(row[0]) ?? []), row]);
  const far = ([, , x, y]) => Math.hypot(Number(x) - vehicle.x, Number(y) - vehicle.y);
  const long = [...walls.values()].filter((pieces) => pieces.length >= kDoubted[0] + 2).sort((a, b) => far(b[0]) - far(a[0]));
  const other = long.findIndex((pieces) => Math.hypot(pieces[0][2] - long[0][0][2], pieces[0][3] - long[0][0][3]) > 10);  // no second face of it
  const stretches = [long[0], long[other]].map((pieces, i) => pieces.slice(1, 1 + kDoubted[i]));
  for (const row of stretches.flat()) row.splice(6, 7, 0, 0, kMissed, 0, 0, 0, "missing");
  writeFileSync(file, `${[header, ...rows].map((row) => row.join(",")).join("\n")}\n`);
  return stretches.map((pieces) => [...pieces[0].slice(2, 4), ...pieces.at(-1).slice(4, 6)].map(Number));
}

/** The colour of the map at a place, as #rrggbb, and those of the legend. */
const colours = (panel, places) => panel.page.evaluate((pixels) => {
  const map = document.querySelector(".map-canvas");
  const box = map.getBoundingClientRect();
  const context = map.querySelector(".ol-layer canvas, canvas.ol-layer").getContext("2d");
  const hex = (rgb) => `#${[...rgb].slice(0, 3).map((one) => Number(one).toString(16).padStart(2, "0")).join("")}`;
  const legend = (name) => hex(getComputedStyle(document.querySelector(`.legend .day-${name}`)).backgroundColor.match(/\d+/g));
  return { at: pixels.map(({ x, y }) => hex(context.getImageData(Math.round(x - box.x), Math.round(y - box.y), 1, 1).data)), grey: legend("grey"), floor: legend("floor") };
}, places);

const middle = ([x0, y0, x1, y1]) => [(x0 + x1) / 2, (y0 + y1) / 2];

/** The slider at yesterday: its picture lies where its cells are, not mirrored and not a cell beside. */
async function seeYesterday(panel) {
  const yesterday = dayBefore(1);
  const slider = await panel.page.locator(".day-slider input").boundingBox();
  await panel.page.touchscreen.tap(slider.x + 22 + 0.75 * (slider.width - 44), slider.y + slider.height / 2);
  await panel.page.locator(`.map-canvas[data-day="${yesterday}"]`).waitFor();
  await mapReady(panel);
  const [x0, y0, x1, y1] = kShelf;
  const inside = [[x0 + 0.3, y0 + 0.3], [x1 - 0.3, y0 + 0.3], [x0 + 0.3, y1 - 0.3]];
  const outside = [[x0 - 0.6, y0 + 1], [x1 + 0.6, y1 - 1], [x0 + 1, y1 + 0.6], [x1 - 1, y0 - 0.6]];
  const pixels = [];
  for (const place of [...inside, ...outside]) pixels.push(await pixelOf(panel, place));
  const seen = await colours(panel, pixels);
  const like = (a, b) => [1, 3, 5].every((at) => Math.abs(Number.parseInt(a.slice(at, at + 2), 16) - Number.parseInt(b.slice(at, at + 2), 16)) < 30);  // the scan's paper is not quite white
  expect(seen.at.slice(0, 3).every((one) => like(one, seen.grey)), `the shelf is ${seen.at.slice(0, 3)}, not ${seen.grey}`);
  expect(seen.at.slice(3).every((one) => like(one, seen.floor)), `beside the shelf is ${seen.at.slice(3)}, not ${seen.floor}`);
}

/** Whether a place has come to the middle of the map (which the slider moves up a little). */
const isShown = async (panel, [x, y]) => {
  const [cx, cy] = await panel.page.evaluate(() => document.querySelector(".map-canvas").olMap.getView().getCenter());
  return Math.hypot(x - cx, y - cy) < 4;
};
const marks = (panel, what) => panel.page.evaluate((mark) => document.querySelector(".map-canvas").olMap.getLayers().getArray()
  .flatMap((layer) => layer.getSource()?.getFeatures?.() ?? []).filter((feature) => feature.get("mark") === mark).length, what);

/** Since a week before yesterday one is gone, one new, one moved; a touch brings the map there. */
async function seeChanges(panel) {
  await panel.page.locator(`.facts[data-since="${dayBefore(8)}"][data-known=yes]`).waitFor();
  for (const kind of ["gone", "new", "moved"]) expect((await panel.page.locator(`[data-change=${kind}]`).count()) === 1, `not one is ${kind}: ${await panel.page.locator("aside .files").innerText()}`);
  expect((await panel.page.locator("[data-change=gone]").innerText()).includes("3 days ago"), "it is not said since when it is gone");
  expect((await panel.page.locator("[data-change=moved]").innerText()).includes("2.0 m"), "it is not said how far it moved");
  await picture(panel, "history-changes");
  await panel.page.locator("[data-change=gone] button").tap();
  await until("the map shows what is gone", () => isShown(panel, middle(kGone)), 10_000);
  expect((await marks(panel, "chosen")) > 0, "what was touched is not marked");
  await touch(panel, "Day before");
  await panel.page.locator(`.facts[data-since="${dayBefore(3)}"][data-known=yes]`).waitFor();
  expect((await panel.page.locator("[data-change]").count()) === 1, "since the day before not only the moved one is told");
}

const metres = async (panel) => (await api(panel, "GET", "/api/site/walls")).json.walls.reduce((sum, wall) => sum + lengthOf(wall), 0);
const asked = (panel, count) => panel.page.locator(`[data-doubts="${count}"]`);  // one of so many questions

/** Taken out by one touch, as a version of the site; the other question stays, for what was learned of other walls does. Put back. */
async function takeOutAndPutBack(panel, stretch) {
  await asked(panel, 2).waitFor();
  const text = await asked(panel, 2).innerText();
  expect(text.includes(`${lengthOf(stretch).toFixed(1)} m`) && text.includes(`${kMissed} times`), `it is asked: ${text}`);
  await asked(panel, 2).locator("button").first().tap();
  await until("the map shows the wall", () => isShown(panel, middle(stretch)), 10_000);
  await mapReady(panel);
  await picture(panel, "history-changes-wall");
  const before = await metres(panel);
  const versions = (await api(panel, "GET", "/api/site/versions")).json.length;
  await touch(panel, "Gone: take it out of the walls");
  await panel.page.locator(".taken-out").waitFor();
  const less = before - (await metres(panel));
  expect(Math.abs(less - lengthOf(stretch)) < 0.01, `${less.toFixed(2)} m of wall went instead of ${lengthOf(stretch).toFixed(2)}`);
  expect((await api(panel, "GET", "/api/site/versions")).json.length > versions, "the edit is no version of the site");
  await asked(panel, 1).waitFor();
  await picture(panel, "history-changes-taken");
  await touch(panel, "Put it back");
  await until("the wall is back", async () => Math.abs((await metres(panel)) - before) < 0.001);
}

/** Said to stand: not asked again, and the walls are as they were. */
async function sayItStands(panel, site, stretch) {
  await until("the vehicle has taken the walls", async () => (await api(panel, "GET", "/api/site/walls/doubted")).json.length === 1, 60_000);
  const before = await metres(panel);
  await asked(panel, 1).locator("button").first().tap();
  await touch(panel, "It is still there");
  await panel.page.locator("[data-doubts]").waitFor({ state: "detached" });
  const [, line, more] = readFileSync(join(site, "learned/standing_walls.csv"), "utf8").trim().split("\n");
  const kept = line.split(",").slice(1, 5).map(Number);
  expect(more === undefined && kept.every((value, i) => Math.abs(value - stretch[i]) < 1e-4), `the answer is kept as ${line}`);
  expect(Math.abs((await metres(panel)) - before) < 0.001, "a wall that stands was changed");
  expect((await api(panel, "GET", "/api/site/walls/doubted")).json.length === 0, "it is asked again");
}

async function expectSchema(panel) {
  const [a, b] = [dayBefore(8), dayBefore(1)];
  for (const [path, type] of [["/api/site/days", "KeptDays"], [`/api/site/days/${a}/against/${b}`, "DayChanges"], ["/api/site/walls/doubted", "DoubtedWall[]"]]) {
    const wrong = misfits(type, (await api(panel, "GET", path)).json);
    expect(wrong.length === 0, `${path}: ${wrong.slice(0, 5).join("; ")}`);
  }
}

async function main(browser) {
  const folder = temporaryFolder();
  const site = join(folder, "site");
  const lidar = await freeUdpPort();
  const drive = await startFactory(madori, data, site, lidar, join(data, "scenarios/demo.yaml"));
  const computer = await startComputer(madori, page, site, lidar, drive, ["--no-record"]);
  const panel = await openGivenPanel(browser, computer.address);
  const { walls, frame } = await firstLife(panel, computer, site);
  makeUpDays(site, frame, walls);
  const [gone, stands] = doubtWalls(site, { x: 46, y: 48 });
  await computer.again();
  await panel.page.reload();
  panel.errors.length = 0;  // of the time between the lives
  await touch(panel, "Look back");
  await touch(panel, "What changed", { role: "tab" });
  await panel.page.locator(`.map-canvas[data-day="${dayBefore(0)}"]`).waitFor();
  await expectSchema(panel);
  await seeYesterday(panel);
  await seeChanges(panel);
  await takeOutAndPutBack(panel, gone);
  await sayItStands(panel, site, stands);
  expectQuietConsole(panel);
}

await run(main);
