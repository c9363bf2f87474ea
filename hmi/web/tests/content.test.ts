import { describe, expect, it } from "vitest";
import type { Routes, Site, Walls } from "../src/api_types";
import { loadContent, newestOnly } from "../src/content";

const site = (revision: string) => ({ name: revision, walls_revision: revision, routes_revision: "r" }) as Site;
const walls = (revision: string): Walls => ({ revision, walls: [] });
const routes: Routes = { revision: "r", nodes: [], legs: [], findings: [] };

describe("the site that is shown", () => {
  it("is of one moment: what was saved between two answers is asked for again", async () => {
    const answers = { site: ["old", "new"], walls: ["new", "new"] };
    const content = await loadContent({
      site: async () => site(answers.site.shift() ?? "-"),
      walls: async () => walls(answers.walls.shift() ?? "-"),
      routes: async () => routes,
    });
    expect(content.site.name).toBe("new");
    expect(answers.site).toEqual([]);
  });
  it("is refused where it never comes to rest", async () => {
    let turn = 0;
    const never = { site: async () => site(`${++turn}`), walls: async () => walls("-"), routes: async () => routes };
    await expect(loadContent(never)).rejects.toMatchObject({ code: "conflict" });
  });
  it("is the one asked for last, whatever order the answers come in; both who asked wait for it", async () => {
    const given: ((value: string) => void)[] = [];
    const shown: string[] = [];
    const load = newestOnly(() => new Promise<string>((give) => given.push(give)), (value) => shown.push(value));
    const done: string[] = [];
    const first = load().then(() => done.push("first"));
    const second = load().then(() => done.push("second"));
    given[0]?.("before");
    await Promise.resolve();
    expect(done).toEqual([]);
    given[1]?.("after");
    await Promise.all([first, second]);
    expect(shown).toEqual(["after"]);
    const third = load();
    given[2]?.("later");
    await third;
    expect(shown).toEqual(["after", "later"]);
  });
  it("is not overtaken by an older answer that comes last", async () => {
    const given: ((value: string) => void)[] = [];
    const shown: string[] = [];
    const load = newestOnly(() => new Promise<string>((give) => given.push(give)), (value) => shown.push(value));
    const both = [load(), load()];
    given[1]?.("after");
    given[0]?.("before");
    await Promise.all(both);
    expect(shown).toEqual(["after"]);
  });
});
