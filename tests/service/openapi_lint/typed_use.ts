// What a client in TypeScript may write, with the types that openapi-typescript makes of the
// description: compiled, never run.
import createClient from 'openapi-fetch';
import type { components, paths } from './api.d.ts';

const client = createClient<paths, 'application/json'>({ baseUrl: '' });
const simulation = { path: { simulation: '1' } };
const campaign = { path: { campaign: '1' } };

export async function use() {
  const { data } = await client.GET('/v1/simulations/{simulation}', { params: simulation });
  if (data === undefined) return;
  const state: components['schemas']['Simulation.State'] = data.state;
  const pinned: boolean = data.pinned;
  await client.POST('/v1/simulations/{simulation}:pin', { params: simulation });
  await client.PATCH('/v1/simulations/{simulation}', { params: simulation, body: { display_name: 'x' } });
  const ranking = await client.POST('/v1/campaigns/{campaign}:rank', { params: campaign, body: { count: 5 } });
  const best: number | undefined = ranking.data?.candidates[0].candidate;
  // @ts-expect-error The path has the name.
  await client.POST('/v1/campaigns/{campaign}:rank', { params: campaign, body: { name: 'campaigns/1' } });
  return { state, pinned, best };
}
