import { useState } from "preact/hooks";
import { useText } from "../i18n";
import { holding } from "./jog_hold";
import { useJogKeys } from "./jog_keys";
import { pushAt } from "./jog_push";

/** A round pad: up is ahead, its sides turn, all between are curves; the farther from the middle the faster. */
export function DrivePad() {
  const t = useText();
  const [thumb, setThumb] = useState<readonly [number, number] | null>(null);
  useJogKeys();
  const move = (event: PointerEvent) => {
    const pad = event.currentTarget as HTMLElement;
    const { left, top, width } = pad.getBoundingClientRect();
    const right = (2 * (event.clientX - left)) / width - 1;
    const up = 1 - (2 * (event.clientY - top)) / width;
    const size = Math.max(1, Math.hypot(right, up));
    setThumb([right / size, up / size]);
    holding.hold("pad", pushAt(right, up));
  };
  const end = () => {
    setThumb(null);
    holding.release("pad");
  };
  const [x, y] = thumb ?? [0, 0];
  return (
    <div class="drive-pad" role="img" aria-label={t("jog.pad")}
      onPointerDown={(event) => { event.currentTarget.setPointerCapture(event.pointerId); move(event); }}
      onPointerMove={(event) => thumb && move(event)}
      onPointerUp={end} onPointerCancel={end} onLostPointerCapture={end} onContextMenu={(event) => event.preventDefault()}>
      <i style={{ left: `${50 + 36 * x}%`, top: `${50 - 36 * y}%` }} data-held={thumb !== null} />
    </div>
  );
}
