import { rounded, zero } from '../format';
import { shown, type Unit } from '../units';

/** protobuf's JSON writes what is no number as a text. */
export const finite = (value: number | string | null | undefined): number | null =>
  typeof value === 'number' && Number.isFinite(value) ? value : null;

interface NumProps {
  value: number | string | null | undefined; // as the service answered it
  error?: number | string | null | undefined; // standard uncertainty or solver error, in the unit of the value
  unit: Unit;
  isSigned?: boolean; // of a difference
  withError?: boolean; // "± error" follows
  data?: Record<string, string | number | undefined>; // attributes for tests
}

/** A number of the service with its rounded text. Tests compare `data-value` with the answer. */
export function Num({ value, error, unit, isSigned = false, withError = false, data = {} }: NumProps) {
  const number = finite(value);
  if (number === null) return <span>–</span>;
  const spread = finite(error);
  const reach = spread === null ? undefined : Math.abs(spread * unit.factor);
  const present = shown(number, unit);
  const text = present === 0 && withError && reach ? zero(reach) : rounded(present, reach);
  const sign = isSigned && /[1-9]/.test(text) && !text.startsWith('−') ? '+' : '';
  return (
    <span class="num">
      <span data-value={number} data-unit={unit.symbol} data-factor={unit.factor} data-offset={unit.offset} {...data}>{sign}{text}</span>
      {withError && spread !== null && spread > 0 && <span> ± <span data-value={spread} data-factor={Math.abs(unit.factor)} data-offset={0}>{rounded(reach!, reach)}</span></span>}
    </span>
  );
}
