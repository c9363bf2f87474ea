// Measures (a machine that is busy with other work shows in blank_page_ms: the first paint of three words): frames a second of the Drive page while 20,000 scan points come ten times a second, and its first paint, in
// Chromium's software rendering. Usage: frame_rate.mjs PAGE
import { openBrowser, openPanel } from "../../../../tests/end_to_end/panel/browser.mjs";
import { startMadeUpVehicle } from "./made_up_vehicle.mjs";

const kSeconds = 10;
const vehicle = await startMadeUpVehicle(process.argv[2]);
const browser = await openBrowser();
const { page } = await openPanel(browser, vehicle.address, { width: 1280, height: 800 });
await page.locator("[data-state]").waitFor();
const figures = await page.evaluate((seconds) => new Promise((done) => {
  const begin = performance.now();
  let frames = 0;
  const count = () => {
    ++frames;
    if (performance.now() - begin < 1000 * seconds) requestAnimationFrame(count);
    else done({ fps: frames / seconds, first_paint_ms: performance.getEntriesByName("first-contentful-paint")[0]?.startTime });
  };
  requestAnimationFrame(count);
}), kSeconds);
const blank = await page.context().newPage();
await blank.goto("data:text/html,<p>three words here");
await blank.waitForFunction(() => performance.getEntriesByName("first-contentful-paint").length > 0);
figures.blank_page_ms = await blank.evaluate(() => performance.getEntriesByName("first-contentful-paint")[0].startTime);
console.log(JSON.stringify(figures));
await browser.close();
vehicle.stop();
