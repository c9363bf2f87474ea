import { useRef, useState } from "preact/hooks";
import { useText } from "../../i18n";
import { Tool } from "../../ui/tool";

export const kDrawingTypes = ".dxf,.pdf,.png,.jpg,.jpeg,.tif,.tiff,.bmp,.svg";

/** Takes the first drawing of a site, by a tap or by dropping it. */
export function Upload({ send }: { send: (file: File) => void }) {
  const t = useText();
  const [over, setOver] = useState(false);
  const input = useRef<HTMLInputElement>(null);
  const take = (file: File | undefined) => file && send(file);
  return (
    <section class={over ? "card drop over" : "card drop"}
      onDragOver={(event) => { event.preventDefault(); setOver(true); }} onDragLeave={() => setOver(false)}
      onDrop={(event) => { event.preventDefault(); setOver(false); take(event.dataTransfer?.files[0]); }}>
      <p>{t("drawing.hint")}</p>
      <div class="buttons">
        <input ref={input} type="file" hidden accept={kDrawingTypes} aria-label={t("drawing.choose")}
          onChange={(event) => { take(event.currentTarget.files?.[0]); event.currentTarget.value = ""; }} />
        <Tool icon="file" label={t("drawing.choose")} primary onClick={() => input.current?.click()} />
      </div>
    </section>
  );
}
