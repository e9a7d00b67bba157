import type { ComponentChildren } from 'preact';
import { useMemo, useState } from 'preact/hooks';
import { ApiError, get, url } from '../api/client';
import type {
  CauseInteraction, ComparedDifference, ComparedLubricant, ComparePointsResponse, DecidingInput, DifferenceCause, DifferenceExplanation,
  DrawnFigure, ExplainPointsResponse, InputShare, Lubricant,
} from '../api/types';
import { CurveChart } from '../charts/curve_chart';
import { Bars, type Bar } from '../components/bars';
import { Entry } from '../components/entry';
import { ModelChoice } from '../components/model_choice';
import { finite, Interval, isUncertain, Num, spreadOf, UncertainNum } from '../components/num';
import { Failure, Notice } from '../components/notice';
import { Swatch } from '../components/swatch';
import { NotIncluded, Validity } from '../components/validity';
import { csvOf, TakeAway } from '../components/take_away';
import {
  COMPARED, compareBodyOf, compareCommandsOf, comparedSpeedUnit, compareQueryOf, compareRequestOf, differenceSpec, explainBodyOf, figuresSpec, GROUPS,
  comparedRemarks, POINTS, speedLabelOf, speedsOf, speedText, VERDICTS, verdictWords, type CompareRequest,
} from '../comparison';
import { inputUnit, inputWords } from '../inputs';
import { shortTitle } from '../curve';
import { idOf, revisionIdOf } from '../format';
import { celsius, plain, readNumber, RPM, shown, sumpText, units, watts, written, type Unit } from '../units';
import { ALL_FIELDS, constraintOf, unitOf, valueOf, type Field } from '../lubricant_fields';
import { PROVENANCE } from '../provenance';
import { titlesOf, useAnswer, useGearSets, useLoaded, useLubricants, useSchema } from '../resources';
import { address, go, place, set } from '../router';
import { useStore } from '../store';
import { remarkLines, remarkOf } from '../validity';

const SHOWN_SHARES = 6;
const PERCENT: Unit = { symbol: '%', factor: 100, offset: 0 };

