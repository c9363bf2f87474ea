import { useText } from "../i18n";
import { live } from "../live/live_socket";
import type { Edit } from "../pages/setup/use_edit";
import { useStore } from "../store";
import { Icon } from "./icon";
import { Tool } from "./tool";

/** Undo, redo, save and go on; what to do when somebody else saved first, and a word while somebody else edits the same. */
export function EditBar<T>({ edit, kind, next }: { edit: Edit<T>; kind: string; next: () => void }) {
  const t = useText();
  const others = useStore(live.newest)?.live.editors ?? [];
  const goOn = () => {
    if (!edit.unsaved) next();
    else void edit.save().then((done) => done && next());
  };
  return (
    <section class="edit-bar">
      {others.includes(kind) && <p class="caution" role="status"><Icon name="warning" /> {t("setup.others")}</p>}
      {edit.conflict && (
        <div class="caution" role="alert">
          <p><Icon name="warning" /> {t("setup.conflict")}</p>
          <div class="buttons">
            <Tool icon="download" label={t("setup.conflict.load")} onClick={edit.loadTheirs} />
            <Tool icon="save" label={t("setup.conflict.overwrite")} onClick={() => void edit.overwrite()} />
          </div>
        </div>
      )}
      <p class="quiet" role="status">{edit.unsaved ? t("setup.unsaved") : t("setup.saved")}</p>
      <div class="buttons">
        <Tool icon="undo" label={t("setup.undo")} disabled={!edit.canUndo} onClick={edit.undo} />
        <Tool icon="redo" label={t("setup.redo")} disabled={!edit.canRedo} onClick={edit.redo} />
        <Tool icon={edit.unsaved ? "save" : "next"} label={edit.unsaved ? t("setup.save_next") : t("setup.next")} primary onClick={goOn} />
      </div>
    </section>
  );
}
