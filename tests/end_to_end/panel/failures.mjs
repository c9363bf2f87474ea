// Lidar, drive and server killed in every state: what is read on the page, and after how long. Writes the table of
// docs/reference/panel.md where it is named. Usage: failures.mjs MADORI PAGE DATA SHOTS WIDTHxHEIGHT [STATE,STATE...] [PANEL.md]
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { askServer as api, expect, touch, until } from "./browser.mjs";
import { freeUdpPort, runToEnd, start, startComputer, startWires, temporaryFolder } from "./processes.mjs";
import { given, openGivenPanel, picture, run } from "./program.mjs";

const { madori, page, data } = given;
const [only, table] = process.argv.slice(7);
const kPin = "2468";
const kLongest_s = 8;  // while the place is sought the cycle is late
const kMarks = ["<!-- written by tests/end_to_end/panel/failures.mjs: begin -->", "<!-- end -->"];

const live = (panel) => panel.page.locator("[data-state]").getAttribute("data-state", { timeout: 1000 }).catch(() => "");
const cause = (panel) => panel.page.locator("[data-cause]").getAttribute("data-cause", { timeout: 1000 }).catch(() => "");

/** What a person reads of the vehicle: the words that say its state. */
const words = (panel) => panel.page.evaluate(() => {
  const shown = [...document.querySelectorAll(".state h2, .state .cause, .state .remedy, .state.alarm p, [data-silent], [data-watch], [data-banner], .login [role=alert]")];
  const text = (element) => element.innerText.replace(/\s+/g, " ").trim();
  return [...new Set(shown.map(text).filter((one) => one !== ""))].join(" · ");
});

/** Where the page says that a device, or the server, is gone. */
const kTold = {
  lidar: "[data-silent]:not([data-silent=drive]), [data-cause=lidar-silent]",
  drive: "[data-silent=drive], [data-cause=drive-silent]",
  server: "[data-connection=lost]",
};

async function enter(panel) {
  const field = panel.page.locator("input[type=password]");
  const state = panel.page.locator(".rail");
  await until("a page", async () => (await field.count()) + (await state.count()) > 0);
  if ((await field.count()) === 0) return;
  await field.fill(kPin);
  await touch(panel, "Enter", { exact: true });
  await state.waitFor({ timeout: 15_000 }).catch(() => undefined);  // tried again where the server was not up yet
}

/** Until nothing is silent, the place is known and the vehicle stands, whatever the last failure left. */
async function settle(panel) {
  await until("all is well again", async () => {
    if ((await panel.page.locator(".rail").count()) === 0) await enter(panel);
    await panel.page.locator(".rail button").first().tap({ timeout: 1000 }).catch(() => undefined);  // Drive
    const now = await live(panel);
    if (now === "fault") await api(panel, "POST", "/api/vehicle/confirm", {});
    const calm = now === "paused" && ["paused", "stopped", "stopped-order"].includes(await cause(panel));
    if (!calm) await api(panel, "POST", "/api/vehicle/stop", {}).catch(() => undefined);
    return calm && (await panel.page.locator("[data-silent]").count()) === 0 && (await panel.page.locator("[data-vehicle=shown]").count()) === 1;
  }, 120_000);
}

async function driveOff(panel, world) {
  const order = await api(panel, "POST", "/api/orders", { stations: world.stations, repeat: 20 });
  expect(order.status === 200, `the order was refused: ${JSON.stringify(order)}`);
  await until("it drives", async () => {
    const button = { fault: "confirm", paused: "resume" }[await live(panel)];
    if (button) await panel.page.locator(`.command.${button}`).tap({ timeout: 1000 }).catch(() => undefined);
    return Number.parseFloat(await panel.page.locator(".gauge", { hasText: "Speed" }).locator("dd").innerText()) > 0.1;
  }, 60_000);
}

/** Each brings the page into a state, and answers what ends it. */
const states = {
  paused: async () => undefined,
  lost: async (panel) => {
    await api(panel, "POST", "/api/locate/search", {});
    await panel.page.locator("[data-vehicle=hidden]").waitFor();
  },
  driving: driveOff,
  jog: async (panel) => {
    await touch(panel, "By hand", { role: "tab" });
    const box = await panel.page.getByRole("button", { name: "Forward" }).boundingBox();
    const finger = await panel.context.newCDPSession(panel.page);
    await finger.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: [{ x: box.x + box.width / 2, y: box.y + box.height / 2 }] });
    await until("it drives by hand", async () => (await live(panel)) === "manual");
    return async () => {
      await finger.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
      await finger.detach();
      await panel.page.getByRole("tab", { name: "Orders" }).tap({ timeout: 2000 }).catch(() => undefined);
    };
  },
  setup: async (panel) => {
    await touch(panel, "Set up");
    await panel.page.locator(".steps button").nth(2).tap();
  },
  login: async (panel) => {
    await touch(panel, "Log out", { exact: true });
    await panel.page.locator("input[type=password]").waitFor();
  },
};

