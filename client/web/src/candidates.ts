import type { BatchCreateLubricantsResponse, CandidateAttribute, CandidateColumn, Constraint, Lubricant, Surface } from './api/types';
import { ApiError, atField, change, url } from './api/client';
import { constraintAt, inputUnit, inputWords } from './inputs';
import { DATA_SHEET, symbolOf } from './lubricant_fields';
import { kelvin, plain, readNumber, scaled, type Unit } from './units';

/** A table of candidates as text, cut into cells. */
export interface Table {
  header: string[];
  rows: { line: number; cells: string[] }[]; // line: in the text, counted from 1
  hasDecimalCommas: boolean; // as commas do not separate cells
}

/** What a column of the table is: "" (left out), "name", "attribute", or one of the kinds below and a path. */
export type Role = '' | 'name' | 'attribute' | `${'parameter' | 'measured' | 'uncertainty'}:${string}`;

/** Something wrong in the table. */
export interface Problem {
  row: number; // counted from 0; -1: the whole column
  column: number; // counted from 0; -1: the whole row
  text: string;
}

/** Cuts a text into cells. Tabs, semicolons or commas separate them: the first of these that the header has. */
export function tableOf(text: string): Table {
  const plainText = text.replace(/^\uFEFF/, '');
  const first = plainText.split(/\r?\n/).find((line) => line.trim() !== '') ?? '';
  const separator = ['\t', ';', ','].find((each) => first.includes(each)) ?? ',';
  const lines: { line: number; cells: string[] }[] = [];
  let cells: string[] = [];
  let cell = '';
  let isQuoted = false;
  let line = 1;
  let begin = 1;
  const endRow = () => {
    cells.push(cell.trim());
    if (cells.some((each) => each !== '')) lines.push({ line: begin, cells });
    cells = [];
    cell = '';
  };
  for (let i = 0; i < plainText.length; ++i) {
    const c = plainText[i]!;
    if (isQuoted) {
      if (c === '\n') ++line;
      if (c !== '"') cell += c;
      else if (plainText[i + 1] === '"') cell += plainText[++i];
      else isQuoted = false;
    } else if (c === '"' && cell.trim() === '') {
      cell = '';
      isQuoted = true;
    } else if (c === separator) {
      cells.push(cell.trim());
      cell = '';
    } else if (c === '\n') {
      endRow();
      begin = ++line;
    } else if (c !== '\r') {
      cell += c;
    }
  }
  endRow();
  // The apostrophe that a CSV file of the service has before a text that a spreadsheet would compute.
  for (const each of lines) each.cells = each.cells.map((text) => text.replace(/^'(?='*[=+\-@\t\r])/, ''));
  const [header, ...rows] = lines;
  return { header: header?.cells ?? [], rows, hasDecimalCommas: separator !== ',' };
}

const MEASURED = new Map(DATA_SHEET.map((each) => [each.field, each.label]));

/** Parameters in which candidates can differ, e.g. "lubricant.relaxation_time_seconds", from the words of the schema. */
export const parametersOf = (vocabularies: { name?: string; words?: string[] }[] | undefined): string[] =>
  ['lubricant', 'surface'].flatMap((kind) => (vocabularies?.find((each) => each.name === `${kind}s.parameters`)?.words ?? []).map((word) => `${kind}.${word}`));

/** The last part of a path: the name of a field, which ends in its unit. */
const fieldOf = (path: string): string => path.replace(/^.*\./, '');

const UNITS_IN_NAMES = /_(per_)?(pascals?|seconds?|kelvin|celsius|metres?|kilograms?|watts|square|cubic|millimetres|pascal_seconds)(_.*)?$/;
const bare = (field: string): string => field.replace(UNITS_IN_NAMES, '');
const word = (text: string): string => text.toLowerCase().replace(/[\s-]+/g, '_').replace(/[^\p{L}\p{N}_.*]/gu, '');

/** Usual short names of what tables hold. */
const SHORT: Record<string, string> = {
  'alpha*': 'parameter:lubricant.pressure_viscosity_coefficient_per_pascal', 'α*': 'parameter:lubricant.pressure_viscosity_coefficient_per_pascal',
  alpha_star: 'parameter:lubricant.pressure_viscosity_coefficient_per_pascal', pvc: 'parameter:lubricant.pressure_viscosity_coefficient_per_pascal',
  roughness: 'parameter:surface.composite_rms_height_metres', sigma: 'parameter:surface.composite_rms_height_metres', 'σ': 'parameter:surface.composite_rms_height_metres',
  kv40: 'measured:kinematic_viscosity_40_celsius_square_millimetres_per_second', kv_40: 'measured:kinematic_viscosity_40_celsius_square_millimetres_per_second',
  kv100: 'measured:kinematic_viscosity_100_celsius_square_millimetres_per_second', kv_100: 'measured:kinematic_viscosity_100_celsius_square_millimetres_per_second',
  density: 'measured:density_15_celsius_kilograms_per_cubic_metre', density15: 'measured:density_15_celsius_kilograms_per_cubic_metre', density_15: 'measured:density_15_celsius_kilograms_per_cubic_metre',
};

