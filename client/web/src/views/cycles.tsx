import { useEffect, useMemo, useState } from 'preact/hooks';
import { ApiError, change, get, url } from '../api/client';
import type { CycleLubricant, CyclePart, EvaluateCycleResponse, ListSurfacesResponse, ListVehiclesResponse } from '../api/types';
import { CurveChart } from '../charts/curve_chart';
import { Bars } from '../components/bars';
import { Entry } from '../components/entry';
import { ModelChoice } from '../components/model_choice';
import { Failure, Notice } from '../components/notice';
import { finite, Num } from '../components/num';
import { Swatch } from '../components/swatch';
import { save } from '../charts/svg';
import { csvOf, TakeAway } from '../components/take_away';
import { NotIncluded, Validity } from '../components/validity';
import { shortTitle } from '../curve';
import {
  cycleBodyOf, cycleCommandOf, cycleQueryOf, cycleRequestOf, lineProblems, lossSpec, ownCycleOf, partWords, speedSpec, STATES,
  type CycleRequest, type LineProblem, type OwnCycle,
} from '../cycle';
import { cycleOf, fragmentOf, tableOfCycle, type CycleFile } from '../cycle_link';
import { idOf, revisionIdOf, rounded } from '../format';
import { titlesOf, useGearSets, useLoaded, useLubricants } from '../resources';
import { address, go, place, set } from '../router';
import { useStore } from '../store';
import { celsius, plain, readNumber, scaled, units, watts, written } from '../units';
import { remarkLines, remarksAt, type Remark } from '../validity';

const MOST_FLUIDS = 8; // of the service
const KILOJOULES = scaled('kJ', 1e-3);
const KILOMETRES = scaled('km', 1e-3);
const PERCENT = plain('%');
const DRAFT = 'cycle'; // in the storage of the tab

function storedFile(): CycleFile | null {
  try {
    return JSON.parse(sessionStorage.getItem(DRAFT) ?? 'null');
  } catch {
    return null;
  }
}

const fileNameOf = (name: string): string => name.replace(/\.\w+$/, '') + '.csv';

/** The cycle that was dropped or that the address holds. The address of the page holds it from then on, if it is short. */
function useCycleFile(isOwn: boolean) {
  const [file, setFile] = useState<CycleFile | null>(() => (location.hash === '' ? storedFile() : null));
  const [isOpening, setOpening] = useState(location.hash !== '');
  const [isDamaged, setDamaged] = useState(false);
  const [fragment, setFragment] = useState<string | null | undefined>(); // null: too long; undefined: not packed yet
  useEffect(() => {
    const open = () => {
      if (location.hash === '') return;
      cycleOf(location.hash).then((found) => {
        setFile(found ?? storedFile());
        setDamaged(false);
      }, () => setDamaged(true)).finally(() => setOpening(false));
    };
    open();
    window.addEventListener('hashchange', open);
    return () => window.removeEventListener('hashchange', open);
  }, []);
  useEffect(() => {
    setFragment(undefined);
    if (isOpening || isDamaged) return;
    const { places, problems } = file && isOwn ? ownCycleOf(file.text) : { places: [], problems: [] };
    let isCurrent = true;
    void (places.length === 0 || problems.length > 0 ? Promise.resolve('') : fragmentOf(file!.name, places)).then((found) => {
      if (!isCurrent) return;
      setFragment(found);
      if (location.hash !== (found ?? '')) history.replaceState(history.state, '', location.pathname + location.search + (found ?? ''));
    });
    return () => { isCurrent = false; };
  }, [file, isOwn, isOpening, isDamaged]);
  const take = (next: CycleFile | null) => {
    setDamaged(false);
    setFile(next);
    if (next) sessionStorage.setItem(DRAFT, JSON.stringify(next));
    else sessionStorage.removeItem(DRAFT);
  };
  return { file, isOpening, isDamaged, fragment, setFile: take };
}