/** What is read once a failure is told, and after how long; null where the page says nothing of it. */
async function told(panel, failure) {
  const begun = Date.now();
  const seconds = await until("it is told", async () => (await panel.page.locator(kTold[failure]).count()) > 0, 10_000).catch(() => null);
  const first_s = seconds === null ? null : (Date.now() - begun) / 1000;
  await panel.page.waitForTimeout(1000);  // what else comes
  return { first_s, words: await words(panel) };
}

async function tryOne(panel, world, state, failure) {
  await settle(panel);
  const end = await states[state](panel, world);
  if (failure === "server") await world.kill();
  else await world.wire(`${failure} off`);
  const read = await told(panel, failure);
  await picture(panel, `failure-${state}-${failure}`);
  await end?.();
  if (failure === "server") world.kill = (await world.computer.again()).kill;
  else await world.wire(`${failure} on`);
  console.log(`${state}, ${failure}: ${read.first_s === null ? "nothing" : `${read.first_s.toFixed(1)} s`}: ${read.words}`);
  return { state, failure, ...read };
}

async function openWorld() {
  const folder = temporaryFolder();
  const site = join(folder, "site");
  const [lidar, wired] = [await freeUdpPort(), await freeUdpPort()];
  runToEnd(madori, ["demo", "--import-only", "--site", site, "--data", data, "--json", join(folder, "import.json")]);
  runToEnd("sh", ["-c", `printf '%s\\n%s\\n' ${kPin} ${kPin} | "$0" pin "$1" integrator`, madori, site]);
  await start(madori, ["sim", site, "--scenario", join(data, "scenarios/demo.yaml"), "--lidar-port", String(lidar)], /truth\s+ws/);
  const wires = await startWires(lidar, wired, join(site, "devices/drive"));
  const computer = await startComputer(madori, page, site, wired, wires.drive, ["--no-record"]);
  return { computer, kill: computer.kill, wire: wires.say };
}

const kWords = { lidar: "lidar killed", drive: "drive killed", server: "server killed" };

function writeTable(rows) {
  const line = ({ state, failure, first_s, words: text }) => `| ${state} | ${kWords[failure]} | ${first_s === null ? "–" : first_s.toFixed(1)} | ${text.replace(/\|/g, "/") || "nothing"} |`;
  const text = ["| state | what | after, s | what is read |", "| --- | --- | --- | --- |", ...rows.map(line)].join("\n");
  console.log(text);
  if (!table) return;
  const doc = readFileSync(table, "utf8");
  const [before, rest] = doc.split(kMarks[0]);
  expect(rest !== undefined, `${table} has no place for the table`);
  writeFileSync(table, `${before}${kMarks[0]}\n${text}\n${rest.slice(rest.indexOf(kMarks[1]))}`);
}

async function main(browser) {
  const world = await openWorld();
  const panel = await openGivenPanel(browser, world.computer.address);
  await settle(panel);
  const { nodes } = (await api(panel, "GET", "/api/site/routes")).json;
  world.stations = ["Press 1", "Lift"].map((name) => nodes.find((node) => node.name === name).id);
  const rows = [];
  for (const state of Object.keys(states).filter((name) => !only || only === "all" || only.split(",").includes(name)))
    for (const failure of Object.keys(kTold)) rows.push(await tryOne(panel, world, state, failure));
  writeTable(rows);
  // who has no session sees nothing of the vehicle; everything else is told, on whatever page
  const silent = rows.filter((row) => row.first_s === null && !(row.state === "login" && row.failure !== "server"));
  expect(silent.length === 0, `nothing is said of ${silent.map((row) => `${row.state}, ${row.failure}`).join("; ")}`);
  const late = rows.filter((row) => row.first_s > kLongest_s);
  expect(late.length === 0, `late: ${late.map((row) => `${row.state}, ${row.failure}: ${row.first_s} s`).join("; ")}`);
}

await run(main);
