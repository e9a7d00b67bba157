import type { ComponentChildren } from 'preact';
import { useState } from 'preact/hooks';
import type { Spec } from '../charts/spec';
import { pngOf, save, svgOf } from '../charts/svg';

interface TakeAwayProps {
  name: string; // of files, without their ending
  spec?: Spec;
  footer?: string[]; // beneath the figure: what a reader needs to repeat it
  csv?: () => string; // a table of the numbers shown
  requests: unknown;
  commands: string[];
  link?: string; // to the page as it is, with revisions; default: its address
  children?: ComponentChildren; // further downloads
}

/** Everything that can be taken away from a view: figure, numbers, request, command line, link. */
export function TakeAway({ name, spec, footer = [], csv, requests, commands, link, children }: TakeAwayProps) {
  const [copied, setCopied] = useState('');
  const [byHand, setByHand] = useState('');
  const linkText = link === undefined ? location.href : location.origin + link;
  const copy = async (what: string, text: string) => {
    try {
      await navigator.clipboard.writeText(text);
      setCopied(what);
    } catch {
      // Browsers have a clipboard for addresses with TLS and of this machine alone.
      return setByHand(text);
    }
    setTimeout(() => setCopied(''), 2000);
  };
  const svg = () => svgOf(spec!, footer);
  const file = (ending: string, type: string, text: string) => save(`${name}.${ending}`, new Blob([text], { type }));
  return (
    <details class="menu">
      <summary class="button">Take away</summary>
      <div class="menu-body">
        {spec && <button onClick={() => file('svg', 'image/svg+xml', svg())}>Figure as SVG</button>}
        {spec && <button onClick={() => void pngOf(svg()).then((png) => save(`${name}.png`, png))}>Figure as PNG</button>}
        {csv && <button onClick={() => file('csv', 'text/csv', csv())}>Numbers as CSV</button>}
        {children}
        <button onClick={() => save('request.json', new Blob([JSON.stringify(requests, null, 2)], { type: 'application/json' }))}>Request as JSON</button>
        {commands.length > 0 && <button onClick={() => void copy('command', commands.join('\n'))}>{copied === 'command' ? 'Copied' : 'Copy the command line'}</button>}
        <button onClick={() => void copy('link', linkText)}>{copied === 'link' ? 'Copied' : 'Copy a link to this page'}</button>
        {byHand && <label>Copy this by hand<input readOnly value={byHand} onFocus={(event) => event.currentTarget.select()} /></label>}
        {commands.length > 0 && <pre class="command" tabIndex={0} aria-label="Command line">{commands.join('\n')}</pre>}
      </div>
    </details>
  );
}

/** A table as CSV, with all digits of the service; an empty cell is no number. An apostrophe stops spreadsheets from computing a text. */
export const csvOf = (header: string[], rows: (number | string | null)[][]): string =>
  [header, ...rows].map((row) => row.map((cell) => (typeof cell === 'string' ? csvText(cell) : cell ?? '')).join(',')).join('\n') + '\n';

function csvText(text: string): string {
  const guarded = /^'*[=+\-@\t\r]/.test(text) && (text.trim() === '' || Number.isNaN(Number(text))) ? `'${text}` : text;
  return /[",;\t\r\n]|^[ #]| $/.test(guarded) ? `"${guarded.replaceAll('"', '""')}"` : guarded;
}
