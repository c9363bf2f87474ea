import { useText } from "../i18n";
import { AbovePage } from "./above_page";
import { Tool } from "./tool";

/** Asks before something is replaced; to leave it as it is comes first. */
export function Question(props: { text: string; yes: string; answer: (yes: boolean) => void }) {
  const t = useText();
  return (
    <AbovePage class="question" label={props.text} cancel={() => props.answer(false)}>
      <p>{props.text}</p>
      <div class="buttons">
        <Tool icon="back" label={t("question.no")} primary onClick={() => props.answer(false)} />
        <Tool icon="good" label={props.yes} onClick={() => props.answer(true)} />
      </div>
    </AbovePage>
  );
}
