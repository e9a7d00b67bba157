import { useMemo } from 'preact/hooks';
import type { EvaluateRigResponse, EvaluateViscosityResponse, Lubricant } from '../api/types';
import { CurveChart } from '../charts/curve_chart';
import { Heat } from '../charts/heat';
import type { Line, Spec } from '../charts/spec';
import { Failure, Notice } from '../components/notice';
import { finite, Num } from '../components/num';
import { TakeAway } from '../components/take_away';
import { Validity } from '../components/validity';
import { shortTitle } from '../curve';
import { idOf, revisionIdOf, rounded } from '../format';
import { titlesOf, useAnswer, useLubricants } from '../resources';
import { place, set } from '../router';
import { useStore } from '../store';
import { celsius, isDynamic, metres, pascals, plain, scaled, shown, units, written, type Unit } from '../units';
import { remarkOf, remarksOnce, runsText } from '../validity';

const TEMPERATURES = Array.from({ length: 33 }, (_, k) => -20 + 5 * k); // [C]
const PRESSURES = Array.from({ length: 25 }, (_, k) => 0.05e9 * k); // [Pa]
const MARKED_TEMPERATURES = [40, 70, 100, 130]; // [C], of curves over pressure
const MILLIPASCAL_SECONDS = scaled('mPa s', 1e3);

const heightOf = (): number => (matchMedia('(max-width: 640px)').matches ? 260 : 340);

const bodyOf = (id: string) => ({ lubricant: `lubricants/${id}`, temperatures_celsius: TEMPERATURES, pressures_pascals: PRESSURES });

/** Viscosity over temperature and over pressure by the law of the fluid, beside another fluid if one is chosen. */
export function Viscosity({ id, lubricant }: { id: string; lubricant: Lubricant }) {
  const { query } = useStore(place);
  const inUnits = useStore(units);
  const lubricants = useLubricants();
  const titles = titlesOf(lubricants.value);
  const other = query.get('vs') ?? '';
  const own = useAnswer<EvaluateViscosityResponse>('viscosities:evaluate', bodyOf(id));
  const beside = useAnswer<EvaluateViscosityResponse>('viscosities:evaluate', other === '' ? null : bodyOf(other));
  const fluids = useMemo(() => [{ id, answer: own.value }, { id: other, answer: other === '' ? undefined : beside.value }]
    .flatMap((each) => (each.answer ? [{ id: each.id, answer: each.answer }] : [])), [own.value, beside.value, id, other]);
  const titleOf = (fluid: string) => shortTitle(titles.get(idOf(fluid)) ?? fluid);
  const [overTemperature, overPressure] = useMemo(() => [temperatureSpec(fluids, titleOf, lubricant), pressureSpec(fluids, titleOf)], [fluids, lubricants.value, lubricant, inUnits]);
  if (own.error !== undefined) return <Failure error={own.error} onRetry={own.reload} />;
  if (!own.value) return <p class="muted">Loading …</p>;
  const requests = fluids.map((each) => bodyOf(each.id));
  return (
    <section aria-label="Viscosity" class={own.isStale || beside.isStale ? 'stale' : ''}>
      <div class="choices">
        <label class="inline">Beside
          <select value={other} onChange={(event) => set({ vs: event.currentTarget.value || undefined })}>
            <option value="">no other fluid</option>
            {[...titles].filter(([each]) => each !== idOf(id)).map(([each, title]) => <option key={each} value={each}>{shortTitle(title)}</option>)}
          </select>
        </label>
      </div>
      {beside.error !== undefined && <Failure error={beside.error} />}
      {(own.value.refusals ?? []).map((each) => <Notice key={each.message} kind="caution">{each.message}</Notice>)}
      {[overTemperature, overPressure].map((spec) => (
        <figure key={spec.xLabel} class="figure">
          <div class="heading">
            <figcaption>{spec.title}</figcaption>
            <TakeAway name="viscosity" spec={spec} footer={[fluids.map((each) => revisionIdOf(each.answer.lubricant_revision)).join(', '), own.value!.model_version ?? '']} requests={requests} commands={[]} />
          </div>
          <CurveChart spec={spec} height={heightOf()} sync={spec.xLabel} />
          <p class="axis-title">{spec.xLabel}</p>
        </figure>
      ))}
      <ViscosityTable fluids={fluids} titleOf={titleOf} />
    </section>
  );
}

type Evaluated = { id: string; answer: EvaluateViscosityResponse };

/** The column and unit of viscosities at ambient pressure. */
const ambient = (): { column: 'ambient_dynamic_viscosity_pascal_seconds' | 'ambient_kinematic_viscosity_square_millimetres_per_second'; unit: Unit; words: string } =>
  (isDynamic() ? { column: 'ambient_dynamic_viscosity_pascal_seconds', unit: MILLIPASCAL_SECONDS, words: 'Dynamic viscosity' }
    : { column: 'ambient_kinematic_viscosity_square_millimetres_per_second', unit: plain('mm²/s'), words: 'Kinematic viscosity' });

