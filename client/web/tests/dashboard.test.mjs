// The dashboard as its users meet it: a real browser, a real server, nothing faked.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { foreignNumbers, launch, newPage, output, Server, signIn, TRIBODYN, TRIBODYND } from './harness.mjs';

let browser;
let server;
before(async () => {
  browser = await launch();
  server = await new Server().start();
});
after(async () => {
  await browser?.close();
  await server?.remove();
});

const FLUIDS = 'lubricants/paper-fluid-';

/** A job of some seconds: a march at each speed. */
function slowJob(speeds, fluid = 1) {
  return {
    lubricant: `${FLUIDS}${fluid}`,
    solver_options: { method: 'STEADY_STATE_METHOD_MARCH' },
    inefficiency_curve: { first_speed_kilometres_per_hour: 20, last_speed_kilometres_per_hour: 19 + speeds, speed_step_kilometres_per_hour: 1 },
  };
}

async function signedIn(path = '/', options = {}) {
  const page = await newPage(browser, server, options);
  await page.goto(server.address + path);
  await signIn(page, server.token);
  return page;
}

/** The number of colored pixels of the main plot that belong to lines. */
const inkOf = (page) =>
  page.locator('.figure canvas').first().evaluate((canvas) => {
    const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) {
      const most = Math.max(data[i], data[i + 1], data[i + 2]);
      if (data[i + 3] > 200 && most - Math.min(data[i], data[i + 1], data[i + 2]) > 60) ++count;
    }
    return count;
  });

test('an empty database leads to three plotted curves in one click', async () => {
  const page = await signedIn();
  await page.getByRole('button', { name: 'Run the three curves' }).click();
  await page.getByRole('heading', { name: /Mesh inefficiency/ }).waitFor();
  await page.waitForFunction(() => document.querySelectorAll('.read-out tbody tr').length === 3);
  assert.equal(new URL(page.url()).search, '?r=1,2,3');
  assert.ok((await inkOf(page)) > 2000, 'the lines are drawn');
  await page.context().close();
});

test('every number on the page is one of the service', async () => {
  const page = await signedIn('/curves?r=1,2,3');
  await page.waitForFunction(() => document.querySelectorAll('.read-out tbody tr').length === 3);
  await page.getByLabel('Speed', { exact: true }).press('Home');
  await page.getByRole('heading', { name: 'At 20 km/h' }).waitFor();
  await page.locator('.verdicts li').first().waitFor();
  assert.deepEqual(await foreignNumbers(page), []);
  const numbers = await page.locator('[data-simulation]').evaluateAll((all) =>
    all.map((each) => ({ ...each.dataset, text: each.textContent })));
  assert.ok(numbers.length >= 27);
  const tables = new Map();
  for (const each of numbers) {
    if (!tables.has(each.simulation)) tables.set(each.simulation, (await server.call('GET', `/v1/${each.simulation}?alt=columns`)).columns);
    const value = tables.get(each.simulation)[each.column][Number(each.row)];
    assert.equal(Number(each.value), value, `${each.simulation} ${each.column}`);
  }
  await page.context().close();
});

test('a figure, its numbers and its request can be taken away', async () => {
  const page = await signedIn('/curves?r=1,2,3&y=loss');
  await page.getByText('Take away').click();
  const download = async (name) => {
    const [file] = await Promise.all([page.waitForEvent('download'), page.getByText(name).first().click()]);
    return readFileSync(await file.path());
  };
  const svg = (await download('Figure as SVG')).toString();
  assert.match(svg, /Mesh loss[^]*Lubricant 2[^]*tribodyn-model-/);
  const png = await download('Figure as PNG');
  assert.equal(png.subarray(1, 4).toString(), 'PNG');
  assert.equal(png.readUInt32BE(16), 1920);
  const csv = (await download('All numbers of paper-fluid-1 as CSV')).toString();
  assert.match(csv, /^speed_kilometres_per_hour,/);
  const requests = JSON.parse((await download('Request as JSON')).toString());
  const again = await server.call('POST', '/v1/simulations', requests[1]);
  assert.equal(again.cache_hit, true, 'the request in JSON has the same inputs');
  const command = await page.getByLabel('Command line').textContent();
  const words = command.split(' ');
  assert.equal(words.shift(), 'tribodyn');
  await output(TRIBODYN, ['--server', `unix:${server.folder}/socket`, ...words]);
  const newest = (await server.call('GET', '/v1/simulations?page_size=3')).simulations;
  assert.ok(newest.every((each) => each.cache_hit), 'the command has the same inputs');
  await page.context().close();
});

test('a wrong token is refused in words, and no page is shown', async () => {
  const page = await newPage(browser, server);
  await page.goto(server.address + '/curves?r=1');
  page.expect(401, '/session');
  await page.getByLabel('Token').fill('no-such-token');
  await page.getByRole('button', { name: 'Sign in' }).click();
  await page.getByText('unknown, has expired or was revoked').waitFor();
  assert.equal(await page.locator('.read-out').count(), 0);
  await page.context().close();
});

