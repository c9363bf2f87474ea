import { language } from "./i18n";

/** Times as the chosen language writes them, of 24 hours: the browser of a panel may speak another one. Stamps: Unix time, seconds. */
export const timeText = (stamp: number): string => new Date(1000 * stamp).toLocaleTimeString(language.value, { hourCycle: "h23" });
export const dayText = (stamp: number): string => new Date(1000 * stamp).toLocaleDateString(language.value, { dateStyle: "medium" });
export const momentText = (stamp: number): string => new Date(1000 * stamp).toLocaleString(language.value, { dateStyle: "medium", timeStyle: "medium", hourCycle: "h23" });

/** A figure of so many digits, without the sign of a nought: not "-0.0". */
export const figure = (value: number, digits: number): string => value.toFixed(digits).replace(/^-(?=[0.]*$)/, "");

/** A probability in whole percent: what is not quite certain is not called so. */
export const certainty = (probability: number): string => (probability > 0.99 ? "> 99" : (100 * probability).toFixed(0));

/** A relative uncertainty in percent, never 0.00; empty where none is known. */
export const uncertainty = (relative: number): string => (relative <= 0 ? "" : relative < 5e-5 ? "< 0.01" : (100 * relative).toFixed(2));
