// From a folder that does not exist to a delivered order, by touch alone: the five steps, then Drive. No typing but the
// scale figure (on the panel's own pad). Usage: first_site.mjs MADORI PAGE DATA SHOTS WIDTHxHEIGHT
import { join } from "node:path";
import { expect, mapReady, restOnMap, touch, touchMap } from "./browser.mjs";
import { freeUdpPort, startFactory, startVehicle, temporaryFolder } from "./processes.mjs";
import { expectQuietConsole, given, openGivenPanel, picture, run } from "./program.mjs";

const kMostTouches = 40;
const kFileChooser = 2;  // choose the file, confirm: fingers that the page cannot see
// meta.yaml of the sample: a dimension of 80 m between two walls, drawing pixels
const kKnown = { ends: [[547.84, 2729.59], [3747.01, 2656.99]], digits: ["8", "0"], height_px: 2970 };
// a way past the vehicle's first place, metres on the scaled drawing; further apart than a finger reaches on the smaller panel
const kWay = [[45.05, 52.3], [45.2, 46.2], [52, 42.5]];

const { madori, page, data } = given;

async function setUpDrawing(panel, look) {
  await look("1-drawing-empty");
  const chooser = panel.page.waitForEvent("filechooser");
  await touch(panel, "Choose a drawing");
  await (await chooser).setFiles(join(data, "sample_factory/factory_scan.png"));
  panel.touches += kFileChooser;
  await panel.page.getByText("wall faces found").waitFor();
  await mapReady(panel);
  await look("1-drawing");
  await touch(panel, "Next");
}

async function setUpScale(panel, look) {
  await panel.page.getByText("Touch one end").waitFor();
  await mapReady(panel);
  for (const [u, v] of kKnown.ends) await restOnMap(panel, [u, kKnown.height_px - v]);
  await panel.page.getByRole("dialog").waitFor();
  await look("2-number-pad");
  for (const digit of kKnown.digits) await touch(panel, digit, { exact: true });
  await touch(panel, "OK", { exact: true });
  await panel.page.locator("[data-verdict]").waitFor();
  await look("2-scale");
  await touch(panel, "Use this scale");
}

async function setUpRoutes(panel, look) {
  await panel.page.getByText("Touch to set points").waitFor();
  await mapReady(panel);
  for (const place of kWay) await touchMap(panel, place);  // one right after the other: none may be lost
  await panel.page.getByText(`${kWay.length} points`).waitFor();
  await touch(panel, "Station", { exact: true });
  await panel.page.getByText("No fault found").waitFor();
  await look("3-routes");
  await touch(panel, "Save, next");
}

async function setUpVehicle(panel, look) {
  await panel.page.getByText("Sensors and drive").waitFor();
  await touch(panel, "Use it");
  await panel.page.getByText("in use").waitFor();
  await look("4-vehicle");
  await touch(panel, "Save, next");
}

async function locate(panel, look) {
  await panel.page.locator("[data-locate=located]").waitFor({ timeout: 90_000 });
  await mapReady(panel);
  await look("5-place");
  await touch(panel, "The vehicle is here");
}

/** A machine that is too busy may silence the virtual drive for longer than the cycle allows: then a person confirms. */
async function letGo(panel, goal) {
  const state = panel.page.locator("[data-state]");
  const deadline = Date.now() + 120_000;
  for (let confirmed = 0; Date.now() < deadline; ) {
    const now = await state.getAttribute("data-state");
    if (await goal(now)) return confirmed;
    if (now === "fault") {
      await touch(panel, "Confirm");
      ++confirmed;
      await panel.page.locator("[data-state]:not([data-state=fault])").waitFor();
    } else if (now === "paused") {
      await touch(panel, "Resume");
      await panel.page.locator("[data-state]:not([data-state=paused])").waitFor();
    } else {
      await panel.page.waitForTimeout(200);
    }
  }
  throw new Error(`the vehicle did not get there: ${await panel.page.locator(".state").innerText()}`);
}

async function deliver(panel, look) {
  await touch(panel, "New order");
  await touch(panel, "Station 1", { exact: true });
  await look("drive-new-order");
  await touch(panel, "Send");
  let pictured = false;
  const confirmed = await letGo(panel, async (state) => {
    if (state === "driving" && !pictured) {
      pictured = true;
      await look("drive");
    }
    return (await panel.page.getByText("delivered").count()) > 0;
  });
  return confirmed;
}

async function lookAround(panel, look) {
  await touch(panel, "By hand", { role: "tab" });
  await look("drive-by-hand");
  await touch(panel, "Last 30 s", { role: "tab" });
  await look("drive-replay");
  await touch(panel, "Look back");
  await panel.page.locator(".events li").first().waitFor();
  await look("history-events");
  await touch(panel, "Statistics", { role: "tab" });
  await panel.page.locator(".figure-box").first().waitFor();
  await look("history-statistics");
  const [deliveries, distance] = await panel.page.locator(".figure-box dd").allInnerTexts();
  expect(deliveries === "1" && Number.parseFloat(distance) > 0, `after one delivery the statistics say ${deliveries} and ${distance}`);
  await touch(panel, "Downloads", { role: "tab" });
  await panel.page.locator(".files li").nth(1).waitFor();
  await look("history-downloads");
}

async function main(browser) {
  const folder = temporaryFolder();
  const lidar = await freeUdpPort();
  const drive = await startFactory(madori, data, join(folder, "world"), lidar, join(data, "scenarios/demo.yaml"));
  const address = await startVehicle(madori, page, join(folder, "site"), lidar, drive);
  const panel = await openGivenPanel(browser, address);
  const look = (name) => picture(panel, name);
  await setUpDrawing(panel, look);
  await setUpScale(panel, look);
  await setUpRoutes(panel, look);
  await setUpVehicle(panel, look);
  await locate(panel, look);
  const confirmed = await deliver(panel, look);
  console.log(`delivered after ${panel.touches} touches, faults confirmed meanwhile: ${confirmed}`);
  expect(panel.touches <= kMostTouches + 2 * confirmed, `${panel.touches} touches, more than ${kMostTouches}`);
  await lookAround(panel, look);
  expectQuietConsole(panel);
}

await run(main);
