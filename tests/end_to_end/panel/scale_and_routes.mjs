// On a finished site: a plan placed with four point pairs on served tiles gets its scale within 0.2 %; a route drawn by
// touch and exported is what `madori route` reads; the published CSV files go through byte for byte; axe-core finds no
// serious issue on any page in both themes. Usage: ... MADORI PAGE DATA SHOTS WIDTHxHEIGHT
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { expect, mapReady, findings, touch, touchMap } from "./browser.mjs";
import { freeUdpPort, runToEnd, startVehicle, temporaryFolder } from "./processes.mjs";
import { expectQuietConsole, given, openGivenPanel, picture, run } from "./program.mjs";
import { mercator, placeOf, serveTiles } from "./tiles.mjs";

const kOrigin = { latitude: 35.464478, longitude: 136.739235 };
const kTrueScale = 0.025;
const kTolerance = 0.002;
// tables 2 and 3 of the layout-map paper (Sasaki, Tsuda, Matsushita, Electronics 2024, 13, 1082), and what a spreadsheet writes
const kPublished = {
  tree: "ID,EDA\n0,1\n1,0 2 3\n2,1 3\n3,1 4\n4,3\n5,2\n",
  path: "ID,x,y\n0,0,0\n1,1.8,-0.1\n2,5.46,-0.61\n3,2.34,1.7\n4,2.46,4.22\n5,5.28,-3.52\n",
};
const kSpreadsheet = { tree: "ID,EDA\r\n1,2\r\n2,1 3\r\n3,2\r\n", path: "ID,x,y\r\n1,45.05,52.30\r\n2,45.2,46.20\r\n3,46.800,43.4\r\n" };
const { madori, page, data } = given;

const readRows = (file) => readFileSync(file, "utf8").trim().split("\n").slice(1).map((line) => line.split(",").map(Number));

/** The wall corners nearest to the four corners of the drawing: far apart, and seen on both pictures. */
function farCorners(walls, [w, h]) {
  const ends = walls.flatMap(([u1, v1, u2, v2]) => [[u1, v1], [u2, v2]]);
  return [[0, 0], [w, 0], [w, h], [0, h]].map(([u, v]) => ends.reduce((best, end) => (Math.hypot(end[0] - u, end[1] - v) < Math.hypot(best[0] - u, best[1] - v) ? end : best)));
}

/** A figure, by its field and the pad. */
async function enter(panel, label, value) {
  await touch(panel, label);
  await panel.page.getByRole("dialog").waitFor();
  await panel.page.keyboard.type(String(value));
  await touch(panel, "OK", { exact: true });
  await panel.page.getByRole("dialog").waitFor({ state: "detached" });
}

async function placeByPairs(panel, tiles, walls, placeOfPixel, drawing, unit) {
  await panel.page.locator(".steps button").nth(1).tap();
  await touch(panel, "Point pairs");
  for (const [label, value] of [["Latitude", kOrigin.latitude], ["Longitude", kOrigin.longitude], ["Radius", 70]]) await enter(panel, label, value);
  await panel.page.getByLabel("Source, or the address").fill(tiles.url);
  await panel.page.locator(".fetch-tiles .primary").tap();
  await panel.page.locator(".photo .map-canvas").waitFor();
  await mapReady(panel, 0);
  await mapReady(panel, 1);
  for (const [u, v] of farCorners(walls, drawing)) {
    await touchMap(panel, [u * unit, (drawing[1] - v) * unit], 0);
    await touchMap(panel, mercator(placeOfPixel(u, v)), 1);
  }
  const verdict = panel.page.locator("[data-verdict]");
  await verdict.waitFor();
  await picture(panel, "2-pairs");
  return Number(await verdict.getAttribute("data-m-per-px"));
}

async function layOver(panel) {
  await touch(panel, "Lay over photo");
  await mapReady(panel, 0);
  await panel.page.getByText("Z_m, drawing").waitFor();
  await panel.page.locator("[data-drawing=shown]").waitFor();
  await picture(panel, "2-overlay");
}

