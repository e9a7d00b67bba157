import { useEffect, useMemo, useRef, useState } from 'preact/hooks';
import { ApiError, change, session, url } from '../api/client';
import { watch } from '../api/events';
import type { Simulation, SimulationEvent } from '../api/types';
import { CurveChart } from '../charts/curve_chart';
import { Conditions } from '../components/conditions';
import { CurveExport } from '../components/curve_export';
import { Failure, Notice } from '../components/notice';
import { ReadOut } from '../components/read_out';
import { readCurve, readSimulation, remarksOf, specOf, type Curve } from '../curve';
import { idOf } from '../format';
import { QUANTITIES, quantityOf } from '../quantities';
import { bodiesOf, DEFAULTS, inputsOf, queryOf, requestOf, requestOfSimulations, type CurveRequest } from '../request';
import { HISTORY_COLUMNS, MESH_CYCLES, SAMPLES_PER_MESH_CYCLE } from '../histories';
import { titlesOf, useGearSets, useLubricants } from '../resources';
import { address, go, place, set } from '../router';
import { useStore } from '../store';
import { run } from './home';

const ENDED = ['SUCCEEDED', 'FAILED', 'CANCELLED'];

interface Job {
  simulation: Simulation;
  stage: string;
  curve?: Curve;
}

/** Reads simulations by id and follows those that have not ended. */
function useJobs(ids: string[]): { jobs: Job[]; error: unknown } {
  const key = ids.join(',');
  const who = useStore(session);
  const [state, setState] = useState<{ key: string; jobs: Job[]; error: unknown }>({ key: '', jobs: [], error: null });
  useEffect(() => {
    if (!who) return;
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
    const fail = (error: unknown) => isCurrent && setState((old) => ({ ...old, key, error }));
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
  }, [key, who]);
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
  const lubricants = useLubricants();
  const gearSets = useGearSets();
  const titles = useMemo(() => titlesOf(lubricants.value), [lubricants.value]);
  const ids = (query.get('r') ?? '').split(',').filter((each) => /^[0-9A-Za-z-]+$/.test(each));
  const { jobs, error } = useJobs(ids);
  const [request, setRequest] = useState<CurveRequest>(() => requestOf(query));
  const [refusal, setRefusal] = useState<unknown>(null);
  const [busy, setBusy] = useState(false);
  const [speed, setSpeed] = useState<number | null>(query.has('v') ? Number(query.get('v')) : null);
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
  const specs = useMemo(
    () => new Map(QUANTITIES.map((each) => [each.id, specOf(done, each, titles, gearSet?.dynamics?.half_backlash_metres)])),
    [done, titles, gearSet],
  );
  const spec = specs.get(quantity.id)!;
  const remarks = useMemo(() => remarksOf(done), [done]);
  const failed = jobs.filter((job) => job.simulation.state === 'FAILED' || job.simulation.state === 'CANCELLED');

  const submit = async () => {
    setBusy(true);
    setRefusal(null);
    try {
      await run(bodiesOf(request));
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
        operating_point: {
          cruise: { speed_kilometres_per_hour: at },
          history: { columns: HISTORY_COLUMNS, mesh_cycles: MESH_CYCLES, samples_per_mesh_cycle: SAMPLES_PER_MESH_CYCLE },
        },
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
        <button class="primary wide" disabled={busy || request.fluids.length === 0 || session.value?.scope === 'read'} onClick={() => void submit()}>
          {busy ? 'Submitting …' : request.fluids.length * request.sumps.length > 1 ? `Run ${request.fluids.length * request.sumps.length} curves` : 'Run the curve'}
        </button>
        <a class="small" href={address('/curves', queryOf(request))}>Link to this form</a>
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
                <h1 id="figure-title">{spec.title}{spec.yLabel && spec.yLabel !== '%' ? `, ${spec.yLabel}` : ''}</h1>
                <CurveExport spec={spec} curves={done} project={project} />
              </div>
              <div class="tabs" role="group" aria-label="Quantity">
                {QUANTITIES.map((each) => (
                  <button key={each.id} aria-pressed={each.id === quantity.id} onClick={() => set({ y: each.id === 'inefficiency' ? undefined : each.id })}>
                    {each.label}
                  </button>
                ))}
              </div>
              <CurveChart spec={spec} height={matchMedia('(max-width: 640px)').matches ? 260 : 360} sync="curves" onSpeed={setSpeed}
                onPick={(at) => set({ v: String(at) })} />
              <p class="axis-title">{spec.xLabel}</p>
              <Key spec={spec} />
            </figure>
            <ReadOut curves={done} titles={titles} speed={speed} onSpeed={setSpeed} onOpen={(curve, at) => void openPoint(curve, at)} />
            <Validity remarks={remarks} curves={done} />
            <div class="multiples">
              {QUANTITIES.map((each) => (
                <button key={each.id} class="multiple" aria-pressed={each.id === quantity.id} onClick={() => set({ y: each.id === 'inefficiency' ? undefined : each.id })}>
                  <span>{each.label}{each.unit.symbol && `, ${each.unit.symbol}`}</span>
                  <CurveChart spec={specs.get(each.id)!} height={132} isSmall sync="curves" />
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
function Key({ spec }: { spec: { parted: unknown[]; caution: unknown[]; outside: unknown[] } }) {
  if (spec.parted.length + spec.caution.length + spec.outside.length === 0) return null;
  return (
    <ul class="key">
      {spec.parted.length > 0 && <li><i class="swatch parted" /> flanks separate (hollow markers)</li>}
      {spec.caution.length > 0 && <li><i class="swatch caution" /> a law leaves its validated range</li>}
      {spec.outside.length > 0 && <li><i class="swatch outside" /> do not rank fluids here</li>}
    </ul>
  );
}

function Validity({ remarks, curves }: { remarks: ReturnType<typeof remarksOf>; curves: Curve[] }) {
  const ends = curves.flatMap((curve) => curve.branchEnds.filter((end) => end !== undefined));
  const refusals = curves.flatMap((curve) => curve.refusals);
  const inputs = new Map(curves.flatMap((curve) => (curve.simulation.result?.input_warnings ?? []).map((each) => [each.code!, each.message!] as const)));
  const symbols = { note: '●', caution: '▲', outside: '■' };
  return (
    <details class="validity" open={remarks.some((each) => each.level === 'outside') || refusals.length > 0}>
      <summary>
        Validity: {remarks.length === 0 ? 'within the validated range' : remarks.map((each) => each.words).join('; ')}
      </summary>
      <ul>
        {remarks.map((each) => (
          <li key={each.code} class={each.level}>
            <span aria-hidden="true">{symbols[each.level]}</span> {each.words}, at {each.speeds}. {each.message}
          </li>
        ))}
        {ends.map((end, i) => (
          <li key={i} class="note">The branch of steady states was followed to {end!.followed_to_kilometres_per_hour} km/h and is gone at {end!.gone_at_kilometres_per_hour} km/h: the response jumps there, and the line breaks.</li>
        ))}
        {refusals.map((each) => <li key={each.speed} class="outside">No result at {each.speed} km/h: {each.message}</li>)}
        {[...inputs].map(([code, message]) => <li key={code} class="caution">{message}</li>)}
        <li class="note">All losses are mesh losses: bearings, churning and seals are not in them.</li>
      </ul>
    </details>
  );
}
