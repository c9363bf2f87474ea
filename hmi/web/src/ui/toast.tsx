import { Refused } from "../api";
import { noticeText, useText } from "../i18n";
import { Store, useStore } from "../store";
import { Icon } from "./icon";

interface Message {
  code: string;
  text: string;
  values: Record<string, string>;
}
const message = new Store<Message | null>(null);
let timer = 0;

/** Shows a refusal until it is tapped away, or for ten seconds. */
export function tell(code: string, text: string, values: Record<string, string> = {}): void {
  message.set({ code, text, values });
  clearTimeout(timer);
  timer = window.setTimeout(() => message.set(null), 10_000);
}

/** Runs something that may be refused, and says why it was. True where it worked. */
export async function attempt(action: () => Promise<unknown>): Promise<boolean> {
  try {
    await action();
    return true;
  } catch (error) {
    if (error instanceof Refused) tell(error.code, error.message, error.values);
    else tell("internal", String(error));
    return false;
  }
}

export function Toast() {
  const t = useText();
  const shown = useStore(message);
  return (
    <div role="alert" aria-live="assertive">
      {shown && (
        <button type="button" class="toast target" onClick={() => message.set(null)}>
          <span><Icon name="warning" /> {noticeText(t, "error", shown)}</span>
        </button>
      )}
    </div>
  );
}
