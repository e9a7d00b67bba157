import { rounded } from '../format';
import { shown, type Unit } from '../units';

/** protobuf's JSON writes what is no number as a text. */
export const finite = (value: number | string | null | undefined): number | null =>
  typeof value === 'number' && Number.isFinite(value) ? value : null;

interface NumProps {
  value: number | string | null | undefined; // as the service answered it
  error?: number | string | null | undefined; // that decides the digits, in the unit of the value
  unit: Unit;
  isSigned?: boolean; // of a difference
  data?: Record<string, string | number | undefined>; // attributes for tests
}

/** A number of the service with its rounded text. Tests compare `data-value` with the answer. */
export function Num({ value, error, unit, isSigned = false, data = {} }: NumProps) {
  const number = finite(value);
  if (number === null) return <span>–</span>;
  const spread = finite(error);
  const text = rounded(shown(number, unit), spread === null ? undefined : Math.abs(spread * unit.factor));
  const sign = isSigned && /[1-9]/.test(text) && !text.startsWith('−') ? '+' : '';
  return <span data-value={number} data-unit={unit.symbol} data-factor={unit.factor} data-offset={unit.offset} {...data}>{sign}{text}</span>;
}

/** A figure of the service: its value and the interval that holds it with 95 %, as far as the inputs decide. */
export interface Figure {
  value?: number | string | null;
  standard_uncertainty?: number | string | null;
  interval_minimum?: number | string | null;
  interval_maximum?: number | string | null;
  solver_error?: number | string | null;
}

/** Whether the inputs move a figure. */
export const isUncertain = (figure: Figure | undefined): boolean => (finite(figure?.standard_uncertainty) ?? 0) > 0;

/** What decides the digits of a figure. */
export const spreadOf = (figure: Figure | undefined): number | null =>
  finite(isUncertain(figure) ? figure!.standard_uncertainty : figure?.solver_error);

export function Interval({ figure, unit, isSigned = false }: { figure: Figure; unit: Unit; isSigned?: boolean }) {
  const error = spreadOf(figure);
  return <span><Num value={figure.interval_minimum} error={error} unit={unit} isSigned={isSigned} /> to <Num value={figure.interval_maximum} error={error} unit={unit} isSigned={isSigned} /></span>;
}

/** A value with its interval beneath: no other error stands beside a value anywhere. */
export function UncertainNum({ figure, unit, isSigned = false, isStated = true, data }: {
  figure: Figure | undefined; unit: Unit; isSigned?: boolean; isStated?: boolean; data?: Record<string, string | number | undefined>;
}) {
  return (
    <>
      <Num value={figure?.value} error={spreadOf(figure)} unit={unit} isSigned={isSigned} {...(data ? { data } : {})} />
      {!isStated ? <small class="interval">not stated</small> : isUncertain(figure) && <small class="interval"><Interval figure={figure!} unit={unit} isSigned={isSigned} /></small>}
    </>
  );
}
