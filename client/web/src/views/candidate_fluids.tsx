import { useState } from 'preact/hooks';
import { get, url } from '../api/client';
import type { ListLubricantsResponse } from '../api/types';
import { Entry } from '../components/entry';
import { shortTitle } from '../curve';
import { idOf } from '../format';
import { titlesOf, useLoaded, useLubricants } from '../resources';

const MOST_SHOWN = 200;

/** Chooses lubricants of the database as candidates. */
export function FluidChoice({ chosen, onChange, problemOf, taken = [] }: {
  chosen: string[]; // ids
  onChange: (ids: string[]) => void;
  problemOf: (id: string) => string | undefined;
  taken?: string[]; // ids of those that are candidates already
}) {
  const titles = titlesOf(useLubricants().value);
  const [search, setSearch] = useState('');
  const fits = [...titles].filter(([id, title]) => !taken.includes(id) && `${id} ${title}`.toLowerCase().includes(search.toLowerCase()));
  const toggle = (id: string) => onChange(chosen.includes(id) ? chosen.filter((each) => each !== id) : [...chosen, id]);
  return (
    <fieldset class="fluid-choice">
      <legend>Fluids <span class="count">{chosen.length} chosen</span></legend>
      {titles.size > 8 && <label>Search<input type="search" value={search} onInput={(event) => setSearch(event.currentTarget.value)} /></label>}
      <div class="fluid-list" tabIndex={0} role="region" aria-label="Fluids of the database">
        {fits.slice(0, MOST_SHOWN).map(([id, title]) => (
          <div key={id}>
            <label class="choice"><input type="checkbox" checked={chosen.includes(id)} onChange={() => toggle(id)} /> <span>{shortTitle(title)}</span></label>
            {problemOf(id) && <span class="problem" role="alert">{problemOf(id)}</span>}
          </div>
        ))}
        {fits.length > MOST_SHOWN && <p class="small">and {fits.length - MOST_SHOWN} more: search, or state a filter</p>}
        {fits.length === 0 && <p class="muted">No fluid has these words.</p>}
      </div>
      <div class="actions">
        <button type="button" onClick={() => onChange([...new Set([...chosen, ...fits.map(([id]) => id)])])}>Choose {search ? 'these' : 'all'}</button>
        <button type="button" disabled={chosen.length === 0} onClick={() => onChange([])}>Choose none</button>
      </div>
    </fieldset>
  );
}

/** States a filter; the fluids that satisfy it now stand beneath. */
export function FluidFilter({ filter, onChange, problem }: { filter: string; onChange: (filter: string) => void; problem: string | undefined }) {
  const found = useLoaded((signal) => (filter === '' ? Promise.resolve(null)
    : get<ListLubricantsResponse>(url('lubricants', { page_size: MOST_SHOWN, filter, read_mask: 'name,display_name' }), signal)), filter);
  const fluids = found.error === undefined ? found.value?.lubricants ?? [] : [];
  return (
    <fieldset>
      <legend>Fluids that satisfy a filter when the campaign is created</legend>
      <label>Filter
        <Entry value={filter} placeholder='kv100 > 14 AND base_oil_class = polyalphaolefin' spellcheck={false} aria-invalid={problem !== undefined}
          onChange={(event) => onChange(event.currentTarget.value.trim())} />
        {problem && <span class="problem" role="alert">{problem}</span>}
      </label>
      <p class="small">Conditions joined by AND, e.g. <code>labels.series = b</code>, <code>vi &gt; 150</code>, <code>sae_grade = 75W-90</code>, <code>display_name : PAO</code>.</p>
      {fluids.length > 0 && (
        <ul class="key" aria-label="Fluids that satisfy the filter">
          {fluids.map((each) => <li key={each.name}>{shortTitle(each.display_name || idOf(each.name))}</li>)}
          {found.value?.next_page_token && <li>and more</li>}
        </ul>
      )}
    </fieldset>
  );
}
