import { useMemo, useState } from 'preact/hooks';
import { ApiError, change, session, url } from '../api/client';
import type {
  Campaign, CandidateConstraint, CandidateObjective, EstimateCandidateEffectsResponse, FindParetoCandidatesResponse,
  ParetoCandidate, PromoteCandidateResponse, RankCandidatesResponse, RankedCandidate,
} from '../api/types';
import { usualFigure, type Column, type Range, type Rows } from '../campaign';
import { Scatter, type Dot } from '../charts/scatter';
import { Bars } from '../components/bars';
import { Failure, Notice } from '../components/notice';
import { finite, Num } from '../components/num';
import { inputWords } from '../inputs';
import { idOf, rounded } from '../format';
import { useAnswer, type Loaded } from '../resources';
import { address, go, place, set } from '../router';
import { useStore } from '../store';
import { shown, units, type Unit } from '../units';
import { remarkOf, type Remark } from '../validity';

const RANKED = 100; // candidates of a ranking that are asked for
const MOST_LABELS = 8; // candidates that are named in a warning
const MOST_BEATEN = 5000; // candidates that are drawn behind a front

export interface DecisionProps {
  campaign: Campaign;
  rows: Rows;
  ranges: Range[];
  version: number; // of the rows
  ranking: Loaded<RankCandidatesResponse | null>;
  chosen: number | null; // number of a candidate
  onChoose: (candidate: number | null) => void;
}

type Aggregate = 'MEAN' | 'MINIMUM' | 'MAXIMUM';
const AGGREGATES: Record<Aggregate, string> = { MEAN: 'mean of all conditions', MINIMUM: 'least of all conditions', MAXIMUM: 'greatest of all conditions' };

const isParameter = (column: Column): boolean => /^(lubricant|surface)\./.test(column.name);

/** Columns that can be an objective: figures and what candidates have beside parameters of the model. */
const objectiveColumns = (rows: Rows): Column[] =>
  rows.columns.filter((each) => each.kind === 'figure' || (each.kind === 'candidate' && !isParameter(each)));

/** Ranges as constraints that hold at all conditions. */
const constraintsOf = (ranges: Range[]): CandidateConstraint[] => ranges.flatMap(({ column, low, high }) => [
  ...(Number.isFinite(low) ? [{ figure: { column, aggregate: 'MINIMUM' as const }, minimum: low }] : []),
  ...(Number.isFinite(high) ? [{ figure: { column, aggregate: 'MAXIMUM' as const }, maximum: high }] : []),
]);

interface Stated {
  objective: CandidateObjective;
  column: Column;
  aggregate: Aggregate;
}

/** An objective of the address: "-mesh_loss_power_watts.MAXIMUM"; with "-" more of it is better. */
function statedOf(text: string | null, columns: Column[], usual: string): Stated | null {
  const match = /^(-?)(.+?)(?:\.(MEAN|MINIMUM|MAXIMUM))?$/.exec(text ?? usual);
  const column = columns.find((each) => each.name === match?.[2]) ?? columns.find((each) => each.name === usual) ?? columns[0];
  if (!column) return null;
  const aggregate = (match?.[3] ?? 'MEAN') as Aggregate;
  return { column, aggregate, objective: { figure: { column: column.name, aggregate }, wants_most: match?.[1] === '-' } };
}

function ObjectiveChoice({ words, setting, stated, columns }: { words: string; setting: string; stated: Stated; columns: Column[] }) {
  const update = (name: string, aggregate: Aggregate, wantsMost: boolean) =>
    set({ [setting]: `${wantsMost ? '-' : ''}${name}${aggregate === 'MEAN' ? '' : `.${aggregate}`}` });
  const { column, aggregate, objective } = stated;
  return (
    <div class="choices" role="group" aria-label={words}>
      <label class="inline">{words}
        <select value={String(objective.wants_most)} onChange={(event) => update(column.name, aggregate, event.currentTarget.value === 'true')}>
          <option value="false">little</option><option value="true">much</option>
        </select>
      </label>
      <label class="inline"><span class="hidden">{words}: figure</span>
        <select value={column.name} onChange={(event) => update(event.currentTarget.value, aggregate, objective.wants_most ?? false)}>
          {columns.map((each) => <option key={each.name} value={each.name}>{each.label}</option>)}
        </select>
      </label>
      {column.kind === 'figure' && (
        <label class="inline"><span class="hidden">{words}: over the conditions</span>
          <select value={aggregate} onChange={(event) => update(column.name, event.currentTarget.value as Aggregate, objective.wants_most ?? false)}>
            {(Object.keys(AGGREGATES) as Aggregate[]).map((each) => <option key={each} value={each}>{AGGREGATES[each]}</option>)}
          </select>
        </label>
      )}
    </div>
  );
}

