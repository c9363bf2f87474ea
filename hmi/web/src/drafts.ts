/** What was edited but not saved: survives a reload, a crash of the server and a closed browser. */
export interface Draft<T> {
  revision: string;
  value: T;
}

const key = (site: string, kind: string) => `madori.draft.${site}.${kind}`;

export function loadDraft<T>(site: string, kind: string): Draft<T> | null {
  const text = localStorage.getItem(key(site, kind));
  if (text === null) return null;
  try {
    return JSON.parse(text) as Draft<T>;
  } catch {
    return null;
  }
}

export function keepDraft<T>(site: string, kind: string, draft: Draft<T>): void {
  localStorage.setItem(key(site, kind), JSON.stringify(draft));
}

export function dropDraft(site: string, kind: string): void {
  localStorage.removeItem(key(site, kind));
}
