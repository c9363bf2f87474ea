// A new revision of the drawing in the panel: looked at before it replaces the old one, moved by hand, left, taken over; then
// a backup downloaded and restored. Every change of the revision is known (revised_factory.py): all are found, and none else,
// also by `madori diff` from a DXF.
// Usage: revision.mjs MADORI PAGE DATA SHOTS WIDTHxHEIGHT
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { askServer as api, dragFinger, expect, mapReady, findings, touch, until } from "./browser.mjs";
import { nearShare } from "./pieces.mjs";
import { runToEnd, startVehicle, temporaryFolder, freeUdpPort } from "./processes.mjs";
import { expectQuietConsole, given, openGivenPanel, picture, run } from "./program.mjs";

const { madori, page, data } = given;
const kLeastFound = 0.8;  // of a face's length; its ends join other walls

/** Every change is found, and nothing is said to have changed that has not. */
function expectChanges(preview, changes) {
  for (const kind of ["gone", "added"]) {
    const missed = changes[kind].filter((face) => nearShare(face, preview[kind]) < kLeastFound);
    const made_up = preview[kind].filter((piece) => nearShare(piece, changes[kind]) < 0.5);
    console.log(`${kind}: ${changes[kind].length - missed.length} of ${changes[kind].length} changed faces found, ${made_up.length} of ${preview[kind].length} pieces false`);
    expect(missed.length === 0, `${kind}: not found ${JSON.stringify(missed)}`);
    expect(made_up.length === 0, `${kind}: never changed ${JSON.stringify(made_up)}`);
  }
}

async function choose(panel, button, file) {
  const chooser = panel.page.waitForEvent("filechooser");
  await touch(panel, button);
  await (await chooser).setFiles(file);
}

async function preview(panel, file) {
  await choose(panel, "Another drawing", file);
  await panel.page.locator(".revision").waitFor({ timeout: 180_000 });
  await mapReady(panel);
  return (await api(panel, "GET", "/api/site/drawing/preview")).json;
}

const walls = async (panel) => (await api(panel, "GET", "/api/site/walls")).json;

async function lookAndLeave(panel, file, changes) {
  const before = await walls(panel);
  const found = await preview(panel, file);
  expectChanges(found, changes);
  expect(found.stations_lost.join() === "Batteries", `stations lost: ${found.stations_lost}`);
  expect((await panel.page.locator("[data-lost]").getAttribute("data-lost")) === "Batteries", "the lost station is not named");
  expect((await panel.page.locator(".map-canvas").getAttribute("data-faulty")) !== "", "the leg through the walled-up door is not marked");
  await picture(panel, "revision-preview");
  const issues = await findings(panel.page);
  expect(issues.length === 0, `axe: ${issues.join("; ")}`);
  await touch(panel, "Leave it as it is");
  await panel.page.getByRole("button", { name: "Another drawing" }).waitFor();
  expect((await walls(panel)).revision === before.revision, "the walls changed without a word");
}

/** The same by command line, from a DXF of the revision. */
function diffByCommand(site, folder, changes) {
  const file = join(folder, "diff.json");
  runToEnd(madori, ["diff", site, join(folder, "revised/drawn/factory.dxf"), "--json", file]);
  expectChanges(JSON.parse(readFileSync(file, "utf8")), changes);
}

/** A finger moves the new drawing by half a metre: it settles back, and nothing else is found. */
async function moveByHand(panel, changes) {
  await touch(panel, "Move it");
  const box = await panel.page.locator(".map-canvas").boundingBox();
  const from = { x: box.x + 0.3 * box.width, y: box.y + 0.75 * box.height };
  await dragFinger(panel, from, { x: from.x + 4, y: from.y - 2 });
  await picture(panel, "revision-moving");
  await touch(panel, "Lay it here");
  await panel.page.getByRole("button", { name: "Move it" }).waitFor();
  expectChanges((await api(panel, "GET", "/api/site/drawing/preview")).json, changes);
}

const lengths = ({ nodes, legs }) => legs.map(([a, b]) => {
  const [from, to] = [a, b].map((id) => nodes.find((node) => node.id === id));
  return Math.hypot(from.x - to.x, from.y - to.y);
});

async function takeOver(panel) {
  const routes = (await api(panel, "GET", "/api/site/routes")).json;
  const before = await walls(panel);
  await touch(panel, "Take it over");
  await until("the new drawing is the site's", async () => (await walls(panel)).revision !== before.revision, 30_000);
  const now = (await api(panel, "GET", "/api/site/routes")).json;
  const [was, is] = [lengths(routes), lengths(now)];
  expect(was.length === is.length && was.every((length, i) => Math.abs(length - is[i]) < 0.002 * length + 0.01), "the routes were not kept");
  expect(now.findings.some((one) => one.severity === "error"), "a check of the routes does not find the walled-up door");
  await panel.page.locator(".revision").waitFor({ state: "detached" });
  await panel.page.locator(".map-canvas[data-drawing=shown]").waitFor();
  await picture(panel, "revision-taken");
}

async function backUpAndRestore(panel, folder) {
  const versions = async () => (await api(panel, "GET", "/api/site/versions")).json;
  const before = await walls(panel);
  await touch(panel, "Look back");
  await touch(panel, "Downloads", { role: "tab" });
  const download = panel.page.waitForEvent("download");
  await panel.page.getByRole("link", { name: "Download a backup" }).tap();
  const backup = join(folder, "site.tar");
  await (await download).saveAs(backup);
  const { revision, walls: all } = before;
  const edit = await api(panel, "PUT", "/api/site/walls", { revision, walls: all.slice(3).map((wall) => wall.slice(0, 4)) });
  expect(edit.status === 200, `the walls were not saved: ${JSON.stringify(edit)}`);
  const known = await versions();
  await choose(panel, "Restore a backup", backup);
  await panel.page.getByRole("dialog").waitFor();
  await picture(panel, "backup-question");
  await panel.page.getByRole("dialog").getByRole("button", { name: "Restore a backup" }).tap();
  await until("the walls are as they were", async () => (await walls(panel)).revision === before.revision);
  const now = await versions();
  expect(now.length === known.length + 1 && known.every((one, i) => one.stamp === now[i].stamp), "a version was lost");
  await panel.page.locator(".toast").tap();
  await picture(panel, "backup-restored");
}

async function main(browser) {
  const folder = temporaryFolder();
  const site = join(folder, "site");
  runToEnd(madori, ["demo", "--import-only", "--site", site, "--data", data, "--json", join(folder, "import.json")]);
  runToEnd("/usr/bin/python3", [fileURLToPath(new URL("revised_factory.py", import.meta.url)), join(data, "sample_factory"), join(folder, "revised")]);
  const changes = JSON.parse(readFileSync(join(folder, "revised/changes.json"), "utf8"));
  const file = join(folder, "revised/drawn/factory_scan.png");
  const address = await startVehicle(madori, page, site, await freeUdpPort(), "none", ["--no-record"]);
  const panel = await openGivenPanel(browser, address);
  await touch(panel, "Set up");
  await panel.page.locator(".steps button").nth(0).tap();
  await lookAndLeave(panel, file, changes);
  diffByCommand(site, folder, changes);
  await preview(panel, file);
  await moveByHand(panel, changes);
  await takeOver(panel);
  await backUpAndRestore(panel, folder);
  expectQuietConsole(panel);
}

await run(main);
