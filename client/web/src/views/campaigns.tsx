import { useEffect, useMemo, useState } from 'preact/hooks';
import { change, get, session, url } from '../api/client';
import { watchCampaign, type Stream } from '../api/events';
import type { Campaign, CampaignEvent, ListCampaignsResponse } from '../api/types';
import { conditionsOf, extentOf, isWithin, MOST_CANDIDATES, MOST_ROWS, orderedRows, rangesOf, rangesText, readRows, rigConditions, usualFigure, varies, type Column, type Range, type Rows } from '../campaign';
import { Parallel, type Axis } from '../charts/parallel';
import { Scatter, type Dot } from '../charts/scatter';
import { MARKERS } from '../charts/spec';
import { Entry } from '../components/entry';
import { Missing } from '../components/missing';
import { Failure, Notice } from '../components/notice';
import { Labels } from '../components/labels';
import { Num } from '../components/num';
import { Swatch } from '../components/swatch';
import { NotIncluded, Validity } from '../components/validity';
import { TakeAway } from '../components/take_away';
import { shortTitle } from '../curve';
import { ago, idOf, revisionIdOf, rounded } from '../format';
import { titlesOf, useLoaded, useLubricants, useSchema } from '../resources';
import { filterOfLabel } from '../labels';
import { modelOf } from '../model';
import { address, place, set } from '../router';
import { useStore } from '../store';
import { readNumber, shown, sumpText, units, written } from '../units';
import { AppendCandidates } from './campaign_append';
import { Effects, Pareto, Promote, Ranking, rankingRemarks, useRanking } from './campaign_decisions';
import { NewCampaign } from './campaign_new';

const PAGE = 100;
const MOST_STREAMS = 3; // a browser opens six connections to a server
const RELOAD_MILLISECONDS = 1500; // between readings of rows of a campaign that runs
const LIST_MILLISECONDS = 5000; // between readings of a list that has more open campaigns than streams
const SHOWN_ROWS = 100;
const MOST_AXES = 8;
const ENDED = ['SUCCEEDED', 'FAILED', 'CANCELLED'];

/** What lists show of a campaign. */
const LISTED = 'name,display_name,state,stop,stalled,lubricant,candidates,rig,points,points_done,points_refused,labels,create_time';
/** What the page of a campaign shows; values of its candidates come with its rows. */
const SHOWN = `${LISTED},conditions,model_options,refusals,lubricant_revision,gear_set_revision,surface_revision,vehicle_revision`;
const SHOWN_OF_CANDIDATES = `${SHOWN},candidate_columns.path,candidate_attributes.name,candidate_attributes.texts`;

export function Campaigns() {
  const { path } = useStore(place);
  const [, , id, part] = path.split('/');
  if (id === 'new') return <NewCampaign />;
  if (part === 'append') return <AppendCandidates key={id} name={`campaigns/${id}`} />;
  return id ? <CampaignPage key={id} name={`campaigns/${id}`} /> : <CampaignList />;
}

/** A campaign after an event. */
const updated = (campaign: Campaign, event: CampaignEvent): Campaign => {
  if (event.kind === 'HEARTBEAT' || event.kind === 'DELETED') return campaign;
  const { stop: _, stalled: __, ...rest } = campaign;
  return {
    ...rest, state: event.state!, points_done: event.points_done ?? 0, points_refused: event.points_refused ?? 0,
    processor_seconds: event.processor_seconds ?? 0, ...(event.stop ? { stop: event.stop } : {}), ...(event.stalled ? { stalled: event.stalled } : {}),
  };
};

/** Pauses, resumes or cancels a campaign; its new state arrives by the answer. */
const order = (campaign: Campaign, method: 'pause' | 'resume' | 'cancel', body: unknown = {}): Promise<Campaign> =>
  change<Campaign>('POST', `${url(campaign.name!)}:${method}`, body);