/** Two fluids side by side: who loses less, how sure that is, why, and what to measure next. */
export function Compare() {
  const { query, project } = useStore(place);
  const inUnits = useStore(units);
  const lubricants = useLubricants();
  const titles = useMemo(() => titlesOf(lubricants.value), [lubricants.value]);
  const stated = compareRequestOf(query);
  const [first, second] = (lubricants.value ?? []).map((each) => idOf(each.name));
  const request = { ...stated, a: stated.a || (first ?? ''), b: stated.b || (second ?? first ?? '') };
  const isComplete = request.a !== '' && request.b !== '';
  const answer = useAnswer<ComparePointsResponse>('points:compare', isComplete ? compareBodyOf(request) : null);
  const speeds = speedsOf(request);
  const at = query.get('at') === 'mean' ? null : nearest(speeds, Number(query.get('at') ?? 60));
  const explainedSpeeds = at === null ? speeds : [at];
  const reasons = useAnswer<ExplainPointsResponse>('points:explain', isComplete ? explainBodyOf(request, explainedSpeeds) : null);
  const change = (next: CompareRequest) =>
    go(address('/compare', { ...compareQueryOf(next), at: query.get('at') ?? undefined, y: query.get('y') ?? undefined }), 'replace');

  const lines = answer.value?.lubricants ?? [];
  const names = lines.map((each) => shortTitle(titles.get(idOf(each.lubricant_revision)) ?? revisionIdOf(each.lubricant_revision)));
  if (names.length === 2 && names[0] === names[1]) {
    lines.forEach((each, k) => (names[k] = revisionIdOf(each.lubricant_revision)));
  }
  const quantity = COMPARED.find((each) => each.id === query.get('y')) ?? COMPARED[0]!;
  const speedUnit = comparedSpeedUnit(answer.value, speeds); // addresses have km/h
  const axis = speeds.map((speed) => shown(speed, speedUnit));
  const xLabel = speedLabelOf(speedUnit);
  const onPick = (place: number) => set({ at: String(nearest(speeds, place / speedUnit.factor)) });
  const torque = at === null || speedUnit.symbol === 'km/h' ? undefined : lines[0]?.points?.[speeds.indexOf(at)]?.pinion_torque_newton_metres;
  const specs = useMemo(() => (lines.length === 2
    ? { figures: figuresSpec(lines, names, axis, quantity, xLabel), difference: differenceSpec(lines, names, axis, [0, 1], xLabel) } : null),
  [answer.value, quantity, titles, inUnits]);
  const row = at === null ? -1 : speeds.indexOf(at);
  const other = lines[1];
  const explanation = at === null ? reasons.value?.mean : reasons.value?.points?.[0];
  const explained = (explanation?.warnings ?? []).map((each) => remarkOf(each, 'a combination of properties'));
  const difference = other && (row < 0 ? other.mean_difference : other.differences?.[row]);

  return (
    <div class="with-panel">
      <aside class="panel" aria-label="Conditions">
        <Form request={request} onChange={change} lubricants={lubricants.value ?? []}
          violations={answer.error instanceof ApiError ? answer.error.violations : []} />
      </aside>
      <div class={answer.isStale || reasons.isStale ? 'stale' : ''}>
        {lubricants.value && lubricants.value.length < 2 && (
          <Notice kind="caution">There is one fluid. <a href={address('/fluids/new')}>Enter another</a> to compare it with.</Notice>
        )}
        {answer.error !== undefined && <Failure error={answer.error} onRetry={answer.reload} />}
        {specs && answer.error === undefined && (
          <>
            <div class="heading">
              <Headline difference={other!.mean_difference} names={names} />
              <TakeAway name="comparison" spec={specs.difference} footer={[...footerOf(answer.value!, request), ...remarkLines(comparedRemarks(lines, names, speeds, speedUnit))]}
                csv={() => tableOf(lines, speeds)} requests={{ compare: compareBodyOf(request), explain: explainBodyOf(request, explainedSpeeds) }}
                commands={compareCommandsOf(request, explainedSpeeds, project)} link={pinned(request, answer.value!, query)} />
            </div>
            <NotIncluded text={answer.value!.not_included} />
            <Unstated answer={answer.value!} names={names} />
            <figure class="figure" aria-label={`${quantity.label} of both fluids`}>
              <div class="tabs" role="group" aria-label="Quantity">
                {COMPARED.map((each) => (
                  <button key={each.id} aria-pressed={each === quantity} onClick={() => set({ y: each === COMPARED[0] ? undefined : each.id })}>{each.label}</button>
                ))}
              </div>
              <figcaption>{specs.figures.title}; bands hold 95&nbsp;%</figcaption>
              <CurveChart spec={specs.figures} height={240} sync="compare" onPick={onPick} />
            </figure>
            <figure class="figure" aria-label="Difference over speed">
              <figcaption>{names[1]} less {names[0]}: mesh inefficiency, percentage points; hollow where there is no verdict</figcaption>
              <CurveChart spec={specs.difference} height={190} sync="compare" onPick={onPick} />
              <p class="axis-title">{xLabel}</p>
            </figure>
            <section class="reasons" aria-labelledby="why">
              <div class="heading">
                <h2 id="why">Why</h2>
                <label class="inline">
                  at
                  <select value={at === null ? 'mean' : String(at)} onChange={(event) => set({ at: event.currentTarget.value })}>
                    {speeds.map((speed) => <option key={speed} value={speed}>{speedText(speed, speedUnit)}</option>)}
                    <option value="mean">the mean of all speeds</option>
                  </select>
                </label>
              </div>
              {difference && <Verdict difference={difference} names={names} where={at === null ? 'on the mean of all speeds' : `at ${speedText(at, speedUnit)}`}>
                {torque && <>, where the pinion of {names[0]} takes <Num value={torque.value} error={spreadOf(torque)} unit={plain('N m')} /> N m at {at} km/h</>}
              </Verdict>}
              {reasons.error !== undefined && <Failure error={reasons.error} onRetry={reasons.reload} />}
              {reasons.value && reasons.error === undefined && (
                <Reasons explanation={explanation} names={names} />
              )}
            </section>
            <Validity remarks={[...comparedRemarks(lines, names, speeds, speedUnit), ...explained]}>
              <li class="note">Draws of the inputs are not compared with the ranges of the laws.</li>
            </Validity>
            {difference && <Deciding difference={difference} lines={lines} titles={names} />}
            {difference && <MeasureNext difference={difference} names={lines} titles={names} />}
            <SpeedTable lines={lines} names={names} speeds={speeds} pinion={speedUnit.symbol === RPM.symbol ? answer.value!.mean_pinion_speed_radians_per_second : undefined} />
            <Inputs a={request.a} b={request.b} names={names} />
          </>
        )}
        {!specs && answer.error === undefined && <p class="muted">{isComplete ? 'Comparing …' : 'Choose two fluids.'}</p>}
      </div>
    </div>
  );
}

