import { useEffect, useRef, useState } from 'preact/hooks';
import { ApiError, atField, change, get, session, url, type Violation } from '../api/client';
import type { BoundaryFrictionAtTemperature, ListLubricantsResponse, Lubricant } from '../api/types';
import { Entry } from '../components/entry';
import { Missing } from '../components/missing';
import { Failure } from '../components/notice';
import { Validity } from '../components/validity';
import { remarkOf } from '../validity';
import { ago, idOf, rounded } from '../format';
import { celsius, readNumber, shown, units, written } from '../units';
import { LawMapView, Viscosity } from './fluid_laws';
import { ALL_FIELDS, BASE_OILS, BOUNDARY, constraintOf, DATA_SHEET, DOCUMENTED, PARAMETERS, PRESSURE_LAW, rangeText, unitOf, valueOf, type Field } from '../lubricant_fields';
import { PROVENANCE } from '../provenance';
import { useLoaded, useSchema } from '../resources';
import { address, go, place, set } from '../router';
import { useStore } from '../store';

export function Fluids() {
  const { path } = useStore(place);
  const [, , id, action] = path.split('/');
  if (!id) return <FluidList />;
  if (id === 'new') return <FluidForm key="new" />;
  return action === 'edit' ? <EditFluid key={id} id={id} /> : <FluidPage key={id} id={id} />;
}

const LISTED = 'name,display_name,characterisation,revision,provenance.provenance';
const MOST_LISTED = 1000;

/** A search as a filter of the service: words of names, unless it is a filter itself, such as "kv100 > 14". */
const filterOf = (search: string): string | undefined => (search === '' ? undefined : /[<>=:]/.test(search) ? search : `display_name : ${JSON.stringify(search)}`);

/** The origins of the parameters of a fluid, each once. */
const originsOf = (lubricant: Lubricant): string =>
  [...new Set((lubricant.provenance ?? []).map((each) => PROVENANCE[each.provenance ?? ''] ?? ''))].filter((each) => each !== '').sort().join(', ');

const COLUMNS: { field: string; label: string; unit?: string; of: (lubricant: Lubricant) => string }[] = [
  { field: 'kv40', label: 'KV40', unit: 'mm²/s', of: (each) => rounded(each.characterisation?.kinematic_viscosity_40_celsius_square_millimetres_per_second) },
  { field: 'kv100', label: 'KV100', unit: 'mm²/s', of: (each) => rounded(each.characterisation?.kinematic_viscosity_100_celsius_square_millimetres_per_second) },
  { field: 'vi', label: 'VI', of: (each) => rounded(each.characterisation?.viscosity_index) },
  { field: 'density', label: 'Density, 15 °C', unit: 'kg/m³', of: (each) => rounded(each.characterisation?.density_15_celsius_kilograms_per_cubic_metre) },
];

