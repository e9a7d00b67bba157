import { useEffect, useRef, useState } from 'preact/hooks';
import { address, go } from '../router';
import { Store, useStore } from '../store';

const PLACES: Record<string, [string, string]> = {
  h: ['/', 'Home'], c: ['/curves', 'Curves'], v: ['/compare', 'Compare'], f: ['/fluids', 'Fluids'], j: ['/jobs', 'Jobs'],
  s: ['/campaigns', 'Campaigns'], d: ['/cycles', 'Cycles'], r: ['/rigs', 'Rigs'], p: ['/paper', 'The paper'],
};
const FOLLOW_MILLISECONDS = 1500; // between g and its letter: slow typing
const SEARCH_TRIES = 60; // frames until the search of a view stands there: a second

const STORED = 'keys';
/** Whether single keys do something. */
const keys = new Store<boolean>(localStorage.getItem(STORED) !== 'off');
keys.subscribe(() => localStorage.setItem(STORED, keys.value ? 'on' : 'off'));

const isTyping = (target: EventTarget | null): boolean =>
  target instanceof HTMLElement && target.closest('input:not([type="checkbox"], [type="radio"], [type="range"]), select, textarea, dialog') !== null;

/** Sets the focus to the search of the view, or to that of the fluids. */
function search(tries = SEARCH_TRIES): void {
  const field = document.querySelector<HTMLInputElement>('main input[type="search"]');
  if (field) return field.focus();
  if (tries === SEARCH_TRIES) go(address('/fluids'));
  if (tries > 0) requestAnimationFrame(() => search(tries - 1));
}

/** Single keys that lead to views and to the parts of a view, and their list. */
export function Keys() {
  const isOn = useStore(keys);
  const dialog = useRef<HTMLDialogElement>(null);
  const [isOpen, setOpen] = useState(false);
  useEffect(() => {
    let lastG = -Infinity;
    const press = (event: KeyboardEvent) => {
      if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented || isTyping(event.target) || document.querySelector('dialog[open]')) return;
      if (event.key === '?') {
        setOpen(true);
        return;
      }
      if (!keys.value) return;
      const place = event.timeStamp - lastG < FOLLOW_MILLISECONDS ? PLACES[event.key] : undefined;
      lastG = event.key === 'g' ? event.timeStamp : -Infinity;
      const part = document.querySelector<HTMLElement>(`main [data-key="${CSS.escape(event.key)}"]`);
      if (place) go(address(place[0]));
      else if (event.key === '/') search();
      else if (part) part.click();
      else return;
      event.preventDefault();
    };
    document.addEventListener('keydown', press);
    return () => document.removeEventListener('keydown', press);
  }, []);
  useEffect(() => {
    if (isOpen) dialog.current!.showModal();
  }, [isOpen]);
  if (!isOpen) return null;
  const row = (key: string, words: string) => <><dt><kbd>{key}</kbd></dt><dd>{words}</dd></>;
  return (
    <dialog ref={dialog} class="keys" aria-labelledby="keys" onClose={() => setOpen(false)}>
      <h1 id="keys">Keys</h1>
      <dl class="facts">
        {Object.entries(PLACES).map(([key, [, word]]) => row(`g ${key}`, word))}
        {row('/', 'Search the fluids')}{row('r', 'Run the curves of the form')}{row('t', 'Every speed as a table')}{row('?', 'This list')}
      </dl>
      <label class="choice"><input type="checkbox" checked={isOn} onChange={() => keys.set(!isOn)} /> <span>Single keys do this</span></label>
      <button class="wide" onClick={() => dialog.current!.close()}>Leave</button>
    </dialog>
  );
}
