import type { ComponentType } from 'preact';
import { useEffect, useState } from 'preact/hooks';
import { awaySince, isPassing, readSession, returns, session, signOut } from '../api/client';
import { theme, type Theme } from '../charts/theme';
import { address, follow, go, place } from '../router';
import { useStore } from '../store';
import { units } from '../units';
import { Home } from '../views/home';
import { Keys } from './keys';
import { Missing } from './missing';
import { Failure, Notice, Waiting } from './notice';
import { SignIn } from './sign_in';
import { UnitChoices } from './unit_choices';

/** Views of the bar; the minor ones stand behind "More" where the bar is narrow. */
const LINKS: { path: string; word: string; isMinor?: boolean }[] = [
  { path: '/', word: 'Home' }, { path: '/curves', word: 'Curves' }, { path: '/compare', word: 'Compare', isMinor: true },
  { path: '/fluids', word: 'Fluids' }, { path: '/jobs', word: 'Jobs' }, { path: '/campaigns', word: 'Campaigns', isMinor: true },
  { path: '/cycles', word: 'Cycles', isMinor: true }, { path: '/rigs', word: 'Rigs', isMinor: true }, { path: '/paper', word: 'The paper', isMinor: true }, { path: '/more', word: 'More' },
];

/** Views by the first word of the path; each but the first has its own chunk. */
const VIEWS: Record<string, () => Promise<ComponentType>> = {
  campaigns: async () => (await import('../views/campaigns')).Campaigns,
  compare: async () => (await import('../views/compare')).Compare,
  cycles: async () => (await import('../views/cycles')).Cycles,
  curves: async () => (await import('../views/curves')).Curves,
  fluids: async () => (await import('../views/fluids')).Fluids,
  more: async () => (await import('../views/more')).More,
  jobs: async () => (await import('../views/jobs')).Jobs,
  paper: async () => (await import('../views/paper')).Paper,
  point: async () => (await import('../views/point')).Point,
  rigs: async () => (await import('../views/rigs')).Rigs,
};

const RELOADED = 'reloaded'; // in the storage of the tab: the page was loaded again for a view

/** Loads a view. Where its file is gone, as after an upgrade of the server, the page loads again, once. */
async function loadView(load: () => Promise<ComponentType>): Promise<ComponentType | 'loading' | 'failed'> {
  try {
    const view = await load();
    sessionStorage.removeItem(RELOADED);
    return view;
  } catch {
    await readSession(); // fails while the server is away
    if (sessionStorage.getItem(RELOADED)) return 'failed';
    sessionStorage.setItem(RELOADED, 'yes');
    window.location.reload();
    return 'loading';
  }
}

function useView(path: string): ComponentType | 'loading' | 'missing' | 'failed' {
  const word = path.split('/')[1] ?? '';
  const count = useStore(returns);
  const [views, setViews] = useState<Record<string, ComponentType | 'loading' | 'failed'>>({ '': Home });
  useEffect(() => {
    const load = VIEWS[word];
    if (!load || typeof views[word] === 'function') return;
    // It is loaded again once the server is back.
    loadView(load).then((view) => setViews((all) => ({ ...all, [word]: view })), () => undefined);
  }, [word, count]);
  return views[word] ?? (VIEWS[word] ? 'loading' : 'missing');
}

function Account() {
  const who = useStore(session);
  const chosen = useStore(theme);
  const projects = who?.projects ?? [];
  const project = useStore(place).project;
  const next: Record<Theme, Theme> = { system: 'light', light: 'dark', dark: 'system' };
  return (
    <div class="account">
      {projects.length > 1 && (
        <select aria-label="Project" value={project} onChange={(event) => {
          const chosenProject = event.currentTarget.value;
          go(chosenProject === 'default' ? '/' : `/p/${chosenProject}/`);
        }}>
          {projects.map((each) => <option key={each}>{each}</option>)}
        </select>
      )}
      <UnitChoices />
      <button class="quiet" onClick={() => theme.set(next[chosen])} title="Colors: system, light, dark">
        {{ system: 'Auto', light: 'Light', dark: 'Dark' }[chosen]}
      </button>
      {who && <button class="quiet" onClick={() => void signOut()} title={`Signed in as ${who.principal}`}>Sign out</button>}
    </div>
  );
}

/** The bar, the view of the address, and what may lie over it. */
export function Shell() {
  const { path, project } = useStore(place);
  const who = useStore(session);
  const away = useStore(awaySince);
  useStore(units);
  const View = useView(path);
  // A session that ends leaves the page as it is: the dialog lies over it.
  const [hasBegun, setBegun] = useState(false);
  if (who && !hasBegun) setBegun(true);
  const count = useStore(returns);
  const [problem, setProblem] = useState<unknown>();
  useEffect(() => {
    readSession().then(() => setProblem(undefined), setProblem);
  }, [count]);
  const isForeign = who && who.projects.length > 0 && !who.projects.includes(project);
  useEffect(() => {
    if (!isForeign) return;
    const first = who.projects[0]!;
    go(first === 'default' ? '/' : `/p/${first}/`, 'replace');
  }, [isForeign]);
  const current = (link: string) => (link === '/' ? path === '/' : path.startsWith(link));
  return (
    <div onClick={follow}>
      <a class="skip" href="#content">Skip to the content</a>
      <header class="bar">
        <a class="brand" href={address('/')}>Tribodyn</a>
        <nav aria-label="Views">
          {LINKS.map(({ path: link, word, isMinor }) => (
            <a key={link} class={isMinor ? 'minor' : link === '/more' ? 'more' : ''} href={address(link)} aria-current={current(link) ? 'page' : undefined}>{word}</a>
          ))}
          <a class="minor" href="/docs" target="_blank">API</a>
        </nav>
        <Account />
      </header>
      {!away ? <Waiting /> : (
        <Notice kind="caution">
          <span data-away>Not connected since {away.toLocaleTimeString()}. The page shows what was loaded, and connects again by itself.</span>
        </Notice>
      )}
      <main id="content" tabIndex={-1} key={project}>
        {who === undefined && problem !== undefined && !isPassing(problem) ? <Failure error={problem} onRetry={() => window.location.reload()} />
          : who === undefined || isForeign ? <p class="muted">Loading …</p>
          : View === 'missing' ? <Missing />
          : View === 'failed' ? (
            <Notice kind="error">
              <p>The server does not have this view.</p>
              <button onClick={() => window.location.reload()}>Load the page again</button>
            </Notice>
          )
          : View === 'loading' ? <p class="muted">Loading …</p>
          : hasBegun ? <View /> : null}
      </main>
      <Keys />
      {who === null && <SignIn />}
    </div>
  );
}
