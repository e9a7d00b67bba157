import { useMemo, useState } from 'preact/hooks';
import { ApiError, change, get, url } from '../api/client';
import type { EvaluateRigResponse, ListSurfacesResponse } from '../api/types';
import { CurveChart } from '../charts/curve_chart';
import { Entry } from '../components/entry';
import { OptionChoice, PresetChoice } from '../components/model_choice';
import { finite, UncertainNum } from '../components/num';
import { Failure, Notice } from '../components/notice';
import { Swatch } from '../components/swatch';
import { csvOf, TakeAway } from '../components/take_away';
import { Validity } from '../components/validity';
import { shortTitle } from '../curve';
import { idOf, revisionIdOf, rounded } from '../format';
import { titlesOf, useLoaded, useLubricants } from '../resources';
import {
  callsOf, codesAt, LISTS, rigBand, rigRemarks, rigCommandsOf, rigCurvesOf, rigQueryOf, RIG_QUANTITIES, rigRequestOf, RIGS, rigSpec, rigValue,
  type RigCurve, type RigKind, type RigRequest,
} from '../rig';
import { address, go, place, set } from '../router';
import { useStore } from '../store';
import { celsius, plain, readNumber, units, written, type Unit } from '../units';
import { remarkLines, remarksOnce } from '../validity';

/** A ball on a disc by the contact of the axle: traction, film and Stribeck curves. */
export function Rigs() {
  const { query, project } = useStore(place);
  const inUnits = useStore(units);
  const lubricants = useLubricants();
  const titles = titlesOf(lubricants.value);
  const stated = rigRequestOf(query);
  const usualFluids = (lubricants.value ?? []).map((each) => idOf(each.name)).filter((id) => id.startsWith('paper-fluid-'));
  const request = { ...stated, fluids: stated.fluids.length > 0 ? stated.fluids : usualFluids };
  const calls = callsOf(request);
  const answers = useLoaded(async (signal) => ({ request, given: await Promise.all(calls.map(async (call) =>
    ({ call, answer: await change<EvaluateRigResponse>('POST', url('rigs:evaluate'), call.body, signal) }))) }), JSON.stringify(calls));
  const { request: answered, given } = answers.value ?? { request, given: [] };
  const rig = RIGS[answered.kind];
  const quantity = RIG_QUANTITIES.find((each) => each.id === (query.get('y') ?? rig.first)) ?? RIG_QUANTITIES[0]!;
  const titleOf = (fluid: string) => shortTitle(titles.get(idOf(fluid)) ?? fluid);
  const curves = useMemo(() => rigCurvesOf(answered, given), [answers.value, inUnits]);
  const spec = useMemo(() => (curves.length > 0 ? rigSpec(answered, curves, quantity, titleOf) : null), [curves, quantity, lubricants.value, inUnits]);
  const [at, setAt] = useState<number | null>(null);
  const update = (next: RigRequest) => go(address('/rigs', { ...rigQueryOf(next), y: next.kind === request.kind ? query.get('y') ?? undefined : undefined }), 'replace');
  const remarks = [...rigRemarks(answered, curves, titleOf), ...remarksOnce(given.flatMap((each) => each.answer.input_warnings ?? []))];
  // The revisions that were evaluated: a link with them shows the same tomorrow.
  const pinned = [...new Set(given.map((each) => revisionIdOf(each.answer.lubricant_revision)))];
  const refusals = new Map(given.flatMap((each) => each.answer.refusals ?? []).map((each) => [each.message, each]));
  return (
    <div class="with-panel">
      <aside class="panel" aria-label="Rig">
        <Form request={request} onChange={update} titles={titles} error={answers.error} />
      </aside>
      <div class={answers.isStale ? 'stale' : ''}>
        {answers.error !== undefined && <Failure error={answers.error} onRetry={answers.reload} />}
        {request.fluids.length === 0 && lubricants.value && <p class="muted">Choose a fluid.</p>}
        {spec && (
          <>
            <div class="heading">
              <div><h1>{rig.about}</h1><p class="muted">{machineText(answered)}</p></div>
              <TakeAway name={answered.kind} spec={{ ...spec, title: `${rig.label}: ${spec.title}` }} requests={given.map((each) => each.call.body)} commands={rigCommandsOf(answered, project)} link={address('/rigs', { ...rigQueryOf({ ...answered, fluids: pinned }), y: query.get('y') ?? undefined })}
                footer={[machineText(answered), given[0]?.answer.model_version ?? '', ...remarkLines(remarks)]} csv={() => tableOf(curves, titleOf)} />
            </div>
            <figure class="figure" aria-label={quantity.label}>
              <div class="tabs" role="group" aria-label="Quantity">
                {RIG_QUANTITIES.map((each) => (
                  <button key={each.id} aria-pressed={each === quantity} onClick={() => set({ y: each.id === rig.first ? undefined : each.id })}>{each.label}</button>
                ))}
              </div>
              <figcaption>{spec.title}</figcaption>
              {spec.lines.every((line) => line.y.every((value) => value === null))
                ? <Notice kind="caution">Smooth specimens have no {quantity.label.toLowerCase()}: choose a surface.</Notice>
                : <CurveChart spec={spec} height={matchMedia('(max-width: 640px)').matches ? 260 : 380} sync="rigs" onSpeed={setAt} />}
              <p class="axis-title">{spec.xLabel}</p>
              <div class="under-chart">
                {spec.lines.some((line) => line.hollow.includes(true)) && <ul class="key"><li>hollow: do not rank fluids here</li></ul>}
                {spec.lines.some((line) => line.low) && <ul class="key"><li><i class="swatch band" /> holds the curve with 95&nbsp;%, as far as the inputs decide</li></ul>}
                <div class="switches">
                  <label class="choice"><input type="checkbox" checked={request.hasBands} onChange={() => update({ ...request, hasBands: !request.hasBands })} /> Uncertainty of the inputs</label>
                </div>
              </div>
            </figure>
            <ReadOut request={answered} curves={curves} titleOf={titleOf} at={at} onAt={setAt} />
            <Validity remarks={remarks} isOpen={refusals.size > 0}>
              {[...refusals.values()].map((each) => <li key={each.message} class="outside">No figures: {each.message}</li>)}
              <li class="note">The contact is the one of the axle: film by eq 12, with the friction, heat and asperities of the flanks.</li>
            </Validity>
          </>
        )}
      </div>
    </div>
  );
}

