import { useEffect, useMemo, useRef, useState } from 'preact/hooks';
import { ApiError, change, isPassing, session, url } from '../api/client';
import { watch } from '../api/events';
import type { Simulation, SimulationEvent } from '../api/types';
import { CurveChart } from '../charts/curve_chart';
import type { Spec } from '../charts/spec';
import { Conditions } from '../components/conditions';
import { CurveExport } from '../components/curve_export';
import { Failure, Notice } from '../components/notice';
import { ReadOut } from '../components/read_out';
import { Swatch } from '../components/swatch';
import { NotIncluded, Validity } from '../components/validity';
import { axisOf, bandsOf, fluidsOf, optionsOf, readCurve, readSimulation, remarksOf, shortTitle, specOf, speedNear, speedUnitOf, splitSpecOf, variantOf, type Curve } from '../curve';
import { idOf, revisionIdOf } from '../format';
import { QUANTITIES, quantityOf } from '../quantities';
import { levelOf } from '../validity';
import { bodiesOf, DEFAULTS, inputsOf, queryOf, requestOf, requestOfSimulations, type CurveRequest } from '../request';
import { studyOf } from '../histories';
import { titlesOf, useConnection, useGearSets, useLubricants } from '../resources';
import { address, go, place, set } from '../router';
import { Store, useStore } from '../store';
import { shown, units, watts } from '../units';
import { differencesOf, needsContactFigures, specWithIntervals, useUncertainty, type ComparedGroup } from '../uncertainty';
import { POINTS, VERDICTS } from '../comparison';
import { UncertainNum } from '../components/num';
import { run } from './home';

const COMPARISONS: [string, string][] = [
  ['isothermal', 'Isothermal'], ['newtonian', 'Newtonian'], ['no_boundary_friction', 'No boundary friction'],
];

const ENDED = ['SUCCEEDED', 'FAILED', 'CANCELLED'];

interface Job {
  simulation: Simulation;
  stage: string;
  curve?: Curve;
}

/** Reads simulations by id and follows those that have not ended. */
function useJobs(ids: string[]): { jobs: Job[]; error: unknown } {
  const key = ids.join(',');
  const connection = useConnection();
  const [state, setState] = useState<{ key: string; jobs: Job[]; error: unknown }>({ key: '', jobs: [], error: null });
  useEffect(() => {
    if (connection === null) return;
    let isCurrent = true;
    let stream: { close: () => void } | undefined;
    const update = (name: string, next: (job: Job) => Job) => {
      if (!isCurrent) return;
      setState((old) => ({ ...old, jobs: old.jobs.map((job) => (job.simulation.name === name ? next(job) : job)) }));
    };
    const complete = async (name: string) => {
      const curve = await readCurve(name);
      update(name, (job) => ({ ...job, curve, simulation: curve.simulation }));
    };
    const fail = (error: unknown) => isCurrent && !isPassing(error) && setState((old) => ({ ...old, key, error }));
    const onEvent = (event: SimulationEvent) => {
      if (!event.state || event.kind === 'HEARTBEAT') return;
      update(event.name!, (job) => ({
        ...job,
        stage: event.stage ?? '',
        simulation: { ...job.simulation, state: event.state!, progress_fraction: event.progress_fraction ?? 0, ...(event.error ? { error: event.error } : {}) },
      }));
      if (event.state === 'SUCCEEDED') void complete(event.name!).catch(fail);
    };
    const load = async () => {
      const simulations = await Promise.all(ids.map((id) => readSimulation(`simulations/${id}`)));
      if (!isCurrent) return;
      setState((old) => ({ key, error: null, jobs: simulations.map((simulation) => ({ stage: '', ...old.jobs.find((job) => job.simulation.name === simulation.name), simulation })) }));
      await Promise.all(simulations.filter((each) => each.state === 'SUCCEEDED').map((each) => complete(each.name!)));
      const open = simulations.filter((each) => !ENDED.includes(each.state!)).map((each) => each.name!);
      if (isCurrent && open.length > 0 && stream === undefined) stream = watch({ names: open }, onEvent, () => void load().catch(fail));
    };
    if (ids.length > 0) load().catch(fail);
    else setState({ key, jobs: [], error: null });
    return () => {
      isCurrent = false;
      stream?.close();
    };
  }, [key, connection]);
  return state;
}