/** Drive cycles: the energy that the mesh loses, when, and where it arises. */
export function Cycles() {
  const { query, project } = useStore(place);
  const inUnits = useStore(units);
  const lubricants = useLubricants();
  const titles = titlesOf(lubricants.value);
  const stated = cycleRequestOf(query);
  const usual = (lubricants.value ?? []).map((each) => idOf(each.name)).filter((id) => id.startsWith('paper-fluid-')).slice(0, 2);
  const request = { ...stated, fluids: stated.fluids.length > 0 ? stated.fluids : usual };
  const { file, isOpening, isDamaged, fragment, setFile } = useCycleFile(stated.isOwn);
  const own = useMemo(() => (file ? ownCycleOf(file.text) : null), [file]);
  const isComplete = request.fluids.length > 0 && (!request.isOwn || (own !== null && own.problems.length === 0));
  const body = cycleBodyOf(request, own?.places ?? []);
  const answer = useLoaded((signal) => (isComplete ? change<EvaluateCycleResponse>('POST', url('cycles:evaluate'), body, signal) : Promise.resolve(null)),
    `${isComplete} ${JSON.stringify({ ...body, places: undefined })} ${request.isOwn ? file?.text : ''}`);
  const violations = answer.error instanceof ApiError ? answer.error.violations : [];
  const problems = [...(own?.problems ?? []), ...(own && request.isOwn ? lineProblems(violations, own.table) : [])];
  const update = (next: CycleRequest) => go(address('/cycles', { ...cycleQueryOf(next), t: query.get('t') ?? undefined }), 'replace');
  const take = (next: CycleFile | null) => {
    setFile(next);
    update({ ...request, isOwn: next !== null });
  };
  const found = isComplete && answer.error === undefined ? answer.value : null;
  const fluids = found?.lubricants ?? [];
  const names = fluids.map((each) => shortTitle(titles.get(idOf(each.lubricant_revision)) ?? revisionIdOf(each.lubricant_revision)));
  const remarks = cycleRemarks(fluids, names);
  const cycleName = request.isOwn ? file?.name ?? '' : 'NEDC';
  const inputs = found && { gearSet: revisionIdOf(found.gear_set_revision), surface: revisionIdOf(found.surface_revision), vehicle: revisionIdOf(found.vehicle_revision) };
  const pinned = address('/cycles', { ...cycleQueryOf({ ...request, ...inputs, fluids: fluids.map((each) => revisionIdOf(each.lubricant_revision)) }), t: query.get('t') ?? undefined })
    + (request.isOwn ? fragment ?? '' : '');
  const loss = useMemo(() => (found ? lossSpec(found, names) : null), [found, lubricants.value, inUnits]);
  const isShownElsewhere = violations.length > 0 && (lineProblems(violations, own?.table ?? { header: [], rows: [], hasDecimalCommas: false }).length > 0 || violations.some((each) => each.field.includes('sump')));
  return (
    <div class="with-panel">
      <aside class="panel" aria-label="Cycle">
        <Form request={request} titles={titles} file={file} onChange={update} onTake={take} violations={violations} />
      </aside>
      <div class={answer.isStale ? 'stale' : ''}>
        {request.isOwn && own && problems.length > 0 && <Lines own={own} problems={problems} />}
        {isDamaged && <Notice kind="error">The link is damaged: the cycle in it cannot be read.</Notice>}
        {request.isOwn && !own && !isOpening && <section class="empty"><h1>Drop a cycle</h1><p>A CSV with the columns time_seconds and speed_kilometres_per_hour; ascent_angle_degrees and sump_temperature_celsius may follow. The address of the page then holds the cycle, unless it is long.</p></section>}
        {request.fluids.length === 0 && lubricants.value && <p class="muted">Choose a fluid.</p>}
        {answer.error !== undefined && !isShownElsewhere && <Failure error={answer.error} onRetry={answer.reload} />}
        {isComplete && answer.error === undefined && !found && <p class="muted">Adding up the cycle …</p>}
        {found && loss && (
          <>
            <div class="heading">
              <div>
                <h1>Energy that the mesh loses over {request.isOwn ? `“${cycleName}”` : 'the NEDC'}</h1>
                <p class="muted">
                  <Num value={found.distance_metres} unit={KILOMETRES} error={10} /> km in <Num value={found.duration_seconds} unit={plain('s')} error={2} /> s, of
                  which <Num value={found.standstill_seconds} unit={plain('s')} error={2} /> s at a standstill; {revisionIdOf(found.gear_set_revision)}, {revisionIdOf(found.surface_revision)}, {revisionIdOf(found.vehicle_revision)}
                </p>
              </div>
              <TakeAway name="cycle" spec={loss} footer={[`${cycleName}; sump ${written(request.sump, celsius)} ${celsius.symbol}`, found.model_version ?? '', found.not_included ?? '', ...remarkLines(remarks)]} requests={body}
                commands={[cycleCommandOf(request, cycleName, project)]} csv={() => tableOfPieces(found, names)} link={pinned}>
                {request.isOwn && <button onClick={() => save(fileNameOf(cycleName), new Blob([tableOfCycle(file!.text)], { type: 'text/csv' }))}>The cycle as CSV</button>}
              </TakeAway>
            </div>
            {request.isOwn && fragment === null && (
              <Notice kind="caution">
                The cycle is too long for a link: send <button class="link" onClick={() => save(fileNameOf(cycleName), new Blob([tableOfCycle(file!.text)], { type: 'text/csv' }))}>its file</button> along, to be dropped on the page that the link opens.
              </Notice>
            )}
            <NotIncluded text={found.not_included} />
            <Totals fluids={fluids} names={names} reference={names[0]!} />
            <Traces answer={found} names={names} />
            <Origins answer={found} names={names} />
            <Validity remarks={remarks}>
              <li class="note">The cycle is cut into pieces of at most 1 s, in each of which the axle counts as steady at its mean speed.</li>
              <li class="note">In coast the axle counts as transmitting all of the braking.</li>
            </Validity>
          </>
        )}
      </div>
    </div>
  );
}

