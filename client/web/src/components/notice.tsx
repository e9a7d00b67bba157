import type { ComponentChildren } from 'preact';
import { ApiError } from '../api/client';

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