function Progress({ jobs, titles }: { jobs: Job[]; titles: Map<string, string> }) {
  const open = jobs.filter((job) => !ENDED.includes(job.simulation.state!));
  const [problem, setProblem] = useState<unknown>(null);
  if (open.length === 0) return null;
  const cancel = () =>
    Promise.all(open.map((job) => change('POST', `${url(job.simulation.name!)}:cancel`, {}))).catch(setProblem);
  return (
    <div class="progress-list">
      {open.map(({ simulation, stage }) => {
        const percent = Math.round(100 * (simulation.progress_fraction ?? 0));
        return (
          <div key={simulation.name} class="progress-row">
            <span>{titles.get(idOf(simulation.lubricant)) ?? idOf(simulation.lubricant)}</span>
            <progress max={100} value={percent} aria-label={`Progress of ${simulation.name}`} />
            <span class="muted">{simulation.state === 'QUEUED' ? 'waits for a processor' : `${percent} % ${stage}`}</span>
          </div>
        );
      })}
      <button onClick={() => void cancel()}>Cancel</button>
      {problem !== null && <Failure error={problem} />}
    </div>
  );
}

/** The curves of fluids over speed, and the form that runs them. */
export function Curves() {
  const { query, project } = useStore(place);
  const inUnits = useStore(units);
  const lubricants = useLubricants();
  const gearSets = useGearSets();
  const titles = useMemo(() => titlesOf(lubricants.value), [lubricants.value]);
  const ids = (query.get('r') ?? '').split(',').filter((each) => /^[0-9A-Za-z-]+$/.test(each));
  const { jobs, error } = useJobs(ids);
  const [request, setRequest] = useState<CurveRequest>(() => requestOf(query));
  const [refusal, setRefusal] = useState<unknown>(null);
  const [busy, setBusy] = useState(false);
  // A store of its own: the pointer moves the table of numbers alone, and not the whole view.
  const [speed] = useState(() => new Store<number | null>(query.has('v') ? Number(query.get('v')) : null));
  const filledFrom = useRef('');

  // The form shows what is on the plot, until the reader changes it.
  const key = ids.join(',');
  useEffect(() => {
    if (jobs.length === 0 || filledFrom.current === key || jobs.length !== ids.length) return;
    filledFrom.current = key;
    setRequest(requestOfSimulations(jobs.map((job) => job.simulation)));
  }, [key, jobs]);
  useEffect(() => {
    if (ids.length === 0 && request.fluids.length === 0 && lubricants.value) {
      setRequest({ ...DEFAULTS, ...request, fluids: lubricants.value.slice(0, 3).map((each) => idOf(each.name)) });
    }
  }, [lubricants.value]);

  const done = useMemo(() => jobs.flatMap((job) => (job.curve ? [job.curve] : [])), [jobs]);
  const quantity = quantityOf(query.get('y'));
  const gearSet = gearSets.value?.find((each) => each.name === done[0]?.simulation.gear_set_revision?.replace(/@.*/, ''));
  const isSplit = query.get('y') === 'split';
  const fluids = fluidsOf(done).map(idOf);
  const reference = fluids.includes(query.get('ref') ?? '') ? query.get('ref')! : fluids[0] ?? '';
  const hasBands = query.get('u') !== '0';
  const uncertainty = useUncertainty(done, reference, hasBands && needsContactFigures(quantity.columns), done.length === jobs.length && done.length > 0);
  const groups = uncertainty.isStale ? undefined : uncertainty.value;
  const speedUnit = speedUnitOf(done[0]); // addresses have km/h
  const places = useMemo(() => new Map(done.flatMap((curve) => axisOf(curve).map((x, row) => [x, curve.columns['speed_kilometres_per_hour']![row]!] as const))), [done, inUnits]);
  const onPlace = (place: number) => speed.set(places.get(place) ?? speedNear(done, place));
  const zoom = useMemo<[number, number] | undefined>(() => {
    const [from, to] = (query.get('x') ?? '').split('-').map(Number);
    return from !== undefined && to !== undefined && to > from ? [shown(from, speedUnit), shown(to, speedUnit)] : undefined;
  }, [query.get('x'), speedUnit.factor]);
  const hasErrors = query.get('e') !== '0';
  const specs = useMemo(
    () => new Map(QUANTITIES.map((each) => [each.id, {
      ...specOf(done, each, titles, gearSet?.dynamics?.half_backlash_metres), hasErrors,
    }])),
    [done, titles, gearSet, hasErrors, inUnits],
  );
  const spec = useMemo(
    () => specWithIntervals(specs.get(quantity.id)!, done, quantity.columns, quantity.unit, hasBands ? groups : undefined),
    [specs, quantity, groups, hasBands],
  );
  const difference = useMemo(() => {
    const found = differencesOf(groups, fluidsOf(done), titles);
    return found && { ...found, hasErrors, parted: spec.parted, outside: spec.outside };
  }, [groups, titles, spec]);
  const onZoom = (range: [number, number] | null) => set({ x: range ? range.map((each) => Number((each / speedUnit.factor).toFixed(2))).join('-') : undefined });
  const failed = jobs.filter((job) => job.simulation.state === 'FAILED' || job.simulation.state === 'CANCELLED');

  const submit = async (bodies: Simulation[], shownIds: string[] = []) => {
    setBusy(true);
    setRefusal(null);
    try {
      await run(bodies, shownIds);
    } catch (problem) {
      setRefusal(problem);
    } finally {
      setBusy(false);
    }
  };
  /** Computes the point of a curve with its time histories, and opens it. */
  const openPoint = async (curve: Curve, at: number) => {
    try {
      const point = await change<Simulation>('POST', url('simulations'), {
        ...inputsOf(curve.simulation),
        operating_point: studyOf({ cruise: { speed_kilometres_per_hour: at } }),
      });
      go(address(`/point/${idOf(point.name)}`));
    } catch (problem) {
      setRefusal(problem);
    }
  };

  return (
    <div class="with-panel">
      <aside class="panel" aria-label="Conditions">
        <Conditions request={request} onChange={setRequest} lubricants={lubricants.value ?? []} gearSets={gearSets.value ?? []}
          violations={refusal instanceof ApiError ? refusal.violations : []} shown={done} />
        <button class="primary wide" data-key="r" disabled={busy || request.fluids.length === 0 || session.value?.scope === 'read'} onClick={() => void submit(bodiesOf(request))}>
          {busy ? 'Submitting …' : request.fluids.length * request.sumps.length > 1 ? `Run ${request.fluids.length * request.sumps.length} curves` : 'Run the curve'}
        </button>
        <a class="small" href={address('/curves', queryOf(request))}>Link to this form</a>
        {done.length > 0 && session.value?.scope !== 'read' && (
          <fieldset class="comparisons">
            <legend>The paper's comparisons</legend>
            {COMPARISONS.map(([option, words]) => {
              const full = done.filter((each) => optionsOf(each.simulation).length === 0);
              const isShown = done.some((each) => optionsOf(each.simulation).join() === option);
              return (
                <button key={option} disabled={busy || isShown || full.length === 0}
                  onClick={() => void submit(full.map(({ simulation }) => ({
                    ...inputsOf(simulation), model_options: { ...simulation.model_options, [option]: true }, inefficiency_curve: simulation.inefficiency_curve!,
                  })), ids)}>
                  {words}
                </button>
              );
            })}
          </fieldset>
        )}
        {refusal !== null && <Failure error={refusal} />}
      </aside>
      <div>
        {error !== null && <Failure error={error} />}
        <Progress jobs={jobs} titles={titles} />
        {failed.map(({ simulation }) => (
          <Notice kind="error" key={simulation.name}>
            <p><a href={address(`/jobs/${idOf(simulation.name)}`)}>{titles.get(idOf(simulation.lubricant)) ?? idOf(simulation.lubricant)}</a> has no curve: {simulation.state === 'CANCELLED' ? 'it was cancelled.' : simulation.error?.message}</p>
          </Notice>
        ))}
        {ids.length === 0 && (
          <section class="empty">
            <h1>Choose fluids and run them</h1>
            <p>Each fluid becomes a curve over speed. Curves that were computed before appear at once.</p>
          </section>
        )}
        {done.length > 0 && (
          <>
            <figure class="figure" aria-labelledby="figure-title">
              <div class="heading">
                <h1 id="figure-title">{isSplit ? 'Mesh loss by viscous and by boundary friction, ' + watts.symbol : `${spec.title}${spec.yLabel && spec.yLabel !== '%' ? `, ${spec.yLabel}` : ''}`}</h1>
                <CurveExport spec={isSplit ? specs.get('loss')! : spec} curves={done} project={project} />
              </div>
              <div class="tabs" role="group" aria-label="Quantity">
                {QUANTITIES.map((each) => (
                  <button key={each.id} aria-pressed={!isSplit && each.id === quantity.id} onClick={() => set({ y: each.id === 'inefficiency' ? undefined : each.id })}>
                    {each.label}
                  </button>
                ))}
                <button aria-pressed={isSplit} onClick={() => set({ y: 'split' })}>Loss split</button>
              </div>
              {isSplit ? <LossSplit curves={done} titles={titles} xRange={zoom} onSpeed={onPlace} onZoom={onZoom} /> : (
                <CurveChart spec={spec} height={matchMedia('(max-width: 640px)').matches ? 260 : 360} sync="curves" xRange={zoom} onSpeed={onPlace}
                  onPick={(at) => set({ v: String(speedNear(done, at)) })} onZoom={onZoom} />
              )}
              <p class="axis-title">{spec.xLabel}</p>
              <div class="under-chart">
                <Key spec={spec} hasBands={spec.lines.some((line) => line.low)} isFilled={!isSplit && spec.lines.some((line) => line.to)} hasEnds={done.some((curve) => curve.branchEnds.some((end) => end))} />
                <div class="switches">
                  <label class="choice"><input type="checkbox" checked={hasBands} onChange={() => set({ u: hasBands ? '0' : undefined })} /> Uncertainty of the inputs</label>
                  <label class="choice"><input type="checkbox" checked={hasErrors} onChange={() => set({ e: hasErrors ? '0' : undefined })} /> Error of the solver</label>
                  {zoom && <button onClick={() => onZoom(null)}>Show all speeds</button>}
                </div>
                <p class="small hint">Drag to zoom, with Shift to move; double-click shows all speeds.</p>
              </div>
            </figure>
            {uncertainty.error !== undefined && <Failure error={uncertainty.error} onRetry={uncertainty.reload} />}
            {difference && (
              <Differences spec={difference} groups={groups!} titles={titles} fluids={fluids} reference={reference} xRange={zoom} onSpeed={onPlace} onZoom={onZoom} />
            )}
            <ReadOut curves={done} titles={titles} groups={hasBands ? groups : undefined} speed={speed} shownQuantity={quantity} onOpen={(curve, at) => void openPoint(curve, at)} />
            <CurveValidity curves={done} />
            <div class="multiples">
              {QUANTITIES.map((each) => (
                <button key={each.id} class="multiple" aria-pressed={!isSplit && each.id === quantity.id} onClick={() => set({ y: each.id === 'inefficiency' ? undefined : each.id })}>
                  <span>{each.label}{each.unit.symbol && `, ${each.unit.symbol}`}</span>
                  <CurveChart spec={specs.get(each.id)!} height={132} isSmall sync="curves" xRange={zoom} />
                </button>
              ))}
            </div>
          </>
        )}
      </div>
    </div>
  );
}