const withUnit = (column: Column): string => (column.unit.symbol ? `${column.label}, ${column.unit.symbol}` : column.label);

/** How many candidates stand in an answer, and why others do not. */
function Counts({ of, words }: { of: { excluded?: number; refused?: number; missing?: number }; words: [number | undefined, string][] }) {
  const all: [number | undefined, string][] = [...words, [of.excluded, 'outside the ranges'], [of.refused, 'without figures'], [of.missing, 'not computed yet']];
  return (
    <p class="muted small" role="status">
      {all.filter(([count], k) => k < words.length || (count ?? 0) > 0).map(([count, text], k) => <span key={text}>{k > 0 && ', '}<span data-value={count ?? 0}>{count ?? 0}</span> {count === 1 ? text.replace('candidates are', 'candidate is').replace(/^are/, 'is') : text}</span>)}
    </p>
  );
}

/** The ranking by the objective of the address, with the warnings of its rows. */
export function useRanking(campaign: Campaign, rows: Rows, ranges: Range[], version: number): Loaded<RankCandidatesResponse | null> {
  const { query } = useStore(place);
  const stated = statedOf(query.get('goal'), objectiveColumns(rows), usualFigure(campaign));
  return useAnswer<RankCandidatesResponse>(`${campaign.name}:rank`, stated && { objective: stated.objective, constraints: constraintsOf(ranges), count: RANKED }, version);
}

/** The warnings of a ranking with the candidates concerned. */
export function rankingRemarks(answer: RankCandidatesResponse | null | undefined): Remark[] {
  const labels = new Map((answer?.candidates ?? []).map((each) => [each.candidate ?? 0, each.label || String(each.candidate ?? 0)]));
  return (answer?.warnings ?? []).map((warning) => {
    const all = warning.candidates ?? [];
    const isOfAll = all.length >= labels.size;
    const candidates = isOfAll ? '' : `${all.slice(0, MOST_LABELS).map((each) => labels.get(each) ?? each).join(', ')}${all.length > MOST_LABELS ? ` and ${all.length - MOST_LABELS} more` : ''}`;
    return remarkOf(warning, [candidates, warning.where].filter(Boolean).join(' '));
  });
}

/** The best candidates, in the order of the service: ties are called ties, and where a warning forbids a verdict there is none. */
export function Ranking({ campaign, rows, ranking: answer, chosen, onChoose }: DecisionProps) {
  const { query } = useStore(place);
  useStore(units);
  const columns = objectiveColumns(rows);
  const stated = statedOf(query.get('goal'), columns, usualFigure(campaign));
  if (!stated) return <p class="muted">No rows are computed yet.</p>;
  const found = answer.value?.candidates ?? [];
  const refused = answer.value?.refused_candidates ?? [];
  const { unit } = stated.column;
  const uncertain = [...(answer.value?.own_uncertain_parameters ?? []), ...(answer.value?.shared_uncertain_parameters ?? [])];
  const error = Math.max(0, ...found.map((each) => finite(each.solver_error) ?? 0));
  return (
    <section aria-label="Ranking" class={answer.isStale ? 'stale' : ''}>
      <ObjectiveChoice words="Good is" setting="goal" stated={stated} columns={columns} />
      {answer.error !== undefined && <Failure error={answer.error} onRetry={answer.reload} />}
      {answer.value && <Counts of={answer.value} words={[[answer.value.ranked, 'candidates are ranked'], ...((answer.value.withheld ?? 0) > 0 ? [[answer.value.withheld, 'of them without a verdict'] as [number, string]] : [])]} />}
      {found.length > 0 && <RankTable found={found} column={stated.column} chosen={chosen} onChoose={onChoose} />}
      <p class="small">
        Rows with 1= cannot be told apart from the best one: the 95&nbsp;% interval of the difference holds 0. Bars reach 1.96 standard uncertainties by the inputs to both sides.{' '}
        {uncertain.length === 0 ? 'No input has a stated uncertainty: there is no probability.' : `Uncertain: ${uncertain.map((each) => inputWords(each)).join('; ')}.`}
        {error > 0 && <> Error of the solver: at most <Num value={error} unit={{ ...unit, offset: 0 }} error={error} /> {unit.symbol}.</>}
        {unit.symbol && ` Values in ${unit.symbol}.`}
      </p>
      {refused.length > 0 && (
        <section aria-label="Refused candidates">
          <h2>Without a figure</h2>
          <ul>{refused.map((each) => <li key={each.candidate}>{each.label || (each.candidate ?? 0)}: {each.refusal?.message} <span class="code">{each.refusal?.reason}</span></li>)}</ul>
        </section>
      )}
    </section>
  );
}

