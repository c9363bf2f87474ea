// The real programs that a test needs: the virtual factory, the vehicle's computer, a tile server.
import { spawn, spawnSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { createSocket } from "node:dgram";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { until } from "./browser.mjs";

const running = [];

export function temporaryFolder() {
  const folder = mkdtempSync(join(tmpdir(), "madori-panel-"));
  running.push({ stop: async () => rmSync(folder, { recursive: true, force: true, maxRetries: 10, retryDelay: 200 }) });  // a browser that was killed may still write
  return folder;
}

/** Stops everything that was started, newest first. */
export async function stopAll() {
  while (running.length > 0) await running.pop().stop();
}

export const freeTcpPort = () => new Promise((done) => {
  const server = createServer().listen(0, "127.0.0.1", () => {
    const { port } = server.address();
    server.close(() => done(port));
  });
});

export const freeUdpPort = () => new Promise((done) => {
  const socket = createSocket("udp4");
  socket.bind(0, "127.0.0.1", () => {
    const { port } = socket.address();
    socket.close(() => done(port));
  });
});

export function runToEnd(program, args) {
  const result = spawnSync(program, args, { encoding: "utf8" });
  if (result.status !== 0) throw new Error(`${program} ${args.join(" ")}: ${result.stdout}${result.stderr}`);
  return result.stdout;
}

/** Starts a program and waits until it has printed what `ready` matches. `input`: whether it is written to. */
export function start(program, args, ready, { input = false } = {}) {
  const child = spawn(program, args, { stdio: [input ? "pipe" : "ignore", "pipe", "pipe"] });
  let output = "";
  let ended = false;
  running.push({
    stop: () => new Promise((done) => {
      if (ended) return done();
      child.once("exit", done);
      child.kill("SIGCONT");
      child.kill("SIGTERM");
      setTimeout(() => child.kill("SIGKILL"), 5000).unref();
    }),
  });
  const endBy = (signal) => () => new Promise((dead) => {
    child.removeAllListeners("exit");
    child.once("exit", () => { ended = true; dead(); });
    child.kill(signal);
  });
  const [kill, end] = [endBy("SIGKILL"), endBy("SIGTERM")];
  return new Promise((done, fail) => {
    const take = (data) => {
      output += data;
      const match = output.match(ready);
      if (match) done({ match, output: () => output, kill, end, child });
    };
    child.stdout.on("data", take);
    child.stderr.on("data", take);
    child.once("exit", (code) => {
      ended = true;
      fail(new Error(`${program} ${args.join(" ")} ended with ${code}: ${output}`));
    });
  });
}

/** A virtual factory whose vehicle stands before the lift, with a folder of its own. */
export async function startFactory(madori, data, folder, lidarPort, scenario) {
  runToEnd(madori, ["demo", "--import-only", "--site", folder, "--data", data, "--json", join(folder, "..", "import.json")]);
  await start(madori, ["sim", folder, "--scenario", scenario, "--lidar-port", String(lidarPort)], /truth\s+ws/);
  return join(folder, "devices", "drive");
}

/** The same with a camera at the vehicle's front; answers the drive's port and the camera's address. */
export async function startFactoryWithCamera(madori, data, folder, lidarPort, scenario) {
  runToEnd(madori, ["demo", "--import-only", "--site", folder, "--data", data, "--json", join(folder, "..", "import.json")]);
  const { output } = await start(madori, ["sim", folder, "--scenario", scenario, "--lidar-port", String(lidarPort), "--camera-port", "0"], /truth\s+ws/);
  return { drive: join(folder, "devices", "drive"), camera: output().match(/camera http (\S+)/)[1] };
}

/** Wires between factory and computer (wires.py): the device to drive through, and `say("drive off")`, which waits for its answer. */
export async function startWires(simLidarPort, runLidarPort, simDrive) {
  const wires = await start("/usr/bin/python3", [fileURLToPath(new URL("wires.py", import.meta.url)), String(simLidarPort), String(runLidarPort), simDrive], /wires (\S+)/, { input: true });
  const say = async (words) => {
    const said = wires.output().length;
    wires.child.stdin.write(`${words}\n`);
    await until(words, () => wires.output().length > said, 5000);
  };
  return { drive: wires.match[1], say };
}

/** The vehicle's computer with its panel: `address`, `kill()` (no farewell), `end()` (as systemd does), `again()` (the same on the same port). */
export async function startComputer(madori, page, folder, lidarPort, drive, more = []) {
  const hmi = `127.0.0.1:${await freeTcpPort()}`;
  const position = await freeUdpPort();
  const again = () => start(madori, ["run", folder, "--hmi", hmi, "--panel-folder", page, "--lidar-port", String(lidarPort), "--position-port", String(position), "--drive", drive, ...more], /panel at/);
  const { kill, end } = await again();
  return { address: `http://${hmi}/`, again, kill, end };
}

/** The vehicle's computer with its panel; answers its address. */
export const startVehicle = async (...given) => (await startComputer(...given)).address;
