import { useEffect, useState } from "preact/hooks";
import { api } from "../../api";
import type { ScaleRequest, ScaleResult } from "../../api_types";
import { attempt } from "../../ui/toast";

type Measured = Omit<ScaleRequest, "apply" | "force">;

/** Asks the server for the fit whenever the measurements change; `apply` gives the site that scale. */
export function useMeasure(measured: Measured | null): { result: ScaleResult | null; apply: (force?: boolean) => Promise<boolean> } {
  const [result, setResult] = useState<ScaleResult | null>(null);
  const key = JSON.stringify(measured);
  useEffect(() => {
    let newest = true;
    setResult(null);
    if (measured === null) return undefined;
    const timer = setTimeout(() => void attempt(async () => {
      const answer = await api.scale({ ...measured, apply: false });
      if (newest) setResult(answer);
    }), 150);
    return () => {
      newest = false;
      clearTimeout(timer);
    };
  }, [key]);
  const apply = (force = false) => attempt(async () => setResult(await api.scale({ ...measured, apply: true, force })));
  return { result, apply };
}