/** The published interface: the scale is what Z_m and Z_p say, by Eq. (9) of the layout-map paper, U = L_t / (R_t Z_p) Z_m. */
async function setOverlayNumbers(panel, site) {
  const zp = 2.5;
  const { zoom, tile_px } = await (await panel.context.request.get(new URL("/api/site/tiles", panel.page.url()).href)).json();
  const tileSide_m = (2 * Math.PI * 6378137 * Math.cos((kOrigin.latitude * Math.PI) / 180)) / 2 ** zoom;
  const zm = (kTrueScale * tile_px * zp) / tileSide_m;
  await enter(panel, "Z_p, photo", zp);
  await enter(panel, "Z_m, drawing", zm.toPrecision(6));
  const shown = async (label) => Number((await panel.page.getByRole("button", { name: label }).locator("span").innerText()).trim());
  expect(Math.abs((await shown("Z_p, photo")) / zp - 1) < 1e-3, `Z_p is shown as ${await shown("Z_p, photo")}`);
  expect(Math.abs((await shown("Z_m, drawing")) / zm - 1) < 1e-3, `Z_m is shown as ${await shown("Z_m, drawing")}, not ${zm}`);
  const wanted = (scale) => Math.abs(Number(scale) / kTrueScale - 1) <= kTolerance / 4;
  await panel.page.waitForFunction(([truth, part]) => Math.abs(Number(document.querySelector("[data-verdict]")?.dataset.mPerPx) / truth - 1) <= part, [kTrueScale, kTolerance / 4]);
  await picture(panel, "2-overlay-numbers");
  await touch(panel, "Use this scale");
  await panel.page.getByText("Touch to set points").waitFor();
  const applied = readFileSync(join(site, "site.yaml"), "utf8").match(/m_per_px: ([\d.e-]+)/)?.[1];
  console.log(`Z_m and Z_p set: ${(100 * (Number(applied) / kTrueScale - 1)).toFixed(4)} % off the true scale`);
  expect(wanted(applied), `site.yaml has the scale ${applied}`);
}

async function drawAndExport(panel, site) {
  await panel.page.locator(".steps button").nth(2).tap();
  await panel.page.getByText("Touch to set points").waitFor();
  await mapReady(panel);
  for (const place of [[61, 51], [70, 51], [65, 58]]) await touchMap(panel, place);
  await touch(panel, "Station", { exact: true });
  await touch(panel, "Save, next");
  await panel.page.getByText("Sensors and drive").waitFor();
  const csv = async (name) => (await panel.context.request.get(new URL(`/api/site/routes/${name}`, panel.page.url()).href)).body();
  for (const name of ["tree.csv", "path.csv"])
    expect((await csv(name)).equals(readFileSync(join(site, "routes", name))), `${name} is not what lies on the disk`);
  const rows = readRows(join(site, "routes/path.csv"));
  const [from, , to] = rows.slice(-3).map((row) => row[0]);
  runToEnd(madori, ["route", site, "--from", String(from), "--to", String(to), "--json", join(site, "route.json")]);
  const route = JSON.parse(readFileSync(join(site, "route.json"), "utf8"));
  expect(JSON.stringify(route.nodes ?? route.ids ?? route.route) === JSON.stringify(rows.slice(-3).map((row) => row[0])), `madori route reads another way: ${JSON.stringify(route).slice(0, 200)}`);
}

/** The checks' findings come some time after the points, and what stands below them moves down. */
async function standsStill(panel, target) {
  for (let before = null, now = ""; now !== before; await panel.page.waitForTimeout(700)) {
    before = now;
    now = JSON.stringify(await target.boundingBox());
  }
}