function FluidList() {
  const { query } = useStore(place);
  const search = query.get('q') ?? '';
  const order = query.get('sort') ?? '';
  const field = order.replace(/^-/, '');
  const list = useLoaded((signal) => get<ListLubricantsResponse>(url('lubricants', {
    page_size: MOST_LISTED, read_mask: LISTED, filter: filterOf(search), order_by: order === '' ? undefined : order.startsWith('-') ? `${field} desc` : field,
  }), signal), `${search} ${order}`);
  const [chosen, setChosen] = useState<string[]>([]);
  const toggle = (id: string) => setChosen((old) => (old.includes(id) ? old.filter((each) => each !== id) : [...old, id]));
  const violation = list.error instanceof ApiError ? list.error.violations.find((each) => each.field === 'filter') : undefined;
  const fluids = list.value?.lubricants ?? [];
  const header = (name: string, label: string, unit?: string) => {
    const sort = field !== name ? undefined : order.startsWith('-') ? 'descending' : 'ascending';
    return (
      <th key={name} class={name === 'name' ? '' : 'number'} aria-sort={sort}>
        <button class="sort" onClick={() => set({ sort: sort === 'ascending' ? `-${name}` : name })}>
          {label} <span aria-hidden="true">{{ ascending: '▲', descending: '▼', none: '' }[sort ?? 'none']}</span>
        </button>
        {unit && <small>{unit}</small>}
      </th>
    );
  };
  return (
    <>
      <div class="heading">
        <h1>Fluids</h1>
        <div class="actions">
          {chosen.length === 2 && <a class="button" href={address('/compare', { a: chosen[0], b: chosen[1] })}>Compare the two</a>}
          {chosen.length > 0 && <a class="button primary" href={address('/curves', { f: chosen.join(',') })}>Curve of {chosen.length}</a>}
          <a class="button" href={address('/fluids/new')}>Enter an oil</a>
        </div>
      </div>
      <label class="search">Search names, or state a filter
        <Entry type="search" value={search} placeholder="PAO, or kv100 > 14 AND vi > 150" spellcheck={false} aria-invalid={violation !== undefined}
          onChange={(event) => set({ q: event.currentTarget.value.trim() || undefined })} />
        {violation && <span class="problem" role="alert">{violation.description}</span>}
      </label>
      {list.error !== undefined && !violation && <Failure error={list.error} onRetry={list.reload} />}
      {list.value && !list.isStale && fluids.length === 0 && <p class="muted">No fluid is like that. <button onClick={() => set({ q: undefined })}>Show all fluids</button></p>}
      <div class={`scroll ${list.isStale ? 'stale' : ''}`} tabIndex={0} role="region" aria-label="Fluids">
        <table>
          <thead>
            <tr>
              <th><span class="hidden">Choose</span></th>{header('name', 'Name')}<th>Grade</th>
              {COLUMNS.map((each) => header(each.field, each.label, each.unit))}
              <th>Parameters are</th><th class="number">Revision</th>
            </tr>
          </thead>
          <tbody>
            {fluids.map((each) => {
              const id = idOf(each.name);
              const [title, note] = (each.display_name || id).split(': ');
              return (
                <tr key={id}>
                  <td><input type="checkbox" aria-label={`Choose ${title}`} checked={chosen.includes(id)} onChange={() => toggle(id)} /></td>
                  <td><a href={address(`/fluids/${id}`)}>{title}</a><small>{note ?? ''}</small></td>
                  <td>{each.characterisation?.sae_j306_grade || <span class="muted">–</span>}</td>
                  {COLUMNS.map((column) => <td key={column.field} class="number">{column.of(each)}</td>)}
                  <td class="muted">{originsOf(each)}</td>
                  <td class="number">{each.revision}</td>
                </tr>
              );
            })}
          </tbody>
        </table>
      </div>
      {list.value?.next_page_token && <p class="small">The list holds {MOST_LISTED} fluids: a search finds the others.</p>}
    </>
  );
}

const useLubricant = (id: string) => useLoaded((signal) => get<Lubricant>(url(`lubricants/${id}`), signal), `lubricant ${id}`);

const REFERENCE = 'paper-fluid-1'; // that a new oil is compared with first

const TABS: [string, string][] = [['', 'Parameters'], ['viscosity', 'Viscosity'], ['film', 'Film map'], ['traction', 'Traction map']];

