import { useState } from "preact/hooks";
import { useText } from "../i18n";
import { AbovePage } from "./above_page";
import { Icon } from "./icon";

interface Asked {
  label: string;
  unit?: string;
  value: number | null;
  least: number;
  most: number;
  /** empty is an answer too: no value */
  optional?: boolean;
}


/** Digits large enough for gloves, so that a panel needs no keyboard; a keyboard works too. */
export function AskNumber(props: Asked & { done: (value: number | null) => void; cancel: () => void }) {
  const t = useText();
  const [text, setText] = useState("");
  const value = Number(text);
  const empty = text === "";
  const good = empty ? props.optional === true : Number.isFinite(value) && value >= props.least && value <= props.most;
  const press = (key: string) => {
    if (/^[0-9]$/.test(key)) setText((old) => old + key);
    else if (key === "." || key === ",") setText((old) => (old.includes(".") ? old : `${old}.`));
    else if (key === "-") setText((old) => (old.startsWith("-") ? old.slice(1) : `-${old}`));
    else if (key === "Backspace") setText((old) => old.slice(0, -1));
    else if (key === "Enter" && good) props.done(empty ? null : value);
    else return false;
    return true;
  };
  const digit = (key: string) => <button key={key} type="button" class="target" onClick={() => press(key)}>{key}</button>;
  return (
    <AbovePage class="number-pad" label={props.label} cancel={props.cancel} pressed={(event) => press(event.key)}>
      <div>
        <h2>{props.label}</h2>
        <output class="figure" aria-live="polite">{empty ? (props.value ?? "–") : text} {props.unit}</output>
        <p class="quiet">{t("pad.range", { least: props.least, most: props.most })}</p>
      </div>
      <div class="keys">
        {["7", "8", "9"].map(digit)}
        <button type="button" class="target" aria-label={t("pad.erase")} onClick={() => press("Backspace")}><Icon name="back" /></button>
        {["4", "5", "6"].map(digit)}
        <button type="button" class="target" aria-label={t("pad.sign")} disabled={props.least >= 0} onClick={() => press("-")}>±</button>
        {["1", "2", "3"].map(digit)}
        <button type="button" class="target" onClick={props.cancel}>{t("pad.cancel")}</button>
        {["0", "."].map(digit)}
        <button type="button" class="target primary enter" disabled={!good} onClick={() => press("Enter")}>{t("pad.enter")}</button>
      </div>
    </AbovePage>
  );
}

/** A figure that opens the pad. */
export function NumberField(props: Asked & { change: (value: number | null) => void; disabled?: boolean }) {
  const [open, setOpen] = useState(false);
  const { label, value, unit } = props;
  return (
    <>
      <button type="button" class="target field" disabled={props.disabled} onClick={() => setOpen(true)}>
        <small>{label}</small>
        <span>{value ?? "–"} {value === null ? "" : unit}</span>
      </button>
      {open && <AskNumber {...props} done={(next) => { setOpen(false); props.change(next); }} cancel={() => setOpen(false)} />}
    </>
  );
}
