import { useEffect, useState } from 'preact/hooks';
import { change, get, isPassing, session, url } from '../api/client';
import { watch } from '../api/events';
import type { Assumption, ListSimulationsResponse, Simulation } from '../api/types';
import { JobState } from '../components/job_state';
import { Labels } from '../components/labels';
import { Missing } from '../components/missing';
import { Failure, Notice } from '../components/notice';
import { Validity } from '../components/validity';
import { remarksOnce } from '../validity';
import { INPUT_FIELDS, readSimulation, shortTitle } from '../curve';
import { ago, duration, idOf, revisionIdOf } from '../format';
import { filterOfLabel, hasLabel } from '../labels';
import { PROVENANCE } from '../provenance';
import { inputsOf } from '../request';
import { titlesOf, useConnection, useLoaded, useLubricants } from '../resources';
import { address, go, place, set } from '../router';
import { useStore } from '../store';
import { sumpText } from '../units';
import { pageOf, subject } from './home';

const PAGE = 100;
const STATES = ['', 'RUNNING', 'QUEUED', 'SUCCEEDED', 'FAILED', 'CANCELLED'];
const ENDED = ['SUCCEEDED', 'FAILED', 'CANCELLED'];

/** The newest jobs in a state and with a label, followed while they are shown. */
function useJobList(state: string, label: string | null): { jobs: Simulation[] | undefined; error: unknown; reload: () => void } {
  const connection = useConnection();
  const [jobs, setJobs] = useState<Simulation[] | undefined>();
  const [error, setError] = useState<unknown>();
  const [round, setRound] = useState(0);
  useEffect(() => {
    if (connection === null) return;
    let isCurrent = true;
    let stream: { close: () => void } | undefined;
    const filter = [state && `state = ${state}`, filterOfLabel(label)].filter(Boolean).join(' AND ') || undefined;
    const isListed = (job: Simulation) => (state === '' || job.state === state) && (!label || hasLabel(job.labels, label));
    const load = () => get<ListSimulationsResponse>(url('simulations', { page_size: PAGE, filter, read_mask: INPUT_FIELDS }));
    const fail = (problem: unknown) => isCurrent && !isPassing(problem) && setError(problem);
    load().then((page) => {
      if (!isCurrent) return;
      setJobs(page.simulations ?? []);
      setError(undefined);
      stream = watch({ afterEvent: page.event_number ?? '0' }, (event) => {
        if (!event.name || event.kind === 'HEARTBEAT') return;
        setJobs((old) => {
          if (!old) return old;
          if (event.kind === 'DELETED') return old.filter((each) => each.name !== event.name);
          if (!old.some((each) => each.name === event.name)) {
            void readSimulation(event.name!).then((simulation) =>
              setJobs((now) => (now && !now.some((each) => each.name === simulation.name) && isListed(simulation) ? [simulation, ...now] : now)), fail);
            return old;
          }
          return old.map((each) => (each.name !== event.name ? each : {
            ...each, state: event.state!, progress_fraction: event.progress_fraction ?? 0,
            ...(event.error ? { error: event.error } : {}),
            ...(event.time && ENDED.includes(event.state!) ? { end_time: event.time } : {}),
          }));
        });
      }, () => void load().then((again) => isCurrent && setJobs(again.simulations ?? []), fail));
    }, fail);
    return () => {
      isCurrent = false;
      stream?.close();
    };
  }, [state, label, connection, round]);
  return { jobs, error, reload: () => setRound((count) => count + 1) };
}

export function Jobs() {
  const { path, query } = useStore(place);
  const id = path.split('/')[2];
  if (id) return <JobPage key={id} name={`simulations/${id}`} />;
  return <JobList state={(query.get('state') ?? '').toUpperCase()} label={query.get('label')} />;
}

