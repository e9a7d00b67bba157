import { useEffect, useState } from 'preact/hooks';
import { change, get, isPassing, returns, session, url } from './api/client';
import type { GearSet, ListGearSetsResponse, ListLubricantsResponse, Lubricant, Schema } from './api/types';
import { idOf } from './format';
import { useStore } from './store';

export interface Loaded<T> {
  value?: T;
  error?: unknown;
  isStale: boolean; // the value belongs to an earlier key
  reload: () => void;
}

/** Changes whenever views load again: after a sign-in, and once a server that was away is back. null: nobody has signed in. */
export function useConnection(): string | null {
  const who = useStore(session);
  const count = useStore(returns);
  return who ? `${who.csrf_token} ${count}` : null;
}

/** Loads something when the view appears, when `key` changes and whenever the connection is new. What was loaded stays meanwhile. */
export function useLoaded<T>(load: (signal: AbortSignal) => Promise<T>, key: string): Loaded<T> {
  const [state, setState] = useState<{ key?: string; value?: T; error?: unknown }>({});
  const [round, setRound] = useState(0);
  const connection = useConnection();
  useEffect(() => {
    if (connection === null) return;
    const controller = new AbortController();
    load(controller.signal).then(
      (value) => setState({ key, value }),
      (error) => { if (!controller.signal.aborted && !isPassing(error)) setState((old) => ({ ...(old.key === key ? old : {}), key, error })); },
    );
    return () => controller.abort();
  }, [key, round, connection]);
  return { ...(state.key === key ? state : { value: state.value }), isStale: state.key !== key, reload: () => setRound((count) => count + 1) } as Loaded<T>;
}

/** Calls a method that stores nothing, again whenever the body or the version changes; without a body, never. */
export const useAnswer = <T>(method: string, body: unknown | null, version = 0): Loaded<T | null> =>
  useLoaded((signal) => (body === null ? Promise.resolve(null) : change<T>('POST', url(method), body, signal)), `${method} ${JSON.stringify(body)} ${version}`);

const LUBRICANT_FIELDS = 'name,display_name,characterisation,revision,base_oil_class';

export const useLubricants = (): Loaded<Lubricant[]> =>
  useLoaded(async (signal) =>
    (await get<ListLubricantsResponse>(url('lubricants', { page_size: 1000, read_mask: LUBRICANT_FIELDS }), signal)).lubricants ?? [],
  'lubricants');

export const useGearSets = (): Loaded<GearSet[]> =>
  useLoaded(async (signal) =>
    (await get<ListGearSetsResponse>(url('gearSets', { page_size: 1000, read_mask: 'name,display_name,dynamics.half_backlash_metres' }), signal)).gear_sets ?? [],
  'gearSets');

export const useSchema = (): Loaded<Schema> => useLoaded((signal) => get<Schema>(url('schema'), signal), 'schema');

/** The names for people of resources, by id. */
export const titlesOf = (resources: { name?: string; display_name?: string }[] | undefined): Map<string, string> =>
  new Map((resources ?? []).map((each) => [idOf(each.name), each.display_name || idOf(each.name)]));
