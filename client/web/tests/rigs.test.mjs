// Rigs, the figures of the paper and the units in which everything is shown.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { foreignNumbers, launch, newPage, output, Server, signIn, TRIBODYN } from './harness.mjs';

let browser;
let server;
let page;
before(async () => {
  browser = await launch();
  server = await new Server().start();
  page = await newPage(browser, server);
  await page.goto(server.address);
  await signIn(page, server.token);
});
after(async () => {
  await browser?.close();
  await server?.remove();
});

test('a rig is evaluated as it is set, and its numbers, its table and its command are those of the service', async () => {
  await page.goto(`${server.address}/rigs`);
  await page.locator('.read-out tbody tr').nth(2).waitFor();
  assert.deepEqual(await foreignNumbers(page), []);
  await page.getByLabel('Load, N').fill('20, 60');
  await page.getByLabel('Load, N').press('Enter');
  await page.getByLabel('Lubricant 2').uncheck();
  await page.getByLabel('Lubricant 3').uncheck();
  await page.waitForURL(/f=paper-fluid-1&load=20,60$/);
  await page.getByRole('rowheader', { name: 'Lubricant 1, 60 N' }).waitFor();
  await page.waitForFunction(() => document.querySelectorAll('.read-out tbody tr').length === 2);
  assert.deepEqual(await foreignNumbers(page), []);
  await page.reload();
  await page.getByRole('rowheader', { name: 'Lubricant 1, 60 N' }).waitFor();
  await page.getByText('Take away').click();
  const [file] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Numbers as CSV' }).click()]);
  const rows = readFileSync(await file.path(), 'utf8').trim().split('\n').slice(1).map((row) => row.split(','));
  const command = await page.getByLabel('Command line').textContent();
  const printed = JSON.parse(await output(TRIBODYN, ['--server', `unix:${server.folder}/socket`, ...command.split(' ').slice(1), '-o', 'json']));
  const known = new Set(JSON.stringify(printed).match(/-?\d[\d.e+-]*/g).map(Number));
  assert.equal(rows.length, 38);
  for (const row of rows) assert.ok(known.has(Number(row[3])), `the command prints ${row[3]}`);
});

test('the uncertainty of a fluid is a band of its curve, and can be switched off', async () => {
  await output(TRIBODYN, ['--server', `unix:${server.folder}/socket`, 'lubricants', 'create', 'sheet-oil', '--kv40', '103', '--kv100', '15.1', '--density15', '868', '--base-oil-class', 'pao']);
  await page.goto(`${server.address}/rigs?kind=film&f=sheet-oil`);
  await page.getByText('holds the curve with 95').waitFor();
  await page.locator('.read-out tbody', { hasText: / to / }).waitFor();
  assert.deepEqual(await foreignNumbers(page), []);
  await page.getByLabel('Uncertainty of the inputs').uncheck();
  await page.waitForURL(/u=0$/);
  await page.getByText('holds the curve with 95').waitFor({ state: 'detached' });
  await page.locator('.read-out tbody tr').first().waitFor();
  assert.ok(!(await page.locator('.read-out tbody').textContent()).includes(' to '));
});

test('the warnings of a rig stand with the places that they hold for', async () => {
  await page.goto(`${server.address}/rigs?kind=stribeck&f=paper-fluid-1`);
  const remark = page.locator('.validity li', { hasText: 'FILM_RATIO' }).first();
  await remark.waitFor({ state: 'attached' });
  assert.match(await remark.textContent(), /Lubricant 1 [\d.]+ to [\d.]+ m\/s/);
});

test('a mistake in the setting of a rig is named at its field', async () => {
  page.expect(400, 'rigs:evaluate');
  await page.goto(`${server.address}/rigs?kind=stribeck&f=paper-fluid-1&load=-5`);
  await page.locator('.panel .problem', { hasText: 'load_newtons' }).waitFor();
  assert.equal(await page.getByLabel('Load, N').getAttribute('aria-invalid'), 'true');
});

