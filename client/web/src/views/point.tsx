import { useEffect, useMemo, useRef, useState } from 'preact/hooks';
import { ApiError, change, get, session, url } from '../api/client';
import { watch } from '../api/events';
import type { GearSet, PointResult, RangeWarning, ReadSpectrumResponse, Simulation } from '../api/types';
import { CurveChart } from '../charts/curve_chart';
import { Loop } from '../charts/loop';
import { Stems } from '../charts/stems';
import type { Line, Spec } from '../charts/spec';
import { Bars } from '../components/bars';
import { JobState } from '../components/job_state';
import { Missing } from '../components/missing';
import { finite, Num } from '../components/num';
import { Failure, Notice } from '../components/notice';
import { figureWords } from '../figures';
import { inputWords } from '../inputs';
import { Swatch } from '../components/swatch';
import { Validity } from '../components/validity';
import { remarksOnce } from '../validity';
import { INPUT_FIELDS, readSimulation, shortTitle } from '../curve';
import { ERROR, MESH_CYCLES, PHASE, studyOf, VELOCITY } from '../histories';
import { idOf, revisionIdOf, rounded } from '../format';
import { kelvin, metres, pascals, plain, scaled, shown, sumpText, units, watts, type Unit } from '../units';
import { titlesOf, useLoaded, useLubricants, type Loaded } from '../resources';
import { inputsOf } from '../request';
import { address, go, place, set } from '../router';
import { useStore } from '../store';

/** A history as REST answers it; with rows_per_pair > 0 rows are minimum and maximum in turn. */
interface History {
  start_row: number;
  total_rows: number;
  rows_per_pair: number;
  columns: Record<string, (number | null)[]>;
}

interface Panel {
  title: string;
  unit: Unit;
  lines: { label: string; column: string }[];
  emptyIsZero?: boolean; // of a flank without load
  hasBacklash?: boolean;
}

const flanks = (column: string) => [0, 1, 2].map((k) => ({ label: `flank ${k + 1}`, column: `${column}_flank_${k}` }));

const PANELS: Panel[] = [
  { title: 'Dynamic transmission error', unit: metres, lines: [{ label: '', column: 'dynamic_transmission_error_metres' }], hasBacklash: true },
  { title: 'Mesh force', unit: plain('N'), lines: [{ label: '', column: 'mesh_force_newtons' }] },
  { title: 'Load of each flank', unit: plain('N'), lines: flanks('flank_load_newtons') },
  { title: 'Film ratio', unit: plain(''), lines: flanks('flank_film_ratio'), emptyIsZero: true },
  { title: 'Contact temperature', unit: kelvin, lines: flanks('flank_contact_temperature_kelvin'), emptyIsZero: true },
  { title: 'Friction torque on the pinion', unit: plain('N m'), lines: [{ label: '', column: 'pinion_friction_torque_newton_metres' }] },
];

const ZOOM_DELAY_MILLISECONDS = 120;

const FIGURES: { label: string; unit: Unit; value: (result: PointResult) => number | undefined }[] = [
  { label: 'Mesh inefficiency', unit: plain('%'), value: (result) => result.inefficiency_energy_mean_percent },
  { label: 'Mesh loss', unit: watts, value: (result) => result.mesh_loss_power_watts },
  { label: 'of it viscous', unit: watts, value: (result) => result.viscous_loss_power_watts },
  { label: 'of it boundary', unit: watts, value: (result) => result.boundary_loss_power_watts },
  { label: 'Least film ratio', unit: plain(''), value: (result) => result.film_ratio?.minimum },
  { label: 'Hottest contact', unit: kelvin, value: (result) => result.contact_temperature_kelvin?.maximum },
  { label: 'Greatest pressure', unit: pascals, value: (result) => result.maximum_pressure_pascals?.maximum },
  { label: 'Mesh frequency', unit: plain('Hz'), value: (result) => result.mesh_frequency_hertz },
  { label: 'Pinion torque', unit: plain('N m'), value: (result) => result.pinion_torque_newton_metres },
];

const ENDED = ['SUCCEEDED', 'FAILED', 'CANCELLED'];

/** Time histories of one operating point over the mesh cycle. */
export function Point() {
  const { path } = useStore(place);
  const id = path.split('/')[2];
  return id ? <PointPage key={id} name={`simulations/${id}`} /> : <Missing />;
}

