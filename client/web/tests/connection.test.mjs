// What a page does when the server goes away and comes back, when its session ends, and when it is made to wait.
import assert from 'node:assert/strict';
import { cpSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { campaignOf, launch, newPage, newTab, Server, signIn } from './harness.mjs';

const BACK_MILLISECONDS = 5000; // from a restart until a page is usable again

let browser;
let server;
before(async () => {
  browser = await launch();
  server = await new Server().start();
  await server.newOil('my-oil', 'My oil', 103, 15.1, 868);
  for (const fluid of [1, 2]) {
    await server.call('POST', '/v1/simulations', {
      lubricant: `lubricants/paper-fluid-${fluid}`,
      inefficiency_curve: { first_speed_kilometres_per_hour: 60, last_speed_kilometres_per_hour: 90, speed_step_kilometres_per_hour: 10 },
    });
  }
  await server.call('POST', '/v1/simulations', {
    lubricant: 'lubricants/paper-fluid-1',
    operating_point: { cruise: { speed_kilometres_per_hour: 75 }, history: { columns: ['mesh_phase_cycles', 'mesh_force_newtons'], mesh_cycles: 2, samples_per_mesh_cycle: 60 } },
  });
  await server.call('POST', '/v1/campaigns', campaignOf(4));
  for (const each of ['simulations/1', 'simulations/2', 'simulations/3', 'campaigns/1']) {
    while ((await server.call('GET', `/v1/${each}`)).state !== 'SUCCEEDED') await new Promise((done) => setTimeout(done, 50));
  }
});
after(async () => {
  await browser?.close();
  await server?.remove();
});

/** A page of a browser of its own, which is closed with the scenario. */
async function signedIn(scenario, address, token = server.token) {
  const page = await newPage(browser, server);
  scenario.after(() => page.context().close());
  await page.goto(server.address + address);
  await signIn(page, token);
  return page;
}

/** Every route of the dashboard, and what is there once its view is usable. */
const ROUTES = [
  ['/', '.runs li'],
  ['/curves?r=1,2', '.read-out tbody tr'],
  ['/compare?a=paper-fluid-1&b=paper-fluid-2&from=60&to=60', '.bars'],
  ['/fluids', 'tbody tr'],
  ['/fluids/new', '.fluid-form'],
  ['/fluids/my-oil', '.parameters tbody tr'],
  ['/fluids/my-oil?tab=viscosity', '.u-over'],
  ['/fluids/my-oil/edit', '.fluid-form'],
  ['/jobs', 'tbody tr'],
  ['/jobs/1', '.assumptions'],
  ['/point/3', '.histories canvas'],
  ['/campaigns', 'tbody tr'],
  ['/campaigns/new', '.drop'],
  ['/campaigns/1', '.ranking tbody tr'],
  ['/campaigns/1/append', '.drop'],
  ['/cycles?f=paper-fluid-1', '.over-time canvas'],
  ['/rigs?f=paper-fluid-1&u=0', '.read-out'],
  ['/paper', '.places'],
  ['/more', '.places'],
];

/** Every route in a tab of its own. */
async function openAll(context) {
  return Promise.all(ROUTES.map(async ([address, mark]) => {
    const page = await newTab(context, server);
    await page.goto(server.address + address);
    await page.locator(mark).first().waitFor({ timeout: 60_000 });
    return { page, address, mark };
  }));
}

/** Starts the server again; returns the addresses of tabs that are not usable in time. */
async function unusableAfterStart(tabs, timeout = BACK_MILLISECONDS) {
  await server.start();
  const late = await Promise.all(tabs.map(async ({ page, address, mark }) => {
    try {
      await page.locator(mark).first().waitFor({ timeout });
      await page.locator('[data-away]').waitFor({ state: 'detached', timeout });
      return [];
    } catch {
      return [address];
    }
  }));
  return late.flat();
}

test('every view shows what was loaded while the server is away, and is usable once it is back', async (scenario) => {
  const first = await signedIn(scenario, '/');
  const began = Date.now();
  const tabs = await openAll(first.context());
  // A busy machine: as long as it takes to open all views.
  const timeout = Math.max(BACK_MILLISECONDS, Date.now() - began);
  await server.stop('SIGKILL');
  // A form that is changed asks the server, and so does a view that is left and entered again.
  for (const { page, address } of tabs) if (/compare|cycles|rigs/.test(address)) await page.locator('label', { hasText: 'Isothermal' }).locator('input').evaluate((box) => box.click());
  await tabs.find(({ address }) => address.startsWith('/compare')).page.locator('[data-away]').waitFor();
  for (const { page, address, mark } of tabs) assert.ok(await page.locator(mark).first().isVisible(), address);
  assert.deepEqual(await unusableAfterStart(tabs, timeout), []);
  await server.stop('SIGKILL');
  await Promise.all(tabs.map(async ({ page }) => {
    const { href } = new URL(page.url());
    await page.evaluate(() => document.querySelector('header .brand').click());
    await page.goBack();
    assert.equal(page.url(), href);
  }));
  assert.deepEqual(await unusableAfterStart(tabs, timeout), []);
});

test('a view whose code was not loaded before the server went away appears once it is back', async (scenario) => {
  const page = await signedIn(scenario, '/');
  await server.stop('SIGKILL');
  await page.getByRole('link', { name: 'Fluids' }).click();
  await page.locator('[data-away]').waitFor();
  assert.deepEqual(await unusableAfterStart([{ page, address: '/fluids', mark: 'tbody tr' }]), []);
  assert.equal(await page.evaluate(() => performance.getEntriesByType('navigation')[0].type), 'navigate', 'the page was not loaded again');
});

/** A copy of the dashboard as another build: its files have other names. */
function otherBuild() {
  const folder = mkdtempSync(path.join(tmpdir(), 'tribodyn-build-'));
  cpSync('dist', folder, { recursive: true, filter: (from) => !from.endsWith('.gz') });
  const assets = path.join(folder, 'assets');
  const names = readdirSync(assets).map((each) => each.replace(/\.\w+$/, ''));
  const renamed = (text) => names.reduce((out, name) => out.replaceAll(name, `${name}-next`), text);
  for (const file of [path.join(folder, 'index.html'), ...readdirSync(assets).map((each) => path.join(assets, each))]) {
    const text = renamed(readFileSync(file, 'utf8'));
    rmSync(file);
    writeFileSync(path.join(path.dirname(file), renamed(path.basename(file))), text);
  }
  return folder;
}

/** Serves another folder from the same address. */
async function serve(folder) {
  await server.stop();
  server.flags = folder ? ['--dashboard', folder] : [];
  await server.start();
}

test('a page that is open over an upgrade loads itself again for a view whose file is gone, and keeps its drafts', async (scenario) => {
  const folder = otherBuild();
  const page = await signedIn(scenario, '/campaigns/new');
  try {
    await page.getByRole('textbox', { name: 'Or paste it' }).fill('name;alpha* [1/GPa]\nA-1;14\nA-2;15\n');
    await page.locator('.estimate:not(.muted)').waitFor();
    await serve(folder);
    page.expect(404, '/assets/');
    await page.getByRole('link', { name: 'Fluids' }).click();
    await page.locator('tbody tr').first().waitFor();
    await page.goBack();
    await page.locator('.estimate:not(.muted)').waitFor();
  } finally {
    await serve();
    rmSync(folder, { recursive: true });
  }
});

test('a view whose file is missing altogether has an error, and the page loads itself again once at most', async (scenario) => {
  const folder = otherBuild();
  for (const each of readdirSync(path.join(folder, 'assets'))) if (each.startsWith('fluids-')) rmSync(path.join(folder, 'assets', each));
  try {
    await serve(folder);
    const page = await signedIn(scenario, '/');
    let loads = 0;
    page.on('domcontentloaded', () => ++loads);
    page.expect(404, '/assets/fluids');
    await page.getByRole('link', { name: 'Fluids' }).click();
    await page.locator('main .notice.error').waitFor();
    await page.waitForTimeout(500);
    assert.equal(loads, 1);
    await page.getByRole('link', { name: 'Jobs' }).click();
    await page.locator('table.jobs tbody tr').first().waitFor();
  } finally {
    await serve();
    rmSync(folder, { recursive: true });
  }
});

test('what a server that went away was asked to do is not shown as done', async (scenario) => {
  const page = await signedIn(scenario, '/curves?f=paper-fluid-1');
  await page.locator('.panel select option').first().waitFor({ state: 'attached' });
  await server.stop('SIGKILL');
  await page.getByRole('button', { name: 'Run the curve' }).click();
  await page.locator('.panel .notice.error').waitFor();
  await server.start();
  await page.locator('[data-away]').waitFor({ state: 'detached' });
  assert.ok(await page.locator('.panel .notice.error').isVisible());
  await page.getByRole('button', { name: 'Run the curve' }).click();
  await page.locator('.read-out').waitFor();
  assert.equal(await page.locator('.panel .notice.error').count(), 0);
});

test('signing out in one tab signs out every tab, and none shows a formulation any more', async (scenario) => {
  const page = await signedIn(scenario, '/campaigns/new');
  const others = await Promise.all(['/fluids/my-oil', '/fluids/my-oil/edit'].map(async (address) => {
    const other = await newTab(page.context(), server);
    await other.goto(server.address + address);
    await other.getByRole('heading', { name: 'My oil' }).waitFor();
    await other.evaluate(() => sessionStorage.setItem('campaign table', 'a draft'));
    return other;
  }));
  await page.getByRole('button', { name: 'Sign out' }).click();
  for (const other of others) {
    await other.getByRole('dialog').waitFor();
    assert.equal(await other.getByText('My oil').count(), 0);
    assert.equal(await other.evaluate(() => sessionStorage.length), 0);
    await other.goBack();
    await other.getByRole('dialog').waitFor();
    assert.equal(await other.getByText('My oil').count(), 0);
  }
});

test('a session that is read again and is as before loads nothing again', async (scenario) => {
  const page = await signedIn(scenario, '/');
  // A stream that is refused has the page read its session.
  let refused = 0;
  await page.route('**/simulations:watch*', (route) => (++refused > 2 ? undefined : route.fulfill({ status: 503, body: '' })));
  page.expect(503, 'simulations:watch');
  const lists = [];
  page.on('request', (request) => { if (/\/v1\/lubricants/.test(request.url())) lists.push(request.url()); });
  await page.goto(`${server.address}/jobs`);
  while (refused < 3) await page.waitForTimeout(100);
  assert.equal(lists.length, 1, lists.join('\n'));
});

test('a guest with a small quota of calls gets every view, slower, and reads what it waits for', async (scenario) => {
  const page = await signedIn(scenario, '/more', await server.newToken('guest', '--calls-per-second', '2'));
  page.expect(429, '/v1/');
  for (const address of ['/curves?r=1,2', '/campaigns/1']) {
    await page.goto(server.address + address);
    await page.locator(ROUTES.find(([route]) => route === address)[1]).first().waitFor();
    assert.equal(await page.locator('.notice.error').count(), 0);
  }
});

test('a page that is made to wait for long counts down to its next try', async (scenario) => {
  const page = await signedIn(scenario, '/more', await server.newToken('slow-guest', '--calls-per-second', '0.25'));
  page.expect(429, '/v1/');
  await page.goto(`${server.address}/fluids/my-oil`);
  const seconds = async () => Number.parseInt(await page.getByRole('timer').textContent(), 10);
  await page.getByRole('timer').waitFor();
  const first = await seconds();
  assert.ok(first > 1 && first <= 60, `${first} s`);
  await page.waitForFunction((before) => Number.parseInt(document.querySelector('[role="timer"]')?.textContent ?? '0', 10) < before, first);
  await page.locator('.parameters tbody tr').first().waitFor();
  await page.getByRole('timer').waitFor({ state: 'detached' });
});
