import type { SimulationEvent } from './types';
import { awaySince, readSession, url } from './client';

const RETRY_MILLISECONDS = 1500;

/**
 * Follows the events of simulations in one stream: those with the names, or all that are created
 * after `afterEvent`. The stream is opened again until close() is called or the server has ended it;
 * `onReopen` is called before events that may repeat what is shown already.
 */
export function watch(
  which: { names: string[] } | { afterEvent: string },
  onEvent: (event: SimulationEvent) => void,
  onReopen: () => void = () => {},
): { close: () => void } {
  let source: EventSource | undefined;
  let timer: number | undefined;
  let last = 'afterEvent' in which ? which.afterEvent : '0';
  const open = () => {
    const names = 'names' in which ? { names: which.names } : {};
    source = new EventSource(url('simulations:watch', { ...names, after_event_number: last }));
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
  };
  const unsubscribe = awaySince.subscribe(() => {
    if (awaySince.value !== null) return;
    source?.close();
    onReopen();
    open();
  });
  open();
  return { close };
}