function PointPage({ name }: { name: string }) {
  const { value: job, error, reload } = useLoaded(() => readSimulation(name, `${INPUT_FIELDS},result.points,result.history_columns,result.history_rows,result.model_version,result.input_warnings`), name);
  const titles = titlesOf(useLubricants().value);
  const [problem, setProblem] = useState<unknown>(null);
  const canWrite = session.value?.scope !== 'read';
  /** Computes the same point again with everything that this page shows. */
  const recompute = async () => {
    try {
      const { history: _, ...study } = job!.operating_point!;
      const next = await change<Simulation>('POST', url('simulations'), {
        ...inputsOf(job!), operating_point: studyOf(study),
      });
      go(address(`/point/${idOf(next.name)}`));
    } catch (refusal) {
      setProblem(refusal);
    }
  };
  const isOpen = job !== undefined && !ENDED.includes(job.state!);
  useEffect(() => {
    if (!isOpen) return;
    const stream = watch({ names: [name] }, (event) => event.kind === 'STATE_CHANGE' && reload(), reload);
    return () => stream.close();
  }, [name, isOpen]);
  if (error !== undefined) return (error as ApiError).status === 404 ? <Missing /> : <Failure error={error} onRetry={reload} />;
  if (!job) return <p class="muted">Loading …</p>;
  const result = job.result?.points?.[0]?.result;
  const title = titles.get(idOf(job.lubricant)) ?? idOf(job.lubricant);
  const speed = result?.vehicle_speed_kilometres_per_hour ?? job.operating_point?.cruise?.speed_kilometres_per_hour;
  return (
    <>
      <div class="heading">
        <div>
          <h1>{shortTitle(title)}{speed !== undefined && ` at ${Number(speed.toPrecision(6))} km/h`}</h1>
          <p class="muted">{revisionIdOf(job.gear_set_revision)}, sump {sumpText(job.sump_temperature_celsius)}{result?.contact_loss ? '; the flanks separate' : result ? '; the flanks stay in contact' : ''}</p>
        </div>
        <a class="button" href={address(`/jobs/${idOf(name)}`)}>Job {idOf(name)}</a>
      </div>
      {isOpen && <p><JobState simulation={job} /></p>}
      {job.state === 'FAILED' && <Notice kind="error">{job.error?.message}</Notice>}
      {job.state === 'CANCELLED' && <Notice kind="caution">The job was cancelled.</Notice>}
      {result && <Figures result={result} inputs={job.result?.input_warnings ?? []} />}
      {result && (job.result?.history_columns?.length ?? 0) > 0 && <Histories job={job} result={result} />}
      {result && <Flanks result={result} />}
      {result && <Sensitivities result={result} />}
      {result && !isComplete(job) && canWrite && (
        <section class="reasons">
          <p class="muted">This job kept {(job.result?.history_columns?.length ?? 0) === 0 ? 'no time histories' : 'fewer histories than this page shows'}{!result.sensitivities && ' and has no sensitivities'}.</p>
          <button onClick={() => void recompute()}>Compute the point with histories and sensitivities</button>
          {problem !== null && <Failure error={problem} />}
        </section>
      )}
    </>
  );
}

/** Whether a job kept all that this page shows. */
const isComplete = (job: Simulation): boolean =>
  (job.result?.history_columns ?? []).includes(VELOCITY) && job.operating_point?.sensitivities === true;

/** What each flank slot loses: a pair of teeth passes slots 1 to 3. */
function Flanks({ result }: { result: PointResult }) {
  const flanks = result.flank_losses ?? [];
  if (flanks.length === 0) return null;
  return (
    <section class="reasons" aria-labelledby="flanks">
      <h2 id="flanks">Which flanks lose power</h2>
      <p class="muted small">Mean over the mesh cycle. A pair of teeth enters the mesh as flank 1 and leaves it as flank 3, or before.</p>
      <Bars label="Loss of each flank" bars={flanks.flatMap((flank, k) => [
        { key: `${k} viscous`, label: <span class="with-swatch"><Swatch series={k} /> flank {k + 1}, viscous</span>, value: flank.viscous_watts ?? 0, text: <><Num value={flank.viscous_watts} unit={watts} /> {watts.symbol}</> },
        { key: `${k} boundary`, label: <span class="with-swatch"><Swatch series={-1} /> flank {k + 1}, boundary</span>, value: flank.boundary_watts ?? 0, text: <><Num value={flank.boundary_watts} unit={watts} /> {watts.symbol}</> },
      ])} />
    </section>
  );
}

