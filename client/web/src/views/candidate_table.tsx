import { Fragment } from 'preact';
import { useMemo, useState } from 'preact/hooks';
import type { ApiError, Violation } from '../api/client';
import type { Campaign, Constraint } from '../api/types';
import { conditionsOf } from '../campaign';
import { candidatesOf, problemOf, roleOf, tableOf, unitOfHeader, unitsOf, type Bases, type Candidates, type Present, type Problem, type Role, type Table, type TableColumn } from '../candidates';
import { inputWords } from '../inputs';
import { Num } from '../components/num';
import { DATA_SHEET } from '../lubricant_fields';
import { plain, scaled, type Unit } from '../units';

const SHOWN_ROWS = 12;
const MOST_WRONG_ROWS = 100;
const MOST_DRAFT = 2_000_000; // characters

const EXAMPLE = `name,alpha* [1/GPa],asperity_friction_coefficient,additive,cost_euros_per_kilogram
A-1,14,0.11,A,4.1
A-2,15,0.10,A,4.4
A-3,16,0.09,A,4.8
B-1,14,0.08,B,5.2
B-2,15,0.08,B,5.5
B-3,16,0.07,B,6.0
`;

export interface Source {
  name: string;
  text: string;
}

/** Reads a draft from the storage of the tab; null if there is none. */
export function storedDraft<T>(key: string): T | null {
  try {
    return JSON.parse(sessionStorage.getItem(key) ?? 'null');
  } catch {
    return null;
  }
}

/** A table of candidates and what is made of it. */
export interface TableState {
  source: Source | null;
  table: Table | null;
  columns: TableColumn[];
  candidates: Candidates | null;
  isWhole: boolean; // has candidates, and no cell is wrong
  take: (source: Source | null) => void;
  choose: (column: number, next: { role?: Role; unit?: string }) => void;
}

/** The table of a form. `draft` is its key in the storage of the tab: it survives a reload, not the tab. */
export function useTable(draft: string, bases: Bases | undefined, parameters: string[], constraints: Constraint[] | undefined, present?: Present): TableState {
  const [source, setSource] = useState<Source | null>(() => storedDraft<Source>(draft));
  const [chosen, setChosen] = useState<Record<number, { role?: Role; unit?: string }>>({});
  const take = (next: Source | null) => {
    setSource(next);
    setChosen({});
    if (next && next.text.length <= MOST_DRAFT) sessionStorage.setItem(draft, JSON.stringify(next));
    else sessionStorage.removeItem(draft);
  };
  const table = useMemo(() => (source ? tableOf(source.text) : null), [source]);
  const columns = useMemo<TableColumn[]>(() => (table && parameters.length > 0 ? table.header.map((header, k) => {
    const role = chosen[k]?.role ?? roleOf(header, parameters);
    const allowed = unitsOf(role, constraints);
    const stated = chosen[k]?.unit;
    return { role, unit: stated === undefined ? unitOfHeader(header, role, allowed) : allowed.find((each) => each.symbol === stated) };
  }) : []), [table, parameters, chosen]);
  const candidates = useMemo(() => (table && bases && columns.length > 0 ? candidatesOf(table, columns, bases, present) : null), [table, columns, bases, present]);
  const isWhole = candidates !== null && candidates.problems.length === 0 && table!.rows.length > 0 && columns.some(({ role }) => /^(parameter|measured):/.test(role));
  return { source, table, columns, candidates, isWhole, take, choose: (column, next) => setChosen((old) => ({ ...old, [column]: next })) };
}

/** The mistakes in a table, the service's among them, and what the service says of other fields. */
export function tableProblems(state: TableState, refusal: ApiError | null): { problems: Problem[]; elsewhere: Violation[] } {
  const { table, columns, candidates } = state;
  const given = (refusal as (ApiError & { candidates?: Candidates }) | null)?.candidates ?? candidates;
  const placed = (refusal?.violations ?? []).map((each) => ({ each, at: table && given ? problemOf(each.field, each.description, table, columns, given) : undefined }));
  return {
    problems: [...(candidates?.problems ?? []), ...placed.flatMap(({ at }) => at ?? [])],
    elsewhere: placed.filter(({ at }) => at === undefined).map(({ each }) => each),
  };
}

/** What stands in the way of a table without an answer of the service yet; "" if nothing does. */
export function tableWords({ table, candidates, isWhole }: TableState, problems: Problem[]): string {
  if (problems.length > 0) return `${problems.length} ${problems.length === 1 ? 'mistake' : 'mistakes'} in the table`;
  if (table && table.rows.length === 0) return 'The table has no rows.';
  return candidates && !isWhole ? 'No column is a parameter or of a data sheet: say below what a column is.' : '';
}

/** Where a table comes in: dropped, chosen, pasted. */
export function Intake({ onTake, hasExample = false }: { onTake: (source: Source) => void; hasExample?: boolean }) {
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
        <p>A row for each candidate. A column is a parameter of the lubricant or of the surface, with its unit in brackets, e.g. <code>alpha* [1/GPa]</code>; or the candidates' <code>name</code>. Every other column, such as an additive or a cost, rides along.</p>
        <p>Oils known by their data sheets are fluids: enter or import them, and screen them as fluids, with the uncertainty of what is estimated.</p>
        {hasExample && <button type="button" onClick={() => onTake({ name: 'example', text: EXAMPLE })}>Show an example</button>}
      </section>
    </>
  );
}

/** The unit in which a time is read with ease. */
const timeUnit = (seconds: number): Unit => (seconds < 1 ? scaled('ms', 1e3) : seconds < 90 ? plain('s') : seconds < 5400 ? scaled('min', 1 / 60) : scaled('h', 1 / 3600));

export function Estimate({ answer, ofNew = false }: { answer: Campaign; ofNew?: boolean }) {
  const seconds = answer.cost_estimate?.processor_seconds ?? 0;
  const unit = timeUnit(seconds);
  return (
    <>
      <strong><span data-value={answer.candidates}>{answer.candidates}</span></strong> candidates at {conditionsOf(answer)} condition{conditionsOf(answer) === 1 ? '' : 's'} are{' '}
      <strong><span data-value={answer.points}>{answer.points}</span></strong> points; {ofNew ? 'the new ones' : 'they'} take about <strong><Num value={seconds} unit={unit} error={0.2 * seconds} /> {unit.symbol}</strong> of one processor.
    </>
  );
}

/** The role of each column, and the faulty rows with their faults. */
export function TableForm({ table, columns, parameters, unitsOf: allowedUnits, problems, onChange }: {
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
                  <optgroup label="Standard uncertainty">{group('uncertainty', inputWords, parameters)}</optgroup>
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
