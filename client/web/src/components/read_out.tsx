import { useMemo, useState } from 'preact/hooks';
import { fluidsOf, shortTitle, speedUnitOf, variantOf, type Curve } from '../curve';
import { idOf, revisionIdOf, rounded } from '../format';
import { Store, useStore } from '../store';
import { isInRpm, shown, units } from '../units';
import { QUANTITIES, type Quantity } from '../quantities';
import { figureOf, unstatedOf, type ComparedGroup } from '../uncertainty';
import { finite, UncertainNum } from './num';
import { Swatch } from './swatch';

interface ReadOutProps {
  curves: Curve[];
  titles: Map<string, string>;
  groups: ComparedGroup[] | undefined;
  speed: Store<number | null>;
  shownQuantity: Quantity; // on the main plot
  onOpen: (curve: Curve, speed: number) => void;
}

/** A value of a curve: with the interval by its inputs if there is one, else rounded by the solver's error. */
function CurveNum({ curve, row, quantity, column, groups }: { curve: Curve; row: number; quantity: Quantity; column: string; groups?: ComparedGroup[] | undefined }) {
  const value = curve.columns[column]![row] ?? null;
  const relative = curve.columns['estimated_relative_error']![row];
  const { value: _, ...errors } = figureOf(groups, curve.simulation, column, row) ?? { solver_error: value === null || relative == null ? undefined : value * relative };
  return <UncertainNum figure={{ ...errors, value }} unit={quantity.unit} data={{ 'data-column': column, 'data-simulation': curve.simulation.name, 'data-row': row }} />;
}

/** The speed at which a column of any curve is greatest. */
function greatestAt(curves: Curve[], column: string): number | null {
  let best: number | null = null;
  let greatest = -Infinity;
  for (const curve of curves) {
    curve.columns[column]!.forEach((value, row) => {
      if (value !== null && value > greatest) [best, greatest] = [curve.columns['speed_kilometres_per_hour']![row]!, value];
    });
  }
  return best;
}

const SHOWN_SPEEDS = 100;

interface LineOfCurve {
  curve: Curve;
  series: number;
  label: string;
  rows: Map<number | null, number>; // by speed
}

/** The plotted numbers at all speeds. */
function EverySpeed({ lines, speeds, quantity, groups }: { lines: LineOfCurve[]; speeds: number[]; quantity: Quantity; groups: ComparedGroup[] | undefined }) {
  const [isOpen, setOpen] = useState(false);
  const [count, setCount] = useState(SHOWN_SPEEDS);
  const kinds = ['least', 'greatest'];
  return (
    <details onToggle={(event) => setOpen(event.currentTarget.open)}>
      <summary data-key="t">Every speed: {quantity.label.toLowerCase()}{quantity.unit.symbol && `, ${quantity.unit.symbol}`}</summary>
      {isOpen && (
        <div class="scroll" tabIndex={0} role="region" aria-label="Every speed">
          <table>
            <thead>
              <tr><th class="number">km/h</th>{lines.map(({ curve, series, label }) => quantity.columns.map((column, k) => (
                <th key={`${curve.simulation.name} ${column}`} class="number"><Swatch series={series} /> {label}{quantity.columns.length > 1 && <small>{kinds[k]}</small>}</th>
              )))}</tr>
            </thead>
            <tbody>
              {speeds.slice(0, count).map((speed) => (
                <tr key={speed}>
                  <th scope="row" class="number">{speed}</th>
                  {lines.map(({ curve, rows }) => quantity.columns.map((column) => (
                    <td key={`${curve.simulation.name} ${column}`} class="number">{rows.has(speed) ? <CurveNum curve={curve} row={rows.get(speed)!} quantity={quantity} column={column} groups={groups} /> : '–'}</td>
                  )))}
                </tr>
              ))}
            </tbody>
          </table>
          {speeds.length > count && <button onClick={() => setCount(count + SHOWN_SPEEDS)}>Show {Math.min(SHOWN_SPEEDS, speeds.length - count)} more of {speeds.length} speeds</button>}
        </div>
      )}
    </details>
  );
}

