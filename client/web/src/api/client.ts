import { place } from '../router';
import { Store } from '../store';

/** What the server says of a field that it refuses. */
export interface Violation {
  field: string; // path in the request, e.g. "lubricant.relaxation_time_seconds"
  description: string;
}

/** What a refusal says beneath the field that it names: without the name. */
export const atField = (description: string): string => description.replace(/^[a-z][a-z0-9_]*_[a-z0-9_]+ = /, '');

/** A refusal of the server (AIP-193), or a server that does not answer (status 0). */
export class ApiError extends Error {
  constructor(
    readonly status: number,
    readonly reason: string,
    message: string,
    readonly violations: Violation[] = [],
    readonly retryAfterSeconds = 0,
  ) {
    super(message);
  }
}

export interface Session {
  principal: string;
  scope: 'read' | 'write' | 'admin';
  projects: string[]; // empty: all
  csrf_token: string;
}

/** undefined: not asked yet; null: signed out. */
export const session = new Store<Session | null | undefined>(undefined);
/** Time of the last answer if the server does not answer any more, else null. */
export const awaySince = new Store<Date | null>(null);
/** How often the server was away and came back. */
export const returns = new Store(0);

/** A request that waits because the server turned it away. */
export interface Wait {
  why: string;
  until: number; // of Date.now()
}
/** Requests that wait for long. */
export const waits = new Store<readonly Wait[]>([]);

/** Whether views load again by themselves after an error: once somebody has signed in, or once the server is back. */
export const isPassing = (error: unknown): boolean => error instanceof ApiError && (error.status === 401 || error.status === 0);

let lastAnswer = new Date();

async function errorOf(response: Response): Promise<ApiError> {
  let body: any;
  try {
    body = (await response.json()).error;
  } catch {
    return new ApiError(response.status, '', `the server answered ${response.status}`);
  }
  const details: any[] = body.details ?? [];
  const info = details.find((each) => each['@type'].endsWith('ErrorInfo'));
  const violations = details.flatMap((each) => each.field_violations ?? []);
  const retry = Number(info?.metadata?.retry_seconds ?? response.headers.get('Retry-After') ?? 0);
  return new ApiError(response.status, info?.reason ?? '', body.message, violations, retry);
}

const LONGEST_PAUSE = 60; // seconds
const LONG_WAIT_MILLISECONDS = 2000; // of all tries: from then on the reader is told
const AMID_WORK = ['STORE_FAILED', 'OUT_OF_MEMORY']; // a change may have had its effect

/** Sends a request. One that the server turns away for some seconds had no effect and is sent again after the pause that it requests. */
async function send(path: string, init: RequestInit): Promise<Response> {
  const began = Date.now();
  let wait: Wait | undefined;
  const tell = (next?: Wait) => {
    waits.set([...waits.value.filter((each) => each !== wait), ...(next ? [next] : [])]);
    wait = next;
  };
  try {
    for (;;) {
      try {
        return await sendOnce(path, init);
      } catch (failure) {
        if (!(failure instanceof ApiError)) throw failure;
        const { retryAfterSeconds: seconds, reason, message } = failure;
        if (!(seconds > 0 && seconds <= LONGEST_PAUSE) || (init.method && AMID_WORK.includes(reason))) throw failure;
        const until = Date.now() + 1000 * (seconds + 0.2 * Math.random());
        if (until - began > LONG_WAIT_MILLISECONDS) tell({ why: message.split('; try again')[0]!, until });
        await sleep(until - Date.now(), init.signal);
      }
    }
  } finally {
    if (wait) tell();
  }
}

/** Waits; fails as soon as the signal says that nobody waits any more. */
const sleep = (milliseconds: number, signal?: AbortSignal | null): Promise<void> =>
  new Promise((done, fail) => {
    const timer = setTimeout(done, milliseconds);
    signal?.addEventListener('abort', () => {
      clearTimeout(timer);
      fail(signal.reason);
    });
  });