function FluidPage({ id }: { id: string }) {
  const tab = useStore(place).query.get('tab') ?? '';
  const { value: lubricant, error, reload } = useLubricant(id);
  const schema = useSchema();
  if (error !== undefined && (error as ApiError).status === 404) return <Missing />;
  if (error !== undefined) return <Failure error={error} onRetry={reload} />;
  if (!lubricant) return <p class="muted">Loading …</p>;
  const figures = lubricant.characterisation ?? {};
  const origin = new Map((lubricant.provenance ?? []).map((each) => [each.field, each]));
  const row = (field: Field) => {
    const value = valueOf(lubricant, field);
    if (value === undefined) return null;
    const unit = unitOf(field, constraintOf(field, schema.value?.constraints));
    const source = origin.get(field.field);
    const spread = source?.standard_uncertainty ? source.standard_uncertainty * unit.factor : undefined;
    return (
      <tr key={field.path}>
        <th scope="row">{field.label}</th>
        <td class="number" data-exact={value}>{written(value, unit).length > 8 ? rounded(shown(value, unit), spread) : written(value, unit)}</td>
        <td class="number">{spread === undefined ? '' : rounded(spread, spread)}</td>
        <td>{unit.symbol}</td>
        <td>{source ? PROVENANCE[source.provenance ?? ''] ?? '' : ''}</td>
        <td class="muted">{source?.source}</td>
      </tr>
    );
  };
  const [title, note] = (lubricant.display_name || id).split(': ');
  const plainId = idOf(lubricant.name);
  return (
    <>
      <div class="heading">
        <div><h1>{title} <span class="count">{note}</span></h1><p class="muted">{plainId}, revision {lubricant.revision}, {ago(lubricant.revision_create_time)}</p></div>
        <div class="actions">
          <a class="button primary" href={address('/curves', { f: id })}>Run a curve</a>
          <a class="button" href={address('/compare', { a: plainId === REFERENCE ? undefined : REFERENCE, b: id })}>Compare</a>
          {session.value?.scope !== 'read' && <a class="button" href={address(`/fluids/${plainId}/edit`)}>Edit</a>}
        </div>
      </div>
      {lubricant.description && <p>{lubricant.description}</p>}
      <ul class="figures">
        <li><span>KV40</span><strong>{rounded(figures.kinematic_viscosity_40_celsius_square_millimetres_per_second)}</strong> mm²/s</li>
        <li><span>KV100</span><strong>{rounded(figures.kinematic_viscosity_100_celsius_square_millimetres_per_second)}</strong> mm²/s</li>
        <li><span>Viscosity index</span><strong>{rounded(figures.viscosity_index)}</strong></li>
        <li><span>Density, 15 °C</span><strong>{rounded(figures.density_15_celsius_kilograms_per_cubic_metre)}</strong> kg/m³</li>
        <li><span>SAE J306</span><strong>{figures.sae_j306_grade || '–'}</strong></li>
      </ul>
      {figures.sae_j306_grade_note && <p class="muted small">{figures.sae_j306_grade_note}</p>}
      {(figures.warnings ?? []).length > 0 && <Validity remarks={figures.warnings!.map((each) => remarkOf(each))} isChecked={false} />}
      <div class="tabs" role="group" aria-label="Show">
        {TABS.map(([word, words]) => <button key={word} aria-pressed={tab === word} onClick={() => set({ tab: word || undefined })}>{words}</button>)}
      </div>
      {tab === 'viscosity' && <Viscosity id={id} lubricant={lubricant} />}
      {(tab === 'film' || tab === 'traction') && <LawMapView key={tab} id={id} kind={tab} />}
      {tab === '' && <div class="scroll" tabIndex={0} role="region" aria-label="Parameters">
        <table class="parameters">
          <thead><tr><th>Quantity</th><th class="number">Value</th><th class="number">Standard uncertainty</th><th>Unit</th><th>Origin</th><th>Source</th></tr></thead>
          <tbody>{ALL_FIELDS.map(row)}</tbody>
        </table>
        <BoundaryFriction rows={lubricant.asperity_friction_by_temperature ?? []} />
      </div>}
    </>
  );
}

/** The boundary friction by temperature at the contact inlet, which takes the place of the coefficient. */
function BoundaryFriction({ rows }: { rows: BoundaryFrictionAtTemperature[] }) {
  useStore(units);
  if (rows.length === 0) return null;
  return (
    <table>
      <thead><tr><th class="number">Inlet<small>{celsius.symbol}</small></th><th class="number">Boundary friction coefficient ζ</th></tr></thead>
      <tbody>
        {rows.map((each) => (
          <tr key={each.temperature_celsius}><th scope="row" class="number">{written(each.temperature_celsius ?? 0, celsius)}</th><td class="number">{rounded(each.asperity_friction_coefficient ?? 0)}</td></tr>
        ))}
      </tbody>
    </table>
  );
}

function EditFluid({ id }: { id: string }) {
  const { value, error, reload } = useLubricant(id);
  if (error !== undefined) return (error as ApiError).status === 404 ? <Missing /> : <Failure error={error} onRetry={reload} />;
  return value ? <FluidForm lubricant={value} /> : <p class="muted">Loading …</p>;
}

/** An id that follows from a name: "my-oil" of "My oil". */
const idFrom = (name: string): string =>
  name.normalize('NFKD').toLowerCase().replace(/[^a-z0-9]+/g, '-').replace(/^[^a-z]+|-+$/g, '').slice(0, 60);

/** Text of a file as base64, as JSON carries bytes. */
const base64 = (text: string): string =>
  btoa(Array.from(new TextEncoder().encode(text), (byte) => String.fromCharCode(byte)).join(''));

