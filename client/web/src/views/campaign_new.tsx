import { useMemo, useState } from 'preact/hooks';
import { ApiError, change, get, session, url } from '../api/client';
import type { Campaign, ListSurfacesResponse, Lubricant, Surface } from '../api/types';
import { characterise, parametersOf, unitsOf, type Bases } from '../candidates';
import { inputWords } from '../inputs';
import { Entry } from '../components/entry';
import { PresetChoice } from '../components/model_choice';
import { Failure, Notice } from '../components/notice';
import { TakeAway } from '../components/take_away';
import { shortTitle } from '../curve';
import { designBody, designProblems, USUAL_DESIGN, type Design } from '../design';
import { idOf } from '../format';
import { labelsOf } from '../labels';
import { modelBodyOf, modelQueryOf, modelRequestOf } from '../model';
import { useGearSets, useLoaded, useLubricants, useSchema } from '../resources';
import { address, go, place, set } from '../router';
import { useStore } from '../store';
import { celsius, plain, readNumber, units, written, type Unit } from '../units';
import { DesignForm } from './candidate_design';
import { FluidChoice, FluidFilter } from './candidate_fluids';
import { Estimate, Intake, storedDraft, TableForm, tableProblems, tableWords, useTable } from './candidate_table';

// Drafts, in the storage of the tab.
const TABLE = 'campaign table';
const DESIGN = 'campaign design';

const USUAL = { base: 'paper-fluid-1', gear: 'reference-axle', surface: 'run-in', speeds: '20,40,60,80,100,120', sumps: '40,90' };

/** Where candidates come from. */
const SOURCES = [['table', 'A table'], ['fluids', 'Fluids of the database'], ['filter', 'Fluids by a filter'], ['design', 'A design']] as const;
type SourceKind = (typeof SOURCES)[number][0];

const numbersOf = (text: string): number[] => text.split(/[,;]\s*|\s+/).filter((each) => each !== '').map(Number);
const wordsOf = (text: string | null): string[] => (text ?? '').split(',').filter((each) => each !== '');

let checks = 0;