function State({ campaign }: { campaign: Campaign }) {
  const words: Record<string, string> = { PAUSED: 'paused', SUCCEEDED: 'done', FAILED: 'failed', CANCELLED: 'cancelled' };
  const isOpen = !ENDED.includes(campaign.state!);
  return (
    <span class={`state ${campaign.stalled ? 'stalled' : campaign.state!.toLowerCase()}`}>
      {isOpen && <progress max={campaign.points} value={campaign.points_done ?? 0} aria-label="Progress" />}
      {campaign.stalled ? 'stalled' : words[campaign.state!] ?? `${Math.floor((100 * (campaign.points_done ?? 0)) / campaign.points!)} %`}
    </span>
  );
}

function Actions({ campaign, onChange, onFailure }: { campaign: Campaign; onChange: (campaign: Campaign) => void; onFailure: (error: unknown) => void }) {
  if (ENDED.includes(campaign.state!) || session.value?.scope === 'read') return null;
  const button = (words: string, method: 'pause' | 'resume' | 'cancel', body?: unknown) => (
    <button onClick={() => void order(campaign, method, body).then(onChange, onFailure)}>
      {words}<span class="hidden"> campaign {idOf(campaign.name)}</span>
    </button>
  );
  return (
    <>
      {campaign.state === 'RUNNING' ? button('Pause', 'pause')
        : campaign.stop?.reason === 'BUDGET_SPENT' ? button('Resume without a budget', 'resume', { budget: {} }) : button('Resume', 'resume')}
      {button('Cancel', 'cancel')}
    </>
  );
}

function CampaignList() {
  const label = useStore(place).query.get('label');
  const filter = filterOfLabel(label);
  const list = useLoaded(async (signal) =>
    (await get<ListCampaignsResponse>(url('campaigns', { page_size: PAGE, read_mask: LISTED, filter }), signal)).campaigns ?? [], `campaigns ${filter}`);
  const titles = titlesOf(useLubricants().value);
  const [campaigns, setCampaigns] = useState<Campaign[] | undefined>();
  const [problem, setProblem] = useState<unknown>(null);
  const put = (next: (old: Campaign) => Campaign, name: string) =>
    setCampaigns((all) => all?.map((each) => (each.name === name ? next(each) : each)));
  useEffect(() => {
    setCampaigns(list.value);
    const open = (list.value ?? []).filter((each) => !ENDED.includes(each.state!));
    // Campaigns without a stream of their own are read now and then.
    const timer = open.length > MOST_STREAMS ? window.setTimeout(list.reload, LIST_MILLISECONDS) : undefined;
    const streams = open.slice(0, MOST_STREAMS).map((each) => watchCampaign(each.name!, (event) => put((old) => updated(old, event), each.name!)));
    return () => {
      streams.forEach((each) => each.close());
      clearTimeout(timer);
    };
  }, [list.value]);
  return (
    <>
      <div class="heading">
        <h1>Campaigns</h1>
        {session.value?.scope !== 'read' && <div class="actions"><a class="button primary" href={address('/campaigns/new')}>New campaign</a></div>}
      </div>
      {list.error !== undefined && <Failure error={list.error} onRetry={list.reload} />}
      {problem !== null && <Failure error={problem} />}
      {label && <p class="choices">Those with the label {label} <button onClick={() => set({ label: undefined })}>Show all campaigns</button></p>}
      {campaigns?.length === 0 && label && <p class="muted">No campaign has this label.</p>}
      {campaigns?.length === 0 && !label && (
        <section class="empty">
          <p>A campaign screens thousands of variants of an oil. <a href={address('/campaigns/new')}>Drop a table of candidates</a>, or begin one with the command line:</p>
          <pre class="command">tribodyn screen candidates.csv --like my-oil --speeds 20,40,60 --sumps 40,90</pre>
        </section>
      )}
      {campaigns && campaigns.length > 0 && (
        <div class="scroll" tabIndex={0} role="region" aria-label="Campaigns">
          <table class="jobs">
            <thead><tr><th>Campaign</th><th>Base</th><th class="number">Candidates</th><th class="number">Conditions</th><th>State</th><th class="number">Refused</th><th class="number">Created</th><th><span class="hidden">Actions</span></th></tr></thead>
            <tbody>
              {campaigns.map((each) => (
                <tr key={each.name}>
                  <td><a href={address(`/campaigns/${idOf(each.name)}`)}>{each.display_name || `Campaign ${idOf(each.name)}`}</a><small>{idOf(each.name)}</small><Labels of="campaigns" labels={each.labels} /></td>
                  <td>{shortTitle(titles.get(idOf(each.lubricant)) ?? idOf(each.lubricant))}</td>
                  <td class="number">{each.candidates}</td>
                  <td class="number">{conditionsOf(each)}{each.rig && <small>of a rig</small>}</td>
                  <td><State campaign={each} />{(each.stop ?? each.stalled) && <small class={each.state === 'FAILED' ? 'problem' : ''}>{(each.stop ?? each.stalled)!.message}</small>}</td>
                  <td class="number">{each.points_refused ?? 0}</td>
                  <td class="number">{ago(each.create_time)}</td>
                  <td><div class="actions"><Actions campaign={each} onChange={(next) => put(() => next, each.name!)} onFailure={setProblem} /></div></td>
                </tr>
              ))}
            </tbody>
          </table>
        </div>
      )}
    </>
  );
}

