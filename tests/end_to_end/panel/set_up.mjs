// A site set up by touch alone: what the programs that begin with an empty folder share.
import { mapReady, restOnMap, touch, touchMap } from "./browser.mjs";

export const kFileChooser = 2;  // choose the file, confirm: fingers that the page cannot see

/** Step 1, from the empty page. */
export async function setUpDrawing(panel, look, file) {
  await look("1-drawing-empty");
  const chooser = panel.page.waitForEvent("filechooser");
  await touch(panel, "Choose a drawing");
  await (await chooser).setFiles(file);
  panel.touches += kFileChooser;
  await panel.page.getByText("wall faces found").waitFor();
  await mapReady(panel);
  await look("1-drawing");
  await touch(panel, "Next");
}

/** Step 2 by one known length: `ends` in pixels of the drawing, `digits` as a person enters the metres. */
export async function setUpScale(panel, look, { ends, digits, height_px }) {
  await panel.page.getByText("Touch one end").waitFor();
  await mapReady(panel);
  for (const [u, v] of ends) await restOnMap(panel, [u, height_px - v]);
  await panel.page.getByRole("dialog").waitFor();
  await look("2-number-pad");
  for (const digit of digits) await touch(panel, digit, { exact: true });
  await touch(panel, "OK", { exact: true });
  await panel.page.locator("[data-verdict]").waitFor();
  await look("2-scale");
  await touch(panel, "Use this scale");
}

/** Step 3: a way of points (metres); the last one becomes a station. */
export async function setUpRoutes(panel, look, way) {
  await panel.page.getByText("Touch to set points").waitFor();
  await mapReady(panel);
  for (const place of way) await touchMap(panel, place);  // one right after the other: none may be lost
  await panel.page.getByText(`${way.length} points`).waitFor();
  await touch(panel, "Station", { exact: true });
  await panel.page.getByText("No fault found").waitFor();
  await look("3-routes");
  await touch(panel, "Save, next");
}

export async function setUpVehicle(panel, look) {
  await panel.page.getByText("Sensors and drive").waitFor();
  await touch(panel, "Use it");
  await panel.page.getByText("in use").waitFor();
  await look("4-vehicle");
  await touch(panel, "Save, next");
}

export async function locate(panel, look) {
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

/** Orders to the station, lets the vehicle go; how many faults of a busy machine were confirmed. */
export async function deliver(panel, look) {
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