const nearest = (speeds: number[], wanted: number): number =>
  speeds.reduce((best, speed) => (Math.abs(speed - wanted) < Math.abs(best - wanted) ? speed : best), speeds[0]!);

/** The address of a comparison with the revisions that were compared: it shows the same tomorrow. */
function pinned(request: CompareRequest, answer: ComparePointsResponse, query: URLSearchParams): string {
  const [a, b] = answer.lubricants!.map((each) => revisionIdOf(each.lubricant_revision));
  const inputs = { gearSet: revisionIdOf(answer.gear_set_revision), surface: revisionIdOf(answer.surface_revision), vehicle: revisionIdOf(answer.vehicle_revision) };
  return address('/compare', { ...compareQueryOf({ ...request, ...inputs, a: a!, b: b! }), at: query.get('at') ?? undefined, y: query.get('y') ?? undefined });
}

interface FormProps {
  request: CompareRequest;
  onChange: (request: CompareRequest) => void;
  lubricants: Lubricant[];
  violations: { field: string; description: string }[];
}

function Form({ request, onChange, lubricants, violations }: FormProps) {
  const gearSets = useGearSets();
  const problemOf = (field: string) => violations.find((each) => each.field.includes(field))?.description;
  const fluid = (key: 'a' | 'b', words: string, series: number) => {
    const present = request[key];
    const isOld = present.includes('@') && !lubricants.some((each) => `${idOf(each.name)}@${each.revision}` === present);
    return (
      <label>
        <span class="with-swatch"><Swatch series={series} /> {words}</span>
        <select value={isOld ? present : idOf(present)} onChange={(event) => onChange({ ...request, [key]: event.currentTarget.value })}>
          {isOld && <option value={present}>{present}</option>}
          {lubricants.map((each) => <option key={each.name} value={idOf(each.name)}>{each.display_name || idOf(each.name)}</option>)}
        </select>
      </label>
    );
  };
  const number = (key: 'sump' | 'first' | 'last' | 'step' | 'sumpUncertainty' | 'correlation', words: string, field: string, unit: Unit = plain('')) => (
    <label>
      {words}
      <Entry type="number" step="any" value={written(request[key], unit)} aria-invalid={problemOf(field) !== undefined}
        onChange={(event) => {
          const value = readNumber(event.currentTarget.value, unit);
          if (Number.isFinite(value)) onChange({ ...request, [key]: value });
        }} />
      {problemOf(field) && <span class="problem" role="alert">{problemOf(field)}</span>}
    </label>
  );
  return (
    <>
      <fieldset>
        <legend>Fluids</legend>
        {fluid('a', 'A, the reference', 0)}
        {fluid('b', 'B', 1)}
        <button onClick={() => onChange({ ...request, a: request.b, b: request.a })}>Exchange A and B</button>
      </fieldset>
      <fieldset>
        <legend>Conditions</legend>
        {number('sump', `Sump, ${celsius.symbol}`, 'sump_temperature_celsius', celsius)}
        <label>
          Gear set
          <select value={idOf(request.gearSet) || 'reference-axle'} onChange={(event) => onChange({ ...request, gearSet: event.currentTarget.value })}>
            {(gearSets.value ?? []).map((each) => <option key={each.name} value={idOf(each.name)}>{each.display_name || idOf(each.name)}</option>)}
          </select>
        </label>
        <div class="triple" role="group" aria-label="Speeds">
          {number('first', 'From km/h', 'speed_kilometres_per_hour')}
          {number('last', 'to', 'last_speed')}
          {number('step', 'by', 'speed_step')}
        </div>
        <ModelChoice request={request} onChange={onChange} />
      </fieldset>
      <fieldset>
        <legend>Uncertainty</legend>
        {number('sumpUncertainty', 'Of the sump, standard, K', 'sump_temperature_uncertainty')}
        {number('correlation', 'Correlation of estimates', 'estimate_correlation')}
        <p class="small">Errors of fluids are those that their data sheets and estimates state.</p>
      </fieldset>
    </>
  );
}