/** What the marks of a plot mean, of those that it has. */
function Key({ spec, hasBands, isFilled, hasEnds }: { spec: Spec; hasBands: boolean; isFilled: boolean; hasEnds: boolean }) {
  if (spec.parted.length + spec.caution.length + spec.outside.length === 0 && !hasBands && !isFilled && !hasEnds) return null;
  return (
    <ul class="key">
      {spec.parted.length > 0 && <li><i class="swatch parted" /> flanks separate (hollow markers)</li>}
      {spec.caution.length > 0 && <li><i class="swatch caution" /> a law leaves its validated range</li>}
      {spec.outside.length > 0 && <li><i class="swatch outside" /> do not rank fluids here</li>}
      {hasBands && <li><i class="swatch band" /> holds the curve with 95&nbsp;%, as far as the inputs decide</li>}
      {isFilled && <li><i class="swatch band" /> what the model option changes</li>}
      {hasEnds && <li><i class="cap" /> the branch of steady states ends, the response jumps</li>}
    </ul>
  );
}

const titleOf = (titles: Map<string, string>, revision: string | undefined): string =>
  shortTitle(titles.get(idOf(revision)) ?? revisionIdOf(revision));

/** The parts of the loss of each curve, on plots of one scale. */
function LossSplit({ curves, titles, xRange, onSpeed, onZoom }: {
  curves: Curve[]; titles: Map<string, string>; xRange: [number, number] | undefined;
  onSpeed: (speed: number) => void; onZoom: (range: [number, number] | null) => void;
}) {
  const inUnits = useStore(units);
  const specs = useMemo(() => {
    const simulations = curves.map((curve) => curve.simulation);
    const fluids = fluidsOf(curves);
    const greatest = Math.max(...curves.flatMap((curve) => curve.columns['mesh_loss_power_watts']!.map((value) => value ?? 0)));
    return curves.map((curve) => {
      const revision = curve.simulation.lubricant_revision ?? '';
      const variant = variantOf(curve.simulation, simulations);
      return splitSpecOf(curve, titleOf(titles, revision) + (variant && `, ${variant}`), fluids.indexOf(revision), greatest,
        bandsOf([curve], (each, row) => each.columns['contact_loss']![row] === 1),
        bandsOf([curve], (each, row) => each.warnings[row]!.some((warning) => levelOf(warning) === 'outside')));
    });
  }, [curves, titles, inUnits]);
  return (
    <>
      <div class="histories">
        {specs.map((spec) => (
          <figure key={spec.title} class="figure">
            <figcaption>{spec.title}</figcaption>
            <CurveChart spec={spec} height={220} sync="curves" xRange={xRange} onSpeed={onSpeed} onZoom={onZoom} />
          </figure>
        ))}
      </div>
      <ul class="key"><li><i class="swatch viscous" /> viscous friction</li><li><i class="swatch boundary" /> boundary friction</li></ul>
    </>
  );
}

