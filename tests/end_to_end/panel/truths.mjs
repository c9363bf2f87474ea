// What the page says while something is wrong, before the real server and the virtual factory: one test for each defect
// that an operator met (numbers of docs/explanation/operator-page.md). One browser, one factory, one server for all.
// Usage: truths.mjs MADORI PAGE DATA SHOTS WIDTHxHEIGHT
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { askServer as api, expect, mapReady, touch, until } from "./browser.mjs";
import { freeUdpPort, runToEnd, start, startComputer, startWires, temporaryFolder } from "./processes.mjs";
import { given, openGivenPanel, picture, run } from "./program.mjs";

const { madori, page, data } = given;
const kOperator = "2468";
const state = (panel) => panel.page.locator("[data-state]").getAttribute("data-state");
const cause = (panel) => panel.page.locator("[data-cause]").getAttribute("data-cause");
const gauge = (panel, name) => panel.page.locator(".gauge", { hasText: name }).locator("dd").innerText();
/** Sends the vehicle off and waits until its wheels turn; a fault of a busy machine is confirmed. */
async function driveOff(panel, station) {
  await touch(panel, "Drive", { exact: true });
  const order = await api(panel, "POST", "/api/orders", { stations: station, repeat: 20 });
  expect(order.status === 200, `the order was refused: ${JSON.stringify(order)}`);
  await until("the vehicle drives", async () => {
    const now = await state(panel).catch(() => "");
    const button = { fault: "confirm", paused: "resume" }[now];  // the state may change under the finger
    if (button) await panel.page.locator(`.command.${button}`).tap({ timeout: 1000 }).catch(() => undefined);
    return now === "driving" && Number.parseFloat(await gauge(panel, "Speed")) > 0.1;
  }, 90_000);
}

const stands = (panel) => until("the wheels stand", async () => Number.parseFloat(await gauge(panel, "Speed")) === 0, 5000);

/** 1: Stop works while a card for numbers is open; 16: and the state says what it ended. */
async function stopAboveCards(panel, world) {
  await driveOff(panel, world.station);
  await touch(panel, "Set up");
  await panel.page.locator(".steps button").nth(3).tap();
  await touch(panel, "Size, mounting");
  await panel.page.locator("button.field").first().tap();
  await panel.page.getByRole("dialog").waitFor();
  await picture(panel, "truth-1-stop-above-pad");
  await touch(panel, "Stop", { exact: true });
  await until("the vehicle is told to stand", async () => (await api(panel, "GET", "/api/orders")).json.every((order) => order.status !== "running"), 3000);
  await touch(panel, "Cancel");
  await touch(panel, "Drive", { exact: true });
  await stands(panel);
  expect((await state(panel)) === "paused", "Stop did not pause the vehicle");
  expect((await cause(panel)) === "stopped-order", `16: after Stop the cause is ${await cause(panel)}`);
  await panel.page.getByText("was cancelled").waitFor();
}

/** 2: a vehicle that does not do what it is told is shown standing, while the cycle still tells it to drive. */
async function measuredSpeed(panel, world) {
  await driveOff(panel, world.station);
  await world.wire("motors off");
  try {
    let now = ["driving", ""];
    const look = () => panel.page.evaluate(() => [document.querySelector("[data-state]").dataset.state, [...document.querySelectorAll(".gauge")].find((one) => one.innerText.startsWith("Speed")).querySelector("dd").innerText]);
    await until("it stands", async () => { now = await look(); return now[0] !== "driving" || Number.parseFloat(now[1]) === 0; }, 10_000);
    expect(now[0] === "driving", "2: the wheels stood, and a speed was shown until the vehicle was told to stand");
  } finally {
    await world.wire("motors on");
  }
  await touch(panel, "Stop", { exact: true });
  await stands(panel);
}