/** A probability from draws: never quite 0 or 1. */
function Probability({ value }: { value: number | undefined }) {
  const number = finite(value);
  if (number === null) return <span>–</span>;
  if (number < 0.01 || number > 0.99) return <span>{number < 0.01 ? 'below 1 %' : 'above 99 %'}</span>;
  return <span><span data-value={number} data-factor={100} data-offset={0}>{Math.round(100 * number)}</span> %</span>;
}

/** The verdict of the service on the mean of all speeds, in a sentence. */
function Headline({ difference, names }: { difference: ComparedDifference | undefined; names: string[] }) {
  const [a, b] = names;
  if (!difference?.difference_percent) return <h1>{a} and {b}</h1>;
  const figure = difference.difference_percent;
  const { verdict } = difference;
  return (
    <div>
      <h1>
        {verdict === 'LOWER' && <>{b} loses less than {a}</>}
        {verdict === 'HIGHER' && <>{b} loses more than {a}</>}
        {verdict !== 'LOWER' && verdict !== 'HIGHER' && verdictWords(verdict, a!, b!)}
      </h1>
      <p class="muted">
        Mean inefficiency over the speeds, {b} less {a}: <Num value={figure.value} error={spreadOf(figure)} unit={POINTS} isSigned /> percentage
        points; <Certainty difference={difference} name={b!} />
      </p>
    </div>
  );
}

/** How sure a difference is: its interval and the probability, or why it has none. */
function Certainty({ difference, name }: { difference: ComparedDifference; name: string }) {
  const figure = difference.difference_percent;
  if (difference.verdict === 'UNCERTAINTY_NOT_STATED') return <>uncertainty of the inputs not stated.</>;
  return (
    <>
      {figure && isUncertain(figure) && <>95&nbsp;% interval <Interval figure={figure} unit={POINTS} isSigned /> percentage points.</>}
      {finite(difference.lower_probability) !== null && <> Probability that {name} loses less: <Probability value={difference.lower_probability} />.</>}
    </>
  );
}

/** What would tell two fluids apart. */
function Deciding({ difference, lines, titles }: { difference: ComparedDifference; lines: ComparedLubricant[]; titles: string[] }) {
  const constraints = useSchema().value?.constraints;
  const inputs = difference.deciding_inputs ?? [];
  if (inputs.length === 0) return null;
  return (
    <p class="deciding">
      To tell them apart, {difference.all_needed && inputs.length > 1 ? 'all of these must be known better: ' : inputs.length > 1 ? 'one of these must be known better: ' : 'this must be known better: '}
      {inputs.map((each, k) => {
        const unit = { ...inputUnit(each.input!, constraints), offset: 0 };
        return (
          <span key={`${each.input} ${each.lubricant_revision}`}>
            {k > 0 && '; '}{inputWords(each.input!)} of {ownerOf(each, lines, titles)}, to{' '}
            {each.input!.includes(' ') || finite(each.standard_uncertainty) === null ? '' : <>a standard uncertainty of <Num value={each.standard_uncertainty} unit={unit} error={each.standard_uncertainty} /> {unit.symbol}, </>}
            <Num value={each.factor} unit={plain('')} error={each.factor} /> of the present one
          </span>
        );
      })}.
    </p>
  );
}

function Verdict({ difference, names, where, children }: { difference: ComparedDifference; names: string[]; where: string; children?: ComponentChildren }) {
  const [a, b] = names;
  const figure = difference.difference_percent;
  return (
    <p class="muted">
      {verdictWords(difference.verdict, a!, b!)} {where}{children}
      {figure && <>: {b} less {a} <Num value={figure.value} error={spreadOf(figure)} unit={POINTS} isSigned /> percentage points; <Certainty difference={difference} name={b!} /></>}
    </p>
  );
}

/** Inputs whose uncertainty nobody stated count as exact: without any the interval is that of the solver. */
function Unstated({ answer, names }: { answer: ComparePointsResponse; names: string[] }) {
  const lists = (answer.lubricants ?? []).map((each) => each.inputs_without_uncertainty ?? []);
  if (lists.every((each) => each.length === 0)) return null;
  const isExact = (answer.lubricants ?? []).every((each) => !each.uncertainty_stated);
  return (
    <Notice kind="caution">
      <details>
        <summary>
          {isExact ? 'No input of the two has a stated uncertainty: there is a difference, but no interval and no probability.'
            : `Some inputs count as exact, because nobody stated their uncertainty: ${lists.map((each, k) => `${each.length} of ${names[k]}`).filter((_, k) => lists[k]!.length > 0).join(', ')}.`}
        </summary>
        <ul>{lists.map((each, k) => each.length > 0 && <li key={k}>{names[k]}: {each.map((field) => inputWords(field)).join('; ')}</li>)}</ul>
      </details>
    </Notice>
  );
}