const NORMAL_95 = 1.96; // standard deviations of a normal distribution that hold 95 % to both sides

function RankTable({ found, column, chosen, onChoose }: { found: RankedCandidate[]; column: Column; chosen: number | null; onChoose: (candidate: number | null) => void }) {
  const { unit } = column;
  const reachOf = (each: RankedCandidate) => NORMAL_95 * (finite(each.comparison?.standard_uncertainty) ?? 0);
  const ends = found.flatMap((each) => [each.value! - reachOf(each), each.value! + reachOf(each)]);
  const [low, high] = [Math.min(...ends), Math.max(...ends)];
  const at = (value: number) => `${2 + (96 * (value - low)) / (high - low || 1)}%`;
  return (
    <div class="scroll rows" tabIndex={0} role="region" aria-label="Ranking">
      <table class="ranking">
        <thead>
          <tr>
            <th class="number">Rank</th><th>Candidate</th><th class="number">{column.label}<small>{unit.symbol}&nbsp;</small></th><th class="number">Standard uncertainty<small>{unit.symbol}&nbsp;</small></th>
            <th><span class="hidden">Interval</span></th><th class="number">Worse than the best with<small>%</small></th>
          </tr>
        </thead>
        <tbody>
          {found.map((each, k) => {
            const { comparison } = each;
            const isTied = comparison?.tied === true && found[1]?.comparison?.tied === true;
            const spread = finite(comparison?.standard_uncertainty);
            return (
              <tr key={each.candidate} class={`${each.candidate === chosen ? 'chosen' : ''} ${isTied ? 'tied' : ''}`}>
                <td class="number">{each.verdict_withheld ? '–' : isTied ? '1=' : k + 1}</td>
                <th scope="row"><button class="sort" aria-pressed={each.candidate === chosen} onClick={() => onChoose(each.candidate === chosen ? null : each.candidate ?? 0)}>{each.label || (each.candidate ?? 0)}</button></th>
                <td class="number"><Num value={each.value} error={spread || each.solver_error} unit={unit} /></td>
                <td class="number">{spread ? <Num value={spread} error={spread} unit={{ ...unit, offset: 0 }} /> : ''}</td>
                <td class="bar-cell">
                  <svg width="100%" height="18" aria-hidden="true" class="interval">
                    <line x1={at(each.value! - reachOf(each))} x2={at(each.value! + reachOf(each))} y1="9" y2="9" />
                    <circle cx={at(each.value!)} cy="9" r="4" class={isTied || each.verdict_withheld ? 'hollow' : ''} />
                  </svg>
                </td>
                <td class="number">{each.verdict_withheld ? 'verdict withheld' : comparison && k > 0 ? <Probability value={comparison.worse_probability} /> : ''}</td>
              </tr>
            );
          })}
        </tbody>
      </table>
    </div>
  );
}

/** A probability in per cent: never quite 0 or 100. */
function Probability({ value }: { value: number | undefined }) {
  const number = finite(value);
  if (number === null) return <span>–</span>;
  if (number < 0.01 || number > 0.99) return <span>{number < 0.01 ? 'below 1' : 'above 99'}</span>;
  return <span data-value={number} data-factor={100} data-offset={0}>{Math.round(100 * number)}</span>;
}

/** Candidates with a row whose verdict a warning withholds. */
const withheldCandidates = (rows: Rows): Set<number> => new Set(rows.candidates.filter((_, row) => rows.isWithheld[row]));

