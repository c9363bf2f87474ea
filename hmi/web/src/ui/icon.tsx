/** Line icons on a 24 x 24 grid, drawn for this panel. */
const paths = {
  drive: "M3 20h18M5 16l3-8h8l3 8M8 16v2M16 16v2",
  setup: "M4 4h16v16H4zM4 10h7M13 4v7M13 15v5",
  history: "M4 12a8 8 0 1 0 3-6.2M4 4v4h4M12 8v4l3 2",
  theme: "M12 3a9 9 0 1 0 9 9 7 7 0 0 1-9-9",
  plus: "M12 5v14M5 12h14",
  minus: "M5 12h14",
  fit: "M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5",
  start: "M7 4l13 8-13 8z",
  resume: "M4 5v14M9 4l12 8-12 8z",
  pause: "M8 5v14M16 5v14",
  stop: "M6 6h12v12H6z",
  warning: "M12 3l10 18H2zM12 10v5M12 18v.5",
  good: "M4 12l6 6L20 6",
  bad: "M5 5l14 14M19 5L5 19",
  up: "M12 20V5M5 12l7-7 7 7",
  down: "M12 4v15M5 12l7 7 7-7",
  left: "M4 10a8 8 0 1 1 2 8M4 4v6h6",
  right: "M20 10a8 8 0 1 0-2 8M20 4v6h-6",
  next: "M4 12h15M13 6l6 6-6 6",
  back: "M9 5L3 12l6 7h12V5zM11 9l6 6M17 9l-6 6",
  follow: "M12 2v5M12 17v5M2 12h5M17 12h5M12 9a3 3 0 1 0 0 6 3 3 0 0 0 0-6",
  earlier: "M19 12H5M11 6l-6 6 6 6",
  week: "M12 6l-6 6 6 6M19 6l-6 6 6 6",
  undo: "M4 9h11a5 5 0 0 1 0 10h-4M4 9l4-4M4 9l4 4",
  redo: "M20 9H9a5 5 0 0 0 0 10h4M20 9l-4-4M20 9l-4 4",
  bin: "M5 7h14M9 7V4h6v3M7 7l1 13h8l1-13",
  save: "M5 4h11l3 3v13H5zM8 4v5h7V4M8 20v-6h8v6",
  list: "M4 6h2M4 12h2M4 18h2M10 6h10M10 12h10M10 18h10",
  hand: "M12 3v8M9 7l3-4 3 4M3 12h6M5 9l-2 3 2 3M21 12h-6M19 9l2 3-2 3M12 21v-6M9 18l3 3 3-3",
  camera: "M3 7h4l2-3h6l2 3h4v13H3zM12 9a4 4 0 1 0 0 8 4 4 0 0 0 0-8",
  repeat: "M4 11V9a3 3 0 0 1 3-3h12M16 3l3 3-3 3M20 13v2a3 3 0 0 1-3 3H5M8 21l-3-3 3-3",
  erase: "M4 16L14 6l6 6-8 8H8zM9 11l6 6M4 20h16",
  move: "M12 3v18M3 12h18M9 6l3-3 3 3M9 18l3 3 3-3M6 9l-3 3 3 3M18 9l3 3-3 3",
  pen: "M4 20l1-5L16 4l4 4L9 19zM13 7l4 4",
  select: "M6 3l13 10-6 1 3 6-3 1-3-6-4 4z",
  station: "M5 5h14v14H5zM12 9v6M9 12h6",
  oneway: "M3 12h16M14 7l5 5-5 5M3 7v10",
  file: "M6 3h8l5 5v13H6zM14 3v5h5",
  search: "M10 4a6 6 0 1 0 0 12 6 6 0 0 0 0-12M15 15l6 6",
  pin: "M12 21s7-7 7-12a7 7 0 0 0-14 0c0 5 7 12 7 12M12 7a2 2 0 1 0 0 4 2 2 0 0 0 0-4",
  download: "M12 4v11M7 11l5 5 5-5M4 20h16",
  ruler: "M3 15L15 3l6 6L9 21zM8 10l2 2M11 7l3 3M6 13l3 3",
  photo: "M3 5h18v14H3zM3 16l6-6 4 4 3-3 5 5",
  chart: "M4 20V10M10 20V4M16 20v-7M21 20H3",
  box: "M4 8l8-4 8 4v9l-8 4-8-4zM4 8l8 4 8-4M12 12v9",
} as const;

export type IconName = keyof typeof paths;

export function Icon({ name }: { name: IconName }) {
  return (
    <svg class="icon" viewBox="0 0 24 24" aria-hidden="true" focusable="false">
      <path d={paths[name]} fill="none" stroke="currentColor" stroke-width="2.2" stroke-linecap="round" stroke-linejoin="round" />
    </svg>
  );
}