/** Two files in, and out again byte for byte. */
async function importAndExport(panel, folder, tree, path, points) {
  writeFileSync(join(folder, "tree.csv"), tree);
  writeFileSync(join(folder, "path.csv"), path);
  await panel.page.locator(".steps button").nth(2).tap();
  const chooser = panel.page.waitForEvent("filechooser");
  await touch(panel, "Import CSV");
  await (await chooser).setFiles([join(folder, "tree.csv"), join(folder, "path.csv")]);
  await panel.page.getByText(`${points} points`).waitFor();
  await standsStill(panel, panel.page.getByRole("link", { name: "tree.csv" }));
  for (const [name, text] of [["tree.csv", tree], ["path.csv", path]]) {
    const download = panel.page.waitForEvent("download");
    await touch(panel, name, { role: "link" });
    expect(readFileSync(await (await download).path(), "utf8") === text, `${name} did not come back byte for byte`);
  }
}

const checkAccess = async (panel, where) => (await findings(panel.page)).map((issue) => `${where}: ${issue}`);

async function checkEveryPage(panel) {
  const problems = [];
  for (const theme of ["light", "dark"]) {
    const look = async (name) => {
      problems.push(...(await checkAccess(panel, `${name}, ${theme}`)));
      if (theme === "dark") await picture(panel, `dark-${name}`);
    };
    await touch(panel, "Drive");
    for (const tab of ["Orders", "By hand", "Last 30 s"]) {
      await touch(panel, tab, { role: "tab" });
      await look(`drive-${tab.replaceAll(" ", "-").toLowerCase()}`);
    }
    await touch(panel, "Look back");
    for (const tab of ["Events", "What changed", "Statistics", "Downloads"]) {
      await touch(panel, tab, { role: "tab" });
      await look(`history-${tab.replaceAll(" ", "-").toLowerCase()}`);
    }
    await touch(panel, "Set up");
    for (let step = 0; step < 5; ++step) {
      await panel.page.locator(".steps button").nth(step).tap();
      await look(`setup-${step + 1}`);
    }
    await touch(panel, "Light or dark");
  }
  expect(problems.length === 0, `axe-core: ${[...new Set(problems)].join("\n")}`);
}

async function main(browser) {
  const folder = temporaryFolder();
  const site = join(folder, "site");
  runToEnd(madori, ["demo", "--import-only", "--site", site, "--data", data, "--json", join(folder, "import.json")]);
  const drawing = [4205, 2970];
  const turned = (12 * Math.PI) / 180;
  // the drawing on Earth: its middle at the origin, turned by 12 degrees
  const placeOfPixel = (u, v) => {
    const x = (u - drawing[0] / 2) * kTrueScale;
    const y = (drawing[1] / 2 - v) * kTrueScale;
    return placeOf(kOrigin, x * Math.cos(turned) - y * Math.sin(turned), x * Math.sin(turned) + y * Math.cos(turned));
  };
  const walls = readRows(join(data, "sample_factory/true_walls_scan_px.csv"));
  const tiles = await serveTiles(walls.map(([u1, v1, u2, v2]) => [placeOfPixel(u1, v1), placeOfPixel(u2, v2)]));
  const lidar = await freeUdpPort();
  const address = await startVehicle(madori, page, site, lidar, join(folder, "no-drive"));
  const panel = await openGivenPanel(browser, address);
  await touch(panel, "Set up");
  const scale = await placeByPairs(panel, tiles, walls, placeOfPixel, drawing, kTrueScale);
  const off = Math.abs(scale / kTrueScale - 1);
  console.log(`four point pairs: ${(100 * off).toFixed(3)} % off the true scale`);
  expect(off <= kTolerance, `the scale is ${(100 * off).toFixed(3)} % off`);
  await layOver(panel);
  await setOverlayNumbers(panel, site);
  await drawAndExport(panel, site);
  await importAndExport(panel, folder, kPublished.tree, kPublished.path, 6);
  await importAndExport(panel, folder, kSpreadsheet.tree, kSpreadsheet.path, 3);
  await checkEveryPage(panel);
  expectQuietConsole(panel);
  tiles.close();
}

await run(main);