function Form({ request, titles, file, onChange, onTake, violations }: {
  request: CycleRequest; titles: Map<string, string>; file: CycleFile | null; violations: { field: string; description: string }[];
  onChange: (request: CycleRequest) => void; onTake: (file: CycleFile | null) => void;
}) {
  const gearSets = useGearSets();
  const surfaces = useLoaded(async (signal) => (await get<ListSurfacesResponse>(url('surfaces', { page_size: 1000, read_mask: 'name,display_name' }), signal)).surfaces ?? [], 'surfaces');
  const vehicles = useLoaded(async (signal) => (await get<ListVehiclesResponse>(url('vehicles', { page_size: 1000, read_mask: 'name,display_name' }), signal)).vehicles ?? [], 'vehicles');
  const [isOver, setOver] = useState(false);
  const sumpProblem = violations.find((each) => each.field.startsWith('sump'))?.description;
  const toggle = (id: string) =>
    onChange({ ...request, fluids: request.fluids.some((each) => idOf(each) === id) ? request.fluids.filter((each) => idOf(each) !== id) : [...request.fluids, id] });
  const read = async (list: FileList | null | undefined) => {
    setOver(false);
    const first = list?.[0];
    if (first) onTake({ name: first.name, text: await first.text() });
  };
  const select = (key: 'gearSet' | 'surface' | 'vehicle', label: string, usual: string, all: { name?: string; display_name?: string }[] | undefined) => (
    <label>
      {label}
      <select value={idOf(request[key]) || usual} onChange={(event) => onChange({ ...request, [key]: event.currentTarget.value === usual ? '' : event.currentTarget.value })}>
        {(all ?? []).map((each) => <option key={each.name} value={idOf(each.name)}>{each.display_name || idOf(each.name)}</option>)}
      </select>
    </label>
  );
  return (
    <>
      <fieldset>
        <legend>Cycle</legend>
        <label class="choice"><input type="radio" name="cycle" checked={!request.isOwn} onChange={() => onChange({ ...request, isOwn: false })} /> <span>NEDC</span></label>
        <label class="choice"><input type="radio" name="cycle" checked={request.isOwn} onChange={() => onChange({ ...request, isOwn: true })} /> <span>{file ? file.name : 'Your own'}</span></label>
        {request.isOwn && (
          <label class={`drop small ${isOver ? 'over' : ''}`}
            onDragOver={(event) => { event.preventDefault(); setOver(true); }} onDragLeave={() => setOver(false)}
            onDrop={(event) => { event.preventDefault(); void read(event.dataTransfer?.files); }}>
            <input type="file" accept=".csv,.tsv,.txt,text/csv" onChange={(event) => void read(event.currentTarget.files)} />
            <span>Drop a CSV here, or choose one: time, speed</span>
          </label>
        )}
      </fieldset>
      <fieldset class="fluids">
        <legend>Fluids, the first as reference</legend>
        {[...titles].map(([id, title]) => {
          const series = request.fluids.findIndex((each) => idOf(each) === id);
          return (
            <label key={id} class="choice">
              <input type="checkbox" checked={series >= 0} disabled={series < 0 && request.fluids.length === MOST_FLUIDS} onChange={() => toggle(id)} />
              <Swatch series={series} /> <span>{shortTitle(title)}</span>
            </label>
          );
        })}
      </fieldset>
      <fieldset>
        <legend>Axle</legend>
        <label>
          Sump, {celsius.symbol}
          <Entry inputMode="decimal" value={written(request.sump, celsius)} aria-invalid={sumpProblem !== undefined}
            onChange={(event) => {
              const value = readNumber(event.currentTarget.value, celsius);
              if (Number.isFinite(value)) onChange({ ...request, sump: value });
            }} />
          {sumpProblem && <span class="problem" role="alert">{sumpProblem}</span>}
        </label>
        {select('gearSet', 'Gear set', 'reference-axle', gearSets.value)}
        {select('surface', 'Surface', 'run-in', surfaces.value)}
        {select('vehicle', 'Vehicle', 'passenger-car', vehicles.value)}
        <label class="choice"><input type="checkbox" checked={request.isSheared} onChange={() => onChange({ ...request, isSheared: !request.isSheared })} /> <span>Oils after the shear test</span></label>
        <ModelChoice request={request} onChange={onChange} />
      </fieldset>
    </>
  );
}

