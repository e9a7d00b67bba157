import type { CyclePlace } from './api/types';
import { ownCycleOf } from './cycle';

/** A cycle file of the reader. */
export interface CycleFile {
  name: string;
  text: string;
}

/** Characters that a link holds of a cycle. Browsers take more, chats and mail programs cut longer addresses. */
export const MOST_PACKED = 16_000;
const MARK = '#cycle=';

const FIELDS = ['time_seconds', 'speed_kilometres_per_hour', 'ascent_angle_degrees', 'sump_temperature_celsius'] as const;

/** Numbers, or the first one, the step and the count of equally spaced ones. */
type Column = number[] | { first: number; step: number; count: number };

interface Packed {
  name: string;
  columns: Partial<Record<(typeof FIELDS)[number], Column>>;
}

function columnOf(values: number[]): Column {
  const [first = 0, second = 0] = values;
  const step = second - first;
  return values.length > 2 && values.every((value, k) => value === first + k * step) ? { first, step, count: values.length } : values;
}

const valuesOf = (column: Column): number[] =>
  (Array.isArray(column) ? column : Array.from({ length: column.count }, (_, k) => column.first + k * column.step));

const through = async (bytes: BlobPart, stream: CompressionStream | DecompressionStream): Promise<Uint8Array<ArrayBuffer>> =>
  new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());

/** The fragment of an address that holds a cycle; null if it would be too long. */
export async function fragmentOf(name: string, places: CyclePlace[]): Promise<string | null> {
  const columns: Packed['columns'] = {};
  for (const field of FIELDS) {
    const values = places.map((each) => each[field]);
    if (values.every((value) => value !== undefined)) columns[field] = columnOf(values as number[]);
  }
  const bytes = await through(JSON.stringify({ name, columns } satisfies Packed), new CompressionStream('deflate-raw'));
  const words = btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join('')).replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, '');
  return words.length > MOST_PACKED ? null : MARK + words;
}

/** The cycle of a fragment; null if the fragment holds none. Throws if it is damaged. */
export async function cycleOf(fragment: string): Promise<CycleFile | null> {
  if (!fragment.startsWith(MARK)) return null;
  const bytes = Uint8Array.from(atob(fragment.slice(MARK.length).replaceAll('-', '+').replaceAll('_', '/')), (each) => each.charCodeAt(0));
  const { name, columns } = JSON.parse(new TextDecoder().decode(await through(bytes, new DecompressionStream('deflate-raw')))) as Packed;
  const fields = FIELDS.filter((field) => columns[field] !== undefined);
  const values = fields.map((field) => valuesOf(columns[field]!));
  return { name, text: [fields.join(','), ...(values[0] ?? []).map((_, row) => values.map((each) => each[row]).join(','))].join('\n') + '\n' };
}

/** The cycle as the service and the command line read it. */
export function tableOfCycle(text: string): string {
  const { places } = ownCycleOf(text);
  const fields = FIELDS.filter((field) => places.every((each) => each[field] !== undefined));
  return [fields.join(','), ...places.map((each) => fields.map((field) => each[field]).join(','))].join('\n') + '\n';
}
