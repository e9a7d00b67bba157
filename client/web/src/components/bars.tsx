import type { ComponentChildren } from 'preact';

export interface Bar {
  key: string;
  label: ComponentChildren;
  value: number; // lengths are drawn to one scale
  low?: number | null; // whisker
  high?: number | null;
  text: ComponentChildren;
  isSum?: boolean; // set apart beneath the others
}

/** Horizontal bars from a common zero, with whiskers; each row reads as label and number. */
export function Bars({ bars, label, less, more }: { bars: Bar[]; label: string; less?: string; more?: string }) {
  const ends = bars.flatMap((bar) => [bar.value, bar.low ?? bar.value, bar.high ?? bar.value]);
  const low = Math.min(0, ...ends);
  const high = Math.max(0, ...ends);
  const room = 0.03 * (high - low || 1);
  const from = low < 0 ? low - room : 0;
  const to = high > 0 ? high + room : 0;
  const at = (value: number) => `${((100 * (value - from)) / (to - from || 1)).toFixed(3)}%`;
  const length = (a: number, b: number) => `${((100 * Math.abs(b - a)) / (to - from || 1)).toFixed(3)}%`;
  return (
    <table class="bars" aria-label={label}>
      {(less || more) && (
        <thead><tr><td /><td class="bars-ends"><span>{less && `← ${less}`}</span><span>{more && `${more} →`}</span></td><td /></tr></thead>
      )}
      <tbody>
        {bars.map((bar) => (
          <tr key={bar.key} class={bar.isSum ? 'sum' : ''}>
            <th scope="row">{bar.label}</th>
            <td class="bar-cell">
              <svg width="100%" height="22" aria-hidden="true">
                <rect class="bar-fill" x={at(Math.min(0, bar.value))} width={length(0, bar.value)} y="4" height="14" rx="1.5" />
                <line class="bar-zero" x1={at(0)} x2={at(0)} y1="0" y2="22" />
                {bar.low != null && bar.high != null && bar.high > bar.low && (
                  <g class="whisker">
                    <line x1={at(bar.low)} x2={at(bar.high)} y1="11" y2="11" />
                    <line x1={at(bar.low)} x2={at(bar.low)} y1="7" y2="15" />
                    <line x1={at(bar.high)} x2={at(bar.high)} y1="7" y2="15" />
                  </g>
                )}
              </svg>
            </td>
            <td class="number">{bar.text}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}
