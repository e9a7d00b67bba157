import { Fragment } from 'preact';
import { useMemo, useState } from 'preact/hooks';
import { ApiError, change, get, session, url } from '../api/client';
import type { Campaign, ListSurfacesResponse, Lubricant, Surface } from '../api/types';
import { candidatesOf, characterise, parametersOf, problemOf, roleOf, tableOf, unitOfHeader, unitsOf, type Bases, type Problem, type Role, type Table, type TableColumn } from '../candidates';
import { inputWords } from '../comparison';
import { Failure, Notice } from '../components/notice';
import { Num } from '../components/num';
import { TakeAway } from '../components/take_away';
import { shortTitle } from '../curve';
import { idOf } from '../format';
import { DATA_SHEET } from '../lubricant_fields';
import { useGearSets, useLoaded, useLubricants, useSchema } from '../resources';
import { address, go, place, set } from '../router';
import { useStore } from '../store';
import { celsius, plain, readNumber, scaled, units, written, type Unit } from '../units';

const SHOWN_ROWS = 12;
const MOST_WRONG_ROWS = 100;
const DRAFT = 'campaign table'; // in the storage of the tab: a table survives a reload, not the tab
const MOST_DRAFT = 2_000_000; // characters

const USUAL = { base: 'paper-fluid-1', gear: 'reference-axle', surface: 'run-in', speeds: '20,40,60,80,100,120', sumps: '40,90' };

const EXAMPLE = `name,alpha* [1/GPa],asperity_friction_coefficient,additive,cost_euros_per_kilogram
A-1,14,0.11,A,4.1
A-2,15,0.10,A,4.4
A-3,16,0.09,A,4.8
B-1,14,0.08,B,5.2
B-2,15,0.08,B,5.5
B-3,16,0.07,B,6.0
`;

const numbersOf = (text: string): number[] => text.split(/[,;]\s*|\s+/).filter((each) => each !== '').map(Number);

interface Source {
  name: string;
  text: string;
}

function storedSource(): Source | null {
  try {
    return JSON.parse(sessionStorage.getItem(DRAFT) ?? 'null');
  } catch {
    return null;
  }
}

let checks = 0;

