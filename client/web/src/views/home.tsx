import { useState } from 'preact/hooks';
import { change, get, url } from '../api/client';
import type { ListSimulationsResponse, Simulation } from '../api/types';
import { Failure } from '../components/notice';
import { JobState } from '../components/job_state';
import { INPUT_FIELDS, shortTitle } from '../curve';
import { ago, idOf, rounded } from '../format';
import { bodiesOf, DEFAULTS } from '../request';
import { titlesOf, useLoaded, useLubricants } from '../resources';
import { address, go } from '../router';
import { sumpText } from '../units';

const SHOWN_RUNS = 8;

/** Runs curves and opens them, beside results that are shown already. */
export async function run(bodies: Simulation[], beside: string[] = [], quantity?: string): Promise<void> {
  const simulations: Simulation[] = [];
  // One after the other, so that numbers have the order of the fluids.
  for (const body of bodies) simulations.push(await change<Simulation>('POST', url('simulations'), body));
  go(address('/curves', { r: [...new Set([...beside, ...simulations.map((each) => idOf(each.name))])].join(','), y: quantity }));
}

/** What a simulation computes, in a few words. */
export function subject(simulation: Simulation): string {
  const curve = simulation.inefficiency_curve;
  if (curve) {
    const speeds = curve.speeds_kilometres_per_hour ?? [];
    return speeds.length > 0 ? `curve of ${speeds.length} speeds`
      : `curve, ${curve.first_speed_kilometres_per_hour} to ${curve.last_speed_kilometres_per_hour} km/h`;
  }
  const speed = simulation.operating_point?.cruise?.speed_kilometres_per_hour;
  return speed === undefined ? 'operating point' : `point at ${speed} km/h`;
}

/** The page that shows a simulation. */
export function pageOf(simulation: Simulation): string {
  const id = idOf(simulation.name);
  if (simulation.state === 'FAILED' || simulation.state === 'CANCELLED') return address(`/jobs/${id}`);
  return simulation.inefficiency_curve ? address('/curves', { r: id }) : address(`/point/${id}`);
}

export function Home() {
  const lubricants = useLubricants();
  const runs = useLoaded(async (signal) =>
    (await get<ListSimulationsResponse>(url('simulations', { page_size: SHOWN_RUNS, read_mask: INPUT_FIELDS }), signal)).simulations ?? [], 'runs');
  const [problem, setProblem] = useState<unknown>(null);
  const [busy, setBusy] = useState(false);
  const titles = titlesOf(lubricants.value);
  const paper = (lubricants.value ?? []).map((each) => idOf(each.name)).filter((id) => id.startsWith('paper-fluid-'));
  const start = async () => {
    setBusy(true);
    try {
      await run(bodiesOf({ ...DEFAULTS, fluids: paper.length > 0 ? paper : (lubricants.value ?? []).slice(0, 3).map((each) => idOf(each.name)) }));
    } catch (error) {
      setProblem(error);
    } finally {
      setBusy(false);
    }
  };
  const isFirst = runs.value?.length === 0;
  return (
    <>
      <h1>What does a gear oil cost in a hypoid axle, and why?</h1>
      {problem !== null && <Failure error={problem} />}
      {isFirst && paper.length > 0 && (
        <section class="welcome">
          <div>
            <h2>Begin with the fluids of the paper</h2>
            <p>
              The database holds three gear oils of Paouris et al. (2018) and their hypoid axle. One button computes what
              each of them costs from 20 to 140 km/h, which takes seconds.
            </p>
          </div>
          <button class="primary large" disabled={busy} onClick={() => void start()}>
            Run the {paper.length === 3 ? 'three ' : ''}curves
          </button>
        </section>
      )}
      <div class="columns">
        <section>
          <div class="heading">
            <h2>Fluids {lubricants.value && <span class="count">{lubricants.value.length}</span>}</h2>
            <a href={address('/fluids/new')} class="button">Enter an oil</a>
          </div>
          {lubricants.error !== undefined && <Failure error={lubricants.error} onRetry={lubricants.reload} />}
          <table class="list">
            <thead><tr><th>Name</th><th class="number">KV100 <small>mm²/s</small></th><th class="number">VI</th></tr></thead>
            <tbody>
              {(lubricants.value ?? []).slice(0, 12).map((each) => (
                <tr key={each.name}>
                  <td>
                    <a href={address(`/fluids/${idOf(each.name)}`)}>{shortTitle(titles.get(idOf(each.name))!)}</a>
                    <small>{titles.get(idOf(each.name))!.split(': ')[1] ?? ''}</small>
                  </td>
                  <td class="number">{rounded(each.characterisation?.kinematic_viscosity_100_celsius_square_millimetres_per_second)}</td>
                  <td class="number">{rounded(each.characterisation?.viscosity_index)}</td>
                </tr>
              ))}
            </tbody>
          </table>
          {(lubricants.value?.length ?? 0) > 12 && <a href={address('/fluids')}>All {lubricants.value!.length} fluids</a>}
        </section>
        <section>
          <div class="heading">
            <h2>Last results</h2>
            <a href={address('/curves')} class={isFirst ? 'button' : 'button primary'}>Run a curve</a>
          </div>
          {runs.error !== undefined && <Failure error={runs.error} onRetry={runs.reload} />}
          {isFirst && <p class="muted">Nothing has been computed yet.</p>}
          <ul class="runs">
            {(runs.value ?? []).map((each) => (
              <li key={each.name}>
                <a href={pageOf(each)}>
                  <strong>{each.display_name || shortTitle(titles.get(idOf(each.lubricant)) ?? idOf(each.lubricant))}</strong>
                  <span>{subject(each)}, sump {sumpText(each.sump_temperature_celsius)}</span>
                </a>
                <JobState simulation={each} />
                <time dateTime={each.create_time}>{ago(each.create_time)}</time>
              </li>
            ))}
          </ul>
        </section>
      </div>
    </>
  );
}