/** 14: a place that is said while an order waits for it waits for Resume. */
async function placeWaits(panel, world) {
  await driveOff(panel, world.station);
  await touch(panel, "Pause");
  await stands(panel);
  const { x, y, yaw } = (await api(panel, "GET", "/api/locate")).json.hypotheses[0];
  let said;
  for (let tries = 0; tries < 5 && said?.status !== 200; ++tries) {  // a search that ended before the place was said
    if (tries > 0) await touch(panel, "Pause").then(() => stands(panel));
    await api(panel, "POST", "/api/locate/search", {});
    await api(panel, "POST", "/api/vehicle/resume", {});
    await until("it waits for its place", async () => (await state(panel)) === "localizing", 5000);
    said = await api(panel, "POST", "/api/vehicle/pose", { x, y, yaw });
    expect(said.status === 200 || said.json.error.code === "driving", `the place was refused: ${JSON.stringify(said)}`);
  }
  expect(said.status === 200, "14: each search ended before the place was said");
  await until("its place is known", async () => (await panel.page.locator(".map-canvas").first().getAttribute("data-vehicle")) === "shown", 60_000);
  await new Promise((later) => setTimeout(later, 3000));
  expect((await state(panel)) === "paused", `14: the vehicle went on by itself after its place was said: ${await state(panel)}`);
  await touch(panel, "Stop", { exact: true });
}

/** 3: lidar and drive silent while paused: no speed, no score, no scan without an age; the state says so. */
async function deadDevices(panel, world) {
  await until("it says why it is paused", async () => ["paused", "stopped", "stopped-order"].includes(await cause(panel)), 3000);
  const before = await cause(panel);
  world.factory.child.kill("SIGSTOP");
  const after_s = await until("the silent drive is the cause", async () => (await cause(panel)) === "drive-silent", 5000);
  await until("3: the scan goes from the map", async () => (await panel.page.locator(".map-canvas").first().getAttribute("data-scan")) === "hidden", 5000);
  await until("3: the speed has an age instead of a value", async () => (await gauge(panel, "Speed")).includes("old"), 5000);
  for (const name of ["Score", "Battery"]) expect((await gauge(panel, name)).includes("old"), `3: ${name} is shown without its age: ${await gauge(panel, name)}`);
  expect((await panel.page.locator("[data-silent]").count()) === 2, "3: the silent devices are not named");
  await picture(panel, "truth-3-dead-devices");
  world.factory.child.kill("SIGCONT");
  await until("they are heard again", async () => !["drive-silent", "lidar-silent"].includes(await cause(panel)), 20_000);
  console.log(`silent devices were said after ${after_s.toFixed(1)} s`);
}

/** 8, 13: while nobody knows the place, the vehicle is not on the map, and Resume is not the remedy. */
async function lostIsNotShown(panel) {
  await api(panel, "POST", "/api/locate/search", {});
  const map = panel.page.locator(".map-canvas").first();
  await until("8: a lost vehicle leaves the map", async () => (await map.getAttribute("data-vehicle")) === "hidden", 5000);
  expect((await cause(panel)) !== "paused", "13: paused and lost, and the page says to press Resume");
  await until("the place is found again", async () => (await map.getAttribute("data-vehicle")) === "shown", 90_000);
}

