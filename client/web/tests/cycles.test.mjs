// Drive cycles: the energy that the mesh loses, when, and where it arises.
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

const total = () => page.getByRole('region', { name: 'Energies of the whole cycle' }).locator('tbody tr');
const file = (text) => ({ name: 'my cycle.csv', mimeType: 'text/csv', buffer: Buffer.from(text) });

test('the NEDC is added up for fluids, with both errors, over time and by its parts, as the service says', async () => {
  await page.goto(`${server.address}/more`);
  await page.getByRole('link', { name: 'Cycles' }).last().click();
  await total().nth(1).waitFor();
  await page.getByText('11.03 km in 1180 s, of which 280 s at a standstill').waitFor();
  const answer = await server.call('POST', '/v1/cycles:evaluate', {
    lubricants: ['lubricants/paper-fluid-1', 'lubricants/paper-fluid-2'], named_cycle: 'NAMED_CYCLE_NEDC', sump_temperature_celsius: 40,
  });
  const values = (row) => total().nth(row).locator('[data-value]').evaluateAll((all) => all.map((each) => Number(each.dataset.value)));
  await page.getByText(answer.not_included).waitFor();
  for (const row of [0, 1]) {
    const fluid = answer.lubricants[row];
    assert.deepEqual(await values(row), [
      fluid.loss_joules, fluid.input_joules, fluid.inefficiency_percent, ...(row === 0 ? [] : [fluid.parts[0].loss_difference_percent]), ...(fluid.map_error_joules === 0 ? [] : [fluid.map_error_joules]), fluid.solver_error_joules,
    ]);
  }
  const bars = page.getByRole('table', { name: 'Loss by what the vehicle does' }).locator('tbody tr');
  assert.deepEqual((await bars.locator('th').allTextContents()).map((each) => each.replace(/ \d+ s$/, '')), ['Standstill', 'Drive, accelerating', 'Drive, steady', 'Coast: the wheels drive']);
  await page.getByText('Every part').click();
  assert.equal(await page.getByRole('region', { name: 'Every part' }).locator('tbody tr').count(), answer.parts.length);
  await page.getByLabel('Time', { exact: true }).press('Home');
  await page.getByLabel('Time', { exact: true }).press('ArrowRight');
  await page.getByRole('heading', { name: 'From 1.00 s on' }).waitFor();
  assert.deepEqual(await foreignNumbers(page), []);
  await page.locator('.origins select').selectOption('Lubricant 2');
  await page.waitForURL(/of=1/);
  assert.deepEqual(await foreignNumbers(page), []);
  await page.getByLabel('Lubricant 3').check();
  await total().nth(2).waitFor();
  await page.waitForURL(/f=paper-fluid-1,paper-fluid-2,paper-fluid-3/);
  await page.getByText('Take away').click();
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Numbers as CSV' }).click()]);
  const rows = readFileSync(await download.path(), 'utf8').trim().split('\n').slice(1).map((row) => row.split(',').map(Number));
  assert.equal(rows.length, 1180);
  assert.deepEqual(rows.map((row) => row[8]), answer.lubricants[1].mesh_loss_power_watts);
  const command = await page.getByLabel('Command line').textContent();
  const printed = JSON.parse(await output(TRIBODYN, ['--server', `unix:${server.folder}/socket`, ...command.split(' ').slice(1), '-o', 'json']));
  assert.equal(printed.lubricants[1].loss_joules, answer.lubricants[1].loss_joules);
});

test('a dropped cycle is added up, and its mistakes are named at their lines, whoever finds them', async () => {
  page.expect(400, 'cycles:evaluate');
  await page.goto(`${server.address}/cycles?f=paper-fluid-1&cycle=own`);
  await page.getByRole('heading', { name: 'Drop a cycle' }).waitFor();
  const drop = (text) => page.locator('.drop input').setInputFiles(file(text));
  const mistake = (line) => page.getByRole('region', { name: 'Mistakes in the file' }).locator('tbody tr', { has: page.getByRole('rowheader', { name: line, exact: true }) });
  await drop('time_seconds,ascent_angle_degrees\n0,0\n');
  await mistake('1').getByText('the column speed_kilometres_per_hour is missing').waitFor();
  await drop('time_seconds,speed_kilometres_per_hour\n0,0\n10,fast\n20,50\n');
  await mistake('3').getByText('speed_kilometres_per_hour: "fast" is not a number').waitFor();
  await drop('time_seconds,speed_kilometres_per_hour\n0,0\n10,30\n5,50\n');
  await mistake('4').getByText('allowed: above that of the place before, 10 s').waitFor();
  await drop('time [s];speed [m/s]\n0;0\n10;12,5\n60;12,5\n70;0\n');
  await page.getByRole('heading', { name: 'over “my cycle.csv”' }).waitFor();
  const answer = await server.call('POST', '/v1/cycles:evaluate', {
    lubricants: ['lubricants/paper-fluid-1'],
    places: [[0, 0], [10, 45], [60, 45], [70, 0]].map(([time_seconds, speed_kilometres_per_hour]) => ({ time_seconds, speed_kilometres_per_hour })),
  });
  assert.equal(Number(await total().locator('[data-value]').first().getAttribute('data-value')), answer.lubricants[0].loss_joules);
  assert.deepEqual(await foreignNumbers(page), []);
  const plot = await page.locator('.over-time .u-over').first().boundingBox();
  await page.mouse.move(plot.x + 0.25 * plot.width, plot.y + 30);
  await page.mouse.down();
  await page.mouse.move(plot.x + 0.75 * plot.width, plot.y + 30, { steps: 4 });
  await page.mouse.up();
  await page.waitForURL(/t=1\d-5\d/);
  await page.reload();
  await page.getByRole('heading', { name: 'over “my cycle.csv”' }).waitFor();
  await page.getByRole('button', { name: 'Show the whole cycle' }).click();
  await page.getByLabel('NEDC').check();
  await page.getByText('11.03 km in 1180 s').waitFor();
});

