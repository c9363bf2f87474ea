// A PDF whose first page is no plan: the panel reads another page of the same file, and the scale says how large the
// drawing is with it, where a length that is wrong by ten shows. Usage: title_page.mjs MADORI PAGE DATA SHOTS WIDTHxHEIGHT
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { askServer, expect, mapReady, touch, until } from "./browser.mjs";
import { freeUdpPort, startVehicle, temporaryFolder } from "./processes.mjs";
import { expectQuietConsole, given, openGivenPanel, picture, run } from "./program.mjs";
import { setUpScale } from "./set_up.mjs";

const kSheet_pt = [400, 300];
const kRoom = "40 40 320 220 re 48 48 304 204 re f*";
const kTitle = "60 200 60 60 re 68 208 44 44 re f*";

function twoPages() {
  const content = (text) => `<</Length ${text.length}>>stream\n${text}\nendstream endobj\n`;
  return "%PDF-1.4\n1 0 obj<</Type/Catalog/Pages 2 0 R>>endobj\n" +
    `2 0 obj<</Type/Pages/Kids[3 0 R 4 0 R]/Count 2/MediaBox[0 0 ${kSheet_pt.join(" ")}]>>endobj\n` +
    "3 0 obj<</Type/Page/Parent 2 0 R/Contents 5 0 R>>endobj\n4 0 obj<</Type/Page/Parent 2 0 R/Contents 6 0 R>>endobj\n" +
    `5 0 obj${content(kTitle)}6 0 obj${content(kRoom)}trailer<</Root 1 0 R>>\n`;
}

/** How long the longest wall is, as a share of the drawing's width; of what the page shows as well as of the site. */
async function longestWall(panel) {
  const site = (await askServer(panel, "GET", "/api/site")).json;
  const { walls } = (await askServer(panel, "GET", "/api/site/walls")).json;
  return { share: Math.max(...walls.map(([x1, y1, x2, y2]) => Math.hypot(x2 - x1, y2 - y1))) / site.drawing.width_px, walls: walls.length, drawing: site.drawing };
}

async function main(browser) {
  const folder = temporaryFolder();
  const address = await startVehicle(given.madori, given.page, join(folder, "a site"), await freeUdpPort(), join(folder, "no-drive"));
  const panel = await openGivenPanel(browser, address);
  const file = join(folder, "plan.pdf");
  writeFileSync(file, twoPages());
  const chooser = panel.page.waitForEvent("filechooser");
  await touch(panel, "Choose a drawing");
  await (await chooser).setFiles(file);
  await panel.page.getByText("page 1 of 2").waitFor();
  expect((await longestWall(panel)).share < 0.3, "the title page was not read first");
  await touch(panel, "Another page");
  await panel.page.getByRole("dialog").waitFor();
  await touch(panel, "2", { exact: true });
  await touch(panel, "OK", { exact: true });
  await panel.page.getByText("page 2 of 2").waitFor();
  const { share, walls, drawing } = await longestWall(panel);
  expect(share > 0.7, `the longest wall of page 2 is ${share} of its width`);
  await until("the page shows the walls of page 2", async () => (await panel.page.locator(".facts").first().innerText()).startsWith(`${walls} wall`));
  await mapReady(panel);
  await picture(panel, "1-drawing-page");
  await touch(panel, "Next");
  const [u, v] = [drawing.width_px, drawing.height_px].map((length) => 0.5 * length);
  await setUpScale(panel, async (name) => {
    if (name !== "2-scale") return;
    const size = await panel.page.locator("[data-size]").innerText();
    const [width, height] = size.match(/[\d.]+/g).map(Number);
    expect(Math.abs(width - 40) < 0.3 && Math.abs(height - 30) < 0.3, `size: "${size}"`);
  }, { ends: [[0.6 * u, v], [1.4 * u, v]], digits: ["1", "6"], height_px: drawing.height_px });
  expectQuietConsole(panel);
}

await run(main);
