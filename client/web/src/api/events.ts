import type { CampaignEvent, SimulationEvent } from './types';
import { awaySince, readSession, url } from './client';

const RETRY_MILLISECONDS = 1500;

export interface Stream {
  close: () => void;
}

/**
 * Follows a stream of events from the one with the number `first` on. The stream is opened again
 * until close() is called or the server has ended it; `onReopen` is called before events that may
 * repeat what is shown already. While the page is hidden it has no stream: a browser opens six
 * connections to a server for all its tabs together.
 */
function follow<Message>(addressAfter: (last: string) => string, first: string, onEvent: (event: Message) => void, onReopen: () => void): Stream {
  let source: EventSource | undefined;
  let timer: number | undefined;
  let last = first;
  const open = () => {
    source?.close();
    if (document.hidden) return;
    source = new EventSource(addressAfter(last));
    source.onmessage = (message) => {
      if (message.lastEventId !== '') last = message.lastEventId;
      onEvent(JSON.parse(message.data));
    };
    source.addEventListener('end', close);
    source.onerror = () => {
      // A browser connects again by itself, but not after a refusal.
      if (source!.readyState !== EventSource.CLOSED) return;
      timer = window.setTimeout(async () => {
        try {
          await readSession();
          onReopen();
          open();
        } catch {
          source!.onerror!(new Event('error'));
        }
      }, RETRY_MILLISECONDS);
    };
  };
  const close = () => {
    source?.close();
    clearTimeout(timer);
    unsubscribe();
    document.removeEventListener('visibilitychange', openAgain);
  };
  const openAgain = () => {
    clearTimeout(timer);
    if (!document.hidden) onReopen();
    open();
  };
  const unsubscribe = awaySince.subscribe(() => {
    if (awaySince.value === null) openAgain();
  });
  document.addEventListener('visibilitychange', openAgain);
  open();
  return { close };
}

/** Follows simulations in one stream: those with the names, or all that are created after `afterEvent`. */
export function watch(
  which: { names: string[] } | { afterEvent: string },
  onEvent: (event: SimulationEvent) => void,
  onReopen: () => void = () => {},
): Stream {
  const names = 'names' in which ? { names: which.names } : {};
  return follow((last) => url('simulations:watch', { ...names, after_event_number: last }),
    'afterEvent' in which ? which.afterEvent : '0', onEvent, onReopen);
}

/** Follows a campaign until it ends or is deleted. */
export const watchCampaign = (name: string, onEvent: (event: CampaignEvent) => void): Stream =>
  follow((last) => url(`${name}:watch`, { after_version: last }), '0', onEvent, () => {});
