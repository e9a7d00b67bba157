import { Store } from './store';

/** Where the page is: a project, a path within it, and settings. */
export interface Place {
  project: string; // "default" or the name behind /p/
  path: string; // e.g. "/curves", without the project
  query: URLSearchParams;
}

function placeOf(location: Location): Place {
  const match = /^\/p\/([^/]+)(\/.*)?$/.exec(location.pathname);
  return {
    project: match ? match[1]! : 'default',
    path: match ? (match[2] ?? '/') : location.pathname,
    query: new URLSearchParams(location.search),
  };
}

export const place = new Store<Place>(placeOf(location));

window.addEventListener('popstate', () => place.set(placeOf(location)));

/** The address of a path in the present project. */
export function address(path: string, query?: Record<string, string | undefined>): string {
  const prefix = place.value.project === 'default' ? '' : `/p/${place.value.project}`;
  const words = Object.entries(query ?? {})
    .filter(([, value]) => value !== undefined && value !== '')
    .map(([name, value]) => `${name}=${encodeURIComponent(value!).replace(/%2C/g, ',').replace(/%40/g, '@')}`);
  return prefix + path + (words.length > 0 ? `?${words.join('&')}` : '');
}

/** Goes to an address of this page. A new view is pushed; a setting of a view replaces it, and leaves its fragment. */
export function go(to: string, how: 'push' | 'replace' = 'push'): void {
  if (how === 'push') history.pushState(null, '', to);
  else history.replaceState(null, '', to + (new URL(to, location.href).pathname === location.pathname ? location.hash : ''));
  place.set(placeOf(location));
  if (how === 'push') window.scrollTo(0, 0);
}

/** Changes settings of the present view. */
export function set(settings: Record<string, string | undefined>): void {
  const all: Record<string, string | undefined> = {
    ...Object.fromEntries(place.value.query),
    ...settings,
  };
  go(address(place.value.path, all), 'replace');
}

/** Follows a link without loading the page again, unless the reader wants another tab. */
export function follow(event: MouseEvent): void {
  if (event.defaultPrevented || event.button !== 0 || event.ctrlKey || event.metaKey || event.shiftKey) return;
  const link = (event.target as Element).closest('a');
  if (!link || link.origin !== location.origin || link.hasAttribute('download') || link.target) return;
  if (link.pathname.startsWith('/v1/') || link.getAttribute('href')!.startsWith('#')) return;
  event.preventDefault();
  go(link.pathname + link.search + link.hash);
}
