import { useEffect, useState } from "preact/hooks";

/** A value that components can watch. */
export class Store<T> {
  private readonly watchers = new Set<(value: T) => void>();
  constructor(private current: T) {}

  get value(): T {
    return this.current;
  }
  set(value: T): void {
    this.current = value;
    for (const watcher of [...this.watchers]) watcher(value);
  }
  watch(watcher: (value: T) => void): () => void {
    this.watchers.add(watcher);
    return () => this.watchers.delete(watcher);
  }
}

export function useStore<T>(store: Store<T>): T {
  const [value, setValue] = useState(store.value);
  useEffect(() => {
    setValue(() => store.value);
    return store.watch((next) => setValue(() => next));
  }, [store]);
  return value;
}

/** What `select` makes of a store's value: the component is drawn anew only when that is another one. */
export function useSelected<T, S extends string | number | boolean>(store: Store<T>, select: (value: T) => S): S {
  const [value, setValue] = useState(() => select(store.value));
  useEffect(() => {
    setValue(select(store.value));
    return store.watch((next) => setValue(select(next)));
    // eslint-disable-next-line -- `select` is a function of its argument alone
  }, [store]);
  return value;
}

/** Asks again every `period_ms` while the component is shown and it is `wanted`; keeps the last answer when one fails, and tells its age. */
export function usePolled<T>(ask: () => Promise<T>, period_ms: number, wanted = true): { value: T | null; refresh: () => void; age_s: number } {
  const [value, setValue] = useState<T | null>(null);
  const [turn, setTurn] = useState(0);
  const [age_s, setAge] = useState(0);
  useEffect(() => {
    if (!wanted) return undefined;
    let shown = true;
    let came_ms = performance.now();
    const came = (answer: T) => {
      if (!shown) return;
      came_ms = performance.now();
      setValue(() => answer);
      setAge(0);
    };
    const once = () => void ask().then(came, () => shown && setAge((performance.now() - came_ms) / 1000));
    once();
    const timer = setInterval(once, period_ms);
    return () => {
      shown = false;
      clearInterval(timer);
    };
    // eslint-disable-next-line -- `ask` is a method of api
  }, [turn, period_ms, wanted]);
  return { value, refresh: () => setTurn((n) => n + 1), age_s };
}