/** A campaign with its candidates, and without them if they are too many for a page. */
async function readCampaign(name: string, signal: AbortSignal): Promise<Campaign> {
  const { candidates = 0 } = await get<Campaign>(url(name, { read_mask: 'candidates' }), signal);
  return get<Campaign>(url(name, { read_mask: candidates > MOST_CANDIDATES ? SHOWN : SHOWN_OF_CANDIDATES }), signal);
}

function CampaignPage({ name }: { name: string }) {
  const loaded = useLoaded((signal) => readCampaign(name, signal), name);
  const [campaign, setCampaign] = useState<Campaign | undefined>();
  const [version, setVersion] = useState(0); // of the rows that were read
  const [problem, setProblem] = useState<unknown>(null);
  const [isDeleted, setDeleted] = useState(false);
  useEffect(() => {
    if (!loaded.value) return;
    setCampaign(loaded.value);
    if (ENDED.includes(loaded.value.state!)) return;
    let timer: number | undefined;
    const stream: Stream = watchCampaign(name, (event) => {
      if (event.kind === 'DELETED') setDeleted(true);
      if (event.kind === 'HEARTBEAT') return;
      setCampaign((old) => old && updated(old, event));
      // Rows are read now and then, and at once when there will be no more of them.
      const isLast = ENDED.includes(event.state!);
      if (isLast) clearTimeout(timer);
      if (isLast || timer === undefined) {
        timer = window.setTimeout(() => {
          timer = undefined;
          setVersion((count) => count + 1);
        }, isLast ? 0 : RELOAD_MILLISECONDS);
      }
    });
    return () => {
      stream.close();
      clearTimeout(timer);
    };
  }, [loaded.value]);
  const constraints = useSchema().value?.constraints;
  const rows = useLoaded((signal) => (loaded.value && constraints ? readRows(loaded.value, constraints, signal) : Promise.resolve(undefined)),
    `${name} ${loaded.value && constraints ? version : ''}`);
  if (loaded.error !== undefined) return (loaded.error as { status?: number }).status === 404 ? <Missing /> : <Failure error={loaded.error} onRetry={loaded.reload} />;
  if (isDeleted) return <Notice kind="caution">The campaign was deleted.</Notice>;
  if (!campaign) return <p class="muted">Loading …</p>;
  const canAppend = session.value?.scope !== 'read' && ['RUNNING', 'PAUSED', 'SUCCEEDED'].includes(campaign.state!) && (campaign.candidates ?? 0) > 1;
  const keep = (next: Campaign) => setCampaign((old) => ({ ...old, stop: undefined, stalled: undefined, ...next, candidate_columns: old!.candidate_columns, candidate_attributes: old!.candidate_attributes } as Campaign));
  return (
    <>
      <div class="heading">
        <div>
          <h1>{campaign.display_name || `Campaign ${idOf(name)}`}</h1>
          <p class="muted">
            {campaign.candidates} candidates like {revisionIdOf(campaign.lubricant_revision)} at {conditionsOf(campaign)} condition{conditionsOf(campaign) === 1 ? '' : 's'};{' '}
            {campaign.rig ? `rig, ${campaign.surface_revision ? revisionIdOf(campaign.surface_revision) : 'smooth specimens'}`
              : `${revisionIdOf(campaign.gear_set_revision)}, ${revisionIdOf(campaign.surface_revision)}, ${revisionIdOf(campaign.vehicle_revision)}`}
            {modelOf(campaign.model_options).preset === 'PAPER' && '; model of the paper'}
          </p>
          <Labels of="campaigns" labels={campaign.labels} />
        </div>
        <div class="actions">
          <Actions campaign={campaign} onChange={keep} onFailure={setProblem} />
          {canAppend && <a class="button" href={address(`/campaigns/${idOf(name)}/append`)}>Add candidates</a>}
          {rows.value && <Downloads campaign={campaign} rows={rows.value} />}
        </div>
      </div>
      {problem !== null && <Failure error={problem} />}
      {campaign.stop && <Notice kind={campaign.state === 'FAILED' ? 'error' : 'caution'}>{campaign.stop.message}</Notice>}
      {campaign.stalled && <Notice kind="caution">{campaign.stalled.message}</Notice>}
      <p class="campaign-progress">
        <progress max={campaign.points} value={campaign.points_done ?? 0} aria-label="Progress of the campaign" />
        <span><span data-value={campaign.points_done ?? 0}>{campaign.points_done ?? 0}</span> of <span data-value={campaign.points}>{campaign.points}</span> rows are computed
          {(campaign.points_refused ?? 0) > 0 && <>, <span data-value={campaign.points_refused}>{campaign.points_refused}</span> of them without figures</>}
          {campaign.state === 'CANCELLED' && '; the campaign was cancelled'}{campaign.stalled ? <>; <span class="state stalled">stalled</span></> : campaign.state === 'RUNNING' && ' …'}</span>
      </p>
      {rows.error !== undefined && <Failure error={rows.error} onRetry={rows.reload} />}
      {rows.value && <Results campaign={campaign} rows={rows.value} version={version} />}
    </>
  );
}