const SHOWN_SENSITIVITIES = 12;
const ELASTICITY: Unit = plain('%');

/** How far one per cent more of each parameter moves a figure: what matters at this point. */
function Sensitivities({ result }: { result: PointResult }) {
  const { query } = useStore(place);
  const [isLong, setLong] = useState(false);
  const given = result.sensitivities;
  if (!given) return null;
  const figures = given.figures ?? [];
  const chosen = Math.max(0, figures.indexOf(query.get('s') ?? 'inefficiency_energy_mean_percent'));
  const rows = (given.parameters ?? []).map((each) => ({ parameter: each.parameter!, value: finite(each.elasticities?.[chosen]) ?? 0 }))
    .filter((each) => each.value !== 0).sort((a, b) => Math.abs(b.value) - Math.abs(a.value));
  const shownRows = isLong ? rows : rows.slice(0, SHOWN_SENSITIVITIES);
  return (
    <section class="reasons" aria-labelledby="sensitivities">
      <div class="heading">
        <h2 id="sensitivities">What moves it: % of the figure for 1 % of a parameter</h2>
        <label class="inline">Figure
          <select aria-label="Figure whose sensitivities are shown" value={figures[chosen]} onChange={(event) => set({ s: event.currentTarget.value })}>
            {figures.map((each) => <option key={each} value={each}>{figureWords(each)}</option>)}
          </select>
        </label>
      </div>
      <Bars label={`Sensitivities of ${figureWords(figures[chosen]!)}`} less="less" more="more"
        bars={shownRows.map((each) => ({ key: each.parameter, label: inputWords(each.parameter), value: each.value, text: <Num value={each.value} unit={ELASTICITY} isSigned /> }))} />
      {rows.length > shownRows.length && <button onClick={() => setLong(true)}>Show all {rows.length} parameters</button>}
      <p class="small">Derivatives of the steady state, exact to rounding; temperatures count from 0 K.{given.one_sided && ' The response is at the edge of an event: the derivatives are those of its side.'}</p>
    </section>
  );
}

/** One quantity of the motion over another: a closed path for a steady state, with the phase under the cursor. */
function PhasePortrait({ job, halfBacklash, phase }: { job: Simulation; halfBacklash: number | undefined; phase: number | null }) {
  const inUnits = useStore(units);
  const history = useLoaded((signal) => get<History>(url(`${job.name}:readHistory`, { alt: 'columns', columns: [PHASE, ERROR, VELOCITY] }), signal), `phase ${job.name}`);
  const path = useMemo(() => {
    const [x, y] = [history.value?.columns[ERROR], history.value?.columns[VELOCITY]];
    return x && y && { x: x.map((value) => shown(value!, metres)), y: y.map((value) => shown(value!, SPEED)) };
  }, [history.value, inUnits]);
  if (!path) return null;
  const phases = history.value!.columns[PHASE] as number[];
  const index = phase === null ? -1 : phases.findIndex((each) => each >= phase);
  return (
    <figure class="figure">
      <figcaption>Phase portrait: the transmission error against its rate</figcaption>
      <Loop x={path.x} y={path.y} xLabel={`Dynamic transmission error, ${metres.symbol}`} yLabel={`Rate, ${SPEED.symbol}`} height={320}
        level={halfBacklash === undefined ? undefined : shown(halfBacklash, metres)} at={index < 0 ? null : index} />
      <p class="small">Dashed: half the backlash, below which the flanks are apart. The dot follows the cursor of the histories.</p>
    </figure>
  );
}

const MOST_ORDER = 20;
const LISTED_ORDERS = 10;

/** The histories of one line that a job has kept. */
const singlePanels = (job: Simulation): Panel[] =>
  PANELS.filter(({ lines }) => lines.length === 1 && job.result?.history_columns?.includes(lines[0]!.column));