function temperatureSpec(fluids: Evaluated[], titleOf: (fluid: string) => string, lubricant: Lubricant): Spec {
  const { column, unit, words } = ambient();
  const x = TEMPERATURES.map((each) => shown(each, celsius));
  const lines: Line[] = fluids.map(({ id, answer }, k) => ({
    label: titleOf(id), series: k, variant: 0, x, hollow: x.map(() => false),
    y: x.map((_, row) => { const value = finite(answer[column]?.[row]); return value === null ? null : shown(value, unit); }),
  }));
  const measured = (lubricant.characterisation?.viscosity_residuals ?? []).filter(() => isDynamic());
  if (measured.length > 0) {
    lines.push({
      label: '', series: 0, variant: 0, isMarksOnly: true, x: measured.map((each) => shown(each.temperature_celsius!, celsius)),
      y: measured.map((each) => each.measured_dynamic_viscosity_millipascal_seconds!), hollow: measured.map(() => true),
    });
  }
  return {
    title: `${words} at ambient pressure, ${unit.symbol}${measured.length > 0 ? '; hollow: measured' : ''}`, xLabel: `Temperature, ${celsius.symbol}`, yLabel: unit.symbol, lines,
    parted: [], caution: [], outside: [], levels: [], fromZero: false, yIsLogarithmic: true,
  };
}

function pressureSpec(fluids: Evaluated[], titleOf: (fluid: string) => string): Spec {
  const x = PRESSURES.map((each) => shown(each, pascals));
  return {
    title: 'Dynamic viscosity under pressure, mPa s', xLabel: `Pressure above ambient, ${pascals.symbol}`, yLabel: 'mPa s',
    lines: fluids.flatMap(({ id, answer }, k) => MARKED_TEMPERATURES.map((temperature, variant) => ({
      label: `${titleOf(id)}, ${written(temperature, celsius)} ${celsius.symbol}`, series: k, variant, x, hollow: x.map(() => false),
      y: PRESSURES.map((_, i) => {
        const value = finite(answer.dynamic_viscosity_pascal_seconds?.[TEMPERATURES.indexOf(temperature) * PRESSURES.length + i]);
        return value === null ? null : shown(value, MILLIPASCAL_SECONDS);
      }),
    }))),
    parted: [], caution: [], outside: [], levels: [], fromZero: false, yIsLogarithmic: true,
  };
}

function ViscosityTable({ fluids, titleOf }: { fluids: Evaluated[]; titleOf: (fluid: string) => string }) {
  const { column, unit } = ambient();
  return (
    <details>
      <summary>Every number at ambient pressure</summary>
      <div class="scroll" tabIndex={0} role="region" aria-label="Viscosities">
        <table>
          <thead>
            <tr><th class="number">Temperature <small>{celsius.symbol}</small></th>
              {fluids.flatMap(({ id }) => [<th class="number">{titleOf(id)}<small>{unit.symbol}</small></th>, <th class="number">density<small>kg/m³</small></th>, <th class="number">α*<small>1/GPa</small></th>])}</tr>
          </thead>
          <tbody>
            {TEMPERATURES.map((temperature, row) => (temperature % 20 === 0 ? (
              <tr key={temperature}>
                <th scope="row" class="number">{written(temperature, celsius)}</th>
                {fluids.flatMap(({ answer }) => [
                  <td class="number"><Num value={answer[column]?.[row]} unit={unit} /></td>,
                  <td class="number"><Num value={answer.ambient_density_kilograms_per_cubic_metre?.[row]} unit={plain('kg/m³')} /></td>,
                  <td class="number"><Num value={answer.pressure_viscosity_coefficient_per_pascal?.[row]} unit={scaled('1/GPa', 1e9)} /></td>,
                ])}
              </tr>
            ) : null))}
          </tbody>
        </table>
      </div>
    </details>
  );
}

const powers = (first: number, last: number, count: number): number[] =>
  Array.from({ length: count }, (_, k) => Number((first * (last / first) ** (k / (count - 1))).toPrecision(3)));

/** A map: what varies, what stays and what is shown. */
interface LawMap {
  title: string;
  about: string;
  column: 'central_film_thickness_metres' | 'traction_coefficient';
  unit: () => Unit;
  isLogarithmic: boolean;
  x: number[];
  y: number[];
  xLabel: string;
  yLabel: () => string;
  yUnit: Unit;
  grid: Record<string, number[]>;
}

const FILM_SPEEDS = powers(0.03, 10, 26);
const FILM_TEMPERATURES = Array.from({ length: 14 }, (_, k) => 10 * k); // [C]
const TRACTION_SLIDES = [0, 0.5, 1, 1.5, 2, 3, 4, 5, 7, 10, 15, 20, 25, 30, 40, 50];
const TRACTION_PRESSURES = Array.from({ length: 14 }, (_, k) => 0.2e9 + 0.1e9 * k); // mean [Pa]

