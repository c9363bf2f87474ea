import { useEffect, useState } from "preact/hooks";
import { api, Refused } from "../api";
import { language, nextLanguage, textIn, useText } from "../i18n";
import { en, type TextKey } from "../i18n/en";

const digits = ["1", "2", "3", "4", "5", "6", "7", "8", "9"];
const kAsk_ms = 2000;

/** Whether the vehicle's server answers; asked every two seconds. */
function useAnswers(): boolean {
  const [answers, setAnswers] = useState(true);
  useEffect(() => {
    const ask = () => void api.session().then(() => setAnswers(true), () => setAnswers(false));
    const timer = setInterval(ask, kAsk_ms);
    return () => clearInterval(timer);
  }, []);
  return answers;
}

/** A number pad large enough for gloves; a keyboard works too. */
export function LoginPage({ entered }: { entered: () => void }) {
  const t = useText();
  const answers = useAnswers();
  const [pin, setPin] = useState("");
  const [refusal, setRefusal] = useState<TextKey | "">("");
  const [asking, setAsking] = useState(false);
  const enter = async () => {
    setAsking(true);
    try {
      await api.login(pin);
      entered();
    } catch (error) {
      setPin("");
      const key = error instanceof Refused ? `error.${error.code}` : "";
      setRefusal(key in en ? (key as TextKey) : "login.wrong");
    }
    setAsking(false);
  };
  const digit = (key: string) => <button key={key} type="button" class="target" onClick={() => setPin(pin + key)}>{key}</button>;
  return (
    <main class="page login">
      <form class="card" onSubmit={(event) => { event.preventDefault(); void enter(); }}>
        <div class="asked">
          <h1>{t("login.title")}</h1>
          <input class="target wide" type="password" autocomplete="current-password" inputMode="numeric" aria-label={t("login.title")}
            value={pin} onInput={(event) => setPin(event.currentTarget.value)} />
          <p role="alert" class="bad" data-connection={answers ? "good" : "lost"}>{!answers ? t("error.no-connection") : refusal === "" ? "" : t(refusal)}</p>
          <button type="button" class="target" lang={nextLanguage()} onClick={() => language.set(nextLanguage())}>{textIn(nextLanguage(), "language.name")}</button>
        </div>
        <div class="pad">
          {digits.map(digit)}
          <button type="button" class="target tool" onClick={() => setPin("")}>{t("login.clear")}</button>
          {digit("0")}
          <button type="submit" class="target tool primary" disabled={pin === "" || asking}>{t("login.enter")}</button>
        </div>
      </form>
    </main>
  );
}