/** Creates a campaign. The service checks every number, counts the points and estimates the time. */
export function NewCampaign() {
  const { query } = useStore(place);
  useStore(units);
  const lubricants = useLubricants();
  const gearSets = useGearSets();
  const surfaces = useLoaded(async (signal) => (await get<ListSurfacesResponse>(url('surfaces', { page_size: 1000, read_mask: 'name,display_name' }), signal)).surfaces ?? [], 'surfaces');
  const schema = useSchema();
  const setting = (name: keyof typeof USUAL): string => query.get(name) ?? USUAL[name];
  const [base, gear, surface, speedText, sumpText] = [setting('base'), setting('gear'), setting('surface'), setting('speeds'), setting('sumps')];
  const kind: SourceKind = SOURCES.find(([id]) => id === query.get('from'))?.[0] ?? 'table';
  const bases = useLoaded<Bases>(async (signal) => {
    const [lubricant, found] = await Promise.all([get<Lubricant>(url(`lubricants/${base}`), signal), get<Surface>(url(`surfaces/${surface}`), signal)]);
    return { lubricant, surface: found };
  }, `${base} ${surface}`);
  const [title, setTitle] = useState('');
  const [labels, setLabels] = useState('');
  const [busy, setBusy] = useState(false);
  const [problem, setProblem] = useState<unknown>(null);
  const constraints = schema.value?.constraints;
  const parameters = useMemo(() => parametersOf(schema.value?.vocabularies), [schema.value]);
  const state = useTable(TABLE, bases.value, parameters, constraints);
  const [design, setDesign] = useState<Design>(() => storedDraft<Design>(DESIGN) ?? USUAL_DESIGN);
  const designed = useMemo(() => designBody(design, constraints), [design, constraints]);
  const fluids = wordsOf(query.get('of'));
  const filter = query.get('filter') ?? '';

  const [speeds, sumps] = [numbersOf(speedText), numbersOf(sumpText)];
  const hasContact = query.get('contact') === '1';
  const { preset } = modelRequestOf(query);
  const varied = kind === 'design' ? design.factors.map((each) => each.parameter)
    : kind === 'table' ? state.columns.flatMap(({ role }) => (role.startsWith('parameter:') ? [role.slice('parameter:'.length)] : [])) : [];
  const by = wordsOf(query.get('by')).filter((each) => varied.includes(each));
  const isWhole = {
    table: state.isWhole, fluids: fluids.length > 0, filter: filter !== '',
    design: constraints !== undefined && designed.problems.length === 0 && (design.method !== 'GRID' || design.factors.length > 0),
  }[kind];
  const key = useMemo(() => `check ${++checks}`, [kind === 'table' ? state.candidates : kind === 'design' ? designed : null, query, labels]);
  // The service checks the request and estimates its cost; it computes nothing.
  const check = useLoaded(async (signal) => {
    if (!isWhole) return null;
    const body: Campaign = {
      gear_set: `gearSets/${gear}`, surface: `surfaces/${surface}`,
      conditions: sumps.flatMap((sump) => speeds.map((speed) => ({ speed_kilometres_per_hour: speed, sump_temperature_celsius: sump }))),
      contact_figures: hasContact, elasticity_parameters: by, labels: labelsOf(labels), ...modelBodyOf({ preset, options: [] }),
    };
    // Without a base, the first one of candidates that are lubricants is it.
    if (kind === 'table' || kind === 'design') body.lubricant = `lubricants/${base}`;
    const given = kind === 'table' ? await characterise(state.candidates!, bases.value!, parameters, signal) : undefined;
    if (given) Object.assign(body, { candidate_columns: given.columns, candidate_attributes: given.attributes });
    if (kind === 'fluids') body.candidate_lubricants = fluids.map((each) => `lubricants/${each}`);
    if (kind === 'filter') body.lubricant_filter = filter;
    if (kind === 'design') body.candidate_design = designed.body;
    try {
      return { body, answer: await change<Campaign>('POST', url('campaigns', { validate_only: 'true' }), body, signal) };
    } catch (refusal) {
      if (refusal instanceof ApiError && given) Object.assign(refusal, { candidates: given });
      throw refusal;
    }
  }, key);
  const refusal = check.error instanceof ApiError ? check.error : null;
  const violations = refusal?.violations ?? [];
  const { problems, elsewhere } = kind === 'table' ? tableProblems(state, refusal) : { problems: [], elsewhere: violations };
  const fieldProblem = (field: string) => violations.find((each) => each.field.includes('conditions') && each.field.includes(field))?.description;
  const labelProblem = violations.find((each) => /^campaign\.labels/.test(each.field))?.description;
  const filterProblem = violations.find((each) => each.field === 'campaign.lubricant_filter')?.description;
  const fluidProblem = (id: string) => violations.find((each) => each.field === `campaign.candidate_lubricants[${fluids.indexOf(id)}]`)?.description;
  const isAtField = (field: string) => /conditions\[\d+\]\.(speed|sump)|^campaign\.labels/.test(field)
    || (kind === 'design' && field.includes('candidate_design')) || (kind === 'filter' && field.endsWith('lubricant_filter')) || (kind === 'fluids' && /candidate_lubricants\[\d+\]/.test(field));
  const others = elsewhere.filter((each) => !isAtField(each.field));
  const isReady = isWhole && !check.isStale && check.error === undefined && check.value != null;
  const isReader = session.value?.scope === 'read';
  const usualTitle = { table: state.source?.name.replace(/\.\w+$/, '') ?? '', fluids: 'Fluids', filter, design: `${design.method === 'GRID' ? 'Grid' : 'Design'} of ${varied.length} ${varied.length === 1 ? 'factor' : 'factors'}` }[kind];
  const words = {
    table: tableWords(state, problems), fluids: fluids.length === 0 ? 'Choose the fluids to be screened.' : '',
    filter: filter === '' ? 'State a filter.' : '',
    design: designed.problems.length > 0 ? 'A number is missing its form.' : design.method === 'GRID' && design.factors.length === 0 ? 'A grid has at least one factor.' : '',
  }[kind];

  const create = async (event: SubmitEvent) => {
    event.preventDefault();
    if (!isReady) return;
    setBusy(true);
    try {
      const made = await change<Campaign>('POST', url('campaigns'), { ...check.value!.body, display_name: title || usualTitle });
      sessionStorage.removeItem({ table: TABLE, design: DESIGN, fluids: '', filter: '' }[kind]);
      go(address(`/campaigns/${idOf(made.name)}`));
    } catch (failure) {
      setProblem(failure);
      setBusy(false);
    }
  };
  const list = (name: 'speeds' | 'sumps', label: string, field: string, unit: Unit) => {
    const wrong = fieldProblem(field);
    return (
      <label>
        {label}
        <Entry value={numbersOf(setting(name)).map((each) => written(each, unit)).join(', ')} title="several with commas between them" inputMode="decimal" aria-invalid={wrong !== undefined}
          onChange={(event) => {
            const values = event.currentTarget.value.split(/[,;]\s*|\s+/).map((each) => readNumber(each, unit)).filter((value) => !Number.isNaN(value)).join(',');
            if (values !== '') set({ [name]: values === USUAL[name] ? undefined : values });
          }} />
        {wrong && <span class="problem" role="alert">{wrong}</span>}
      </label>
    );
  };
  const select = (name: 'base' | 'gear' | 'surface', label: string, all: { name?: string; display_name?: string }[] | undefined) => (
    <label>
      {label}
      <select value={setting(name)} onChange={(event) => set({ [name]: event.currentTarget.value === USUAL[name] ? undefined : event.currentTarget.value })}>
        {(all ?? []).map((each) => <option key={each.name} value={idOf(each.name)}>{shortTitle(each.display_name || idOf(each.name))}</option>)}
      </select>
    </label>
  );
  return (
    <form class="with-panel" onSubmit={(event) => void create(event)} noValidate>
      <aside class="panel" aria-label="Campaign">
        <fieldset>
          <legend>What candidates are like</legend>
          {kind === 'fluids' || kind === 'filter' ? <p class="small">Each candidate is a fluid as it is; all have the pressure law of the first.</p> : select('base', 'Base fluid', lubricants.value)}
          {select('gear', 'Gear set', gearSets.value)}
          {select('surface', 'Surface', surfaces.value)}
          <PresetChoice preset={preset} onChange={(next) => set(modelQueryOf({ preset: next, options: [] }))} />
        </fieldset>
        <fieldset>
          <legend>Conditions: each speed at each sump</legend>
          {list('speeds', 'Speeds, km/h', 'speed_kilometres_per_hour', plain('km/h'))}
          {list('sumps', `Sumps, ${celsius.symbol}`, 'sump_temperature_celsius', celsius)}
        </fieldset>
        <fieldset>
          <legend>Figures</legend>
          <p class="small">Always: inefficiency, loss, torque and transmission error.</p>
          <label class="choice"><input type="checkbox" checked={hasContact} onChange={() => set({ contact: hasContact ? undefined : '1' })} /> <span>Film, pressure and temperature of the contacts</span></label>
          {varied.map((path) => (
            <label key={path} class="choice">
              <input type="checkbox" checked={by.includes(path)} onChange={() => set({ by: (by.includes(path) ? by.filter((each) => each !== path) : [...by, path]).join(',') || undefined })} />
              <span>Sensitivity by {inputWords(path)}</span>
            </label>
          ))}
        </fieldset>
        <label>Name<input value={title} placeholder={usualTitle} onInput={(event) => setTitle(event.currentTarget.value)} /></label>
        <label>Labels
          <Entry value={labels} placeholder="project=axle, series=b" aria-invalid={labelProblem !== undefined} onChange={(event) => setLabels(event.currentTarget.value)} />
          {labelProblem && <span class="problem" role="alert">{labelProblem}</span>}
        </label>
        <button class="primary wide" disabled={!isReady || busy || isReader}>{busy ? 'Creating …' : 'Create the campaign'}</button>
        {isReader && <p class="small">Your token reads only.</p>}
      </aside>
      <div>
        <div class="heading">
          <h1>New campaign</h1>
          {isReady && <TakeAway name="campaign" requests={check.value!.body} commands={[]} />}
        </div>
        <div class="tabs" role="group" aria-label="Where candidates come from">
          {SOURCES.map(([id, label]) => <button key={id} type="button" aria-pressed={id === kind} onClick={() => set({ from: id === 'table' ? undefined : id })}>{label}</button>)}
        </div>
        {problem !== null && <Failure error={problem} />}
        {bases.error !== undefined && <Failure error={bases.error} onRetry={bases.reload} />}
        {(kind !== 'table' || state.table) && (
          <p role="status" class={isReady ? 'estimate' : 'estimate muted'}>
            {isReady ? <Estimate answer={check.value!.answer} /> : words || (check.error !== undefined ? 'The request is refused.' : 'Checking …')}
          </p>
        )}
        {others.length > 0 && <Notice kind="error">{others.map((each) => <p key={each.field}>{each.field.replace(/^campaign\./, '')}: {each.description}</p>)}</Notice>}
        {check.error !== undefined && violations.length === 0 && <Failure error={check.error} onRetry={check.reload} />}
        {kind === 'fluids' && <FluidChoice chosen={fluids} onChange={(ids) => set({ of: ids.join(',') || undefined })} problemOf={fluidProblem} />}
        {kind === 'filter' && <FluidFilter filter={filter} onChange={(text) => set({ filter: text || undefined })} problem={filterProblem} />}
        {kind === 'design' && (
          <DesignForm design={design} parameters={parameters} constraints={constraints} bases={bases.value} problems={[...designed.problems, ...designProblems(violations)]}
            onChange={(next) => {
              setDesign(next);
              sessionStorage.setItem(DESIGN, JSON.stringify(next));
            }} />
        )}
        {kind === 'table' && !state.table && <Intake onTake={state.take} hasExample />}
        {kind === 'table' && state.table && (
          <>
            {state.columns.length > 0 && <TableForm table={state.table} columns={state.columns} parameters={parameters} unitsOf={(role) => unitsOf(role, constraints)} problems={problems} onChange={state.choose} />}
            <button type="button" onClick={() => state.take(null)}>Take the table away</button>
          </>
        )}
      </div>
    </form>
  );
}
