import { address } from '../router';

const PLACES: [string, string, string][] = [
  ['/compare', 'Compare', 'Two fluids: who loses less, how sure that is, and why'],
  ['/campaigns', 'Campaigns', 'Thousands of candidates: ranks, fronts, ranges'],
  ['/cycles', 'Cycles', 'The energy that the mesh loses over a drive cycle, when, and where it arises'],
  ['/rigs', 'Rigs', 'Traction, film and Stribeck curves of a ball on a disc'],
  ['/paper', 'The paper', 'Figures of Paouris et al. (2018) as curves of this server'],
  ['/docs', 'Programs', 'Every address and field of the interface for programs'],
];

/** Views that have no place in a narrow bar. */
export function More() {
  return (
    <>
      <h1>More</h1>
      <ul class="places">
        {PLACES.map(([path, title, words]) => <li key={path}><a href={path === '/docs' ? path : address(path)} target={path === '/docs' ? '_blank' : undefined}>{title}</a><span class="muted">{words}</span></li>)}
      </ul>
    </>
  );
}
