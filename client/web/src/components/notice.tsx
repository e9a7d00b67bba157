import type { ComponentChildren } from 'preact';
import { useEffect, useState } from 'preact/hooks';
import { ApiError, waits } from '../api/client';
import { useStore } from '../store';

export function Notice({ kind, children }: { kind: 'caution' | 'error' | 'ok'; children: ComponentChildren }) {
  return <div class={`notice ${kind}`} role={kind === 'error' ? 'alert' : 'status'}>{children}</div>;
}

/** A refusal in words: what, and what to do. */
export function Failure({ error, onRetry }: { error: unknown; onRetry?: () => void }) {
  const refusal = error instanceof ApiError ? error : null;
  if (refusal?.status === 401) return null; // the shell says so
  return (
    <Notice kind="error">
      <p>{(error as Error).message}</p>
      {refusal && refusal.violations.length > 1 && (
        <ul>{refusal.violations.map((each) => <li key={each.field}>{each.description}</li>)}</ul>
      )}
      {refusal?.reason && <p class="code">{refusal.reason}</p>}
      {onRetry && <button onClick={onRetry}>Try again</button>}
    </Notice>
  );
}

/** Why requests wait, with the seconds until the next one is sent again. */
export function Waiting() {
  const all = useStore(waits);
  const [, redraw] = useState(0);
  const isWaiting = all.length > 0;
  useEffect(() => {
    if (!isWaiting) return;
    const timer = setInterval(() => redraw((count) => count + 1), 500);
    return () => clearInterval(timer);
  }, [isWaiting]);
  if (!isWaiting) return null;
  const next = all.reduce((best, each) => (each.until < best.until ? each : best));
  return (
    <Notice kind="caution">
      {next.why.charAt(0).toUpperCase() + next.why.slice(1)}. Trying again in <span role="timer">{Math.max(1, Math.ceil((next.until - Date.now()) / 1000))} s</span>.
    </Notice>
  );
}