const SHOWN_LINES = 100;

/** The faulty lines of a file, each with its fault. */
function Lines({ own, problems }: { own: OwnCycle; problems: LineProblem[] }) {
  const texts = new Map([[1, own.table.header], ...own.table.rows.map(({ line, cells }) => [line, cells] as [number, string[]])]);
  return (
    <section aria-label="Mistakes in the file">
      <h1>{problems.length === 1 ? 'One line of the file is wrong' : `${problems.length} mistakes in the file`}</h1>
      <table class="candidates">
        <thead><tr><th>Line</th><th>Cells</th></tr></thead>
        <tbody>
          {problems.slice(0, SHOWN_LINES).map(({ line, text }, k) => (
            <tr key={k}><th scope="row">{line}</th><td class="wrong"><code>{(texts.get(line) ?? []).join(', ')}</code><span class="problem" role="alert">{text}</span></td></tr>
          ))}
        </tbody>
      </table>
      {problems.length > SHOWN_LINES && <p class="small">and {problems.length - SHOWN_LINES} more</p>}
    </section>
  );
}

/** The warnings of a cycle, each with the fluids that it holds for. */
const cycleRemarks = (fluids: CycleLubricant[], names: string[]): Remark[] =>
  remarksAt(fluids.flatMap((each, k) => [...(each.warnings ?? []), ...(each.input_warnings ?? [])].map((warning) => ({ warning, where: names[k]! }))));