function Downloads({ campaign, rows }: { campaign: Campaign; rows: Rows }) {
  const id = idOf(campaign.name);
  const columns = ['candidate', 'condition', 'refusal_number', ...(rows.isWithheld.length > 0 ? ['verdict_withheld', 'warning_bits'] : []), ...rows.columns.map((each) => each.name)];
  return (
    <TakeAway name={`campaign-${id}`} requests={{ name: campaign.name, columns }} commands={[`tribodyn campaigns columns ${id} --output csv`]}>
      <a class="button" download={`campaign-${id}.csv`} href={url(`${campaign.name}:read`, { alt: 'csv', columns })}>All rows as CSV</a>
      <a class="button" download={`campaign-${id}.npy`} href={url(`${campaign.name}:read`, { alt: 'npy', columns })}>All rows for NumPy</a>
    </TakeAway>
  );
}

const VIEWS: [string, string][] = [['rank', 'Ranking'], ['pareto', 'Pareto front'], ['effects', 'Main effects'], ['rows', 'Table'], ['plot', 'One against another'], ['parallel', 'Parallel coordinates']];

function Results({ campaign, rows, version }: { campaign: Campaign; rows: Rows; version: number }) {
  const { query } = useStore(place);
  useStore(units);
  const view = query.get('view') ?? 'rank';
  const isDecision = ['rank', 'pareto', 'effects'].includes(view);
  const conditions = campaign.rig ? rigConditions(campaign, rows) : (campaign.conditions ?? []).map((each) =>
    `${each.speed_kilometres_per_hour} km/h, ${sumpText(each.sump_temperature_celsius)}${each.ascent_angle_degrees ? `, ${each.ascent_angle_degrees}° uphill` : ''}`);
  const condition = conditions.length < 2 || query.get('at') === 'all' ? null : Math.min(conditions.length - 1, Number(query.get('at') ?? 0));
  const ranges = useMemo(() => rangesOf(query.get('b')), [query.get('b')]);
  const setRange = (column: string, ends: [number, number] | null) =>
    set({ b: rangesText([...ranges.filter((each) => each.column !== column), ...(ends ? [{ column, low: ends[0], high: ends[1] }] : [])]) });
  const orderName = query.get('order') ?? '';
  const orderColumn = rows.columns.find((each) => each.name === orderName.replace(/^-/, ''));
  const all = useMemo(() => orderedRows(rows, condition, orderColumn, orderName.startsWith('-')), [rows, condition, orderName]);
  const within = useMemo(() => isWithin(rows, ranges), [rows, ranges]);
  const kept = useMemo(() => all.filter(within), [all, within]);
  const chosen = query.has('c') ? Number(query.get('c')) : null;
  const chosenRow = chosen === null ? null : all.find((row) => rows.candidates[row] === chosen) ?? null;
  const choose = (row: number | null) => set({ c: row === null ? undefined : String(rows.candidates[row]) });
  const ranking = useRanking(campaign, rows, ranges, version);
  const decision = { campaign, rows, ranges, version, ranking, chosen, onChoose: (candidate: number | null) => set({ c: candidate === null ? undefined : String(candidate) }) };
  const shownColumns = useMemo(() => rows.columns.filter((each) => varies(each, all) || each.name === usualFigure(campaign)), [rows, all]);
  return (
    <>
      <div class="tabs" role="group" aria-label="View">
        {VIEWS.map(([id, words]) => <button key={id} aria-pressed={view === id} onClick={() => set({ view: id === 'rank' ? undefined : id })}>{words}</button>)}
      </div>
      <div class="choices">
        {conditions.length > 1 && !isDecision && (
          <label class="inline">Condition
            <select value={condition === null ? 'all' : String(condition)} onChange={(event) => set({ at: event.currentTarget.value === '0' ? undefined : event.currentTarget.value })}>
              {conditions.map((each, k) => <option key={k} value={k}>{each}</option>)}
              <option value="all">all of them</option>
            </select>
          </label>
        )}
        {!isDecision && <span class="muted" role="status">
          {kept.length === all.length ? `${all.length} rows` : `${kept.length} of ${all.length} rows are within the ranges`}
          {rows.isCut && `, of the first ${MOST_ROWS} of the campaign`}
        </span>}
        {ranges.length > 0 && <button onClick={() => set({ b: undefined })}>Show all rows</button>}
      </div>
      {(campaign.candidates ?? 0) > MOST_CANDIDATES && (
        <Notice kind="caution">The page shows figures alone: the campaign has more than {MOST_CANDIDATES} candidates. The download of its rows has everything.</Notice>
      )}
      {view === 'rank' && <Ranking {...decision} />}
      {view === 'pareto' && <Pareto {...decision} />}
      {view === 'effects' && <Effects {...decision} />}
      {view === 'plot' && <Plot rows={rows} columns={shownColumns} all={all} within={within} chosen={chosenRow} onChoose={choose} />}
      {view === 'parallel' && <Coordinates columns={shownColumns} all={all} within={within} ranges={ranges} chosen={chosenRow} onRange={setRange} />}
      {view === 'rows' && <Table rows={rows} columns={shownColumns} kept={kept} order={orderName} chosen={chosenRow} onChoose={choose} />}
      <Ranges columns={shownColumns} ranges={ranges} onRange={setRange} />
      {chosenRow !== null && <Candidate campaign={campaign} rows={rows} row={chosenRow} onLeave={() => choose(null)} />}
      <Refusals campaign={campaign} />
      <Validity remarks={rankingRemarks(ranking.value)} isChecked={ranking.value != null}>
        <li class="note">A warning that withholds a verdict holds for a candidate if one of its conditions has it. Make a candidate a fluid: its curve says at which speeds.</li>
      </Validity>
      <NotIncluded text={ranking.value?.not_included} />
    </>
  );
}

