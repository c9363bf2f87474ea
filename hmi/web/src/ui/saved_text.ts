import type { Translate } from "../i18n";
import { en, type TextKey } from "../i18n/en";

const whole: Record<string, TextKey> = {
  "as it was found": "saved.found",
  "backup restored": "saved.backup",
  "drawing replaced by a new revision, routes kept": "saved.revision",
  "panel": "saved.panel",
  "command line": "saved.command_line",
};

/** What a version of the site says of itself (mapping/site/site_versions), in the page's language; unknown words stay as they are. */
export function savedText(t: Translate, sentence: string): string {
  const key = whole[sentence];
  if (key) return t(key);
  const restored = /^version (\d+) restored$/.exec(sentence);
  if (restored) return t("saved.version", { number: restored[1] ?? "" });
  return sentence.split(", ").map((word) => (`saved.${word}` in en ? t(`saved.${word}` as TextKey) : word)).join(", ");
}