function machineText(request: RigRequest): string {
  const lists = [
    `${request.loads.join(', ')} N`,
    ...(request.kind === 'traction' ? [`${request.speeds.join(', ')} m/s`] : [`slide-roll ratio ${request.slides.join(', ')} %`]),
    `oil at ${request.temperatures.map((each) => written(each, celsius)).join(', ')} ${celsius.symbol}`,
  ];
  const surface = request.surface ? `${request.surface}${request.roughness > 0 ? ` of ${request.roughness} nm` : ''}` : 'smooth';
  return `A ball of ${rounded(2 * request.radius)} mm on ${request.disc}, ${surface}; ${lists.join('; ')}${request.preset === 'PAPER' ? '; model of the paper' : ''}`;
}

const FIELDS: Record<(typeof LISTS)[number], { label: string; field: string; unit: Unit }> = {
  loads: { label: 'Load, N', field: 'load_newtons', unit: plain('N') },
  speeds: { label: 'Entrainment speed, m/s', field: 'entrainment_speed_metres_per_second', unit: plain('m/s') },
  slides: { label: 'Slide-roll ratio, %', field: 'slide_roll_ratio_percent', unit: plain('%') },
  temperatures: { label: 'Oil', field: 'supply_temperature_celsius', unit: celsius },
};

function Form({ request, onChange, titles, error }: { request: RigRequest; onChange: (request: RigRequest) => void; titles: Map<string, string>; error: unknown }) {
  const surfaces = useLoaded(async (signal) => (await get<ListSurfacesResponse>(url('surfaces', { page_size: 1000, read_mask: 'name,display_name' }), signal)).surfaces ?? [], 'surfaces');
  const violations = error instanceof ApiError ? error.violations : [];
  const problem = (field: string) => {
    const text = violations.find((each) => each.field.includes(field))?.description;
    return text && <span class="problem" role="alert">{text}</span>;
  };
  const isWrong = (field: string) => violations.some((each) => each.field.includes(field));
  const toggle = (id: string) =>
    onChange({ ...request, fluids: request.fluids.some((each) => idOf(each) === id) ? request.fluids.filter((each) => idOf(each) !== id) : [...request.fluids, id] });
  const list = (key: (typeof LISTS)[number]) => {
    const { label, field, unit } = FIELDS[key];
    return (
      <label>
        {label}{key === 'temperatures' && `, ${unit.symbol}`}
        <Entry inputMode="decimal" value={request[key].map((each) => written(each, unit)).join(', ')} title="several with commas between them" aria-invalid={isWrong(field)}
          onChange={(event) => {
            const values = event.currentTarget.value.split(/[,;]\s*|\s+/).map((word) => readNumber(word, unit)).filter((value) => !Number.isNaN(value));
            if (values.length > 0) onChange({ ...request, [key]: values });
          }} />
        {problem(field)}
      </label>
    );
  };
  const number = (key: 'radius' | 'roughness', label: string, field: string) => (
    <label>
      {label}
      <Entry inputMode="decimal" value={String(request[key])} aria-invalid={isWrong(field)}
        onChange={(event) => {
          const value = readNumber(event.currentTarget.value, plain(''));
          if (!Number.isNaN(value)) onChange({ ...request, [key]: value });
        }} />
      {problem(field)}
    </label>
  );
  return (
    <>
      <fieldset>
        <legend>Rig</legend>
        <div class="tabs" role="group" aria-label="Rig">
          {(Object.keys(RIGS) as RigKind[]).map((kind) => (
            <button key={kind} aria-pressed={kind === request.kind} onClick={() => onChange({ ...RIGS[kind].usual, kind, fluids: request.fluids, preset: request.preset, hasBands: request.hasBands })}>{RIGS[kind].label}</button>
          ))}
        </div>
      </fieldset>
      <fieldset class="fluids">
        <legend>Fluids</legend>
        {[...titles].map(([id, title]) => (
          <label key={id} class="choice">
            <input type="checkbox" checked={request.fluids.some((each) => idOf(each) === id)} onChange={() => toggle(id)} />
            <Swatch series={request.fluids.findIndex((each) => idOf(each) === id)} /> <span>{shortTitle(title)}</span>
          </label>
        ))}
      </fieldset>
      <fieldset>
        <legend>Machine</legend>
        {list('loads')}
        {request.kind === 'traction' ? list('speeds') : list('slides')}
        {list('temperatures')}
        {number('radius', 'Radius of the ball, mm', 'radius_x')}
        <label>
          Disc
          <select value={request.disc} onChange={(event) => onChange({ ...request, disc: event.currentTarget.value as RigRequest['disc'] })}>
            <option>steel</option><option>glass</option>
          </select>
        </label>
        <label>
          Specimens
          <select value={request.surface} onChange={(event) => onChange({ ...request, surface: event.currentTarget.value })}>
            <option value="">smooth</option>
            {(surfaces.value ?? []).map((each) => <option key={each.name} value={idOf(each.name)}>{each.display_name || idOf(each.name)}</option>)}
          </select>
        </label>
        <PresetChoice preset={request.preset} onChange={(preset) => onChange({ ...request, preset })} />
        {request.surface !== '' && number('roughness', 'Roughness σ, nm; 0: of the surface', 'composite_rms')}
      </fieldset>
      <fieldset>
        <legend>Beside the full model</legend>
        <OptionChoice options={request.options} onChange={(options) => onChange({ ...request, options })} />
      </fieldset>
    </>
  );
}

