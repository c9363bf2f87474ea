// From a folder that does not exist to a delivered order, by touch alone: the five steps, then Drive. No typing but the
// scale figure (on the panel's own pad). Usage: first_site.mjs MADORI PAGE DATA SHOTS WIDTHxHEIGHT
import { join } from "node:path";
import { expect, touch } from "./browser.mjs";
import { freeUdpPort, startFactory, startVehicle, temporaryFolder } from "./processes.mjs";
import { expectQuietConsole, given, openGivenPanel, picture, run } from "./program.mjs";
import { deliver, locate, setUpDrawing, setUpRoutes, setUpScale, setUpVehicle } from "./set_up.mjs";

const kMostTouches = 40;
// meta.yaml of the sample: a dimension of 80 m between two walls, drawing pixels
const kKnown = { ends: [[547.84, 2729.59], [3747.01, 2656.99]], digits: ["8", "0"], height_px: 2970 };
// a way past the vehicle's first place, metres on the scaled drawing; further apart than a finger reaches on the smaller panel
const kWay = [[45.05, 52.3], [45.2, 46.2], [52, 42.5]];

const { madori, page, data } = given;

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
  await setUpDrawing(panel, look, join(data, "sample_factory/factory_scan.png"));
  await setUpScale(panel, look, kKnown);
  await setUpRoutes(panel, look, kWay);
  await setUpVehicle(panel, look);
  await locate(panel, look);
  const confirmed = await deliver(panel, look);
  console.log(`delivered after ${panel.touches} touches, faults confirmed meanwhile: ${confirmed}`);
  expect(panel.touches <= kMostTouches + 2 * confirmed, `${panel.touches} touches, more than ${kMostTouches}`);
  await lookAround(panel, look);
  expectQuietConsole(panel);
}

await run(main);
