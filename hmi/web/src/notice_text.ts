import type { Notice } from "./api_types";
import { language, type Translate } from "./i18n";
import { en, type TextKey } from "./i18n/en";

/** A value in the chosen language, where the vehicle sent its codes (the outer one first) and they are known. */
function translated(t: Translate, values: Record<string, string>, name: string, prefix: "fault" | "reason", between: string): Record<string, string> {
  const codes = values[`${prefix}_codes`] ?? "";
  const keys = codes.split("+").map((code) => (prefix === "fault" ? `fault.${code}` : `reason.${code}`));
  return codes !== "" && keys.every((key) => key in en) ? { [name]: keys.map((key) => t(key as TextKey)).join(between) } : {};
}

/** A notice of the vehicle: from the catalogue where it is known and all its values came, else in the vehicle's own English. */
export function noticeText(t: Translate, prefix: string, notice: Notice): string {
  const key = [`${prefix}.${notice.code}`, notice.code].find((one) => one in en);
  if (key === undefined) return notice.text;
  const { values } = notice;
  const wanted = [...en[key as TextKey].matchAll(/\{(\w+)\}/g)].map(([, name]) => name ?? "");
  if (wanted.some((name) => !(name in values))) return notice.text;
  const known = { ...translated(t, values, "reason", "reason", " "), ...translated(t, values, "faults", "fault", ", ") };
  // the vehicle's own English does not belong into a sentence of another language
  const foreign = language.value !== "en" && wanted.includes("reason") && !("reason" in known);
  return foreign && `kind.${notice.code}` in en ? kindText(t, notice) : t(key as TextKey, { ...values, ...known });
}

/** A device as people say it: the vehicle knows its lidars' products, the page has words for the rest. */
export function deviceName(t: Translate, device: { type: string; title: string }): string {
  return device.title !== "" ? t("device.titled", { title: device.title }) : t(`device.${device.type}` as TextKey);
}

/** What kind of standstill a cause is, without its values: for sums over many. */
export function kindText(t: Translate, cause: Notice): string {
  const key = [`kind.${cause.code}`, `cause.${cause.code}`].find((one) => one in en);
  return key === undefined ? cause.text : t(key as TextKey);
}