/** Amplitudes of a history over multiples of the mesh frequency. */
function Spectrum({ job }: { job: Simulation }) {
  const { query } = useStore(place);
  const inUnits = useStore(units);
  const panels = singlePanels(job);
  const panel = panels.find((each) => each.lines[0]!.column === query.get('o')) ?? panels[0]!;
  const { column } = panel.lines[0]!;
  const answer = useLoaded((signal) => get<ReadSpectrumResponse>(url(`${job.name}:readSpectrum`, { columns: [column], maximum_order: MOST_ORDER }), signal), `spectrum ${job.name} ${column}`);
  const unit: Unit = { ...panel.unit, offset: 0 };
  const found = answer.value?.columns?.[0];
  const orders = answer.value?.orders ?? [];
  const amplitudes = useMemo(() => (found?.amplitudes ?? []).map((value) => shown(value, unit)), [found, inUnits]);
  if (answer.error !== undefined) return <Failure error={answer.error} onRetry={answer.reload} />;
  if (!found) return null;
  const largest = orders.map((_, k) => k).sort((a, b) => amplitudes[b]! - amplitudes[a]!).slice(0, LISTED_ORDERS);
  return (
    <figure class="figure">
      <div class="heading">
        <figcaption>Order spectrum: amplitudes at multiples of the mesh frequency, {rounded(answer.value!.mesh_frequency_hertz)} Hz</figcaption>
        <label class="inline">of
          <select aria-label="History whose spectrum is shown" value={column} onChange={(event) => set({ o: event.currentTarget.value })}>
            {panels.map((each) => <option key={each.title} value={each.lines[0]!.column}>{each.title}</option>)}
          </select>
        </label>
      </div>
      <Stems x={orders} y={amplitudes} xLabel="Order" yLabel={`Amplitude, ${unit.symbol}`} height={320} />
      <details>
        <summary>The largest amplitudes</summary>
        <table>
          <thead><tr><th class="number">Order</th><th class="number">Amplitude <small>{unit.symbol}</small></th><th class="number">Phase angle <small>rad</small></th></tr></thead>
          <tbody>
            {largest.map((k) => (
              <tr key={k}><th scope="row" class="number">{orders[k]}</th><td class="number"><Num value={found.amplitudes![k]} unit={unit} /></td><td class="number"><Num value={found.phase_angles_radians?.[k]} unit={plain('rad')} /></td></tr>
            ))}
          </tbody>
        </table>
      </details>
      {!answer.value!.is_periodic && <p class="small">The response has no period: the amplitudes depend on the length of the record.</p>}
    </figure>
  );
}

const SPEED: Unit = scaled('mm/s', 1e3);

function Figures({ result, inputs }: { result: PointResult; inputs: RangeWarning[] }) {
  const relative = result.estimated_relative_error;
  return (
    <>
      <ul class="figures">
        {FIGURES.map(({ label, unit, value }) => {
          const number = value(result);
          const error = number === undefined || relative === undefined ? undefined : Math.abs(number * unit.factor * relative);
          return <li key={label}><span>{label}</span><strong>{number === undefined ? '–' : rounded(shown(number, unit), error)}</strong> {unit.symbol}</li>;
        })}
      </ul>
      <Validity remarks={remarksOnce([...(result.warnings ?? []), ...inputs])} />
    </>
  );
}

/** Rows of a history between two mesh phases, refetched when the reader zooms. */
function useHistory(name: string, rows: number, zoom: [number, number] | null): Loaded<History> {
  const perCycle = rows / MESH_CYCLES;
  const start = zoom ? Math.max(0, Math.floor(zoom[0] * perCycle) - 1) : 0;
  const count = zoom ? Math.min(rows - start, Math.ceil((zoom[1] - zoom[0]) * perCycle) + 3) : rows;
  const points = Math.max(400, 2 * Math.min(900, window.innerWidth));
  const isFirst = useRef(true);
  return useLoaded(async (signal) => {
    // The end of a zoom is fetched, and not its way there.
    if (!isFirst.current) await new Promise((done) => setTimeout(done, ZOOM_DELAY_MILLISECONDS));
    isFirst.current = false;
    return get<History>(url(`${name}:readHistory`, { alt: 'columns', start_row: start, row_count: count, max_points: points }), signal);
  }, `history ${name} ${start} ${count}`);
}

