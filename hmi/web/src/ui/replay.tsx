import { useEffect, useRef, useState } from "preact/hooks";
import { api } from "../api";
import { useText } from "../i18n";
import { live, type Frame } from "../live/live_socket";
import { parseReplay } from "../live/replay";
import { Tool } from "./tool";

const kSeconds = 30;
const kStep_s = 0.2;

/** The last 30 seconds, frozen when the card is opened: from the server, or from this page where that fails. */
export function Replay({ onFrame }: { onFrame: (frame: Frame | null, back_s: number) => void }) {
  const t = useText();
  const [frames, setFrames] = useState<readonly Frame[]>([]);
  const [back, setBack] = useState(0);
  const [playing, setPlaying] = useState(false);
  const frozen = useRef(performance.now());
  const load = () => {
    frozen.current = performance.now();
    setFrames([...live.history]);
    void api.replay().then((bytes) => setFrames(parseReplay(bytes, frozen.current)), () => undefined);
  };
  useEffect(() => {
    load();
    return () => onFrame(null, 0);
  }, []);
  useEffect(() => {
    const wanted = frozen.current - 1000 * back;
    onFrame(back === 0 ? null : (frames.findLast((frame) => frame.received_ms <= wanted) ?? frames[0] ?? null), back);
  }, [back, frames]);
  useEffect(() => {
    if (!playing) return undefined;
    const timer = setInterval(() => setBack((old) => {
      if (old <= kStep_s) setPlaying(false);
      return Math.max(0, old - kStep_s);
    }), 1000 * kStep_s);
    return () => clearInterval(timer);
  }, [playing]);
  const play = () => {
    if (back === 0) {
      load();
      setBack(kSeconds);
    }
    setPlaying(!playing);
  };
  return (
    <section class="replay">
      <p class="quiet">{t("drive.replay.hint")}</p>
      <label>
        {back === 0 ? t("drive.replay.now") : t("drive.replay.at", { age: back.toFixed(0) })}
        <input class="target wide" type="range" min={0} max={kSeconds} step={kStep_s} value={kSeconds - back}
          onInput={(event) => { setPlaying(false); setBack(kSeconds - Number(event.currentTarget.value)); }} />
      </label>
      <div class="buttons">
        <Tool icon={playing ? "pause" : "start"} label={playing ? t("drive.replay.halt") : t("drive.replay.play")} primary onClick={play} />
        <Tool icon="next" label={t("drive.replay.live")} disabled={back === 0} onClick={() => { setPlaying(false); setBack(0); }} />
      </div>
    </section>
  );
}