/** Every figure at one place of the axis. */
function ReadOut({ request, curves, titleOf, at, onAt }: {
  request: RigRequest; curves: RigCurve[]; titleOf: (fluid: string) => string; at: number | null; onAt: (at: number) => void;
}) {
  const x = curves[0]!.x;
  const found = at === null ? -1 : x.indexOf(at);
  const row = found < 0 ? Math.floor(x.length / 2) : found;
  const [name, symbol] = RIGS[request.kind].x.label.split(', ');
  const has = RIG_QUANTITIES.filter((quantity) => curves.some((curve) => curve.x.some((_, k) => rigValue(curve, quantity, k) !== null)));
  return (
    <section class="read-out" aria-labelledby="rig-read-out">
      <div class="heading">
        <h2 id="rig-read-out">At {rounded(x[row])} {symbol}</h2>
        <input type="range" min={0} max={x.length - 1} value={row} aria-label={name} aria-valuetext={`${rounded(x[row])} ${symbol}`} onInput={(event) => onAt(x[event.currentTarget.valueAsNumber]!)} />
      </div>
      <div class="scroll" tabIndex={0} role="region" aria-label="All numbers at this place">
        <table>
          <thead><tr><th>Fluid</th>{has.map((each) => <th key={each.id} class="number">{each.label}<small>{each.unit.symbol}&nbsp;</small></th>)}</tr></thead>
          <tbody>
            {curves.map((curve, k) => (
              <tr key={k}>
                <th scope="row"><Swatch series={request.fluids.indexOf(curve.fluid)} />{[titleOf(curve.fluid), curve.label].filter((each) => each !== '').join(', ')}</th>
                {has.map((each) => <td key={each.id} class="number"><UncertainNum figure={rigBand(curve, each, row) ?? { value: rigValue(curve, each, row) }} unit={each.unit} /></td>)}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </section>
  );
}

function tableOf(curves: RigCurve[], titleOf: (fluid: string) => string): string {
  const uncertain = RIG_QUANTITIES.filter((quantity) => curves.some((curve) => curve.x.some((_, row) => rigBand(curve, quantity, row) !== null)));
  return csvOf(['fluid', 'variant', 'x', ...RIG_QUANTITIES.map((each) => each.column as string),
    ...uncertain.flatMap((each) => ['standard_uncertainty', 'interval_minimum', 'interval_maximum'].map((end) => `${each.column}_${end}`)), 'warnings'],
  curves.flatMap((curve) => curve.x.map((x, row) => [titleOf(curve.fluid), curve.label, x, ...RIG_QUANTITIES.map((each) => rigValue(curve, each, row)),
    ...uncertain.flatMap((each) => {
      const band = rigBand(curve, each, row);
      return [finite(band?.standard_uncertainty), finite(band?.interval_minimum), finite(band?.interval_maximum)];
    }), codesAt(curve, row)])));
}
