import { Icon, type IconName } from "./icon";

interface ToolProps {
  icon: IconName;
  label: string;
  pressed?: boolean;
  disabled?: boolean;
  primary?: boolean;
  onClick: () => void;
}

/** A square button: picture above, words below. */
export function Tool({ icon, label, pressed, disabled, primary, onClick }: ToolProps) {
  return (
    <button type="button" class={primary ? "target tool primary" : "target tool"} aria-pressed={pressed} disabled={disabled} onClick={onClick}>
      <Icon name={icon} />
      <span>{label}</span>
    </button>
  );
}