/** 5, 6: an operator asks "Where am I?", lays the scan elsewhere, sees which walls contradict, and what became of the word. */
async function whereAmI(panel) {
  await touch(panel, "Where am I?");
  await panel.page.locator(".where [data-locate=located]").waitFor();
  await touch(panel, "Place by hand");
  const card = panel.page.locator("[data-contradicted]");
  const here = Number(await card.getAttribute("data-contradicted"));
  const box = await panel.page.locator(".map-canvas").first().boundingBox();
  const from = { x: box.x + 0.35 * box.width, y: box.y + 0.7 * box.height };
  const session = await panel.context.newCDPSession(panel.page);
  const send = (type, points) => session.send("Input.dispatchTouchEvent", { type, touchPoints: points });
  await send("touchStart", [from]);
  for (let i = 1; i <= 5; ++i) await send("touchMove", [{ x: from.x + 20 * i, y: from.y - 8 * i }]);
  await send("touchEnd", []);
  await until("5: contradicting walls are marked", async () => Number(await card.getAttribute("data-contradicted")) > here + 2, 5000);
  await picture(panel, "truth-5-where-am-i");
  await touch(panel, "The vehicle is here");
  await panel.page.locator("[data-said]").waitFor();
  await new Promise((later) => setTimeout(later, 1500));
  expect(await panel.page.locator("[data-said]").isVisible(), "5: what became of the word is gone");
  await touch(panel, "Place by hand");
  let asked = "";
  await until("5: places are offered", async () => {
    const [words, places] = await panel.page.evaluate(() => [document.querySelector(".where [data-locate]").dataset.locate, document.querySelectorAll(".where [role=group] button").length]);
    asked = words;
    return places > 0;
  });
  expect(asked !== "searching", "5: ranked places are offered, and the card says to wait while it compares");
  await touch(panel, "Close");
  await api(panel, "POST", "/api/locate/search", {});
}

/** 9: a file that is no drawing is refused with the reason. */
async function badDrawings(panel, world) {
  const png = readFileSync(join(data, "sample_factory/factory_scan.png"));
  const files = [["plan.dwg", Buffer.from("AC1032\0\0\0\0"), /DXF/], ["plan.docx", Buffer.from("PK\u0003\u0004word"), /cannot be read/], ["cut.png", png.subarray(0, png.length / 3), /damaged or cut off/], ["broken.pdf", Buffer.from("%PDF-1.7\nnothing"), /damaged/]];
  for (const [name, bytes, words] of files) {
    const file = join(world.folder, name);
    writeFileSync(file, bytes);
    const chooser = panel.page.waitForEvent("filechooser");
    await touch(panel, "Another drawing");
    await (await chooser).setFiles(file);
    const toast = panel.page.locator(".toast");
    await toast.waitFor();
    const said = await toast.innerText();
    expect(words.test(said), `9: ${name}: "${said}"`);
    await toast.tap();
    await panel.page.getByRole("button", { name: "Another drawing" }).waitFor();
  }
}

/** A drawing of another building: rooms whose walls do not lie on the sample factory's. */
function hallAsDxf() {
  const corners = [[0, 0], [31, 0], [37, 17], [22, 29], [5, 23], [0, 0], [14, 11], [22, 29], [14, 11], [31, 0], [14, 11], [5, 23]];
  const lines = corners.slice(1).flatMap(([x, y], i) => {
    const [x0, y0] = corners[i];
    const length = Math.hypot(x - x0, y - y0);
    const [nx, ny] = [(-0.15 * (y - y0)) / length, (0.15 * (x - x0)) / length];  // both faces of a wall
    return [-1, 1].map((side) => `0\nLINE\n8\nWALLS\n10\n${x0 + side * nx}\n20\n${y0 + side * ny}\n11\n${x + side * nx}\n21\n${y + side * ny}\n`);
  });
  return `0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n6\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n${lines.join("")}0\nENDSEC\n0\nEOF\n`;
}