/** What a header says that its column is; a column without a known name rides along as it is. */
export function roleOf(header: string, parameters: string[]): Role {
  const text = word(withoutUnit(header).text);
  if (['name', 'candidate', 'id', 'candidate_id'].includes(text)) return 'name';
  const isUncertainty = /\.(standard_)?uncertainty$/.test(text);
  const plainText = text.replace(/\.(standard_)?uncertainty$/, '').replace(/^measurements\./, '');
  // A name that lubricants and surfaces have is that of the lubricant.
  const path = parameters.filter((each) => [each, each.replace(/^\w+\./, ''), fieldOf(each)].includes(plainText))[0]
    ?? parameters.filter((each) => [bare(fieldOf(each)), word(inputWords(each))].includes(plainText)).at(-1);
  if (path) return `${isUncertainty ? 'uncertainty' : 'parameter'}:${path}`;
  const measured = [...MEASURED].find(([field, label]) => plainText === field || plainText === word(label));
  if (measured && !isUncertainty) return `measured:${measured[0]}`;
  return (SHORT[text] as Role | undefined) ?? (text === '' ? '' : 'attribute');
}

/** "alpha*" and "1/GPa" of "alpha* [1/GPa]". */
function withoutUnit(header: string): { text: string; unit: string | null } {
  const match = /^(.*?)\s*[[(]([^\])]*)[\])]\s*$/.exec(header);
  return match ? { text: match[1]!, unit: match[2]!.trim() } : { text: header, unit: null };
}

const MORE_UNITS: Record<string, Unit[]> = {
  '1/Pa': [scaled('1/GPa', 1e9), scaled('mm²/N', 1e6)], s: [scaled('ms', 1e3), scaled('µs', 1e6), scaled('ns', 1e9)], Pa: [scaled('MPa', 1e-6), scaled('GPa', 1e-9)],
  m: [scaled('mm', 1e3), scaled('µm', 1e6), scaled('nm', 1e9)], 'Pa s': [scaled('mPa s', 1e3)], 'kg/m3': [scaled('g/cm³', 1e-3)], '1/m2': [scaled('1/mm²', 1e-6)],
  'mm2/s': [plain('cSt')],
};

/** The units in which cells of a column may be, that of the service first. */
export function unitsOf(role: Role, constraints: Constraint[] | undefined): Unit[] {
  const [kind, path] = role.split(':');
  if (!path || kind === 'name') return [];
  const unit = (kind === 'measured' ? constraints?.find((each) => each.message === 'LubricantMeasurements' && each.field === path) : constraintAt(path, constraints))?.unit ?? '';
  const isTemperature = inputUnit(path, constraints) === kelvin && kind !== 'uncertainty';
  return unit === '' ? [] : [plain(symbolOf(unit)), ...(isTemperature ? [{ symbol: '°C', factor: 1, offset: -273.15 }] : MORE_UNITS[unit] ?? [])];
}

const sameUnit = (a: string, b: string): boolean => {
  const plainUnit = (text: string) => text.replace(/[\s·*^]/g, '').replace('²', '2').replace('³', '3').replace(/^[uμ](?=[ms])/, 'µ').replace(/^(deg)?C$/, '°C').toLowerCase();
  return plainUnit(a) === plainUnit(b);
};

/** The unit of a column by its header; undefined if the header does not say it. */
export function unitOfHeader(header: string, role: Role, units: Unit[]): Unit | undefined {
  if (units.length === 0) return plain('');
  const { text, unit } = withoutUnit(header);
  if (unit !== null) return units.find((each) => sameUnit(each.symbol, unit));
  // The name of a field ends in its unit, and data sheets have one unit each.
  const field = fieldOf(role.split(':')[1] ?? '');
  return units.length === 1 || word(text).includes(field) || role.startsWith('measured:') ? units[0] : undefined;
}

/** A column of the table with its role. */
export interface TableColumn {
  role: Role;
  unit: Unit | undefined;
}

export interface Bases {
  lubricant: Lubricant;
  surface: Surface;
}

/** Candidates as the service takes them, and the columns of the table that they come from. */
export interface Candidates {
  columns: CandidateColumn[];
  sources: number[]; // of `columns`; -1: the service computed it from a data sheet
  attributes: CandidateAttribute[];
  attributeSources: number[];
  measurements: Record<string, number>[]; // by row; empty without columns of a data sheet
  stated: Record<string, number>[]; // parameters of lubricants by row, beside their measurements
  problems: Problem[];
}

