import type { Label } from '../api/types';
import { labelText } from '../labels';
import { address } from '../router';

/** The labels of a campaign or a job; each leads to the list of those that have it. */
export function Labels({ of, labels }: { of: 'campaigns' | 'jobs'; labels: Label[] | undefined }) {
  if (!labels || labels.length === 0) return null;
  return (
    <ul class="labels" aria-label="Labels">
      {labels.map((each) => (
        <li key={each.key}><a href={address(`/${of}`, { label: labelText(each) })}>{labelText(each)}</a></li>
      ))}
    </ul>
  );
}