/** 7: a drawing of another building asks first, and what was before can be brought back. */
async function replaceAndBringBack(panel, world) {
  const before = (await api(panel, "GET", "/api/site/walls")).json;
  const other = join(world.folder, "other.dxf");
  writeFileSync(other, hallAsDxf());
  const choose = async () => {
    const chooser = panel.page.waitForEvent("filechooser");
    await touch(panel, "Another drawing");
    await (await chooser).setFiles(other);
    await panel.page.getByRole("dialog").waitFor({ timeout: 60_000 });
  };
  await choose();
  await picture(panel, "truth-7-question");
  await touch(panel, "Leave it as it is");
  expect((await api(panel, "GET", "/api/site/walls")).json.revision === before.revision, "7: the walls changed without a word");
  await choose();
  await touch(panel, "Replace it");
  await until("the new drawing is there", async () => (await api(panel, "GET", "/api/site/walls")).json.revision !== before.revision, 30_000);
  await touch(panel, "Look back");
  await touch(panel, "Downloads", { role: "tab" });
  const versions = (await api(panel, "GET", "/api/site/versions")).json;
  expect(versions.length >= 2 && versions.every((one) => one.stamp > 0 && one.author !== "" && one.sentence !== ""), `7: the versions are ${JSON.stringify(versions)}`);
  await panel.page.locator(".versions .row").nth(1).tap();
  await picture(panel, "truth-7-versions");
  await touch(panel, "Bring it back");
  await panel.page.getByRole("dialog").getByRole("button", { name: "Bring it back" }).tap();
  await until("7: the walls are as they were", async () => (await api(panel, "GET", "/api/site/walls")).json.revision === before.revision, 15_000);
}

/** 10: a leg through a wall is marked on the map, its step has no tick, and an order that cannot be served is refused. */
async function faultyRoutes(panel, world) {
  const routes = (await api(panel, "GET", "/api/site/routes")).json;
  const walls = (await api(panel, "GET", "/api/site/walls")).json.walls;
  const wall = walls.reduce((long, one) => (Math.hypot(one[2] - one[0], one[3] - one[1]) > Math.hypot(long[2] - long[0], long[3] - long[1]) ? one : long));
  const [mx, my] = [(wall[0] + wall[2]) / 2, (wall[1] + wall[3]) / 2];
  const length = Math.hypot(wall[2] - wall[0], wall[3] - wall[1]);
  const [nx, ny] = [-(wall[3] - wall[1]) / length, (wall[2] - wall[0]) / length];
  const point = (id, by, name) => ({ id, x: mx + by * nx, y: my + by * ny, name, station: true, heading_deg: null, speed_mps: null, action: "" });
  const faulty = { revision: routes.revision, nodes: [...routes.nodes, point(901, 1, "Beyond"), point(902, -1, "Behind")], legs: [...routes.legs, [901, 902], [902, 901]] };
  const saved = await api(panel, "PUT", "/api/site/routes", faulty);
  expect(saved.status === 200, `the faulty routes were not saved: ${JSON.stringify(saved)}`);
  await until("10: an order that cannot be served is refused", async () => (await api(panel, "POST", "/api/orders", { stations: [901], repeat: 1 })).json?.error?.code === "no-way-to-station", 20_000);
  await touch(panel, "Set up");
  await panel.page.locator(".steps button").nth(2).tap();
  await mapReady(panel);
  await until("10: the leg is marked", async () => (await panel.page.locator(".map-canvas").first().getAttribute("data-faulty"))?.includes("901>902"), 5000);
  await until("10: the step with a leg through a wall loses its tick", async () => (await panel.page.locator(".steps button").nth(2).getAttribute("data-done")) === "false", 8000);
  await picture(panel, "truth-10-leg-through-wall");
  const restored = await api(panel, "PUT", "/api/site/routes", { revision: saved.json.revision, nodes: routes.nodes, legs: routes.legs });
  expect(restored.status === 200, "the routes were not put back");
}