/** Enters an oil, from its data sheet or from a table of viscosities, or changes one. */
function FluidForm({ lubricant: given }: { lubricant?: Lubricant }) {
  const [lubricant] = useState(given); // a change by somebody else meanwhile is a conflict
  const schema = useSchema();
  const constraints = schema.value?.constraints;
  const [typedId, setId] = useState<string | null>(null);
  const [name, setName] = useState(lubricant?.display_name ?? '');
  const id = typedId ?? idFrom(name);
  const [base, setBase] = useState<string>(lubricant?.base_oil_class ?? 'BASE_OIL_CLASS_POLYALPHAOLEFIN');
  const [texts, setTexts] = useState<Record<string, string>>({});
  const [table, setTable] = useState<{ name: string; text: string } | null>(null);
  const [problem, setProblem] = useState<unknown>(null);
  const [isOver, setOver] = useState(false);
  const form = useRef<HTMLFormElement>(null);

  const violations = problem instanceof ApiError ? problem.violations : [];
  const violationOf = (path: string): Violation | undefined =>
    violations.find((each) => each.field === path || each.field.endsWith(`lubricant.${path}`) || each.field === `lubricant.${path}`);
  const rows = violations.filter((each) => each.field.startsWith('viscosity_table_csv'));
  const textOf = (field: Field) =>
    texts[field.path] ?? (lubricant ? written(valueOf(lubricant, field), unitOf(field, constraintOf(field, constraints))) : '');

  useEffect(() => form.current?.querySelector<HTMLElement>('[aria-invalid="true"]')?.focus(), [problem]);

  const submit = async (event: SubmitEvent) => {
    event.preventDefault();
    const body: Record<string, unknown> = { display_name: name, base_oil_class: base };
    const measurements: Record<string, number> = {};
    const law: Record<string, number> = {};
    const changed = ['display_name', 'base_oil_class'];
    const wrong: Violation[] = [];
    for (const field of ALL_FIELDS) {
      const text = texts[field.path];
      if (text === undefined) continue;
      const unit = unitOf(field, constraintOf(field, constraints));
      const value = readNumber(text, unit);
      if (text.trim() !== '' && Number.isNaN(value)) {
        wrong.push({ field: `lubricant.${field.path}`, description: `"${text}" is not a number` });
        continue;
      }
      changed.push(field.path);
      if (text.trim() === '') continue;
      if (field.message === 'Lubricant') body[field.field] = value;
      else (field.message === 'ImprovedYasutomi' ? law : measurements)[field.field] = value;
    }
    if (Object.keys(law).length > 0) body['improved_yasutomi'] = law;
    if (Object.keys(measurements).length > 0) body['measurements'] = measurements;
    if (wrong.length > 0) return setProblem(new ApiError(400, '', wrong[0]!.description, wrong));
    try {
      const saved = lubricant
        ? await change<Lubricant>('PATCH', url(idPath(lubricant), { update_mask: changed.join(',') }), { ...body, etag: lubricant.etag })
        : table
          ? await change<Lubricant>('POST', `${url('lubricants')}:import`, { lubricant: body, lubricant_id: id, viscosity_table_csv: base64(table.text) })
          : await change<Lubricant>('POST', url('lubricants', { lubricant_id: id }), body);
      go(address(`/fluids/${idOf(saved.name)}`));
    } catch (refusal) {
      setProblem(refusal);
    }
  };

  const take = async (file: File | undefined) => {
    setOver(false);
    if (file) setTable({ name: file.name, text: await file.text() });
  };
  const input = (field: Field) => {
    const constraint = constraintOf(field, constraints);
    const unit = unitOf(field, constraint);
    const violation = violationOf(field.path);
    const note = `note-${field.path}`;
    return (
      <label key={field.path}>
        {field.label}{unit.symbol && `, ${unit.symbol}`}
        <input value={textOf(field)} inputMode="decimal" aria-invalid={violation !== undefined} aria-describedby={note}
          onInput={(event) => { const text = event.currentTarget.value; setTexts((old) => ({ ...old, [field.path]: text })); }} />
        <span id={note} class={violation ? 'problem' : 'small'}>{violation ? atField(violation.description) : rangeText(constraint, unit)}</span>
      </label>
    );
  };
  const idViolation = violationOf('lubricant_id') ?? violations.find((each) => each.field === 'lubricant_id' || each.field === 'lubricant.name');
  const shownElsewhere = violations.length > 0 &&
    violations.every((each) => ALL_FIELDS.some((field) => violationOf(field.path) === each) || rows.includes(each) || each === idViolation);
  return (
    <form ref={form} class="fluid-form" onSubmit={(event) => void submit(event)} noValidate>
      <h1>{lubricant ? `Edit ${lubricant.display_name || idOf(lubricant.name)}` : 'Enter an oil'}</h1>
      {problem !== null && !shownElsewhere && <Failure error={problem} />}
      <fieldset class="grid">
        <legend>Name</legend>
        <label>Name<input value={name} placeholder="My oil" onInput={(event) => setName(event.currentTarget.value)} /></label>
        {!lubricant && (
          <label>
            Id
            <input value={id} placeholder="my-oil" spellcheck={false} aria-invalid={idViolation !== undefined} aria-describedby="note-id"
              onInput={(event) => setId(event.currentTarget.value)} />
            <span id="note-id" class={idViolation ? 'problem' : 'small'}>{idViolation?.description ?? 'in addresses and commands: lower-case letters, digits and -'}</span>
          </label>
        )}
        <label>
          Base oil
          <select value={base} onChange={(event) => setBase(event.currentTarget.value)}>
            {BASE_OILS.map(([value, words]) => <option key={value} value={value}>{words}</option>)}
          </select>
        </label>
      </fieldset>
      <fieldset class="grid">
        <legend>Data sheet</legend>
        {[...DATA_SHEET, ...DOCUMENTED].map(input)}
      </fieldset>
      <fieldset class="grid">
        <legend>Boundary friction of the additives; empty: that of the surface</legend>
        {BOUNDARY.map(input)}
      </fieldset>
      {!lubricant && (
        <fieldset>
          <legend>Or a table of viscosities</legend>
          <label class={`drop ${isOver ? 'over' : ''}`}
            onDragOver={(event) => { event.preventDefault(); setOver(true); }} onDragLeave={() => setOver(false)}
            onDrop={(event) => { event.preventDefault(); void take(event.dataTransfer?.files[0]); }}>
            <input type="file" accept=".csv,.txt,text/csv" onChange={(event) => void take(event.currentTarget.files?.[0])} />
            <span>{table ? table.name : 'Drop a CSV here, or choose one: T (C), KV (mm2/s), …'}</span>
          </label>
          {table && <TablePreview text={table.text} rows={rows} onRemove={() => setTable(null)} />}
        </fieldset>
      )}
      <details open={(lubricant !== undefined && !lubricant.measurements) || [...PARAMETERS, ...PRESSURE_LAW].some((field) => violationOf(field.path))}>
        <summary>Parameters of the model{lubricant ? '' : ': what stays empty is estimated, and the result says so'}</summary>
        <fieldset class="grid">{PARAMETERS.map(input)}</fieldset>
        <fieldset class="grid">
          <legend>In place of α*: the improved Yasutomi law, for viscosities that were measured under pressure</legend>
          {PRESSURE_LAW.map(input)}
        </fieldset>
      </details>
      <div class="actions">
        <button class="primary">{lubricant ? 'Save a new revision' : 'Save'}</button>
        <a class="button" href={address(lubricant ? `/fluids/${idOf(lubricant.name)}` : '/fluids')}>Leave</a>
      </div>
    </form>
  );
}