const within = (resource: unknown, path: string): number | undefined => {
  const value = path.split('.').reduce<unknown>((holder, name) => (holder as Record<string, unknown> | undefined)?.[name], resource);
  return typeof value === 'number' ? value : undefined;
};

/** The value that a base has of a parameter. An oil without boundary friction has that of the surface, in a field of the same name. */
export const baseValue = (bases: Bases, path: string): number | undefined => {
  const [, resource, name] = path.match(/^(lubricant|surface)\.(.*)$/)!;
  return (resource === 'lubricant' ? within(bases.lubricant, name!) : undefined) ?? within(bases.surface, name!);
};

const MOST_NAME = 63; // characters of the name of an attribute

const attributeName = (header: string): string => header.trim().replace(/[^A-Za-z0-9._-]+/g, '_').replace(/^_+|_+$/g, '').slice(0, MOST_NAME) || '_';

/** What a campaign has already, for candidates that are added to it. */
export interface Present {
  paths: string[]; // of its columns
  attributes: Map<string, 'values' | 'texts'>;
}

/** Reads the cells. An empty cell of a parameter leaves the value of its base. */
export function candidatesOf(table: Table, columns: TableColumn[], bases: Bases, present?: Present): Candidates {
  const out: Candidates = { columns: [], sources: [], attributes: [], attributeSources: [], measurements: [], stated: [], problems: [] };
  const isMeasured = columns.some(({ role }) => role.startsWith('measured:'));
  if (isMeasured) {
    out.measurements = table.rows.map(() => ({}));
    out.stated = table.rows.map(() => ({}));
  }
  const numberOf = (text: string, unit: Unit) => readNumber(table.hasDecimalCommas ? text : text.replace(',', '?'), unit);
  table.rows.forEach(({ cells }, row) => {
    if (cells.length !== table.header.length) out.problems.push({ row, column: -1, text: `has ${cells.length} cells; the header has ${table.header.length}` });
  });
  const seen = new Map<string, number>();
  columns.forEach(({ role, unit }, column) => {
    const [kind, path] = role.split(':');
    if (role === '') return;
    const cells = table.rows.map((row) => row.cells[column] ?? '');
    const known = role === 'attribute' ? undefined : seen.get(role);
    if (known !== undefined) return out.problems.push({ row: -1, column, text: `is the same as column ${known + 1}` });
    seen.set(role, column);
    const keepAttribute = (attribute: CandidateAttribute) => {
      out.attributes.push(attribute);
      out.attributeSources.push(column);
    };
    if (role === 'name') return keepAttribute({ name: 'name', texts: cells });
    if (role === 'attribute') {
      const values = cells.map((text) => (text === '' ? NaN : numberOf(text, plain(''))));
      const name = attributeName(table.header[column]!);
      const kind = present?.attributes.get(name) ?? (values.every(Number.isFinite) ? 'values' : 'texts');
      if (kind === 'texts') return keepAttribute({ name, texts: cells });
      values.forEach((value, row) => Number.isFinite(value) || out.problems.push({ row, column, text: `"${cells[row]}" is not a number; those of the campaign are` }));
      return keepAttribute({ name, values: values.map((value) => (Number.isFinite(value) ? value : 0)) });
    }
    if (!unit) return out.problems.push({ row: -1, column, text: 'choose its unit' });
    const scale = kind === 'uncertainty' ? { ...unit, offset: 0 } : unit;
    const values = cells.map((text, row) => {
      if (text === '') return undefined;
      const value = numberOf(text, scale);
      if (Number.isFinite(value)) return value;
      out.problems.push({ row, column, text: `"${text}" is not a number` });
      return undefined;
    });
    if (kind === 'measured') return values.forEach((value, row) => value !== undefined && (out.measurements[row]![path!] = value));
    if (kind === 'uncertainty') return keepAttribute({ name: `${fieldOf(path!)}.uncertainty`, values: values.map((value) => value ?? 0) });
    if (isMeasured && path!.startsWith('lubricant.')) return values.forEach((value, row) => value !== undefined && (out.stated[row]![path!.slice('lubricant.'.length)] = value));
    const usual = baseValue(bases, path!);
    out.columns.push({
      path: path!, values: values.map((value, row) => {
        if (value === undefined && usual === undefined && cells[row] === '') out.problems.push({ row, column, text: 'is empty, and the base has no value' });
        return value ?? usual ?? 0;
      }),
    });
    out.sources.push(column);
  });
  return out;
}

const AT_ONCE = 400; // lubricants of one call, whose answer stays far below its limit