const endOf = (value: number | undefined, unit: Unit): number | null => { const end = finite(value); return end === null ? null : shown(end, unit); };

const barOf = (key: string, label: string, figure: DrawnFigure, unit: Unit, more?: Partial<Bar>): Bar => {
  const value = shown(finite(figure.value) ?? 0, unit);
  const hasInterval = isUncertain(figure);
  return {
    key, label, value,
    low: hasInterval ? endOf(figure.interval_minimum, unit) : null,
    high: hasInterval ? endOf(figure.interval_maximum, unit) : null,
    text: <UncertainNum figure={figure} unit={unit} isSigned />,
    ...more,
  };
};

function Reasons({ explanation, names }: { explanation: DifferenceExplanation | undefined; names: string[] }) {
  const [inWatts, setWatts] = useState(false);
  if (!explanation) return null;
  if (explanation.refusal_reason) return <Notice kind="error">{explanation.refusal_message}</Notice>;
  const [a, b] = names;
  const unit = inWatts ? watts : POINTS;
  const shapley = (cause: DifferenceCause) => (inWatts ? cause.mesh_loss_power_watts : cause.inefficiency_percent);
  const causes = [...(explanation.causes ?? [])].sort((x, y) =>
    Number(x.is_equal ?? false) - Number(y.is_equal ?? false) ||
    Math.abs(finite(shapley(y)?.shapley_value?.value) ?? 0) - Math.abs(finite(shapley(x)?.shapley_value?.value) ?? 0));
  const sum = inWatts ? explanation.mesh_loss_power_difference_watts : explanation.inefficiency_difference_percent;
  const bars = causes.map((cause) =>
    barOf(cause.group!, GROUPS[cause.group!] ?? cause.group!, shapley(cause)?.shapley_value ?? {}, unit,
      cause.is_equal ? { label: <>{GROUPS[cause.group!]} <small>equal values</small></> } : {}));
  bars.push(barOf('sum', `Together: ${b} less ${a}`, sum ?? {}, unit, { isSum: true }));
  const size = (each: CauseInteraction) => finite(inWatts ? each.mesh_loss_power_watts : each.inefficiency_percent) ?? 0;
  const interactions = (explanation.interactions ?? []).filter((each) => size(each) !== 0).sort((x, y) => Math.abs(size(y)) - Math.abs(size(x))).slice(0, 5);
  return (
    <>
      <div class="tabs" role="group" aria-label="Figure">
        <button aria-pressed={!inWatts} onClick={() => setWatts(false)}>Inefficiency, percentage points</button>
        <button aria-pressed={inWatts} onClick={() => setWatts(true)}>Loss, {watts.symbol}</button>
      </div>
      <Bars bars={bars} label="What each property group adds" less={`${b} loses less`} more={`${b} loses more`} />
      <p class="small">Each bar is what {b}'s values of that group change, averaged over all orders of exchange (Shapley value); whiskers hold 95&nbsp;%. Together they make the last bar; one of them can be longer, where others work against it.</p>
      {(explanation.contact_loss_combinations ?? 0) > 0 && explanation.contact_loss_combinations! < 64 && (
        <Notice kind="caution">Flanks part in some of the combinations: the shares depend on where the vibration sets in.</Notice>
      )}
      {interactions.length > 0 && (
        <details>
          <summary>Before or after the others, and in pairs</summary>
          <div class="scroll" tabIndex={0} role="region" aria-label="Effects alone">
            <table>
              <thead><tr><th>Group</th><th class="number">exchanged first</th><th class="number">exchanged last</th></tr></thead>
              <tbody>
                {causes.filter((cause) => !cause.is_equal).map((cause) => (
                  <tr key={cause.group}><th scope="row">{GROUPS[cause.group!]}</th>
                    <td class="number"><Num value={shapley(cause)?.first_effect} error={shapley(cause)?.shapley_value?.solver_error} unit={unit} isSigned /></td>
                    <td class="number"><Num value={shapley(cause)?.last_effect} error={shapley(cause)?.shapley_value?.solver_error} unit={unit} isSigned /></td></tr>
                ))}
              </tbody>
            </table>
            <table>
              <thead><tr><th>Two groups together</th><th class="number">beyond each alone, {unit.symbol}</th></tr></thead>
              <tbody>
                {interactions.map((each) => (
                  <tr key={`${each.group}${each.other_group}`}><th scope="row">{GROUPS[each.group!]} with {GROUPS[each.other_group!]!.toLowerCase()}</th>
                    <td class="number"><Num value={inWatts ? each.mesh_loss_power_watts : each.inefficiency_percent} unit={unit} isSigned /></td></tr>
                ))}
              </tbody>
            </table>
          </div>
        </details>
      )}
    </>
  );
}

