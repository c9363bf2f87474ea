import { useEffect, useRef, useState } from "preact/hooks";
import { useText } from "../i18n";
import { Stale } from "./stale";

const kPause_ms = 200;

/** The verification camera: the next picture is asked for when the last one has come. */
export function Camera() {
  const t = useText();
  const [shown, setShown] = useState("");
  const [age, setAge] = useState(Infinity);
  const came = useRef(-Infinity);
  useEffect(() => {
    let open = true;
    let current = "";
    const next = async () => {
      try {
        const answer = await fetch("/api/camera.jpg", { credentials: "same-origin", cache: "no-store" });
        if (answer.ok && open) {
          const url = URL.createObjectURL(await answer.blob());
          setShown(url);
          URL.revokeObjectURL(current);
          current = url;
          came.current = performance.now();
        }
      } catch { /* its age tells */ }
      if (open) setTimeout(() => void next(), kPause_ms);
    };
    void next();
    const clock = setInterval(() => setAge((performance.now() - came.current) / 1000), 250);
    return () => {
      open = false;
      clearInterval(clock);
      URL.revokeObjectURL(current);
    };
  }, []);
  return (
    <figure class="camera">
      {shown === "" ? <p class="quiet">{t("camera.none")}</p> : <img src={shown} alt={t("camera.alt")} />}
      {shown !== "" && <Stale age={age} />}
    </figure>
  );
}