/** Sets a number at a path within a message. */
function put(message: Record<string, unknown>, path: string, value: number): void {
  const [first, ...rest] = path.split('.');
  if (rest.length === 0) message[first!] = value;
  else put((message[first!] ??= {}) as Record<string, unknown>, rest.join('.'), value);
}

/** What the service estimated of an oil with a standard uncertainty: a column of values cannot carry that. */
const estimatesOf = (lubricant: Lubricant, isGiven: boolean): string[] =>
  (lubricant.provenance ?? []).filter((each) => each.computed && each.provenance === 'PROVENANCE_ASSUMED' && (each.standard_uncertainty ?? 0) > 0
    && !(isGiven && each.field!.startsWith('pressure_viscosity_'))).map((each) => each.field!);

/**
 * Has the service compute the parameters of lubricants from their data sheets, as it does for an oil
 * that is entered; nothing is stored. Adds the columns in which a candidate differs from the base, and
 * those that the campaign has. Throws if it estimates a parameter with a standard uncertainty.
 */
export async function characterise(candidates: Candidates, bases: Bases, parameters: string[], signal: AbortSignal, present?: Present): Promise<Candidates> {
  if (candidates.measurements.length === 0) return candidates;
  const paths = parameters.filter((each) => each.startsWith('lubricant.')).map((each) => each.slice('lubricant.'.length));
  const found: Lubricant[] = [];
  for (let first = 0; first < candidates.measurements.length; first += AT_ONCE) {
    const requests = candidates.measurements.slice(first, first + AT_ONCE).map((measurements, i) => {
      const lubricant: Record<string, unknown> = { base_oil_class: bases.lubricant.base_oil_class, measurements };
      for (const [path, value] of Object.entries(candidates.stated[first + i]!)) put(lubricant, path, value);
      return { lubricant_id: `candidate-of-a-campaign-${first + i + 1}`, lubricant };
    });
    try {
      const answer = await change<BatchCreateLubricantsResponse>('POST', `${url('lubricants')}:batchCreate`, { requests, validate_only: true, read_mask: [...paths, 'provenance'].join(',') }, signal);
      found.push(...answer.lubricants!);
    } catch (refusal) {
      if (!(refusal instanceof ApiError) || first === 0) throw refusal;
      // Rows are counted from the first one of the table.
      throw new ApiError(refusal.status, refusal.reason, refusal.message, refusal.violations.map((each) =>
        ({ ...each, field: each.field.replace(/^requests\[(\d+)\]/, (_, k: string) => `requests[${Number(k) + first}]`) })));
    }
  }
  const isGiven = bases.lubricant.improved_yasutomi !== undefined; // the law of the base gives its alpha*
  const estimated = [...new Set(found.flatMap((each) => estimatesOf(each, isGiven)))];
  if (estimated.length > 0) {
    throw new Error('A table cannot carry the uncertainty of estimates, and the service would estimate '
      + `${estimated.map((each) => inputWords(`lubricant.${each}`)).join(', ')}. Add the oils (Fluids, import) and screen them as fluids.`);
  }
  const columns = paths.filter((path) => !(isGiven && path.startsWith('pressure_viscosity_'))).flatMap((path): CandidateColumn[] => {
    const usual = within(bases.lubricant, path);
    const values = found.map((each) => within(each, path) ?? usual);
    const isWanted = present?.paths.includes(`lubricant.${path}`) === true || values.some((value) => value !== usual);
    return values.some((value) => value === undefined) || !isWanted ? [] : [{ path: `lubricant.${path}`, values: values as number[] }];
  });
  return { ...candidates, columns: [...columns, ...candidates.columns], sources: [...columns.map(() => -1), ...candidates.sources] };
}

/** Where violations of the service lie in the table; undefined: not in the table. */
export function problemOf(field: string, description: string, table: Table, columns: TableColumn[], candidates: Candidates): Problem | undefined {
  const single = /^requests\[(\d+)\]\.?(?:lubricant\.?)?(.*)$/.exec(field);
  if (single) {
    const name = fieldOf(single[2]!.replace(/\[.*$/, ''));
    return { row: Number(single[1]), column: columns.findIndex(({ role }) => role.includes(':') && fieldOf(role.split(':')[1]!) === name), text: atField(description) };
  }
  const match = /candidate_(columns|attributes)\[(\d+)\](?:\.(?:values|texts)\[(\d+)\])?/.exec(field);
  if (!match) return undefined;
  const sources = match[1] === 'columns' ? candidates.sources : candidates.attributeSources;
  const column = sources[Number(match[2])] ?? -1;
  if (match[3] === undefined) return column < 0 ? undefined : { row: -1, column, text: description };
  const row = Number(match[3]);
  const text = column < 0 ? `${inputWords(candidates.columns[Number(match[2])]!.path!)}: ${description}` : description;
  return row < table.rows.length ? { row, column, text: atField(text) } : undefined;
}