function JobList({ state, label }: { state: string; label: string | null }) {
  const { jobs, error, reload } = useJobList(state, label);
  const titles = titlesOf(useLubricants().value);
  const [problem, setProblem] = useState<unknown>(null);
  const cancel = (job: Simulation) => change('POST', `${url(job.name!)}:cancel`, {}).catch(setProblem);
  return (
    <>
      <h1>Jobs</h1>
      <div class="tabs" role="group" aria-label="State">
        {STATES.map((each) => (
          <button key={each} aria-pressed={each === state} onClick={() => set({ state: each.toLowerCase() || undefined })}>
            {each === '' ? 'All' : each.charAt(0) + each.slice(1).toLowerCase()}
          </button>
        ))}
      </div>
      {label && <p class="choices">Those with the label {label} <button onClick={() => set({ label: undefined })}>Show all jobs</button></p>}
      {error !== undefined && <Failure error={error} onRetry={reload} />}
      {problem !== null && <Failure error={problem} />}
      {jobs?.length === 0 && <p class="muted">No job is in this list.</p>}
      {jobs && jobs.length > 0 && (
        <div class="scroll" tabIndex={0} role="region" aria-label="Jobs">
          <table class="jobs">
            <thead><tr><th>Job</th><th>Fluid</th><th>Computes</th><th class="number">Sump</th><th>State</th><th class="number">Time</th><th class="number">Created</th><th><span class="hidden">Actions</span></th></tr></thead>
            <tbody>
              {jobs.map((job) => (
                <tr key={job.name}>
                  <td><a href={address(`/jobs/${idOf(job.name)}`)}>{idOf(job.name)}</a></td>
                  <td>{shortTitle(titles.get(idOf(job.lubricant)) ?? idOf(job.lubricant))}</td>
                  <td>{job.display_name && <strong>{job.display_name}: </strong>}{subject(job)}{job.state === 'FAILED' && <small class="problem">{job.error?.message}</small>}<Labels of="jobs" labels={job.labels} /></td>
                  <td class="number">{sumpText(job.sump_temperature_celsius)}</td>
                  <td><JobState simulation={job} /></td>
                  <td class="number">{job.cache_hit ? 'stored' : duration(job.start_time, job.end_time)}</td>
                  <td class="number">{ago(job.create_time)}</td>
                  <td class="number">
                    {ENDED.includes(job.state!)
                      ? job.state === 'SUCCEEDED' && <a class="button" href={pageOf(job)}>Open</a>
                      : <button onClick={() => void cancel(job)} aria-label={`Cancel job ${idOf(job.name)}`}>Cancel</button>}
                  </td>
                </tr>
              ))}
            </tbody>
          </table>
        </div>
      )}
      {jobs?.length === PAGE && <p class="muted small">The newest {PAGE} jobs are shown.</p>}
    </>
  );
}