/** Every number of the plots at one speed. */
export function ReadOut({ curves, titles, groups, speed, shownQuantity, onOpen }: ReadOutProps) {
  const chosen = useStore(speed);
  const inUnits = useStore(units);
  const onSpeed = (next: number) => speed.set(next);
  // What a speed does not change is made once: the table follows the pointer.
  const speeds = useMemo(() => [...new Set(curves.flatMap((curve) => curve.columns['speed_kilometres_per_hour'] as number[]))].sort((a, b) => a - b), [curves]);
  const lines = useMemo(() => {
    const fluids = fluidsOf(curves);
    const simulations = curves.map((curve) => curve.simulation);
    return curves.map((curve) => {
      const revision = curve.simulation.lubricant_revision ?? '';
      const variant = variantOf(curve.simulation, simulations);
      return {
        curve, series: fluids.indexOf(revision), label: `${shortTitle(titles.get(idOf(revision)) ?? revisionIdOf(revision))}${variant && `, ${variant}`}`,
        rows: new Map(curve.columns['speed_kilometres_per_hour']!.map((each, row) => [each, row])),
      };
    });
  }, [curves, titles, inUnits]);
  const worst = useMemo(() => greatestAt(curves, shownQuantity.columns.at(-1)!), [curves, shownQuantity]);
  const at = chosen !== null && speeds.includes(chosen) ? chosen : speeds[Math.floor(speeds.length / 2)]!;
  const index = speeds.indexOf(at);
  const columns = QUANTITIES.flatMap((quantity) => quantity.columns.map((column, k) => ({ quantity, column, k })));
  const torque = finite(curves[0]!.columns['pinion_torque_newton_metres']![lines[0]!.rows.get(at) ?? -1]);
  const every = useMemo(() => <EverySpeed lines={lines} speeds={speeds} quantity={shownQuantity} groups={groups} />, [lines, speeds, shownQuantity, groups]);
  const unstated = unstatedOf(groups).map((each) => shortTitle(titles.get(idOf(each)) ?? revisionIdOf(each)));
  const errors = lines.map(({ curve, rows }) => curve.columns['estimated_relative_error']![rows.get(at) ?? -1]);
  return (
    <section class="read-out" aria-labelledby="read-out-title">
      <div class="heading">
        <h2 id="read-out-title">{isInRpm() ? <>At {rounded(shown(at, speedUnitOf(curves[0])), 1)} rpm <span class="count">{at} km/h{torque !== null && <>, {rounded(torque)} N m on the pinion</>}</span></> : `At ${at} km/h`}</h2>
        {worst !== null && <button onClick={() => onSpeed(worst)}>To the greatest {shownQuantity.label.toLowerCase()}</button>}
        <input type="range" min={0} max={speeds.length - 1} value={index} aria-label="Speed" aria-valuetext={`${at} kilometres per hour`}
          onInput={(event) => onSpeed(speeds[event.currentTarget.valueAsNumber]!)} />
      </div>
      <div class="scroll" tabIndex={0} role="region" aria-label="All numbers at this speed">
        <table>
          <thead>
            <tr>
              <th>Fluid</th>
              {columns.map(({ quantity, column, k }) => (
                <th key={column} class="number">
                  {quantity.columns.length > 1 ? `DTE ${k === 0 ? 'least' : 'greatest'}` : quantity.label}
                  {quantity.unit.symbol && <small>{quantity.unit.symbol}</small>}
                </th>
              ))}
              <th><span class="hidden">Details</span></th>
            </tr>
          </thead>
          <tbody>
            {lines.map(({ curve, series, label, rows }) => {
              const row = rows.get(at) ?? -1;
              return (
                <tr key={curve.simulation.name}>
                  <th scope="row"><Swatch series={series} />{label}</th>
                  {columns.map(({ quantity, column }) => (
                    <td key={column} class="number">{row < 0 ? '–' : <CurveNum curve={curve} row={row} quantity={quantity} column={column} groups={groups} />}</td>
                  ))}
                  <td class="number"><button onClick={() => onOpen(curve, at)} title="Time histories at this speed">Open<span class="hidden"> the point</span></button></td>
                </tr>
              );
            })}
          </tbody>
        </table>
      </div>
      <p class="muted small">{errorText(errors)}{groups && ' Beneath a value: what its inputs leave, with 95 %.'}{unstated.length > 0 && ` Uncertainty not stated: ${unstated.join(', ')}.`}</p>
      {every}
    </section>
  );
}

function errorText(errors: (number | null | undefined)[]): string {
  const known = errors.filter((each): each is number => each !== null && each !== undefined);
  if (known.length === 0) return 'The solver error is not estimated.';
  const most = Math.max(...known);
  const text = most < 1e-4 ? most.toExponential(0).replace('e-', ' × 10⁻').replace(/\d+$/, (digits) => [...digits].map((each) => '⁰¹²³⁴⁵⁶⁷⁸⁹'[Number(each)]).join('')) : `${Number((100 * most).toPrecision(1))} %`;
  return most < 1e-4 ? `Solver error: at most ${text} of each value, thinner than the lines.` : `Solver error: at most ${text} of each value.`;
}
