/** How a value is known, in a word. */
export const PROVENANCE: Record<string, string> = {
  PROVENANCE_PUBLISHED: 'published', PROVENANCE_DERIVED: 'derived', PROVENANCE_LITERATURE: 'literature',
  PROVENANCE_MEASURED: 'measured', PROVENANCE_FITTED: 'fitted', PROVENANCE_ASSUMED: 'assumed',
  PROVENANCE_CALIBRATED: 'calibrated', PROVENANCE_USER: 'entered',
};
