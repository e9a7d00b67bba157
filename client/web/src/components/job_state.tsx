import type { Simulation } from '../api/types';

const WORDS: Record<string, string> = {
  QUEUED: 'waits', RUNNING: 'runs', SUCCEEDED: 'done', FAILED: 'failed', CANCELLED: 'cancelled',
};

export function JobState({ simulation }: { simulation: Simulation }) {
  const state = simulation.state ?? 'QUEUED';
  if (state === 'RUNNING') {
    const percent = Math.round(100 * (simulation.progress_fraction ?? 0));
    return (
      <span class="state running">
        <progress max={100} value={percent} aria-label="Progress" /> {percent} %
      </span>
    );
  }
  return <span class={`state ${state.toLowerCase()}`}>{WORDS[state] ?? state}</span>;
}