function lineOf(history: History, panel: Panel, label: string, column: string, series: number): Line {
  const line: Line = { label, series, variant: 0, x: [], y: [], hollow: [] };
  const phases = history.columns[PHASE] as number[];
  (history.columns[column] ?? []).forEach((value, row) => {
    // From one mesh cycle to the next each flank takes the place of its neighbour.
    if (label !== '' && row > 0 && Math.floor(phases[row]!) > Math.floor(phases[row - 1]!)) {
      line.x.push((phases[row - 1]! + phases[row]!) / 2);
      line.y.push(null);
    }
    line.x.push(phases[row]!);
    // A flank without load has no film and no temperature: the service writes 0.
    line.y.push(value === null || (panel.emptyIsZero && value === 0) ? null : shown(value, panel.unit));
  });
  return line;
}

function Histories({ job, result }: { job: Simulation; result: PointResult }) {
  const { query } = useStore(place);
  const inUnits = useStore(units);
  const [phase, setPhase] = useState<number | null>(null);
  const zoom = useMemo<[number, number] | null>(() => {
    const [from, to] = (query.get('t') ?? '').split('-').map(Number);
    return from !== undefined && to !== undefined && to > from ? [from, to] : null;
  }, [query.get('t')]);
  const { value: history, error, reload } = useHistory(job.name!, Number(job.result!.history_rows), zoom);
  const gearSet = useLoaded((signal) => get<GearSet>(url(job.gear_set_revision!, { read_mask: 'dynamics.half_backlash_metres' }), signal), job.gear_set_revision!);
  const halfBacklash = gearSet.value?.dynamics?.half_backlash_metres;
  const specs = useMemo(() => {
    if (!history) return [];
    const period = result.period_in_mesh_cycles || MESH_CYCLES;
    const parted: [number, number][] = [];
    for (let cycle = 0; cycle < MESH_CYCLES; cycle += period) {
      for (const each of result.contact_losses ?? []) parted.push([each.start_mesh_phase! + cycle, each.end_mesh_phase! + cycle]);
    }
    return PANELS.map((panel): Spec => ({
      title: panel.title, xLabel: 'Mesh cycles', yLabel: panel.unit.symbol,
      lines: panel.lines.map(({ label, column }, k) => lineOf(history, panel, label, column, k)),
      parted: parted.filter(([from]) => from < MESH_CYCLES),
      caution: [], outside: [], fromZero: false, hasMarkers: false,
      xRange: zoom ?? [0, MESH_CYCLES],
      levels: panel.hasBacklash && halfBacklash !== undefined ? [{ value: shown(halfBacklash, panel.unit), label: 'half backlash' }] : [],
    }));
  }, [history, zoom, halfBacklash, inUnits]);
  const onZoom = (range: [number, number] | null) =>
    set({ t: range ? range.map((each) => Math.min(MESH_CYCLES, Math.max(0, each)).toFixed(4)).join('-') : undefined });
  if (error !== undefined) return <Failure error={error} onRetry={reload} />;
  if (!history) return <p class="muted">Loading the histories …</p>;
  return (
    <section aria-label="Time histories">
      <div class="heading">
        <p class="muted small">
          Over {MESH_CYCLES} mesh cycles{result.contact_loss && '; gray: the flanks are apart'}.
          Drag to zoom, double-click to go back. {history.rows_per_pair > 0 ? `Least and greatest of ${history.rows_per_pair} rows.` : 'Every row.'}
        </p>
        <ul class="key">
          {[0, 1, 2].map((k) => <li key={k}><Swatch series={k} /> flank {k + 1}</li>)}
        </ul>
        {zoom && <button onClick={() => onZoom(null)}>Show both cycles</button>}
      </div>
      <div class="histories" data-rows-per-pair={history.rows_per_pair}>
        {specs.map((spec) => (
          <figure key={spec.title} class="figure">
            <figcaption>{spec.title}{spec.yLabel && `, ${spec.yLabel}`}</figcaption>
            <CurveChart spec={spec} height={190} sync="histories" onSpeed={setPhase} onZoom={onZoom} />
          </figure>
        ))}
      </div>
      <p class="axis-title">Mesh cycles</p>
      <div class="pair">
        {(job.result?.history_columns ?? []).includes(VELOCITY) && <PhasePortrait job={job} halfBacklash={halfBacklash} phase={phase} />}
        {singlePanels(job).length > 0 && <Spectrum job={job} />}
      </div>
    </section>
  );
}