/** Differences from the reference fluid with their intervals; hollow where there is no verdict. */
function Differences({ spec, groups, titles, fluids, reference, xRange, onSpeed, onZoom }: {
  spec: Spec; groups: ComparedGroup[]; titles: Map<string, string>; fluids: string[]; reference: string; xRange: [number, number] | undefined;
  onSpeed: (speed: number) => void; onZoom: (range: [number, number] | null) => void;
}) {
  const wide = groups.filter((each) => each.curves.length > 1);
  const simulations = wide.map((each) => each.curves[0]!.simulation);
  return (
    <figure class="figure differences" aria-labelledby="difference-title">
      <div class="heading">
        <h2 id="difference-title">Difference of the inefficiency, percentage points</h2>
        <label class="inline">from
          <select value={reference} onChange={(event) => set({ ref: event.currentTarget.value })}>
            {fluids.map((each) => <option key={each} value={each}>{titleOf(titles, each)}</option>)}
          </select>
        </label>
      </div>
      <ul class="verdicts">
        {wide.flatMap((group, k) => (group.answer.lubricants ?? []).slice(1).map((each) => {
          const difference = each.mean_difference;
          if (!difference?.verdict || difference.verdict === 'VERDICT_UNSPECIFIED') return null;
          const id = idOf(each.lubricant_revision);
          const variant = variantOf(simulations[k]!, simulations);
          const figure = difference.difference_percent!;
          return (
            <li key={`${k} ${id}`}>
              <Swatch series={fluids.indexOf(id)} />
              <a href={address('/compare', { a: revisionIdOf(group.answer.lubricants![0]!.lubricant_revision), b: revisionIdOf(each.lubricant_revision), sump: String(group.curves[0]!.simulation.sump_temperature_celsius ?? 40) })}>
                {titleOf(titles, each.lubricant_revision)} {VERDICTS[difference.verdict]}
              </a>{' '}
              <UncertainNum figure={figure} unit={POINTS} isSigned isStated={difference.verdict !== 'UNCERTAINTY_NOT_STATED'} />
              {variant && ` (${variant})`}
            </li>
          );
        }))}
      </ul>
      <CurveChart spec={spec} height={180} sync="curves" xRange={xRange} onSpeed={onSpeed} onZoom={onZoom} />
      <NotIncluded text={wide[0]?.answer.not_included} />
      <p class="small">Means over the speeds with their 95&nbsp;% intervals; hollow where there is no verdict. Each speed is solved alone here; a curve follows its branch.</p>
    </figure>
  );
}