const idPath = (lubricant: Lubricant): string => `lubricants/${idOf(lubricant.name)}`;

const SHOWN_ROWS = 50;

/** The dropped table with what the server says of its rows. */
function TablePreview({ text, rows, onRemove }: { text: string; rows: Violation[]; onRemove: () => void }) {
  const lines = text.split(/\r?\n/).filter((line, i, all) => line !== '' || i < all.length - 1);
  const problems = new Map<number, string[]>();
  for (const each of rows) {
    const row = Number(/row (\d+)/.exec(each.field)?.[1] ?? 1);
    const column = /column (\S+)/.exec(each.field)?.[1];
    problems.set(row, [...(problems.get(row) ?? []), (column ? `${column}: ` : '') + each.description]);
  }
  return (
    <div>
      <ol class="table-preview" aria-label="Rows of the table">
        {lines.slice(0, SHOWN_ROWS).map((line, i) => (
          <li key={i} class={problems.has(i + 1) ? 'wrong' : ''}>
            <code>{line}</code>
            {problems.get(i + 1)?.map((each) => <span key={each} class="problem" role="alert">{each}</span>)}
          </li>
        ))}
      </ol>
      {lines.length > SHOWN_ROWS && <p class="small">and {lines.length - SHOWN_ROWS} more rows</p>}
      <button type="button" onClick={onRemove}>Take the table away</button>
    </div>
  );
}