/** Everything that a result rests on, with its origin. */
function Assumptions({ items }: { items: Assumption[] }) {
  if (items.length === 0) return null;
  return (
    <details class="assumptions" open>
      <summary>What the result rests on: {items.length} assumptions</summary>
      <div class="scroll" tabIndex={0} role="region" aria-label="Assumptions">
        <table>
          <thead><tr><th>Field</th><th>Value</th><th>Origin</th><th>Source</th></tr></thead>
          <tbody>
            {items.map((each) => (
              <tr key={`${each.resource} ${each.field}`}>
                <th scope="row">{each.field!.replaceAll('_', ' ')}<small>{each.resource}</small></th>
                <td>{each.value}</td><td>{PROVENANCE[each.provenance ?? ''] ?? ''}</td><td class="muted">{each.source}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </details>
  );
}

/** What a job was asked, what became of it, and how to repeat it. */
function JobPage({ name }: { name: string }) {
  const { value: job, error, reload } = useLoaded(() => readSimulation(name, `${INPUT_FIELDS},result.model_version,result.platform,result.assumptions,result.input_warnings,result.points.result.warnings`), name);
  const [problem, setProblem] = useState<unknown>(null);
  const isOpen = job !== undefined && !ENDED.includes(job.state!);
  const [progress, setProgress] = useState<{ fraction: number; stage: string } | null>(null);
  useEffect(() => {
    if (!isOpen) return;
    const stream = watch({ names: [name] }, (event) => {
      if (event.kind === 'PROGRESS') setProgress({ fraction: event.progress_fraction ?? 0, stage: event.stage ?? '' });
      if (event.kind === 'STATE_CHANGE') reload();
    }, reload);
    return () => stream.close();
  }, [name, isOpen]);
  if (error !== undefined && (error as { status?: number }).status === 404) return <Missing />;
  if (error !== undefined) return <Failure error={error} onRetry={reload} />;
  if (!job) return <p class="muted">Loading …</p>;
  const inputs = {
    ...inputsOf(job),
    operating_point: job.operating_point, inefficiency_curve: job.inefficiency_curve,
  };
  const again = async () => {
    try {
      const next = await change<Simulation>('POST', url('simulations', { force: 'true' }), inputs);
      go(address(`/jobs/${idOf(next.name)}`));
    } catch (refusal) {
      setProblem(refusal);
    }
  };
  const canWrite = session.value?.scope !== 'read';
  return (
    <>
      <div class="heading">
        <h1>Job {idOf(job.name)}: {subject(job)} of {revisionIdOf(job.lubricant_revision)}</h1>
        <div class="actions">
          {job.state === 'SUCCEEDED' && <a class="button primary" href={pageOf(job)}>Open the result</a>}
          {isOpen && canWrite && <button onClick={() => change('POST', `${url(name)}:cancel`, {}).then(reload, setProblem)}>Cancel</button>}
          {!isOpen && canWrite && <button onClick={() => void again()}>Compute again</button>}
        </div>
      </div>
      {problem !== null && <Failure error={problem} />}
      {job.state === 'FAILED' && <Notice kind="error"><p>{job.error?.message}</p><p class="code">{job.error?.reason}</p></Notice>}
      {job.state === 'CANCELLED' && <Notice kind="caution">The job was cancelled before it had a result.</Notice>}
      <dl class="facts">
        <dt>State</dt>
        <dd><JobState simulation={progress && isOpen ? { ...job, progress_fraction: progress.fraction } : job} /> {isOpen && progress?.stage}</dd>
        <dt>Created</dt><dd><time dateTime={job.create_time}>{new Date(job.create_time!).toLocaleString()}</time></dd>
        {job.end_time && job.start_time && <><dt>Took</dt><dd>{job.cache_hit ? 'nothing: equal inputs had a result' : duration(job.start_time, job.end_time)}</dd></>}
        <dt>Lubricant</dt><dd><a href={address(`/fluids/${revisionIdOf(job.lubricant_revision)}`)}>{revisionIdOf(job.lubricant_revision)}</a></dd>
        <dt>Gear set</dt><dd>{revisionIdOf(job.gear_set_revision)}</dd>
        <dt>Surface</dt><dd>{revisionIdOf(job.surface_revision)}</dd>
        <dt>Vehicle</dt><dd>{revisionIdOf(job.vehicle_revision)}</dd>
        <dt>Sump</dt><dd>{sumpText(job.sump_temperature_celsius)}</dd>
        {job.result?.model_version && <><dt>Model</dt><dd>{job.result.model_version}, {job.result.platform}</dd></>}
        <dt>Hash of the inputs</dt><dd><code>{job.input_hash}</code></dd>
      </dl>
      {job.result && <Validity remarks={remarksOnce([...(job.result.points ?? []).flatMap((each) => each.result?.warnings ?? []), ...(job.result.input_warnings ?? [])])} />}
      <Assumptions items={job.result?.assumptions ?? []} />
      <h2>Request</h2>
      <p class="muted">Sent again, it gives this result, or a new one if the model has changed.</p>
      <pre class="command">{JSON.stringify(inputs, null, 2)}</pre>
    </>
  );
}
