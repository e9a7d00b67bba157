import type { ComponentChildren } from 'preact';
import { worstOf, type Level, type Remark } from '../validity';

const WORDS = { ok: 'Within the validated range', note: 'Not compared with validated ranges', caution: 'With caution', outside: 'Do not rank by this' };

/** What the figures leave out, in the words of the service. */
export function NotIncluded({ text }: { text: string | undefined }) {
  return text ? <p class="small not-included">{text}</p> : null;
}

/** A circle, a triangle or a square: shape and words say what the color says. */
function Light({ level }: { level: Level | 'ok' }) {
  return (
    <svg class={`light ${level}`} width="14" height="14" viewBox="-7 -7 14 14" aria-hidden="true">
      {level === 'caution' ? <polygon points="0,-6 6,5 -6,5" /> : level === 'outside' ? <rect x="-5" y="-5" width="10" height="10" /> : <circle r="5" />}
    </svg>
  );
}

/**
 * Whether a result may be relied on, in one light, with every sentence of the service behind it.
 * Without `isChecked` the service compares the result with no range.
 */
export function Validity({ remarks, isOpen = false, isChecked = true, children }: {
  remarks: Remark[]; isOpen?: boolean; isChecked?: boolean; children?: ComponentChildren;
}) {
  const worst = worstOf(remarks);
  const level = worst === 'ok' && !isChecked ? 'note' : worst;
  const heads = [...new Set(remarks.filter((each) => each.level !== 'note').map((each) => each.words))];
  const notes = remarks.filter((each) => each.level === 'note').length;
  return (
    <details class="validity" data-level={level} open={isOpen || level === 'outside'}>
      <summary><Light level={level} /> <strong class={level}>{WORDS[level]}</strong>
        {heads.length > 0 && <span class="muted">: {heads.join('; ')}</span>}{heads.length === 0 && notes > 0 && <span class="muted">, {notes} note{notes > 1 ? 's' : ''}</span>}</summary>
      <ul>
        {remarks.map((each) => (
          <li key={`${each.code} ${each.where} ${each.message}`} class={each.level}>
            <Light level={each.level} /> <span>{each.words}{each.where && `, at ${each.where}`}. <span class="muted">{each.message}</span> <span class="code">{each.code}</span></span>
          </li>
        ))}
        {children}
        {remarks.length === 0 && !children && <li class="note">No law of the model leaves the range in which it was measured or checked.</li>}
      </ul>
    </details>
  );
}