const MAPS: Record<'film' | 'traction', LawMap> = {
  film: {
    title: 'Central film of a rolling ball', about: 'A ball of 19.05 mm on steel under 20 N, pure rolling', column: 'central_film_thickness_metres',
    unit: () => metres, isLogarithmic: true, x: FILM_SPEEDS, y: FILM_TEMPERATURES, xLabel: 'Entrainment speed, m/s', yLabel: () => `Oil, ${celsius.symbol}`, yUnit: celsius,
    grid: { supply_temperatures_celsius: FILM_TEMPERATURES, loads_newtons: [20], entrainment_speeds_metres_per_second: FILM_SPEEDS, slide_roll_ratios_percent: [0] },
  },
  traction: {
    title: 'Traction of a ball on a disc', about: 'A smooth ball of 19.05 mm on steel at 2 m/s, oil at 40 °C', column: 'traction_coefficient',
    unit: () => plain(''), isLogarithmic: false, x: TRACTION_SLIDES, y: TRACTION_PRESSURES, xLabel: 'Slide-roll ratio, %', yLabel: () => `Mean pressure, ${pascals.symbol}`, yUnit: pascals,
    grid: { supply_temperatures_celsius: [40], mean_pressures_pascals: TRACTION_PRESSURES, entrainment_speeds_metres_per_second: [2], slide_roll_ratios_percent: TRACTION_SLIDES },
  },
};

/** The lines of a map in which rows of the answer lie. */
function placesOf(rows: number[], map: LawMap): string {
  const lines = new Set(rows.map((row) => Math.floor(row / map.x.length)));
  const text = (value: number) => rounded(shown(value, map.yUnit));
  return `${runsText(map.y, (_, i) => lines.has(i), text) || 'all values'} of ${map.yLabel()}`;
}

/** A map of film or traction of a fluid on a rig. */
export function LawMapView({ id, kind }: { id: string; kind: 'film' | 'traction' }) {
  const inUnits = useStore(units);
  const map = MAPS[kind];
  const body = { lubricant: `lubricants/${id}`, radius_x_metres: 0.009525, grid: map.grid };
  const answer = useAnswer<EvaluateRigResponse>('rigs:evaluate', body);
  const unit = map.unit();
  const values = useMemo(() => map.y.map((_, i) => map.x.map((_, k) => {
    const value = finite(answer.value?.[map.column]?.[i * map.x.length + k]);
    return value === null ? null : shown(value, unit);
  })), [answer.value, kind, inUnits]);
  if (answer.error !== undefined) return <Failure error={answer.error} onRetry={answer.reload} />;
  if (!answer.value || answer.isStale) return <p class="muted">Loading …</p>;
  const xTexts = map.x.map((each) => String(Number(each.toPrecision(2))));
  const yTexts = map.y.map((each) => rounded(shown(each, map.yUnit)));
  const everyOther = (k: number, count: number) => k % Math.ceil(count / 8) === 0;
  return (
    <section aria-label={map.title}>
      <figure class="figure">
        <div class="heading">
          <div><figcaption>{map.title}{unit.symbol && `, ${unit.symbol}`}</figcaption><p class="muted small">{map.about}; darker is more (in the dark theme: paler).</p></div>
          <TakeAway name={`${kind}-map`} requests={body} commands={[]} />
        </div>
        <Heat x={xTexts} y={yTexts} values={values} xLabel={map.xLabel} yLabel={map.yLabel()} height={heightOf() + 60} isLogarithmic={map.isLogarithmic}
          words={(row, column) => `${rounded(values[row]![column])} ${unit.symbol} at ${xTexts[column]} ${map.xLabel.split(', ')[1]}, ${yTexts[row]} ${map.yUnit.symbol}`} />
      </figure>
      {(answer.value.refusals ?? []).map((each) => <Notice key={each.message} kind="caution">Gray: {each.message}</Notice>)}
      <Validity remarks={[...(answer.value.range_warnings ?? []).map((each) => remarkOf(each, placesOf(each.rows ?? [], map))), ...remarksOnce(answer.value.input_warnings ?? [])]} />
      <div class="scroll" tabIndex={0} role="region" aria-label="Numbers of the map">
        <table>
          <thead><tr><th>{map.yLabel()}</th>{map.x.map((_, k) => everyOther(k, map.x.length) && <th key={k} class="number">{xTexts[k]}</th>)}</tr></thead>
          <tbody>
            {map.y.map((_, i) => everyOther(i, map.y.length) && (
              <tr key={i}>
                <th scope="row">{yTexts[i]}</th>
                {map.x.map((_, k) => everyOther(k, map.x.length) && <td key={k} class="number"><Num value={answer.value![map.column]?.[i * map.x.length + k]} unit={unit} /></td>)}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
      <p class="small">{map.xLabel} to the right. Every number: Take away, or the rigs.</p>
    </section>
  );
}
