import type { ComponentChildren } from "preact";
import { Icon, type IconName } from "./icon";

export interface Tab<Name extends string> {
  name: Name;
  icon: IconName;
  label: string;
}

/** One of several cards at a time; the row of tabs takes the arrow keys as screen readers expect. */
export function Tabs<Name extends string>(props: { label: string; tabs: readonly Tab<Name>[]; shown: Name; choose: (name: Name) => void; children: ComponentChildren }) {
  const { tabs, shown, choose } = props;
  const step = (event: KeyboardEvent) => {
    const by = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (by === 0) return;
    const at = tabs.findIndex((tab) => tab.name === shown);
    const next = tabs[(at + by + tabs.length) % tabs.length];
    if (next) {
      choose(next.name);
      document.getElementById(`tab-${next.name}`)?.focus();
    }
  };
  return (
    <div class="tabbed">
      <div class="tabs" role="tablist" aria-label={props.label} onKeyDown={step}>
        {tabs.map((tab) => (
          <button key={tab.name} id={`tab-${tab.name}`} type="button" role="tab" class="target tool" aria-selected={tab.name === shown}
            aria-controls={`panel-${tab.name}`} tabIndex={tab.name === shown ? 0 : -1} onClick={() => choose(tab.name)}>
            <Icon name={tab.icon} />
            <span>{tab.label}</span>
          </button>
        ))}
      </div>
      <div key={shown} class="tab-panel" id={`panel-${shown}`} role="tabpanel" aria-labelledby={`tab-${shown}`} tabIndex={0}>{props.children}</div>
    </div>
  );
}
