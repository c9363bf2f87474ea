import { useEffect, useRef, useState } from "preact/hooks";
import { Refused } from "../../api";
import { dropDraft, keepDraft, loadDraft } from "../../drafts";
import { EditHistory } from "../../edit_history";
import { live, type Editing } from "../../live/live_socket";
import { tell } from "../../ui/toast";

export interface Edit<T> {
  value: T;
  change: (next: T) => void;
  undo: () => void;
  redo: () => void;
  canUndo: boolean;
  canRedo: boolean;
  unsaved: boolean;
  conflict: boolean;
  save: () => Promise<boolean>;
  overwrite: () => Promise<boolean>;
  loadTheirs: () => void;
}

interface Source<T> {
  site: string;
  kind: Exclude<Editing, "">;
  loaded: { revision: string; value: T };
  save: (revision: string, value: T) => Promise<{ revision: string }>;
  reload: () => Promise<{ revision: string; value: T }>;
}

/** Editing with undo, drafts that survive a reload, and a word when somebody else saved first. */
export function useEdit<T>(source: Source<T>): Edit<T> {
  const draft = useRef(loadDraft<T>(source.site, source.kind));
  const history = useRef(new EditHistory<T>(draft.current?.value ?? source.loaded.value));
  const revision = useRef(draft.current?.revision ?? source.loaded.revision);
  const [unsaved, setUnsaved] = useState(draft.current !== null);
  const [conflict, setConflict] = useState(false);
  const [, redraw] = useState(0);
  const touched = () => {
    keepDraft(source.site, source.kind, { revision: revision.current, value: history.current.value });
    setUnsaved(true);
    redraw((n) => n + 1);
  };
  // Somebody else saved, also from the command line: taken over where nothing is unsaved here, else the person decides.
  useEffect(() => {
    if (source.loaded.revision === revision.current) return;
    if (unsaved) return setConflict(true);
    history.current = new EditHistory(source.loaded.value);
    revision.current = source.loaded.revision;
    redraw((n) => n + 1);
  }, [source.loaded.revision]);
  useEffect(() => {
    live.editing(unsaved ? source.kind : "");
  }, [unsaved]);
  useEffect(() => () => live.editing(""), []);

  const saveAs = async (base: string): Promise<boolean> => {
    try {
      revision.current = (await source.save(base, history.current.value)).revision;
    } catch (error) {
      if (error instanceof Refused && error.status === 409) setConflict(true);
      else if (error instanceof Refused) tell(error.code, error.message);
      else throw error;
      return false;
    }
    dropDraft(source.site, source.kind);
    setUnsaved(false);
    setConflict(false);
    return true;
  };
  return {
    get value() {
      return history.current.value;
    },
    change: (next) => {
      history.current.change(next);
      touched();
    },
    undo: () => {
      history.current.undo();
      touched();
    },
    redo: () => {
      history.current.redo();
      touched();
    },
    canUndo: history.current.canUndo,
    canRedo: history.current.canRedo,
    unsaved,
    conflict,
    save: () => saveAs(revision.current),
    overwrite: async () => saveAs((await source.reload()).revision),
    loadTheirs: () =>
      void source.reload().then((theirs) => {
        history.current = new EditHistory(theirs.value);
        revision.current = theirs.revision;
        dropDraft(source.site, source.kind);
        setUnsaved(false);
        setConflict(false);
        redraw((n) => n + 1);
      }),
  };
}