/** What each fluid loses over the whole cycle, with both stated errors. */
function Totals({ fluids, names, reference }: { fluids: CycleLubricant[]; names: string[]; reference: string }) {
  const all = (fluid: CycleLubricant) => fluid.parts?.[0];
  return (
    <section class="read-out" aria-label="Whole cycle">
      <div class="scroll" tabIndex={0} role="region" aria-label="Energies of the whole cycle">
        <table>
          <thead>
            <tr>
              <th>Fluid</th><th class="number">Energy lost<small>kJ</small></th><th class="number">Energy that comes in<small>kJ</small></th>
              <th class="number">Inefficiency<small>%, weighted by energy</small></th>{fluids.length > 1 && <th class="number">Loss less that of {reference}<small>%</small></th>}
              <th class="number">Error of the map<small>kJ</small></th><th class="number">Error of the solver<small>kJ</small></th>
            </tr>
          </thead>
          <tbody>
            {fluids.map((fluid, k) => (
              <tr key={k}>
                <th scope="row"><Swatch series={k} />{names[k]}</th>
                {fluid.refusal_reason ? <td colSpan={6}><span class="problem">{fluid.refusal_message}</span></td> : (
                  <>
                    <td class="number"><strong><Num value={fluid.loss_joules} unit={KILOJOULES} error={(fluid.map_error_joules ?? 0) + (fluid.solver_error_joules ?? 0)} /></strong></td>
                    <td class="number"><Num value={fluid.input_joules} unit={KILOJOULES} /></td>
                    <td class="number"><Num value={fluid.inefficiency_percent} unit={PERCENT} error={0.001} /></td>
                    {fluids.length > 1 && <td class="number">{k === 0 ? '' : <Num value={all(fluid)?.loss_difference_percent} unit={PERCENT} error={0.1} isSigned />}</td>}
                    <td class="number">{fluid.map_error_joules === 0 ? 'none' : <Num value={fluid.map_error_joules} unit={KILOJOULES} error={fluid.map_error_joules} />}</td>
                    <td class="number"><Num value={fluid.solver_error_joules} unit={KILOJOULES} error={fluid.solver_error_joules} /></td>
                  </>
                )}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
      <p class="small">Errors: of the energy lost, by the interpolation of the map and by the solver. The uncertainty of the inputs is not in them, so that a difference here is no verdict: <a href={address('/compare', { a: idOf(fluids[0]?.lubricant_revision), b: idOf(fluids.at(-1)?.lubricant_revision) })}>compare the fluids</a>.</p>
    </section>
  );
}

/** The piece in which the first fluid loses most. */
function greatestRow(answer: EvaluateCycleResponse): number {
  const losses = answer.lubricants?.find((each) => (each.mesh_loss_power_watts ?? []).length > 0)?.mesh_loss_power_watts ?? [];
  return losses.reduce((best, value, row) => (value > losses[best]! ? row : best), 0);
}

/** Speed and loss over time, and all numbers of a piece. */
function Traces({ answer, names }: { answer: EvaluateCycleResponse; names: string[] }) {
  const { query } = useStore(place);
  const inUnits = useStore(units);
  const [at, setAt] = useState<number | null>(null);
  const starts = answer.start_seconds ?? [];
  const zoom = useMemo<[number, number] | undefined>(() => {
    const [from, to] = (query.get('t') ?? '').split('-').map(Number);
    return from !== undefined && to !== undefined && to > from ? [from, to] : undefined;
  }, [query.get('t')]);
  const onZoom = (range: [number, number] | null) => set({ t: range ? range.map((each) => Math.max(0, each).toFixed(0)).join('-') : undefined });
  const speed = useMemo(() => speedSpec(answer), [answer]);
  const loss = useMemo(() => lossSpec(answer, names), [answer, names.join(), inUnits]);
  const row = at === null ? greatestRow(answer) : Math.max(0, starts.indexOf(at));
  const number = (value: number | undefined, unit = plain(''), error?: number) => <Num value={value} unit={unit} error={error} />;
  return (
    <section class="over-time" aria-label="Over time">
      <div class="heading">
        <h2>Over time</h2>
        {zoom && <button onClick={() => onZoom(null)}>Show the whole cycle</button>}
      </div>
      <figure class="figure"><figcaption>{speed.title}</figcaption><CurveChart spec={speed} height={150} sync="cycle" xRange={zoom} onSpeed={setAt} onZoom={onZoom} /></figure>
      <figure class="figure"><figcaption>{loss.title}</figcaption><CurveChart spec={loss} height={220} sync="cycle" xRange={zoom} onSpeed={setAt} onZoom={onZoom} /></figure>
      <p class="axis-title">{loss.xLabel}</p>
      <ul class="key">{names.map((name, k) => <li key={k}><Swatch series={k} /> {name}</li>)}</ul>
      <p class="small hint">Drag to zoom, with Shift to move; double-click shows the whole cycle.</p>
      <section class="read-out" aria-labelledby="piece">
        <div class="heading">
          <h3 id="piece">From {rounded(starts[row], 0.1)} s on, for {rounded(answer.piece_seconds?.[row])} s</h3>
          <input type="range" min={0} max={starts.length - 1} value={row} aria-label="Time" aria-valuetext={`${rounded(starts[row], 0.1)} seconds`} onInput={(event) => setAt(starts[event.currentTarget.valueAsNumber]!)} />
        </div>
        <ul class="figures">
          <li><span>Speed</span><strong>{number(answer.speed_kilometres_per_hour?.[row])}</strong> km/h</li>
          <li><span>Acceleration</span><strong>{number(answer.acceleration_metres_per_second_squared?.[row])}</strong> m/s²</li>
          <li><span>Torque at the wheels</span><strong>{number(answer.wheel_torque_newton_metres?.[row])}</strong> N m</li>
          <li><span>Sump</span><strong>{number(answer.sump_temperature_celsius?.[row], celsius, 0.2)}</strong> {celsius.symbol}</li>
          {(answer.lubricants ?? []).map((fluid, k) => (
            <li key={k}><span><Swatch series={k} /> {names[k]} loses</span><strong>{number(fluid.mesh_loss_power_watts?.[row], watts)}</strong> {watts.symbol}</li>
          ))}
        </ul>
      </section>
    </section>
  );
}

/** Where the loss arises: by what the vehicle does and by its speed. */
function Origins({ answer, names }: { answer: EvaluateCycleResponse; names: string[] }) {
  const { query } = useStore(place);
  const fluids = answer.lubricants ?? [];
  const chosen = Math.min(Math.max(0, fluids.length - 1), Number(query.get('of') ?? 0) || 0);
  const fluid = fluids[chosen];
  const parts = answer.parts ?? [];
  const bars = (has: (part: CyclePart) => boolean) => parts.flatMap((part, k) => {
    const loss = fluid?.parts?.[k];
    const share = finite(loss?.loss_share_percent);
    return !has(part) || !loss || share === null || part.duration_seconds === 0 ? [] : [{
      key: String(k), label: <>{partWords(part)} <small><Num value={part.duration_seconds} unit={plain('s')} error={2} /> s</small></>, value: share,
      text: <><Num value={share} unit={PERCENT} error={0.2} /> % <small><Num value={loss.loss_joules} unit={KILOJOULES} /> kJ</small></>,
    }];
  });
  const states = bars((part) => STATES[part.kind!] !== undefined);
  const bands = bars((part) => part.kind === 'CYCLE_PART_KIND_SPEED_BAND');
  if (!fluid) return null;
  return (
    <section class="origins" aria-labelledby="origins">
      <div class="heading">
        <h2 id="origins">Where the loss arises</h2>
        {fluids.length > 1 && (
          <label class="inline">of
            <select value={String(chosen)} onChange={(event) => set({ of: event.currentTarget.value === '0' ? undefined : event.currentTarget.value })}>
              {names.map((name, k) => <option key={k} value={k}>{name}</option>)}
            </select>
          </label>
        )}
      </div>
      {fluid.refusal_reason ? <Notice kind="error">{fluid.refusal_message}</Notice> : (
        <div class="pair">
          <div><h3>By what the vehicle does</h3><Bars label="Loss by what the vehicle does" bars={states} /></div>
          <div><h3>By speed</h3><Bars label="Loss by speed" bars={bands} /></div>
        </div>
      )}
      <details>
        <summary>Every part</summary>
        <div class="scroll" tabIndex={0} role="region" aria-label="Every part">
          <table>
            <thead>
              <tr>
                <th rowSpan={2}>Part</th><th class="number" rowSpan={2}>Time<small>s</small></th><th class="number" rowSpan={2}>Distance<small>km</small></th>
                {names.map((name, k) => <th key={k} class="number" colSpan={k === 0 ? 2 : 3}>{name}</th>)}
              </tr>
              <tr>{names.map((_, k) => [
                <th key={`${k} loss`} class="number">lost<small>kJ</small></th>, <th key={`${k} share`} class="number">inefficiency<small>%</small></th>,
                ...(k === 0 ? [] : [<th key={`${k} less`} class="number">to the first<small>%</small></th>]),
              ])}</tr>
            </thead>
            <tbody>
              {parts.map((part, k) => (
                <tr key={k}>
                  <th scope="row">{partWords(part)}</th>
                  <td class="number"><Num value={part.duration_seconds} unit={plain('s')} error={2} /></td><td class="number"><Num value={part.distance_metres} unit={KILOMETRES} error={10} /></td>
                  {fluids.map((each, i) => {
                    const loss = each.parts?.[k];
                    return [
                      <td key={`${i} loss`} class="number"><Num value={loss?.loss_joules} unit={KILOJOULES} /></td>, <td key={`${i} share`} class="number"><Num value={loss?.inefficiency_percent} unit={PERCENT} error={0.001} /></td>,
                      ...(i === 0 ? [] : [<td key={`${i} less`} class="number"><Num value={loss?.loss_difference_percent} unit={PERCENT} error={0.1} isSigned /></td>]),
                    ];
                  })}
                </tr>
              ))}
            </tbody>
          </table>
        </div>
      </details>
    </section>
  );
}

/** Every piece, with all digits of the service. */
function tableOfPieces(answer: EvaluateCycleResponse, names: string[]): string {
  const columns = ['start_seconds', 'piece_seconds', 'speed_kilometres_per_hour', 'acceleration_metres_per_second_squared', 'ascent_angle_degrees', 'sump_temperature_celsius', 'wheel_torque_newton_metres'] as const;
  return csvOf([...columns, ...names.map((name) => `mesh_loss_power_watts of ${name}`)],
    (answer.start_seconds ?? []).map((_, row) => [
      ...columns.map((column) => answer[column]?.[row] ?? null), ...(answer.lubricants ?? []).map((fluid) => finite(fluid.mesh_loss_power_watts?.[row])),
    ]));
}
