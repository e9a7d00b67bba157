const MOST_FIGURES = 4;

/** Returns how many decimal places an error leaves: its first digit, the second if that is a 1. */
function placesOf(error: number): number {
  const exponent = Math.floor(Math.log10(error));
  const leading = Math.floor(error / 10 ** exponent + 1e-9);
  return -exponent + (leading === 1 ? 1 : 0);
}

/** Rounds to what the error bears, at most to four figures; without an error to three. */
export function rounded(value: number | null | undefined, error?: number): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const magnitude = Math.floor(Math.log10(Math.abs(value)));
  let places = (error === undefined ? 3 : MOST_FIGURES) - 1 - magnitude;
  if (error !== undefined && error > 0) places = Math.min(places, placesOf(error));
  const bearsFewDigits = error !== undefined && error > 0 && places <= 8;
  if ((magnitude < -4 && !bearsFewDigits) || magnitude > 6) {
    return value.toExponential(Math.max(0, Math.min(places + magnitude, 3))).replaceAll('-', '−');
  }
  const text = value.toFixed(Math.max(0, Math.min(places, 8)));
  return Number(text) === 0 ? text.replace('-', '') : text.replace('-', '−');
}

/** "2 min ago". */
export function ago(time: string | undefined, now = Date.now()): string {
  if (!time) return '';
  const seconds = Math.max(0, (now - Date.parse(time)) / 1000);
  if (seconds < 60) return `${Math.floor(seconds)} s ago`;
  if (seconds < 3600) return `${Math.floor(seconds / 60)} min ago`;
  if (seconds < 86400) return `${Math.floor(seconds / 3600)} h ago`;
  return new Date(time).toLocaleDateString(undefined, { day: 'numeric', month: 'short', year: 'numeric' });
}

/** "300 ms", "4 s". */
export function duration(start?: string, end?: string): string {
  if (!start || !end) return '';
  const milliseconds = Date.parse(end) - Date.parse(start);
  return milliseconds < 1000 ? `${milliseconds} ms` : `${(milliseconds / 1000).toFixed(1)} s`;
}

/** The id in "lubricants/my-oil@2": "my-oil", or with the revision. */
export const idOf = (name: string | undefined): string => (name ?? '').replace(/^.*\//, '').replace(/@.*$/, '');
export const revisionIdOf = (name: string | undefined): string => (name ?? '').replace(/^.*\//, '');