/** Whose error a share is: that of one of the fluids, or of both. */
const ownerOf = (share: InputShare | DecidingInput, lines: ComparedLubricant[], titles: string[]): string => {
  const k = lines.findIndex((each) => each.lubricant_revision === share.lubricant_revision);
  return !share.lubricant_revision || k < 0 ? (share.input!.startsWith('lubricant.') ? 'both fluids' : 'conditions') : titles[k]!;
};

function MeasureNext({ difference, names, titles }: { difference: ComparedDifference; names: ComparedLubricant[]; titles: string[] }) {
  const shares = (difference.shares ?? []).filter((each) => (each.variance_share ?? 0) > 0).slice(0, SHOWN_SHARES);
  if (shares.length === 0) return null;
  const first = shares[0]!;
  return (
    <section class="reasons" aria-labelledby="measure">
      <h2 id="measure">Measure first: {inputWords(first.input!)} <span class="count">of {ownerOf(first, names, titles)}</span></h2>
      <p class="muted">What the uncertainty of the difference consists of, and how far one standard uncertainty of each input moves the difference.</p>
      <Bars label="Shares of the uncertainty" bars={shares.map((share) => ({
        key: `${share.input} ${share.lubricant_revision}`,
        label: <>{inputWords(share.input!)} <small>{ownerOf(share, names, titles)}</small></>,
        value: share.variance_share!,
        text: <><Num value={share.variance_share} unit={PERCENT} error={0.01} /> % <small>moves <Num value={share.effect} unit={POINTS} isSigned /> points</small></>,
      }))} />
    </section>
  );
}

function SpeedTable({ lines, names, speeds, pinion }: { lines: ComparedLubricant[]; names: string[]; speeds: number[]; pinion: number[] | undefined }) {
  const [a, b] = lines;
  const solver = lines.flatMap((line) => (line.points ?? []).flatMap((point) => finite(point.inefficiency_energy_mean_percent?.solver_error) ?? []));
  const figure = (line: ComparedLubricant, k: number) => {
    const point = line.points![k]!;
    if (point.refusal_reason) return <span title={point.refusal_message}>refused</span>;
    return <UncertainNum figure={point.inefficiency_energy_mean_percent} unit={plain('%')} isStated={line.uncertainty_stated === true} />;
  };
  return (
    <details>
      <summary data-key="t">Every speed</summary>
      <div class="scroll" tabIndex={0} role="region" aria-label="Every speed">
        <table>
          <thead>
            <tr>{pinion && <th class="number">rpm</th>}<th class="number">km/h</th><th class="number">{names[0]} <small>%</small></th><th class="number">{names[1]} <small>%</small></th>
              <th class="number">Difference <small>% points</small></th><th class="number">95&nbsp;% interval</th><th class="number">P({names[1]} less)</th><th>Verdict</th></tr>
          </thead>
          <tbody>
            {speeds.map((speed, k) => {
              const difference = b!.differences?.[k];
              return (
                <tr key={speed}>
                  {pinion && <td class="number"><Num value={pinion[k]} unit={RPM} error={1 / RPM.factor} /></td>}
                  <th scope="row" class="number">{speed}</th>
                  <td class="number">{figure(a!, k)}</td><td class="number">{figure(b!, k)}</td>
                  <td class="number"><Num value={difference?.difference_percent?.value} error={spreadOf(difference?.difference_percent)} unit={POINTS} isSigned /></td>
                  <td class="number">{difference?.verdict === 'UNCERTAINTY_NOT_STATED' ? 'not stated' : isUncertain(difference?.difference_percent) && <Interval figure={difference!.difference_percent!} unit={POINTS} isSigned />}</td>
                  <td class="number"><Probability value={difference?.lower_probability} /></td>
                  <td>{difference?.verdict === 'LOWER' || difference?.verdict === 'HIGHER' ? `${names[1]} ` : ''}{VERDICTS[difference?.verdict ?? 'VERDICT_UNSPECIFIED']}</td>
                </tr>
              );
            })}
          </tbody>
        </table>
      </div>
      {solver.length > 0 && <p class="small">Error of the solver: at most <Num value={Math.max(...solver)} unit={plain('%')} error={Math.max(...solver)} /> % in an inefficiency. Beneath a value: what its inputs leave, with 95&nbsp;%.</p>}
    </details>
  );
}

