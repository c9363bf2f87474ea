import { render, type ComponentChildren } from "preact";
import { useEffect, useRef } from "preact/hooks";

/** How many cards lie above the page; the page below takes no touch and no key while there is one. */
let open = 0;
function cover(by: 1 | -1): void {
  open += by;
  for (const below of document.querySelectorAll<HTMLElement>(".rail, .page")) below.inert = open > 0;
}

interface Above {
  label: string;
  class: string;
  cancel: () => void;
  pressed?: (event: KeyboardEvent) => boolean;
  children: ComponentChildren;
}

function Card(props: Above) {
  const card = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const before = document.activeElement as HTMLElement | null;
    card.current?.querySelector<HTMLElement>("button:not(:disabled), input")?.focus();
    return () => before?.focus();
  }, []);
  return (
    <div class="above" onKeyDown={(event) => {
      if (event.key === "Escape") props.cancel();
      else if (props.pressed?.(event)) event.preventDefault();
    }}>
      <div ref={card} class={`above-card ${props.class}`} role="dialog" aria-label={props.label}>{props.children}</div>
    </div>
  );
}

/**
 * A card above the page and the rail, but never above the command bar: Stop stays in reach of finger and keyboard. A
 * modal <dialog> would make everything else of the document dead, Stop too.
 */
export function AbovePage(props: Above) {
  const holder = useRef<HTMLElement | null>(null);
  useEffect(() => {
    const element = document.createElement("div");
    document.body.append(element);
    holder.current = element;
    cover(1);
    return () => {
      cover(-1);
      render(null, element);
      element.remove();
    };
  }, []);
  useEffect(() => {
    if (holder.current) render(<Card {...props} />, holder.current);
  });
  return null;
}