test('a link reproduces the cycle that was dropped, and a cycle that is too long for a link goes with its file', async () => {
  page.expect(400, 'cycles:evaluate'); // no measurement after the shear test
  const rows = Array.from({ length: 1800 }, (_, k) => [k, Number((30 - 30 * Math.cos((2 * Math.PI * k) / 600)).toFixed(1))]);
  await page.goto(`${server.address}/cycles?f=paper-fluid-1&cycle=own`);
  await page.locator('.drop input').setInputFiles(file(`time;v [km/h]\n${rows.map((row) => row.join(';').replaceAll('.', ',')).join('\n')}\n`));
  await page.getByRole('heading', { name: 'over “my cycle.csv”' }).waitFor();
  await page.waitForURL(/#cycle=/);
  await page.waitForFunction(() => !document.querySelector('.stale'));
  const loss = () => total().locator('[data-value]').first().getAttribute('data-value');
  const expected = await loss();
  await page.getByLabel('Oils after the shear test').check();
  await page.waitForURL(/sheared=1.*#cycle=/);
  await page.getByLabel('Oils after the shear test').uncheck();
  await page.waitForURL(/own#cycle=/);
  await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
  await page.getByText('Take away').click();
  await page.getByRole('button', { name: 'Copy a link to this page' }).click();
  await page.getByRole('button', { name: 'Copied' }).waitFor();
  const link = await page.evaluate(() => navigator.clipboard.readText());
  assert.match(link, /f=paper-fluid-1@1.*gear=reference-axle@1.*surface=run-in@1.*vehicle=passenger-car@1/);
  assert.ok(link.length < 16_500, `${link.length} characters`);
  // Another browser has no file of its own.
  const other = await newPage(browser, server);
  const sent = [];
  other.on('request', (request) => sent.push(`${request.url()} ${request.headers().referer ?? ''}`));
  await other.goto(link);
  await signIn(other, server.token);
  await other.getByRole('heading', { name: 'over “my cycle.csv”' }).waitFor();
  assert.equal(await other.getByRole('region', { name: 'Energies of the whole cycle' }).locator('[data-value]').first().getAttribute('data-value'), expected);
  assert.ok(!sent.some((each) => each.includes('#cycle=')), 'a fragment stays in the browser');
  await other.getByText('Take away').click();
  const [cycle] = await Promise.all([other.waitForEvent('download'), other.getByRole('button', { name: 'The cycle as CSV' }).click()]);
  assert.deepEqual(readFileSync(await cycle.path(), 'utf8').trim().split('\n').slice(1).map((row) => row.split(',').map(Number)), rows);
  await other.goto(`${server.address}/more`);
  await other.goto(`${link.slice(0, -40)}`);
  await other.getByText('The link is damaged').waitFor();
  await other.context().close();
  // Digits that no pattern makes shorter.
  const digits = rows.map(([time, speed], k) => `${time},${Number((speed + ((k * 7919 * 7919) % 1e9) / 1e11).toFixed(12))}`);
  await page.locator('.drop input').setInputFiles(file(`time_seconds,speed_kilometres_per_hour\n${digits.join('\n')}\n`));
  await page.getByText('The cycle is too long for a link').waitFor();
  assert.doesNotMatch(page.url(), /#/);
  const [long] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'its file' }).click()]);
  assert.equal(long.suggestedFilename(), 'my cycle.csv');
  assert.deepEqual(readFileSync(await long.path(), 'utf8').trim().split('\n').slice(1), digits);
});

test('a sump that the service refuses is named at its field', async () => {
  page.expect(400, 'cycles:evaluate');
  await page.goto(`${server.address}/cycles?f=paper-fluid-1`);
  await total().waitFor();
  await page.getByLabel('Sump, °C').fill('400');
  await page.getByLabel('Sump, °C').press('Tab');
  await page.locator('.panel .problem', { hasText: 'allowed: -70 to 200' }).waitFor();
  assert.equal(await page.getByLabel('Sump, °C').getAttribute('aria-invalid'), 'true');
});