/** 4: a server that was started anew asks for the PIN where the page stands; Stop needs none, and says when nobody hears it. */
async function serverRestart(browser, world) {
  runToEnd("sh", ["-c", `printf '%s\\n%s\\n' ${kOperator} ${kOperator} | "$0" pin "$1" operator`, madori, world.site]);
  await world.computer.kill();
  await world.computer.again().then((again) => { world.kill = again.kill; });
  const panel = await openGivenPanel(browser, world.computer.address);
  await panel.page.locator("input[type=password]").fill(kOperator);
  await touch(panel, "Enter", { exact: true });
  await panel.page.locator("[data-state]").waitFor();
  await world.kill();
  const lost_s = await until("4: no connection is said", async () => (await panel.page.locator("[data-connection=lost]").count()) === 1, 5000);
  await touch(panel, "Stop", { exact: true });
  await panel.page.locator("[data-stop=unheard]").waitFor({ timeout: 5000 }).catch(async (error) => { await picture(panel, "truth-failed-4b"); throw error; });
  await picture(panel, "truth-4-stop-unheard");
  await world.computer.again().then((again) => { world.kill = again.kill; });
  await panel.page.locator("input[type=password]").waitFor();
  await until("4: the Stop that nobody heard arrives", async () => (await panel.page.locator("[data-stop=unheard]").count()) === 0, 20_000);
  await picture(panel, "truth-4-pin-again");
  const status = await api(panel, "POST", "/api/vehicle/halt", {});
  expect(status.status === 200, `4: without a PIN a halt answers ${status.status}`);
  await panel.page.locator("input[type=password]").fill(kOperator);
  await touch(panel, "Enter", { exact: true });
  await panel.page.locator("[data-state]").waitFor();
  console.log(`the lost server was said after ${lost_s.toFixed(1)} s`);
  expect((await panel.page.getByRole("button", { name: "Where am I?" }).count()) === 1, "6: an operator has no page to say where the vehicle is");
}

async function main(browser) {
  const folder = temporaryFolder();
  const [lidar, wired] = [await freeUdpPort(), await freeUdpPort()];
  const site = join(folder, "site");
  runToEnd(madori, ["demo", "--import-only", "--site", site, "--data", data, "--json", join(folder, "import.json")]);
  const factory = await start(madori, ["sim", site, "--scenario", join(data, "scenarios/demo.yaml"), "--lidar-port", String(lidar)], /truth\s+ws/);
  const wires = await startWires(lidar, wired, join(site, "devices/drive"));
  const computer = await startComputer(madori, page, site, wired, wires.drive, ["--no-record"]);
  const world = { folder, site, factory, computer, kill: computer.kill, wire: wires.say };
  const panel = await openGivenPanel(browser, computer.address);
  await touch(panel, "Drive", { exact: true });
  await until("the place is known", async () => (await panel.page.locator(".map-canvas").first().getAttribute("data-vehicle")) === "shown", 60_000);
  const { nodes } = (await api(panel, "GET", "/api/site/routes")).json;
  world.station = ["Press 1", "Lift"].map((name) => nodes.find((node) => node.name === name).id);  // to and fro: it never ends
  const checks = [["1, 16", () => stopAboveCards(panel, world)], ["2", () => measuredSpeed(panel, world)], ["3", () => deadDevices(panel, world)], ["14", () => placeWaits(panel, world)], ["8, 13", () => lostIsNotShown(panel)], ["5, 6", () => whereAmI(panel)],
    ["9", async () => { await touch(panel, "Set up"); await panel.page.locator(".steps button").nth(0).tap(); await badDrawings(panel, world); }],
    ["7", async () => { await touch(panel, "Set up"); await panel.page.locator(".steps button").nth(0).tap(); await replaceAndBringBack(panel, world); }], ["10", () => faultyRoutes(panel, world)], ["4", () => serverRestart(browser, world)]];
  const failed = [];
  const wanted = process.env["TRUTHS"]?.split(";");  // for whoever mends one of them
  for (const [number, check] of checks.filter(([name]) => !wanted || wanted.includes(name))) {
    const begun = Date.now();
    try {
      await check();
      console.log(`${number}: good after ${((Date.now() - begun) / 1000).toFixed(1)} s`);
    } catch (error) {
      failed.push(`${number}: ${error.message}`);
      console.log(`${number}: FAILED ${error.message}`);
      await picture(panel, `truth-failed-${number.replace(/\W+/g, "-")}`);
      await api(panel, "POST", "/api/vehicle/halt", {}).catch(() => undefined);  // the next check begins standing
      await panel.page.reload().catch(() => undefined);
    }
  }
  expect(failed.length === 0, failed.join("\n"));
}

await run(main);