/** The parameters of both fluids with their origins. */
function Inputs({ a, b, names }: { a: string; b: string; names: string[] }) {
  const both = useLoaded((signal) => Promise.all([a, b].map((id) => get<Lubricant>(url(`lubricants/${id}`), signal))), `${a} ${b}`);
  const schema = useSchema();
  if (!both.value) return null;
  const cell = (lubricant: Lubricant, field: Field) => {
    const unit = unitOf(field, constraintOf(field, schema.value?.constraints));
    const origin = (lubricant.provenance ?? []).find((each) => each.field === field.field);
    return (
      <td class="number">
        <Num value={valueOf(lubricant, field)} error={origin?.standard_uncertainty || undefined} unit={unit} />
        {(origin?.standard_uncertainty ?? 0) > 0 && <small>standard uncertainty <Num value={origin!.standard_uncertainty} error={origin!.standard_uncertainty} unit={{ ...unit, offset: 0 }} /></small>}
        <small>{origin ? PROVENANCE[origin.provenance ?? ''] : ''}</small>
      </td>
    );
  };
  return (
    <details>
      <summary>Inputs side by side</summary>
      <div class="scroll" tabIndex={0} role="region" aria-label="Inputs side by side">
        <table>
          <thead><tr><th>Quantity</th><th>Unit</th>{names.map((name) => <th key={name} class="number">{name}</th>)}</tr></thead>
          <tbody>
            {ALL_FIELDS.filter((field) => both.value!.some((each) => valueOf(each, field) !== undefined)).map((field) => (
              <tr key={field.path}>
                <th scope="row">{field.label}</th><td>{unitOf(field, constraintOf(field, schema.value?.constraints)).symbol}</td>
                {both.value!.map((each) => cell(each, field))}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </details>
  );
}

function footerOf(answer: ComparePointsResponse, request: CompareRequest): string[] {
  return [
    `Less ${revisionIdOf(answer.lubricants?.[0]?.lubricant_revision)}: ${revisionIdOf(answer.lubricants?.[1]?.lubricant_revision)}. Bands hold 95 % by ${answer.draws} draws of the inputs; hollow: no verdict.`,
    `Gear set ${revisionIdOf(answer.gear_set_revision)}, surface ${revisionIdOf(answer.surface_revision)}, vehicle ${revisionIdOf(answer.vehicle_revision)}, sump ${sumpText(request.sump)}.`,
    answer.not_included ?? '',
    `${answer.model_version ?? ''}; correlation of estimates ${request.correlation}, uncertainty of the sump ${request.sumpUncertainty} K`,
  ];
}

function tableOf(lines: ComparedLubricant[], speeds: number[]): string {
  const figures = ['value', 'standard_uncertainty', 'interval_minimum', 'interval_maximum', 'solver_error'] as const;
  const header = ['speed_kilometres_per_hour',
    ...lines.flatMap((line) => figures.map((each) => `${revisionIdOf(line.lubricant_revision)}_inefficiency_energy_mean_percent_${each}`)),
    ...figures.map((each) => `difference_percent_${each}`), 'lower_probability', 'verdict', ...lines.map((line) => `${revisionIdOf(line.lubricant_revision)}_warnings`)];
  return csvOf(header, speeds.map((speed, k) => {
    const difference = lines[1]!.differences?.[k];
    return [speed,
      ...lines.flatMap((line) => figures.map((each) => finite(line.points?.[k]?.inefficiency_energy_mean_percent?.[each]))),
      ...figures.map((each) => finite(difference?.difference_percent?.[each])), finite(difference?.lower_probability), difference?.verdict ?? '',
      ...lines.map((line) => (line.points?.[k]?.warnings ?? []).map((each) => each.code).join(' '))];
  }));
}