const withUnit = (column: Column): string => (column.unit.symbol ? `${column.label}, ${column.unit.symbol}` : column.label);

function Table({ rows, columns, kept, order, chosen, onChoose }: {
  rows: Rows; columns: Column[]; kept: number[]; order: string; chosen: number | null; onChoose: (row: number | null) => void;
}) {
  const [count, setCount] = useState(SHOWN_ROWS);
  const name = order.replace(/^-/, '');
  const sortOf = (column: Column) => (column.name !== name ? undefined : order.startsWith('-') ? 'descending' : 'ascending');
  return (
    <>
      <div class="scroll rows" tabIndex={0} role="region" aria-label="Rows">
        <table>
          <thead>
            <tr>
              <th>Candidate</th>
              {rows.texts.map((each) => <th key={each.name}>{each.name}</th>)}
              {columns.map((column) => (
                <th key={column.name} class="number" aria-sort={sortOf(column)}>
                  <button class="sort" onClick={() => set({ order: sortOf(column) === 'ascending' ? `-${column.name}` : column.name })}>
                    {column.label} <span aria-hidden="true">{{ ascending: '▲', descending: '▼', none: '' }[sortOf(column) ?? 'none']}</span>
                  </button>
                  <small>{column.unit.symbol}&nbsp;</small>
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {kept.slice(0, count).map((row) => (
              <tr key={row} class={row === chosen ? 'chosen' : ''}>
                <th scope="row"><button class="sort" aria-pressed={row === chosen} onClick={() => onChoose(row === chosen ? null : row)}>{rows.candidates[row]}</button>{rows.isWithheld[row] && <small>verdict withheld</small>}</th>
                {rows.texts.map((each) => <td key={each.name}>{each.values[rows.candidates[row]!]}</td>)}
                {columns.map((column) => (
                  <td key={column.name} class="number"><Num value={column.values[row]} unit={column.unit} error={errorOf(rows, column, row)} /></td>
                ))}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
      {kept.length > count && <button onClick={() => setCount(count + SHOWN_ROWS)}>Show {Math.min(SHOWN_ROWS, kept.length - count)} more of {kept.length} rows</button>}
    </>
  );
}

/** What the solver leaves open of a figure, for its rounding. */
function errorOf(rows: Rows, column: Column, row: number): number | undefined {
  if (!/^(inefficiency|mesh_loss|pinion_torque|dynamic)/.test(column.name)) return undefined;
  const value = column.values[row];
  const relative = rows.columns.find((each) => each.name === 'estimated_relative_error')?.values[row];
  return value == null || relative == null ? undefined : Math.abs(value * relative);
}

/** One column against another. */
function Plot({ rows, columns, all, within, chosen, onChoose }: {
  rows: Rows; columns: Column[]; all: number[]; within: (row: number) => boolean; chosen: number | null; onChoose: (row: number) => void;
}) {
  const { query } = useStore(place);
  const inUnits = useStore(units);
  const find = (name: string | null, otherwise: Column | undefined) => columns.find((each) => each.name === name) ?? otherwise;
  const x = find(query.get('x'), columns.find((each) => each.kind === 'candidate') ?? columns[0]);
  const y = find(query.get('y'), columns.find((each) => ['inefficiency_energy_mean_percent', 'traction_coefficient'].includes(each.name)) ?? columns.at(-1));
  // Words of candidates give the colors if there are as many colors.
  const words = rows.texts.find((each) => each.name === query.get('color'));
  const kinds = useMemo(() => [...new Set(words?.values ?? [])].sort(), [words]);
  const dots = useMemo<Dot[]>(() => (!x || !y ? [] : all.flatMap((row) => {
    const [a, b] = [x.values[row], y.values[row]];
    return a == null || b == null ? [] : [{ key: row, x: shown(a, x.unit), y: shown(b, y.unit), series: !within(row) ? -1 : words ? kinds.indexOf(words.values[rows.candidates[row]!]!) : 0 }];
  })), [x, y, all, within, words, inUnits]);
  if (!x || !y) return <p class="muted">No rows are computed yet.</p>;
  const select = (key: 'x' | 'y', words: string, present: Column) => (
    <label class="inline">{words}
      <select value={present.name} onChange={(event) => set({ [key]: event.currentTarget.value })}>
        {columns.map((each) => <option key={each.name} value={each.name}>{withUnit(each)}</option>)}
      </select>
    </label>
  );
  return (
    <figure class="figure" aria-label={`${y.label} against ${x.label}`}>
      <div class="choices">{select('y', 'Upward', y)}{select('x', 'Rightward', x)}
        {rows.texts.length > 0 && (
          <label class="inline">Color
            <select value={words?.name ?? ''} onChange={(event) => set({ color: event.currentTarget.value || undefined })}>
              <option value="">one for all</option>
              {rows.texts.filter((each) => new Set(each.values).size <= MARKERS.length).map((each) => <option key={each.name}>{each.name}</option>)}
            </select>
          </label>
        )}
      </div>
      {words && <ul class="key">{kinds.map((each, k) => <li key={each}><Swatch series={k} /> {each}</li>)}</ul>}
      <Scatter dots={dots} xLabel={withUnit(x)} yLabel={withUnit(y)} height={matchMedia('(max-width: 640px)').matches ? 320 : 440} chosen={chosen} onChoose={onChoose}
        words={(row) => `candidate ${rows.candidates[row]}: ${rounded(shown(y.values[row]!, y.unit))} ${y.unit.symbol}`} />
    </figure>
  );
}

/** Columns whose spread a reader screens by: what candidates differ in, and the main figures. */
const isUsual = (column: Column): boolean =>
  column.kind === 'candidate' || ['inefficiency_energy_mean_percent', 'mesh_loss_power_watts', 'dynamic_transmission_error_maximum_metres', 'film_ratio_minimum', 'contact_temperature_maximum_kelvin',
    'traction_coefficient', 'central_film_thickness_metres', 'contact_temperature_kelvin'].includes(column.name);

function Coordinates({ columns, all, within, ranges, chosen, onRange }: {
  columns: Column[]; all: number[]; within: (row: number) => boolean; ranges: Range[]; chosen: number | null;
  onRange: (column: string, ends: [number, number] | null) => void;
}) {
  const { query } = useStore(place);
  const inUnits = useStore(units);
  const stated = (query.get('axes') ?? '').split(',').filter((each) => each !== '');
  const axisColumns = useMemo(() => (stated.length > 0 ? columns.filter((each) => stated.includes(each.name)) : columns.filter(isUsual).slice(0, MOST_AXES)), [columns, query.get('axes')]);
  const axes = useMemo<Axis[]>(() => axisColumns.flatMap((column) => {
    const extent = extentOf(all.map((row) => column.values[row]));
    if (!extent) return [];
    const range = extent.map((value) => shown(value, column.unit)) as [number, number];
    const brush = ranges.find((each) => each.column === column.name);
    return [{
      key: column.name, label: column.label, unit: column.unit.symbol, range, ends: [rounded(range[0]), rounded(range[1])] as [string, string],
      brush: brush ? [shown(brush.low, column.unit), shown(brush.high, column.unit)] as [number, number] : null,
    }];
  }), [axisColumns, all, ranges, inUnits]);
  const lines = useMemo(() => all.map((row) => ({
    key: row, isWithin: within(row),
    values: axisColumns.filter((column) => axes.some((axis) => axis.key === column.name)).map((column) => {
      const value = column.values[row];
      return value == null ? null : shown(value, column.unit);
    }),
  })), [axisColumns, axes, all, within]);
  const toggle = (name: string) => {
    const present = axisColumns.map((each) => each.name);
    set({ axes: (present.includes(name) ? present.filter((each) => each !== name) : [...present, name]).join(',') || undefined });
  };
  return (
    <figure class="figure" aria-label="Parallel coordinates">
      <p class="small">Each line is a row. Draw along an axis to keep the lines that pass there; a click on it takes the range away.</p>
      <div class="scroll" tabIndex={0} role="region" aria-label="Axes">
        <Parallel axes={axes} lines={lines} height={300} chosen={chosen}
          onBrush={(key, brush) => {
            const { unit } = columns.find((each) => each.name === key)!;
            onRange(key, brush && (brush.map((value) => (value - unit.offset) / unit.factor) as [number, number]));
          }} />
      </div>
      <details class="axes">
        <summary>Axes</summary>
        {columns.map((each) => (
          <label key={each.name} class="choice"><input type="checkbox" checked={axisColumns.includes(each)} onChange={() => toggle(each.name)} /> {each.label}</label>
        ))}
      </details>
    </figure>
  );
}

/** The ranges of columns as fields: what strokes along axes do, by the keyboard. */
function Ranges({ columns, ranges, onRange }: { columns: Column[]; ranges: Range[]; onRange: (column: string, ends: [number, number] | null) => void }) {
  const field = (column: Column, k: 0 | 1) => {
    const range = ranges.find((each) => each.column === column.name);
    const ends: [number, number] = [range?.low ?? -Infinity, range?.high ?? Infinity];
    return (
      <Entry aria-label={`${column.label}, ${k === 0 ? 'least' : 'greatest'}`} inputMode="decimal"
        value={Number.isFinite(ends[k]) ? written(ends[k], column.unit) : ''} placeholder={k === 0 ? 'least' : 'greatest'}
        onChange={(event) => {
          const value = readNumber(event.currentTarget.value, column.unit);
          ends[k] = Number.isNaN(value) ? (k === 0 ? -Infinity : Infinity) : value;
          onRange(column.name, ends.some(Number.isFinite) ? ends : null);
        }} />
    );
  };
  return (
    <details class="ranges" open={ranges.length > 0}>
      <summary>Ranges: rows outside them are left out</summary>
      <div class="range-fields">
        {columns.map((column) => (
          <div key={column.name} role="group" aria-label={column.label}>
            <span>{withUnit(column)}</span>{field(column, 0)}<span class="muted">to</span>{field(column, 1)}
          </div>
        ))}
      </div>
    </details>
  );
}

/** Everything about one candidate at one condition. */
function Candidate({ campaign, rows, row, onLeave }: { campaign: Campaign; rows: Rows; row: number; onLeave: () => void }) {
  const candidate = rows.candidates[row]!;
  const refusal = rows.refusals[row]! > 0 ? campaign.refusals?.[rows.refusals[row]! - 1] : undefined;
  return (
    <section class="read-out" aria-labelledby="candidate">
      <div class="heading"><h2 id="candidate">Candidate {candidate}</h2><button onClick={onLeave}>Leave</button></div>
      {refusal && <Notice kind="caution">{refusal.message}</Notice>}
      {rows.isWithheld[row] && <Notice kind="caution">A warning withholds the verdict on this row: do not rank by it.</Notice>}
      <Promote key={candidate} campaign={campaign} rows={rows} candidate={candidate} />
      <dl class="facts pairs">
        {rows.texts.map((each) => <><dt>{each.name}</dt><dd>{each.values[candidate]}</dd></>)}
        {rows.columns.map((column) => (
          <><dt>{column.label}</dt><dd><Num value={column.values[row]} unit={column.unit} error={errorOf(rows, column, row)} /> {column.unit.symbol}</dd></>
        ))}
      </dl>
    </section>
  );
}

function Refusals({ campaign }: { campaign: Campaign }) {
  if ((campaign.refusals ?? []).length === 0) return null;
  return (
    <details class="validity">
      <summary>Why rows have no figures</summary>
      <ul>{campaign.refusals!.map((each, k) => <li key={k}>{each.message} <span class="code">{each.reason}</span></li>)}</ul>
    </details>
  );
}