/** Two objectives against each other: candidates that none beats in both are marked. */
export function Pareto({ campaign, rows, ranges, version, chosen, onChoose }: DecisionProps) {
  const { query } = useStore(place);
  const inUnits = useStore(units);
  const columns = objectiveColumns(rows);
  const first = statedOf(query.get('goal'), columns, usualFigure(campaign));
  const usual = columns.find((each) => each.kind === 'candidate')?.name ?? columns.find((each) => each.name === 'film_ratio_minimum')?.name ?? (campaign.rig ? '-central_film_thickness_metres' : 'dynamic_transmission_error_maximum_metres');
  const second = statedOf(query.get('other'), columns, usual);
  const constraints = constraintsOf(ranges);
  const front = useAnswer<FindParetoCandidatesResponse>(`${campaign.name}:findPareto`, first && second && { first: first.objective, second: second.objective, constraints, beaten_count: MOST_BEATEN }, version);
  const dots = useMemo<Dot[]>(() => {
    if (!first || !second) return [];
    const dot = (each: ParetoCandidate, series: number): Dot[] =>
      (finite(each.first_value) === null || finite(each.second_value) === null ? []
        : [{ key: each.candidate ?? 0, x: shown(each.second_value!, second.column.unit), y: shown(each.first_value!, first.column.unit), series }]);
    return [
      ...(front.value?.beaten_candidates ?? []).flatMap((each) => dot(each, -1)),
      ...(front.value?.candidates ?? []).flatMap((each) => dot(each, 0)),
    ];
  }, [front.value, inUnits]);
  if (!first || !second) return <p class="muted">No rows are computed yet.</p>;
  const members = front.value?.candidates ?? [];
  const withheld = withheldCandidates(rows);
  return (
    <section aria-label="Pareto front" class={front.isStale ? 'stale' : ''}>
      <ObjectiveChoice words="Good is" setting="goal" stated={first} columns={columns} />
      <ObjectiveChoice words="and" setting="other" stated={second} columns={columns} />
      {front.error !== undefined && <Failure error={front.error} onRetry={front.reload} />}
      {front.value && <Counts of={front.value} words={[[front.value.total_size, 'candidates are beaten by none in both'], [front.value.beaten, 'are beaten']]} />}
      <Scatter dots={dots} xLabel={withUnit(second.column)} yLabel={withUnit(first.column)} height={matchMedia('(max-width: 640px)').matches ? 320 : 420}
        chosen={chosen} onChoose={onChoose} words={(key) => `candidate ${key}`} />
      {(front.value?.beaten ?? 0) > MOST_BEATEN && <p class="small">The {MOST_BEATEN} best of <span data-value={front.value!.beaten}>{front.value!.beaten}</span> beaten candidates are drawn, and the front.</p>}
      <details open>
        <summary>The front</summary>
        <div class="scroll rows" tabIndex={0} role="region" aria-label="The front">
          <table>
            <thead><tr><th>Candidate</th>{[first, second].map(({ column }) => <th key={column.name} class="number">{column.label}<small>{column.unit.symbol}&nbsp;</small></th>)}</tr></thead>
            <tbody>
              {members.slice(0, RANKED).map((each) => (
                <tr key={each.candidate} class={each.candidate === chosen ? 'chosen' : ''}>
                  <th scope="row"><button class="sort" onClick={() => onChoose(each.candidate ?? 0)}>{each.label || (each.candidate ?? 0)}</button>{withheld.has(each.candidate ?? 0) && <small>verdict withheld</small>}</th>
                  <td class="number"><Num value={each.first_value} unit={first.column.unit} /></td>
                  <td class="number"><Num value={each.second_value} unit={second.column.unit} /></td>
                </tr>
              ))}
            </tbody>
          </table>
        </div>
      </details>
    </section>
  );
}

