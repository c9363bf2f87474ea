import { beforeAll, describe, expect, it, vi } from "vitest";
import type { Finding } from "../src/api_types";

const stamp = Date.UTC(2026, 10, 28, 21, 49, 40) / 1000 + new Date(2026, 10, 28).getTimezoneOffset() * 60;  // 21:49:40 on this computer's clock

let figures: typeof import("../src/figures");
let i18n: typeof import("../src/i18n");
let worstFirst: (findings: readonly Finding[]) => Finding[];

beforeAll(async () => {
  vi.stubGlobal("localStorage", { getItem: () => null, setItem: () => undefined });
  vi.stubGlobal("document", { documentElement: { lang: "", dataset: {} } });
  vi.stubGlobal("navigator", { language: "en-US" });
  i18n = await import("../src/i18n");
  figures = await import("../src/figures");
  ({ worstFirst } = await import("../src/pages/setup/findings"));
});

describe("figures on the page", () => {
  it("times are of 24 hours and of the language that was chosen, not the browser's", () => {
    i18n.language.set("de");
    expect(figures.timeText(stamp)).toBe("21:49:40");
    expect(figures.dayText(stamp)).toBe("28.11.2026");
    expect(figures.momentText(stamp)).toBe("28.11.2026, 21:49:40");
    i18n.language.set("en");
    expect(figures.timeText(stamp)).toBe("21:49:40");
    expect(figures.momentText(stamp)).toContain("21:49:40");
  });
  it("a probability is certain only where it is", () => {
    expect(figures.certainty(0.554)).toBe("55");
    expect(figures.certainty(0.9999)).toBe("> 99");
  });
  it("a nought has no sign", () => {
    expect(figures.figure(-0.04, 1)).toBe("0.0");
    expect(figures.figure(-0.4, 0)).toBe("0");
    expect(figures.figure(-0.06, 1)).toBe("-0.1");
    expect(figures.figure(-10, 0)).toBe("-10");
  });
  it("an uncertainty is never shown as none", () => {
    expect(figures.uncertainty(0.0004)).toBe("0.04");
    expect(figures.uncertainty(0.00001)).toBe("< 0.01");
    expect(figures.uncertainty(0)).toBe("");
  });
});

describe("findings of the routes", () => {
  it("begin with the errors, whatever the check found first", () => {
    const finding = (code: string, severity: Finding["severity"]) => ({ code, severity, message: code, values: {} }) as unknown as Finding;
    const sorted = worstFirst([finding("short-leg", "warning"), finding("through-wall", "error"), finding("one-way", "warning")]);
    expect(sorted.map(({ code }) => code)).toEqual(["through-wall", "short-leg", "one-way"]);
  });
});
