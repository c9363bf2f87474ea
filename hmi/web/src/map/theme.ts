import { Store } from "../store";

export type Theme = "light" | "dark";

const stored = localStorage.getItem("madori.theme");
const preferred: Theme = matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
export const theme = new Store<Theme>(stored === "light" || stored === "dark" ? stored : preferred);
document.documentElement.dataset.theme = theme.value;
theme.watch((value) => {
  document.documentElement.dataset.theme = value;
  localStorage.setItem("madori.theme", value);
});

/** Colours of what is drawn on maps. Grey and one blue; amber and red only for what is abnormal. */
const palettes = {
  light: { ink: "#222222", paper: "#f2f2f2", grey: "#5f6368", faint: "#9aa0a6", blue: "#174ea6", scan: [0, 74, 173], amber: "#b35900", red: "#c62828", floor: "#ffffff", rgb: [34, 34, 34] },
  dark: { ink: "#e8e8e8", paper: "#1b1d1f", grey: "#9aa0a6", faint: "#6f757a", blue: "#8ab4f8", scan: [138, 190, 255], amber: "#ffb74d", red: "#ff6f61", floor: "#34383c", rgb: [225, 225, 225] },
} as const;

export const palette = () => palettes[theme.value];

/** What a map draws, its legend shows in the same colour: --map-amber and so on. */
function giveToLegends(): void {
  for (const name of ["amber", "red", "blue", "grey", "floor"] as const) document.documentElement.style.setProperty(`--map-${name}`, palette()[name]);
}
giveToLegends();
theme.watch(giveToLegends);