test('a revoked token leads back to the log-in, and what was entered stays', async () => {
  const token = await server.newToken('anna');
  const page = await newPage(browser, server);
  await page.goto(server.address + '/curves?f=paper-fluid-1');
  await signIn(page, token);
  await page.getByLabel('Sump, °C').fill('77');
  await page.getByLabel('Sump, °C').blur();
  const cookies = await page.context().cookies();
  assert.deepEqual(cookies.map((each) => [each.httpOnly, each.sameSite, each.value.includes(token)]), [[true, 'Strict', false]]);
  assert.equal(await page.evaluate(() => document.cookie), '');
  await output(TRIBODYND, ['tokens', 'revoke', 'anna', '--database', server.database]);
  const isKnown = async () => (await fetch(`${server.address}/v1/lubricants`, { headers: { Authorization: `Bearer ${token}` } })).ok;
  while (await isKnown()) await new Promise((done) => setTimeout(done, 50)); // the server reads its tokens once a second
  page.expect(401, '/v1/simulations');
  await page.getByRole('button', { name: 'Run the curve' }).click();
  await page.getByRole('dialog').waitFor();
  await signIn(page, server.token);
  assert.equal(await page.getByLabel('Sump, °C').inputValue(), '77');
  await page.getByRole('button', { name: 'Run the curve' }).click();
  await page.locator('.read-out').waitFor();
  await page.context().close();
});

test('a reload amid a job goes on with its progress', async () => {
  const job = await server.call('POST', '/v1/simulations', slowJob(24));
  const page = await signedIn(`/curves?r=${job.name.split('/')[1]}`);
  await page.locator('.progress-row').waitFor();
  await page.reload();
  await page.locator('.progress-row').waitFor();
  await page.locator('.read-out').waitFor({ timeout: 40_000 });
  assert.equal(await page.locator('.progress-row').count(), 0);
  await page.context().close();
});

test('a hidden page holds no stream, and catches up once it is seen', async () => {
  const job = await server.call('POST', '/v1/simulations', slowJob(24, 3));
  const page = await signedIn();
  await page.addInitScript(() => {
    window.streams = [];
    window.EventSource = class extends EventSource {
      constructor(...all) {
        super(...all);
        window.streams.push(this);
      }
    };
  });
  await page.goto(`${server.address}/curves?r=${job.name.split('/')[1]}`);
  await page.locator('.progress-row').waitFor();
  const show = (isHidden) => page.evaluate((value) => {
    Object.defineProperty(document, 'hidden', { configurable: true, value });
    document.dispatchEvent(new Event('visibilitychange'));
    return window.streams.filter((each) => each.readyState !== EventSource.CLOSED).length;
  }, isHidden);
  assert.equal(await show(true), 0);
  await server.call('POST', `/v1/${job.name}:cancel`, {});
  assert.equal(await page.getByText(/cancelled/i).count(), 0);
  assert.ok(await show(false) > 0);
  await page.getByText(/cancelled/i).first().waitFor();
  await page.context().close();
});

test('a server that is killed and restarted amid a job is noticed and found again', async () => {
  const job = await server.call('POST', '/v1/simulations', slowJob(24, 2));
  const page = await signedIn(`/curves?r=${job.name.split('/')[1]}`);
  await page.locator('.progress-row').waitFor();
  await server.stop('SIGKILL');
  await page.getByRole('button', { name: /Run/ }).click();
  await page.getByText('Not connected since').waitFor();
  await server.start();
  await page.getByText('Not connected since').waitFor({ state: 'detached' });
  await page.locator('.read-out').waitFor({ timeout: 40_000 });
  assert.equal(await page.getByRole('dialog').count(), 0, 'the session outlives the server');
  await page.context().close();
});

test('a refused request names the field', async () => {
  const page = await signedIn('/curves?f=paper-fluid-1');
  page.expect(400, '/v1/simulations');
  await page.getByLabel('Sump, °C').fill('400');
  await page.getByLabel('Sump, °C').blur();
  await page.getByRole('button', { name: 'Run the curve' }).click();
  await page.locator('.panel .problem', { hasText: 'allowed: -70 to 200' }).waitFor();
  assert.equal(await page.getByLabel('Sump, °C').getAttribute('aria-invalid'), 'true');
  await page.context().close();
});

test('what is typed stays while lists arrive', async () => {
  const page = await signedIn();
  let release;
  const held = new Promise((resolve) => { release = resolve; });
  await page.route('**/v1/gearSets*', async (route) => {
    await held;
    await route.continue();
  });
  await page.goto(server.address + '/curves?f=paper-fluid-1');
  await page.getByLabel('Sump, °C').fill('90,');
  release();
  await page.locator('.panel select option').first().waitFor({ state: 'attached' });
  assert.equal(await page.getByLabel('Sump, °C').inputValue(), '90,');
  await page.getByLabel('Sump, °C').blur();
  assert.equal(await page.getByLabel('Sump, °C').inputValue(), '90');
  await page.context().close();
});

test('a server without the files of the dashboard says so in one line and serves everything else', async () => {
  const bare = await new Server('--dashboard', '/no/such/folder').start();
  try {
    assert.equal(bare.log.match(/no dashboard: .*no\/such\/folder/g)?.length, 1, bare.log);
    assert.equal((await fetch(bare.address, { headers: { Accept: 'text/html' } })).status, 404);
    assert.equal((await bare.call('GET', '/v1/vehicles')).total_size, 1);
  } finally {
    await bare.remove();
  }
});