test('a figure of the paper opens as its curves, or as its rig', async () => {
  await page.goto(`${server.address}/paper`);
  await page.getByRole('button', { name: /Inefficiency of lubricant 1, isothermal and thermal/ }).click();
  await page.getByRole('rowheader', { name: 'Lubricant 1, isothermal' }).waitFor();
  await page.goto(`${server.address}/paper`);
  await page.getByRole('link', { name: /Traction of the three lubricants/ }).click();
  await page.getByText('A ball of 19.1 mm on steel, smooth; 35.2 N; 2.5 m/s').waitFor();
});

test('speeds of curves are those of the pinion if the reader wants so, and addresses stay the same', async () => {
  const curve = await server.call('POST', '/v1/simulations', {
    lubricant: 'lubricants/paper-fluid-1',
    inefficiency_curve: { first_speed_kilometres_per_hour: 60, last_speed_kilometres_per_hour: 90, speed_step_kilometres_per_hour: 5 },
  });
  await page.goto(`${server.address}/curves?r=${curve.name.split('/')[1]}&x=65-85`);
  await page.getByRole('heading', { name: 'At 75 km/h' }).waitFor();
  await page.getByText('Units', { exact: true }).click();
  await page.getByLabel('Unit: Speed of curves').selectOption('rpm');
  const { columns } = await server.call('GET', `/v1/${curve.name}?alt=columns&columns=mean_pinion_speed_radians_per_second`);
  const speed = (30 / Math.PI) * columns.mean_pinion_speed_radians_per_second[3];
  await page.getByRole('heading', { name: `At ${speed.toFixed(0)} rpm` }).waitFor();
  await page.getByText('Mean speed of the pinion, rpm').first().waitFor();
  const plot = await page.locator('.figure .u-over').first().boundingBox();
  await page.mouse.click(plot.x + plot.width / 2, plot.y + 60);
  await page.waitForURL(/x=65-85&v=75/);
  assert.deepEqual(await foreignNumbers(page), []);
  await page.getByLabel('Unit: Speed of curves').selectOption('km/h');
  await page.getByRole('heading', { name: 'At 75 km/h' }).waitFor();
});

test('units are chosen in one place for every view, and a form reads what it shows', async () => {
  const curve = await server.call('POST', '/v1/simulations', {
    lubricant: 'lubricants/paper-fluid-1', sump_temperature_celsius: 90,
    inefficiency_curve: { first_speed_kilometres_per_hour: 100, last_speed_kilometres_per_hour: 120, speed_step_kilometres_per_hour: 10 },
  });
  await page.goto(`${server.address}/curves?r=${curve.name.split('/')[1]}&y=temperature`);
  await page.locator('.read-out tbody tr').waitFor();
  await page.getByText('holds the curve with 95').waitFor(); // the interval decides the digits
  const cell = page.locator('[data-column="maximum_contact_temperature_kelvin"]');
  const celsius = Number(await cell.textContent());
  await page.getByText('Units', { exact: true }).click();
  await page.getByLabel('Unit: Temperature').selectOption('K');
  await page.getByLabel('Unit: Film, transmission error').selectOption('nm');
  await page.getByRole('heading', { name: 'Hottest contact over the mesh cycle, K' }).waitFor();
  assert.ok(Math.abs(Number(await cell.textContent()) - celsius - 273.15) < 1);
  assert.equal(await page.getByLabel('Sump, K').inputValue(), '363.15');
  assert.deepEqual(await foreignNumbers(page), []);
  await page.getByText('Units', { exact: true }).click();
  await page.getByLabel('Sump, K').fill('373.15');
  await page.getByLabel('Sump, K').blur();
  await page.getByRole('button', { name: 'Run the curve' }).click();
  await page.waitForURL((url) => !url.search.endsWith('y=temperature'));
  const newest = await server.call('GET', '/v1/simulations?page_size=1');
  assert.equal(newest.simulations[0].sump_temperature_celsius, 100);
  await page.goto(`${server.address}/compare?a=paper-fluid-1&b=paper-fluid-2&y=dte-least`);
  await page.getByText('Least transmission error, nm; bands hold').waitFor();
  assert.equal(await page.getByLabel('Sump, K').inputValue(), '313.15');
});
