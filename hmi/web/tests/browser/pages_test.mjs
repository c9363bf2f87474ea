// Every page, both themes, three languages, both panel sizes and a phone held upright, before a made-up vehicle: no finding of axe-core, no
// console error, targets of at least 20 mm (a phone's: 9 mm), nothing beyond the edge of the screen; pictures on request.
// Usage: pages_test.mjs PAGE [FOLDER_FOR_PICTURES]
import { existsSync, mkdirSync } from "node:fs";
import { join } from "node:path";
import { expect, openBrowser, openPanel, findings, skipUnlessInstalled } from "../../../../tests/end_to_end/panel/browser.mjs";
import { startMadeUpVehicle } from "./made_up_vehicle.mjs";

const [page, shots] = process.argv.slice(2);
const kSizes = [{ width: 1280, height: 800, target: 118 }, { width: 1024, height: 600, target: 93 }, { width: 390, height: 844, target: 46 }];

/** What to touch, one after the other: rail entry, tab, step; by place, for the words depend on the language. */
const pages = [
  ["drive", ".rail button >> nth=0", "[role=tab] >> nth=0"], ["drive-by-hand", null, "[role=tab] >> nth=1"], ["drive-replay", null, "[role=tab] >> nth=2"],
  ["setup-1-drawing", ".rail button >> nth=1", ".steps button >> nth=0"], ["setup-2-scale", null, ".steps button >> nth=1"], ["setup-3-routes", null, ".steps button >> nth=2"],
  ["setup-4-vehicle", null, ".steps button >> nth=3"], ["setup-4-details", null, "aside .buttons button >> nth=0"], ["setup-5-place", null, ".steps button >> nth=4"],
  ["history-events", ".rail button >> nth=2", "[role=tab] >> nth=0"], ["history-statistics", null, "[role=tab] >> nth=2"], ["history-downloads", null, "[role=tab] >> nth=3"],
  ["history-changes", null, "[role=tab] >> nth=1"], ["history-changes-one", null, "[data-change] button >> nth=0"], ["history-changes-wall", null, "[data-doubts] button >> nth=0"],
];

/** Touch targets that are smaller than 20 mm (the buttons on the map: 14 mm), or stick out of the screen. */
async function small(panel, target) {
  return panel.page.evaluate((least) => [...document.querySelectorAll("button, a.target, input.target")].flatMap((element) => {
    const { width, height, left, right } = element.getBoundingClientRect();
    if (width === 0 || element.closest("[hidden]")) return [];
    const wanted = (element.closest(".map-tools") ? 0.7 * least : least) - 0.6;
    const range = element.type === "range";
    const bad = (!range && width < wanted) || height < wanted || left < -1 || right > innerWidth + 1;
    return bad ? [`${element.textContent || element.getAttribute("aria-label")}: ${width.toFixed(0)} x ${height.toFixed(0)} at ${left.toFixed(0)}`] : [];
  }), target);
}

/** Words on buttons that are cut in two or stick out of them (Japanese may break anywhere). */
async function badWords(panel) {
  return panel.page.evaluate(() => [...document.querySelectorAll("button, a.target")].flatMap((element) => {
    const box = element.getBoundingClientRect();
    if (box.width === 0 || element.closest("[hidden]")) return [];
    const bad = [];
    const texts = document.createTreeWalker(element, NodeFilter.SHOW_TEXT);
    while (texts.nextNode()) {
      if (texts.currentNode.parentElement.closest(".unseen")) continue;
      for (const word of texts.currentNode.data.matchAll(/[\p{Script=Latin}]+/gu)) {
        const range = document.createRange();
        range.setStart(texts.currentNode, word.index);
        range.setEnd(texts.currentNode, word.index + word[0].length);
        const parts = [...range.getClientRects()];
        if (parts.length > 1 || parts.some((part) => part.left < box.left || part.right > box.right)) bad.push(word[0]);
      }
    }
    return bad;
  }));
}

/** A site without a drawing: what maps it, and the map that grows. `say` is what the vehicle says from then on. */
const mappingPages = [
  ["mapping-start", null, ".centre > .buttons button >> nth=-1"],
  ["mapping", null, ".map-tools button >> nth=0", { mapping: true, state: "manual", cause: { code: "mapping", values: {}, text: "x" }, remedy: { code: "drive-to-map", values: {}, text: "x" } }],
];

async function walk(browser, address, { width, height, target }, language, theme, walked = pages) {
  const panel = await openPanel(browser, address, { width, height, language, theme });
  const problems = [];
  for (const [name, entry, part, say] of walked) {
    if (say) vehicle.say(say);
    if (entry) await panel.page.locator(entry).tap();
    await panel.page.locator(part).tap();
    const where = `${name}, ${width}x${height}, ${language}, ${theme}`;
    for (const issue of await findings(panel.page)) problems.push(`${where}: ${issue}`);
    for (const issue of await small(panel, target)) problems.push(`${where}: too small or cut off: ${issue}`);
    for (const word of await badWords(panel)) problems.push(`${where}: cut or sticks out: ${word}`);
    if (shots) await panel.page.screenshot({ path: join(shots, `${name}-${width}x${height}-${language}-${theme}.png`) });
  }
  for (const error of panel.errors) problems.push(`${width}x${height}, ${language}, ${theme}: console: ${error}`);
  await panel.context.close();
  return problems;
}

skipUnlessInstalled();
if (!existsSync(join(page, "index.html"))) {
  console.log(`skipped: ${page} holds no built page (cmake --build build/release --target panel)`);
  process.exit(77);
}
if (shots) mkdirSync(shots, { recursive: true });
const vehicle = await startMadeUpVehicle(page, { points: 2000 });
const browser = await openBrowser();
try {
  const problems = [
    ...(await walk(browser, vehicle.address, kSizes[0], "en", "light")),
    ...(await walk(browser, vehicle.address, kSizes[1], "ja", "dark")),
    ...(await walk(browser, vehicle.address, kSizes[1], "de", "light")),
    ...(await walk(browser, vehicle.address, kSizes[2], "de", "dark")),
    ...(await walk(browser, vehicle.address, kSizes[2], "ja", "light")),
  ];
  const site = await (await fetch(`${vehicle.address}api/site`)).json();
  const sensors = ["made_up", "other", "third"].map((type) => ({ name: type, type, x_m: 0.3, y_m: 0, z_m: 1.2, yaw_deg: 0 }));
  vehicle.answer("/api/site", { ...site, drawing: null, scale: null, sensors: [] });
  vehicle.answer("/api/mapping", { state: "mapping", driven_m: 34, scans: 900, keyframes: 120, loops: 3, dropped: 0, problem: { code: "mapping-lost", values: {}, text: "x" }, revision: 1, walls: [[0, 0, 8, 0]], vehicle: site.vehicle, sensors: sensors.slice(0, 1), kinds: sensors.map((sensor) => ({ type: sensor.type, title: "Made-up", address: "", heard: false, detail: { code: "", values: {}, text: "" }, sensor })) });
  for (const [size, language, theme] of [[0, "en", "light"], [1, "ja", "dark"], [1, "de", "light"], [2, "de", "dark"]]) {
    vehicle.say({});
    problems.push(...(await walk(browser, vehicle.address, kSizes[size], language, theme, mappingPages)));
  }
  expect(problems.length === 0, problems.join("\n"));
  console.log(`${pages.length + mappingPages.length} pages, three sizes, two themes, three languages: nothing found`);
} catch (error) {
  console.error(String(error));
  process.exitCode = 1;
} finally {
  await browser.close();
  vehicle.stop();
}