/** Creates a campaign of a table of candidates. The service checks every number, counts the points and estimates the time. */
export function NewCampaign() {
  const { query } = useStore(place);
  useStore(units);
  const lubricants = useLubricants();
  const gearSets = useGearSets();
  const surfaces = useLoaded(async (signal) => (await get<ListSurfacesResponse>(url('surfaces', { page_size: 1000, read_mask: 'name,display_name' }), signal)).surfaces ?? [], 'surfaces');
  const schema = useSchema();
  const setting = (name: keyof typeof USUAL): string => query.get(name) ?? USUAL[name];
  const [base, gear, surface, speedText, sumpText] = [setting('base'), setting('gear'), setting('surface'), setting('speeds'), setting('sumps')];
  const bases = useLoaded<Bases>(async (signal) => {
    const [lubricant, found] = await Promise.all([get<Lubricant>(url(`lubricants/${base}`), signal), get<Surface>(url(`surfaces/${surface}`), signal)]);
    return { lubricant, surface: found };
  }, `${base} ${surface}`);
  const [source, setSource] = useState<Source | null>(storedSource);
  const [title, setTitle] = useState('');
  const [chosen, setChosen] = useState<Record<number, { role?: Role; unit?: string }>>({});
  const [busy, setBusy] = useState(false);
  const [problem, setProblem] = useState<unknown>(null);

  const take = (next: Source | null) => {
    setSource(next);
    setChosen({});
    setProblem(null);
    if (next && next.text.length <= MOST_DRAFT) sessionStorage.setItem(DRAFT, JSON.stringify(next));
    else sessionStorage.removeItem(DRAFT);
  };
  const constraints = schema.value?.constraints;
  const parameters = useMemo(() => parametersOf(schema.value?.vocabularies), [schema.value]);
  const table = useMemo(() => (source ? tableOf(source.text) : null), [source]);
  const columns = useMemo<TableColumn[]>(() => (table && parameters.length > 0 ? table.header.map((header, k) => {
    const role = chosen[k]?.role ?? roleOf(header, parameters);
    const allowed = unitsOf(role, constraints);
    const stated = chosen[k]?.unit;
    return { role, unit: stated === undefined ? unitOfHeader(header, role, allowed) : allowed.find((each) => each.symbol === stated) };
  }) : []), [table, parameters, chosen]);
  const candidates = useMemo(() => (table && bases.value && columns.length > 0 ? candidatesOf(table, columns, bases.value) : null), [table, columns, bases.value]);
  const [speeds, sumps] = [numbersOf(speedText), numbersOf(sumpText)];
  const hasContact = query.get('contact') === '1';
  const by = (query.get('by') ?? '').split(',').filter((each) => each !== '');
  const isWhole = candidates !== null && candidates.problems.length === 0 && table!.rows.length > 0 && columns.some(({ role }) => /^(parameter|measured):/.test(role));
  const key = useMemo(() => `check ${++checks}`, [candidates, query]);
  // The service checks the request and estimates its cost; it computes nothing.
  const check = useLoaded(async (signal) => {
    if (!isWhole) return null;
    const given = await characterise(candidates, bases.value!, parameters, signal);
    const body: Campaign = {
      lubricant: `lubricants/${base}`, gear_set: `gearSets/${gear}`, surface: `surfaces/${surface}`,
      candidate_columns: given.columns, candidate_attributes: given.attributes,
      conditions: sumps.flatMap((sump) => speeds.map((speed) => ({ speed_kilometres_per_hour: speed, sump_temperature_celsius: sump }))),
      contact_figures: hasContact, elasticity_parameters: by,
    };
    try {
      return { body, answer: await change<Campaign>('POST', url('campaigns', { validate_only: 'true' }), body, signal) };
    } catch (refusal) {
      if (refusal instanceof ApiError) Object.assign(refusal, { candidates: given });
      throw refusal;
    }
  }, key);
  const refusal = check.error instanceof ApiError ? check.error : null;
  const violations = refusal?.violations ?? [];
  const placed = table && candidates ? violations.map((each) => ({ each, at: problemOf(each.field, each.description, table, columns, (refusal as ApiError & { candidates?: typeof candidates }).candidates ?? candidates) })) : [];
  const problems = [...(candidates?.problems ?? []), ...placed.flatMap(({ at }) => at ?? [])];
  const fieldProblem = (field: string) => violations.find((each) => each.field.includes('conditions') && each.field.includes(field))?.description;
  const elsewhere = placed.filter(({ each, at }) => at === undefined && !/conditions\[\d+\]\.(speed|sump)/.test(each.field)).map(({ each }) => each);
  const isReady = isWhole && !check.isStale && check.error === undefined && check.value != null;
  const isReader = session.value?.scope === 'read';

  const create = async (event: SubmitEvent) => {
    event.preventDefault();
    if (!isReady) return;
    setBusy(true);
    try {
      const made = await change<Campaign>('POST', url('campaigns'), { ...check.value!.body, display_name: title || source!.name.replace(/\.\w+$/, '') });
      sessionStorage.removeItem(DRAFT);
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
        <input value={numbersOf(setting(name)).map((each) => written(each, unit)).join(', ')} title="several with commas between them" inputMode="decimal" aria-invalid={wrong !== undefined}
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
  const differing = columns.flatMap(({ role }) => (role.startsWith('parameter:') ? [role.slice('parameter:'.length)] : []));
  return (
    <form class="with-panel" onSubmit={(event) => void create(event)} noValidate>
      <aside class="panel" aria-label="Campaign">
        <fieldset>
          <legend>What candidates are like</legend>
          {select('base', 'Base fluid', lubricants.value)}
          {select('gear', 'Gear set', gearSets.value)}
          {select('surface', 'Surface', surfaces.value)}
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
          {differing.map((path) => (
            <label key={path} class="choice">
              <input type="checkbox" checked={by.includes(path)} onChange={() => set({ by: (by.includes(path) ? by.filter((each) => each !== path) : [...by, path]).join(',') || undefined })} />
              <span>Sensitivity by {inputWords(path)}</span>
            </label>
          ))}
        </fieldset>
        <label>Name<input value={title} placeholder={source?.name.replace(/\.\w+$/, '') ?? ''} onInput={(event) => setTitle(event.currentTarget.value)} /></label>
        <button class="primary wide" disabled={!isReady || busy || isReader}>{busy ? 'Creating …' : 'Create the campaign'}</button>
        {isReader && <p class="small">Your token reads only.</p>}
      </aside>
      <div>
        <div class="heading">
          <h1>New campaign</h1>
          {isReady && <TakeAway name="campaign" requests={check.value!.body} commands={[]} />}
        </div>
        {problem !== null && <Failure error={problem} />}
        {bases.error !== undefined && <Failure error={bases.error} onRetry={bases.reload} />}
        {!table && <Intake onTake={take} />}
        {table && (
          <>
            <p role="status" class={isReady ? 'estimate' : 'estimate muted'}>
              {isReady ? <Estimate answer={check.value!.answer} />
                : problems.length > 0 ? `${problems.length} ${problems.length === 1 ? 'mistake' : 'mistakes'} in the table`
                : table.rows.length === 0 ? 'The table has no rows.'
                : candidates && !isWhole ? 'No column is a parameter or of a data sheet: say below what a column is.'
                : check.error !== undefined ? 'The request is refused.' : 'Checking …'}
            </p>
            {elsewhere.length > 0 && <Notice kind="error">{elsewhere.map((each) => <p key={each.field}>{each.field.replace(/^campaign\./, '')}: {each.description}</p>)}</Notice>}
            {check.error !== undefined && violations.length === 0 && <Failure error={check.error} onRetry={check.reload} />}
            {candidates && candidates.measurements.length > 0 && (
              <p class="small">The service estimates what a data sheet does not state, as for an oil that is entered, with the base oil of the base fluid.</p>
            )}
            {columns.length > 0 && <TableForm table={table} columns={columns} parameters={parameters} unitsOf={(role) => unitsOf(role, constraints)} problems={problems}
              onChange={(column, next) => setChosen((old) => ({ ...old, [column]: next }))} />}
            <button type="button" onClick={() => take(null)}>Take the table away</button>
          </>
        )}
      </div>
    </form>
  );
}

/** Where a table comes in: dropped, chosen, pasted. */
function Intake({ onTake }: { onTake: (source: Source) => void }) {
  const [isOver, setOver] = useState(false);
  const read = async (file: File | undefined) => {
    setOver(false);
    if (file) onTake({ name: file.name, text: await file.text() });
  };
  return (
    <>
      <label class={`drop ${isOver ? 'over' : ''}`}
        onDragOver={(event) => { event.preventDefault(); setOver(true); }} onDragLeave={() => setOver(false)}
        onDrop={(event) => { event.preventDefault(); void read(event.dataTransfer?.files[0]); }}>
        <input type="file" accept=".csv,.tsv,.txt,text/csv" onChange={(event) => void read(event.currentTarget.files?.[0])} />
        <span>Drop a CSV of candidates here, or choose one</span>
      </label>
      <label class="paste">Or paste it from a spreadsheet
        <textarea rows={6} spellcheck={false} onInput={(event) => event.currentTarget.value.trim() !== '' && onTake({ name: 'pasted', text: event.currentTarget.value })} />
      </label>
      <section class="small">
        <p>A row for each candidate. A column is a parameter of the lubricant or of the surface, with its unit in brackets, e.g. <code>alpha* [1/GPa]</code>; or what a data sheet says, e.g. <code>KV40</code>; or the candidates' <code>name</code>. Every other column, such as an additive or a cost, rides along.</p>
        <button type="button" onClick={() => onTake({ name: 'example', text: EXAMPLE })}>Show an example</button>
      </section>
    </>
  );
}

/** The unit in which a time is read with ease. */
const timeUnit = (seconds: number): Unit => (seconds < 90 ? plain('s') : seconds < 5400 ? scaled('min', 1 / 60) : scaled('h', 1 / 3600));

function Estimate({ answer }: { answer: Campaign }) {
  const seconds = answer.cost_estimate?.processor_seconds ?? 0;
  const unit = timeUnit(seconds);
  return (
    <>
      <strong><span data-value={answer.candidates}>{answer.candidates}</span></strong> candidates at {answer.conditions!.length} conditions are{' '}
      <strong><span data-value={answer.points}>{answer.points}</span></strong> points; they take about <strong><Num value={seconds} unit={unit} error={0.05 * seconds} /> {unit.symbol}</strong> of one processor.
    </>
  );
}

/** The role of each column, and the faulty rows with their faults. */
function TableForm({ table, columns, parameters, unitsOf: allowedUnits, problems, onChange }: {
  table: Table; columns: TableColumn[]; parameters: string[]; unitsOf: (role: Role) => Unit[]; problems: Problem[];
  onChange: (column: number, next: { role?: Role; unit?: string }) => void;
}) {
  const wrong = [...new Set(problems.map((each) => each.row).filter((row) => row >= SHOWN_ROWS))].sort((a, b) => a - b).slice(0, MOST_WRONG_ROWS);
  const rows = [...table.rows.keys()].slice(0, SHOWN_ROWS).concat(wrong);
  const textsAt = (row: number, column: number) => problems.filter((each) => each.row === row && each.column === column).map((each) => each.text);
  const Texts = ({ row, column }: { row: number; column: number }) => <>{textsAt(row, column).map((text) => <span key={text} class="problem" role="alert">{text}</span>)}</>;
  const group = (kind: string, words: (path: string) => string, paths: string[]) => paths.map((path) => <option key={path} value={`${kind}:${path}`}>{words(path)}</option>);
  return (
    <div class="scroll rows" tabIndex={0} role="region" aria-label="Table of candidates">
      <table class="candidates">
        <thead>
          <tr><th>Row</th>{table.header.map((header, k) => <th key={k}>{header}<Texts row={-1} column={k} /></th>)}</tr>
          <tr>
            <td>is</td>
            {columns.map(({ role }, k) => (
              <td key={k}>
                <select aria-label={`What ${table.header[k]} is`} value={role} onChange={(event) => onChange(k, { role: event.currentTarget.value as Role })}>
                  <option value="attribute">rides along</option>
                  <option value="name">name of the candidate</option>
                  <option value="">left out</option>
                  <optgroup label="Parameter of the lubricant">{group('parameter', inputWords, parameters.filter((each) => each.startsWith('lubricant.')))}</optgroup>
                  <optgroup label="Parameter of the surface">{group('parameter', inputWords, parameters.filter((each) => each.startsWith('surface.')))}</optgroup>
                  <optgroup label="Data sheet">{DATA_SHEET.map((each) => <option key={each.field} value={`measured:${each.field}`}>{each.label}</option>)}</optgroup>
                  <optgroup label="Standard uncertainty">{group('uncertainty', (path) => `± ${inputWords(path)}`, parameters)}</optgroup>
                </select>
              </td>
            ))}
          </tr>
          <tr>
            <td>in</td>
            {columns.map(({ role, unit }, k) => {
              const all = allowedUnits(role);
              return (
                <td key={k}>
                  {all.length > 0 && (
                    <select aria-label={`Unit of ${table.header[k]}`} aria-invalid={!unit} value={unit?.symbol ?? ''} onChange={(event) => onChange(k, { role, unit: event.currentTarget.value })}>
                      {!unit && <option value="">which unit?</option>}
                      {all.map((each) => <option key={each.symbol}>{each.symbol}</option>)}
                    </select>
                  )}
                </td>
              );
            })}
          </tr>
        </thead>
        <tbody>
          {rows.map((row) => (
            <Fragment key={row}>
              <tr>
                <th scope="row">{table.rows[row]!.line}</th>
                {table.header.map((_, k) => <td key={k} class={textsAt(row, k).length > 0 ? 'wrong' : ''}>{table.rows[row]!.cells[k]}<Texts row={row} column={k} /></td>)}
              </tr>
              {textsAt(row, -1).length > 0 && <tr><td /><td colSpan={table.header.length} class="wrong"><Texts row={row} column={-1} /></td></tr>}
            </Fragment>
          ))}
        </tbody>
      </table>
      {table.rows.length > rows.length && <p class="small">and {table.rows.length - rows.length} more rows</p>}
    </div>
  );
}
