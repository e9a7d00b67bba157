import type { JSX } from 'preact';
import { useState } from 'preact/hooks';

type Props = JSX.InputHTMLAttributes<HTMLInputElement>;

/** An input that is read when the reader leaves it. Until then its text stays, also when the view is drawn anew meanwhile. */
export function Entry({ value, onChange, onInput, onBlur, ...more }: Props & { value: string }) {
  const [draft, setDraft] = useState<string | null>(null);
  return (
    <input {...more} value={draft ?? value}
      onInput={(event) => setDraft(event.currentTarget.value)}
      onChange={(event) => {
        setDraft(null);
        (onChange as ((event: JSX.TargetedEvent<HTMLInputElement>) => void) | undefined)?.(event);
      }}
      onBlur={() => setDraft(null)} />
  );
}
