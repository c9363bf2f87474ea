import { describe, expect, it } from "vitest";
import { placeAgain } from "../src/map/chosen_place";
import { fromLatLon, overlayNumbers, tileMiddle, tileResolution, toLatLon } from "../src/map/mercator";
import { about, angleOf, apply, compose, fromFingers, identity, inverse, scaleOf, type Similarity } from "../src/map/similarity";
import { corners, snapTo, withMiddles } from "../src/map/snap";
import { addWall, eraseAt, eraseInside, totalLength } from "../src/pages/setup/wall_edit";

const close = (a: readonly number[], b: readonly number[]) => a.forEach((value, i) => expect(value).toBeCloseTo(b[i] ?? NaN, 9));
const some: Similarity = { a: 1.2, b: -0.7, tx: 3, ty: -5 };

describe("similarities", () => {
  it("form a group", () => {
    close(apply(compose(inverse(some), some), [7, -2]), [7, -2]);
    close(apply(compose(some, about([1, 1], 0.3, 2)), [4, 5]), apply(some, apply(about([1, 1], 0.3, 2), [4, 5])));
    expect(compose(some, identity)).toEqual(some);
  });
  it("about a point leave it, turn and stretch", () => {
    const by = about([2, 3], 0.4, 1.5);
    close(apply(by, [2, 3]), [2, 3]);
    expect(scaleOf(by)).toBeCloseTo(1.5);
    expect(angleOf(by)).toBeCloseTo(0.4);
  });
  it("of two fingers bring both to where they went, a rigid one their middle", () => {
    const by = fromFingers([[0, 0], [2, 0]], [[5, 5], [5, 9]], false);
    close(apply(by, [0, 0]), [5, 5]);
    close(apply(by, [2, 0]), [5, 9]);
    const rigid = fromFingers([[0, 0], [2, 0]], [[5, 5], [5, 9]], true);
    expect(scaleOf(rigid)).toBeCloseTo(1);
    close(apply(rigid, [1, 0]), [5, 7]);
  });
});

describe("a chosen place", () => {
  const here = { x: 54.6, y: 19.9, yaw: 0.65 };
  const aside = { x: 54.6, y: 23.6, yaw: 0.65 };
  const turned = { x: 7.6, y: 25.9, yaw: -2.5 };
  it("stays chosen where its rank changes", () => {
    expect(placeAgain(here, [turned, here, aside], [turned, aside, { ...here, y: 20 }])).toBe(2);
    expect(placeAgain(aside, [turned, here, aside], [aside, turned, here])).toBe(0);
  });
  it("is not another one where it is not ranked any more", () => {
    expect(placeAgain(here, [turned, here, aside], [turned, aside])).toBe(-1);
    expect(placeAgain(here, [here], [])).toBe(-1);
  });
  it("at one point is told by where it looks", () => {
    const back = { ...here, yaw: here.yaw + Math.PI };
    expect(placeAgain(here, [here, back], [back, { ...here, yaw: here.yaw - 2 * Math.PI }])).toBe(1);
  });
});

describe("Web Mercator", () => {
  it("goes there and back", () => {
    const { latitude, longitude } = toLatLon(fromLatLon(35.464478, 136.739235));
    close([latitude, longitude], [35.464478, 136.739235]);
  });
  it("knows the middle of a tile of the published example", () => {
    const { latitude, longitude } = tileMiddle(18, 230642, 103420);
    const [x, y] = fromLatLon(latitude, longitude);
    const half = Math.PI * 6378137;
    close([(x + half) / tileResolution(18, 1), (half - y) / tileResolution(18, 1)], [230642.5, 103420.5]);
  });
  it("gives the published scale for Z_m 3.3 and Z_p 1.67, Eq. (9)", () => {
    const [x, y] = fromLatLon(35.464478, 136.739235);
    const view = tileResolution(18, 256) / 1.67;
    const side = 3.3 * view;
    const numbers = overlayNumbers({ a: side, b: 0, tx: x, ty: y }, [0, 0], view, 18, 256);
    expect(numbers.photo_zoom).toBeCloseTo(1.67, 9);
    expect(numbers.layout_zoom).toBeCloseTo(3.3, 9);
    expect(numbers.m_per_px).toBeCloseTo(0.9611, 3);
  });
});

describe("snapping", () => {
  it("draws the ends of two walls together where they would meet", () => {
    const found = corners([[0, 0, 9.5, 0], [10, 0.4, 10, 8]], 1);
    close(found[1] ?? [], [10, 0]);
    close(found[2] ?? [], [10, 0]);
    close(found[0] ?? [], [0, 0]);
  });
  it("takes a corner within reach, else the place itself", () => {
    expect(snapTo([[1, 1]], [1.2, 1], 0.5)).toEqual({ at: [1, 1], snapped: true });
    expect(snapTo([[1, 1]], [2, 2], 0.5)).toEqual({ at: [2, 2], snapped: false });
  });
});

describe("editing walls", () => {
  const walls = [[0, 0, 10, 0, -1], [0, 5, 10, 5, -1]];
  it("erases the nearest within reach", () => {
    expect(eraseAt(walls, [5, 4], 2)).toEqual([walls[0]]);
    expect(eraseAt(walls, [5, 2.5], 1)).toEqual(walls);
  });
  it("erases what lies wholly inside an area", () => {
    expect(eraseInside(walls, [-1, 6], [11, 4])).toEqual([walls[0]]);
    expect(eraseInside(walls, [1, 6], [11, 4])).toEqual(walls);
  });
  it("adds one and sums up the lengths", () => expect(totalLength(addWall(walls, [0, 0], [3, 4]))).toBe(25));
});

describe("the corners of a drawn wall", () => {
  it("have a middle between the inner and the outer one, and only there", () => {
    const points = withMiddles([[0, 0], [0.3, 0.3], [10, 0]], 0.6);
    expect(points).toEqual([[0, 0], [0.3, 0.3], [10, 0], [0.15, 0.15]]);
    expect(snapTo(points, [0.16, 0.14], 1).at).toEqual([0.15, 0.15]);
    expect(snapTo(points, [0.28, 0.31], 1).at).toEqual([0.3, 0.3]);
  });
});
