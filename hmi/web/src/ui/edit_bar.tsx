import { useText } from "../i18n";
import type { Edit } from "../pages/setup/use_edit";
import { Icon } from "./icon";

/** Undo, redo, save, and what to do when somebody else saved first. */
export function EditBar<T>({ edit, saved }: { edit: Edit<T>; saved?: () => void }) {
  const t = useText();
  const save = () => void edit.save().then((done) => done && saved?.());
  return (
    <section class="card">
      <div class="buttons">
        <button class="target" aria-label={t("setup.undo")} disabled={!edit.canUndo} onClick={edit.undo}><Icon name="undo" /></button>
        <button class="target" aria-label={t("setup.redo")} disabled={!edit.canRedo} onClick={edit.redo}><Icon name="redo" /></button>
        <button class="target primary" disabled={!edit.unsaved} onClick={save}><Icon name="save" /> {t("setup.save")}</button>
      </div>
      <p class="quiet" role="status">{edit.unsaved ? t("setup.unsaved") : t("setup.saved")}</p>
      {edit.conflict && (
        <div class="caution" role="alert">
          <p>{t("setup.conflict")}</p>
          <div class="buttons">
            <button class="target" onClick={edit.loadTheirs}>{t("setup.conflict.load")}</button>
            <button class="target" onClick={() => void edit.overwrite().then((done) => done && saved?.())}>{t("setup.conflict.overwrite")}</button>
          </div>
        </div>
      )}
    </section>
  );
}