async function sendOnce(path: string, init: RequestInit): Promise<Response> {
  let response: Response;
  try {
    response = await fetch(path, { credentials: 'same-origin', ...init });
  } catch (failure) {
    if ((failure as Error).name === 'AbortError') throw failure;
    if (awaySince.value === null) {
      awaySince.set(lastAnswer);
      void waitForServer();
    }
    throw new ApiError(0, 'SERVER_AWAY', 'the server did not answer');
  }
  lastAnswer = new Date();
  if (response.ok) return response;
  const error = await errorOf(response);
  if (error.status === 401 && path !== '/session') session.set(null);
  throw error;
}

async function waitForServer(): Promise<void> {
  while (awaySince.value !== null) {
    await new Promise((done) => setTimeout(done, 1000));
    try {
      if (!(await fetch('/healthz')).ok) continue;
    } catch {
      continue;
    }
    awaySince.set(null);
    returns.set(returns.value + 1);
  }
}

/** Reads the session of this browser's cookie. One that is as before stays: views that follow it do not load again. */
export async function readSession(): Promise<void> {
  try {
    const found: Session = await (await send('/session', {})).json();
    if (JSON.stringify(found) !== JSON.stringify(session.value)) session.set(found);
  } catch (error) {
    if ((error as ApiError).status === 401) session.set(null);
    else throw error;
  }
}

/** Exchanges a token for a cookie that scripts cannot read. */
export async function signIn(token: string): Promise<void> {
  const headers = { Authorization: `Bearer ${token}` };
  session.set(await (await send('/session', { method: 'POST', headers })).json());
}

/** Leaves nothing of the session on the screen or in the storage of the tab. */
function leave(): void {
  sessionStorage.clear();
  window.location.assign('/');
}

/** Tells the other tabs of the browser that the session was ended. */
const signOuts = new BroadcastChannel('sign-out');
signOuts.onmessage = leave;
// A browser may keep a page whole and show it again after the end of its session.
window.addEventListener('pageshow', (event) => event.persisted && window.location.reload());

export async function signOut(): Promise<void> {
  try {
    await send('/session', { method: 'DELETE', headers: { 'Tribodyn-Csrf': session.value?.csrf_token ?? '' } });
  } catch (error) {
    if ((error as ApiError).status !== 401) throw error;
  }
  signOuts.postMessage(null);
  leave();
}

/** The address of a resource or method of the present project: "lubricants/a" or "simulations". */
export function url(path: string, query: Record<string, string | number | string[] | undefined> = {}): string {
  const words: string[] = [];
  for (const [name, value] of Object.entries(query)) {
    for (const each of Array.isArray(value) ? value : [value]) {
      if (each !== undefined && each !== '') words.push(`${name}=${encodeURIComponent(each)}`);
    }
  }
  const project = path.startsWith('projects/') || path === 'schema' || place.value.project === 'default'
    ? '' : `projects/${place.value.project}/`;
  return `/v1/${project}${path}${words.length > 0 ? `?${words.join('&')}` : ''}`;
}

export async function get<T>(address: string, signal?: AbortSignal): Promise<T> {
  return (await send(address, { signal: signal ?? null })).json();
}

export async function getBytes(address: string, signal?: AbortSignal): Promise<ArrayBuffer> {
  return (await send(address, { signal: signal ?? null })).arrayBuffer();
}

/** Calls a method that changes something. */
export async function change<T>(method: 'POST' | 'PATCH' | 'DELETE', address: string, body?: unknown, signal?: AbortSignal): Promise<T> {
  const headers: Record<string, string> = { 'Tribodyn-Csrf': session.value?.csrf_token ?? '' };
  if (body !== undefined) headers['Content-Type'] = 'application/json';
  const init = { method, headers, signal: signal ?? null, body: body === undefined ? null : JSON.stringify(body) };
  return (await send(address, init)).json();
}