/** What restricts the curves, beside the light: ends of branches, refusals, what they rest on. */
function CurveValidity({ curves }: { curves: Curve[] }) {
  const remarks = useMemo(() => remarksOf(curves), [curves]);
  const ends = curves.flatMap((curve) => curve.branchEnds.filter((end) => end !== undefined));
  const refusals = curves.flatMap((curve) => curve.refusals);
  return (
    <Validity remarks={remarks} isOpen={refusals.length > 0}>
      {ends.map((end, i) => (
        <li key={i} class="note">The branch of steady states was followed to {end!.followed_to_kilometres_per_hour} km/h and is gone at {end!.gone_at_kilometres_per_hour} km/h: the response jumps there, and the line breaks.</li>
      ))}
      {refusals.map((each) => <li key={each.speed} class="outside">No result at {each.speed} km/h: {each.message}</li>)}
      <li class="note">
        What each result rests on: {curves.map(({ simulation }, k) => (
          <span key={simulation.name}>{k > 0 && ', '}<a href={address(`/jobs/${idOf(simulation.name)}`)}>assumptions of {revisionIdOf(simulation.lubricant_revision)}</a></span>
        ))}.
      </li>
      <li class="note">All losses are mesh losses: bearings, churning and seals are not in them.</li>
    </Validity>
  );
}
