// A site from a drawing that no other test uses, from an empty folder to a delivered order, by touch alone: its touches are
// counted, and a film strip of it is left beside the pictures. The drawings are not part of the project.
// Usage: film_strip.mjs MADORI PAGE DATA SHOTS WIDTHxHEIGHT CORPUS
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { expect } from "./browser.mjs";
import { freeUdpPort, runToEnd, start, startVehicle, temporaryFolder } from "./processes.mjs";
import { expectQuietConsole, given, openGivenPanel, run } from "./program.mjs";
import { deliver, locate, setUpDrawing, setUpRoutes, setUpScale, setUpVehicle } from "./set_up.mjs";

const { madori, page, shots, size } = given;
const corpus = process.argv[7];
const kMostTouches = 40;
const kDrawing = { name: "workshop_cremer", height_px: 1793, m_per_px: 0.009307 };  // of its meta.yaml
const kWay_px = [[1100, 1300], [1500, 1300], [1500, 1560]];  // in its hall, from where the vehicle stands

const metres = ([u, v]) => [u * kDrawing.m_per_px, (kDrawing.height_px - v) * kDrawing.m_per_px];

/** The true faces of the drawing, pixels: u1, v1, u2, v2. */
const faces = () => readFileSync(join(corpus, kDrawing.name, "walls.csv"), "utf8").trim().split("\n").slice(1).map((line) => line.split(",").map(Number));

/** The building as it is drawn, its walls and ceiling as high as the sample factory's. */
function writeScenario(folder) {
  const rows = faces().map(([u1, v1, u2, v2], i) => [i + 1, ...metres([u1, v1]), ...metres([u2, v2])].join(","));
  writeFileSync(join(folder, "walls.csv"), `id,x1,y1,x2,y2\n${rows.join("\n")}\n`);
  const [x, y] = metres(kWay_px[0]);
  writeFileSync(join(folder, "scenario.yaml"), `madori_scenario: 1\nname: a workshop\nseed: 1\nstart: {x_m: ${x}, y_m: ${y}, yaw_deg: 0}\nbuilding: {walls: walls.csv, wall_height_m: 6.0, ceiling_height_m: 6.0}\n`);
  return join(folder, "scenario.yaml");
}

/** The longest face, as a person would measure it. */
function knownLength() {
  const length = ([u1, v1, u2, v2]) => Math.hypot(u2 - u1, v2 - v1);
  const longest = faces().reduce((best, one) => (length(one) > length(best) ? one : best));
  const digits = [...(length(longest) * kDrawing.m_per_px).toFixed(2)];
  return { ends: [longest.slice(0, 2), longest.slice(2)], digits, height_px: kDrawing.height_px };
}

/** All pictures in one, each with its name and the touches so far. */
async function joinFilm(browser, frames) {
  const film = await browser.newPage({ viewport: { width: 1720, height: 1000 } });
  const shown = frames.map(({ name, touches, png }) => `<figure><img src="data:image/png;base64,${png.toString("base64")}"><figcaption>${name} · ${touches} touches</figcaption></figure>`);
  await film.setContent(`<style>body{margin:8px;display:grid;grid-template-columns:repeat(4,1fr);gap:8px;font:16px sans-serif}figure{margin:0}img{width:100%;border:1px solid #888}</style>${shown.join("")}`);
  await film.screenshot({ path: join(shots, `film-strip-${size}.png`), fullPage: true });
  await film.close();
}

async function main(browser) {
  const folder = temporaryFolder();
  const world = join(folder, "world");
  const file = join(corpus, kDrawing.name, `${kDrawing.name}.png`);
  runToEnd(madori, ["import", file, "--site", world, "--scale", String(kDrawing.m_per_px)]);  // the virtual factory wants a folder; what stands in it is the scenario's
  const lidar = await freeUdpPort();
  await start(madori, ["sim", world, "--scenario", writeScenario(world), "--lidar-port", String(lidar)], /truth\s+ws/);
  const address = await startVehicle(madori, page, join(folder, "site"), lidar, join(world, "devices/drive"), ["--no-record"]);
  const panel = await openGivenPanel(browser, address);
  const frames = [];
  const look = async (name) => frames.push({ name, touches: panel.touches, png: await panel.page.screenshot() });
  try {
    await setUpDrawing(panel, look, file);
    await setUpScale(panel, look, knownLength());
    await setUpRoutes(panel, look, kWay_px.map(metres));
    await setUpVehicle(panel, look);
    await locate(panel, look);
    const confirmed = await deliver(panel, look);
    await look("delivered");
    console.log(`delivered after ${panel.touches} touches, faults confirmed meanwhile: ${confirmed}`);
    expect(panel.touches <= kMostTouches + 2 * confirmed, `${panel.touches} touches, more than ${kMostTouches}`);
    expectQuietConsole(panel);
  } finally {
    await joinFilm(browser, frames);
  }
}

if (!existsSync(join(corpus, kDrawing.name))) {
  console.log(`skipped: ${corpus} does not hold ${kDrawing.name}`);
  process.exit(77);
}
await run(main);
