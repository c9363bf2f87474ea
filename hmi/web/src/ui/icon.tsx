/** Line icons on a 24 x 24 grid, drawn for this panel. */
const paths = {
  drive: "M3 20h18M5 16l3-8h8l3 8M8 16v2M16 16v2",
  setup: "M4 4h16v16H4zM4 10h7M13 4v7M13 15v5",
  history: "M4 12a8 8 0 1 0 3-6.2M4 4v4h4M12 8v4l3 2",
  theme: "M12 3a9 9 0 1 0 9 9 7 7 0 0 1-9-9",
  plus: "M12 5v14M5 12h14",
  minus: "M5 12h14",
  start: "M7 4l13 8-13 8z",
  pause: "M8 5v14M16 5v14",
  stop: "M6 6h12v12H6z",
  warning: "M12 3l10 18H2zM12 10v5M12 18v.5",
  good: "M4 12l6 6L20 6",
  bad: "M5 5l14 14M19 5L5 19",
  up: "M12 20V5M5 12l7-7 7 7",
  down: "M12 4v15M5 12l7 7 7-7",
  left: "M4 10a8 8 0 1 1 2 8M4 4v6h6",
  right: "M20 10a8 8 0 1 0-2 8M20 4v6h-6",
  follow: "M12 2v5M12 17v5M2 12h5M17 12h5M12 9a3 3 0 1 0 0 6 3 3 0 0 0 0-6",
  undo: "M4 9h11a5 5 0 0 1 0 10h-4M4 9l4-4M4 9l4 4",
  redo: "M20 9H9a5 5 0 0 0 0 10h4M20 9l-4-4M20 9l-4 4",
  bin: "M5 7h14M9 7V4h6v3M7 7l1 13h8l1-13",
  save: "M5 4h11l3 3v13H5zM8 4v5h7V4M8 20v-6h8v6",
} as const;

export type IconName = keyof typeof paths;

export function Icon({ name }: { name: IconName }) {
  return (
    <svg class="icon" viewBox="0 0 24 24" aria-hidden="true" focusable="false">
      <path d={paths[name]} fill="none" stroke="currentColor" stroke-width="2.2" stroke-linecap="round" stroke-linejoin="round" />
    </svg>
  );
}