/** What each column of the candidates does to a figure. */
export function Effects({ campaign, rows, ranges, version }: DecisionProps) {
  const { query } = useStore(place);
  useStore(units);
  const columns = rows.columns.filter((each) => each.kind === 'figure');
  const stated = statedOf(query.get('goal')?.replace(/^-/, '') ?? null, columns, usualFigure(campaign));
  const answer = useAnswer<EstimateCandidateEffectsResponse>(`${campaign.name}:estimateEffects`, stated && {
    figure: stated.objective.figure, constraints: constraintsOf(ranges),
  }, version);
  if (!stated) return <p class="muted">No rows are computed yet.</p>;
  const unit: Unit = { ...stated.column.unit, offset: 0 };
  const valueText = (column: string, candidate: number | undefined) => {
    const text = rows.texts.find((each) => each.name === column);
    if (text) return text.values[candidate ?? 0];
    const found = rows.columns.find((each) => each.name === column);
    const row = rows.candidates.indexOf(candidate ?? 0);
    const value = found?.values[row];
    return value == null ? '' : `${rounded(shown(value, found!.unit))} ${found!.unit.symbol}`;
  };
  const labelOf = (column: string) => rows.columns.find((each) => each.name === column)?.label ?? column.replaceAll('_', ' ');
  return (
    <section aria-label="Main effects" class={answer.isStale ? 'stale' : ''}>
      <div class="choices">
        <label class="inline">Figure
          <select value={stated.column.name} onChange={(event) => set({ goal: event.currentTarget.value })}>
            {columns.map((each) => <option key={each.name} value={each.name}>{each.label}</option>)}
          </select>
        </label>
      </div>
      {answer.error !== undefined && <Failure error={answer.error} onRetry={answer.reload} />}
      {answer.value && (
        <>
          <Bars label="Main effects" less={`less ${stated.column.label.toLowerCase()}`} more={`more ${stated.column.label.toLowerCase()}`}
            bars={(answer.value.effects ?? []).map((each, k) => ({
              key: `${k}`,
              label: <>{labelOf(each.column!)} <small>{valueText(each.column!, each.from_candidate)} → {valueText(each.column!, each.to_candidate)}{(each.collinear_columns ?? []).length > 0 && `; not separable from ${each.collinear_columns!.map(labelOf).join(', ')}`}</small></>,
              value: shown(each.effect ?? 0, unit), low: shown(each.effect_minimum ?? 0, unit), high: shown(each.effect_maximum ?? 0, unit),
              text: <><Num value={each.effect} unit={unit} error={Math.abs((each.effect_maximum ?? 0) - (each.effect_minimum ?? 0)) / 4 || undefined} isSigned /> {unit.symbol}</>,
            }))} />
          <p class="small">
            A linear model of <span data-value={answer.value.candidates}>{answer.value.candidates}</span> candidates, without interactions; whiskers hold 95&nbsp;%. It explains{' '}
            <span data-value={answer.value.explained_share} data-factor={100} data-offset={0}>{Math.round(100 * (finite(answer.value.explained_share) ?? 0))}</span> % of the variance.
          </p>
          {(answer.value.left_out ?? []).length > 0 && <p class="small">Without an effect: {answer.value.left_out!.map((each) => `${labelOf(each.column!)} (${each.reason!.toLowerCase().replaceAll('_', ' ')})`).join(', ')}.</p>}
        </>
      )}
    </section>
  );
}

/** Makes a candidate a lubricant of its own, which can then be compared and run, and a surface where it has one. */
export function Promote({ campaign, rows, candidate }: { campaign: Campaign; rows: Rows; candidate: number }) {
  const hasSurface = rows.columns.some((each) => each.name.startsWith('surface.'));
  const [id, setId] = useState('');
  const [problem, setProblem] = useState<unknown>(null);
  if (session.value?.scope === 'read') return null;
  const submit = async (event: SubmitEvent) => {
    event.preventDefault();
    try {
      const made = await change<PromoteCandidateResponse>('POST', `${url(campaign.name!)}:promote`, { candidate, lubricant_id: id, ...(hasSurface ? { surface_id: id } : {}) });
      go(address(`/fluids/${idOf(made.lubricant?.name)}`));
    } catch (refusal) {
      setProblem(refusal);
    }
  };
  const violation = problem instanceof ApiError ? problem.violations.find((each) => each.field.endsWith('lubricant_id')) : undefined;
  return (
    <form class="choices" onSubmit={(event) => void submit(event)}>
      <label class="inline">Id of a new fluid{hasSurface && ' and surface'} <input value={id} placeholder="my-candidate" spellcheck={false} aria-invalid={violation !== undefined} onInput={(event) => setId(event.currentTarget.value)} /></label>
      <button disabled={id.trim() === ''}>Make it a fluid</button>
      {violation ? <span class="problem" role="alert">{violation.description}</span> : problem !== null && <Notice kind="error">{(problem as Error).message}</Notice>}
    </form>
  );
}
