// A real server and Debian's Chromium for the tests of the dashboard.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { afterEach } from 'node:test';
import { chromium } from 'playwright-core';

export const TRIBODYND = process.env.TRIBODYND;
export const TRIBODYN = process.env.TRIBODYN;

const pause = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds));

/** Runs a program and returns what it printed; throws if it fails. */
export async function output(program, args, options = {}) {
  const child = spawn(program, args, { stdio: ['ignore', 'pipe', 'pipe'], ...options });
  let out = '';
  let err = '';
  child.stdout.on('data', (text) => (out += text));
  child.stderr.on('data', (text) => (err += text));
  const code = await new Promise((done) => child.on('close', done));
  if (code !== 0) throw new Error(`${program} ${args.join(' ')} ended with ${code}: ${err}`);
  return out;
}

/** A server with a database of its own in a folder of its own. */
export class Server {
  constructor(...flags) {
    this.folder = mkdtempSync(path.join(tmpdir(), 'tribodyn-web-'));
    this.database = path.join(this.folder, 'test.sqlite');
    this.flags = flags;
    this.port = 0;
  }

  /** Starts it on a free port, after a stop on the same one. */
  async start() {
    const args = ['--database', this.database, '--listen', `unix:${this.folder}/socket`, '--http-listen',
      `127.0.0.1:${this.port}`, '--threads', '1', '--dashboard', path.resolve('dist'), ...this.flags];
    this.log = '';
    this.process = spawn(TRIBODYND, args, { stdio: ['ignore', 'pipe', 'pipe'] });
    for (const stream of [this.process.stdout, this.process.stderr]) stream.on('data', (text) => (this.log += text));
    this.ended = new Promise((done) => this.process.on('close', done));
    for (let i = 0; i < 300; ++i) {
      this.port = Number(/REST at http:\/\/127\.0\.0\.1:(\d+)/.exec(this.log)?.[1] ?? this.port);
      try {
        if (this.port !== 0 && (await fetch(`${this.address}/healthz`)).ok) return this;
      } catch {
        // It does not listen yet.
      }
      await pause(100);
    }
    throw new Error(`the server did not start:\n${this.log}`);
  }

  get address() { return `http://127.0.0.1:${this.port}`; }
  get token() { return readFileSync(`${this.database}.token`, 'utf8').trim(); }

  async stop(signal = 'SIGTERM') {
    this.process.kill(signal);
    await this.ended;
  }
  async remove() {
    if (this.process.exitCode === null && this.process.signalCode === null) await this.stop('SIGKILL');
    rmSync(this.folder, { recursive: true });
  }

  /** Calls a method as a script would. */
  async call(method, target, body) {
    const response = await fetch(this.address + target, {
      method,
      headers: { Authorization: `Bearer ${this.token}`, ...(body ? { 'Content-Type': 'application/json' } : {}) },
      body: body ? JSON.stringify(body) : undefined,
    });
    if (!response.ok) throw new Error(`${method} ${target}: ${response.status} ${await response.text()}`);
    return response.json();
  }

  /** Enters an oil by its data sheet; what it does not state is estimated, with uncertainties. */
  async newOil(id, name, kv40, kv100, density) {
    return this.call('POST', `/v1/lubricants?lubricant_id=${id}`, {
      display_name: name, base_oil_class: 'BASE_OIL_CLASS_POLYALPHAOLEFIN',
      measurements: {
        kinematic_viscosity_40_celsius_square_millimetres_per_second: kv40,
        kinematic_viscosity_100_celsius_square_millimetres_per_second: kv100,
        density_15_celsius_kilograms_per_cubic_metre: density,
      },
    });
  }

  /** Prints a new token for somebody. */
  async newToken(name, ...flags) {
    return (await output(TRIBODYND, ['tokens', 'create', name, '--database', this.database, ...flags])).trim();
  }
}

export async function launch() {
  const executablePath = ['/usr/bin/chromium', '/usr/bin/google-chrome'].find(existsSync);
  if (!executablePath) throw new Error('Chromium is not installed: deploy/setup test');
  return chromium.launch({ executablePath, args: process.getuid() === 0 ? ['--no-sandbox'] : [] });
}

/** Pages of the scenario, which ends with a complaint of any of them. */
const pages = new Set();
afterEach(() => {
  const complaints = [...pages].flatMap((page) => [...page.complaints, ...page.expected.filter((each) => !each.hasCome).map((each) => `no answer ${each.status} of ${each.target}`)]);
  for (const page of pages) {
    page.complaints.length = 0;
    page.expected = [];
    if (page.isClosed()) pages.delete(page);
  }
  assert.deepEqual(complaints, []);
});

/**
 * A browser without cookies that has a page. A scenario fails if the page sends a request elsewhere, has an
 * error in a script, violates its content security policy, or gets an answer of 400 or above that the scenario
 * does not expect: `page.expect(404, 'lubricants/no-such-oil')`. Numbers of the service's answers are recorded
 * in `answered`.
 */
export async function newPage(browser, server, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, locale: 'en-GB', ...options });
  return newTab(context, server);
}

/** A further page of a browser. */
export async function newTab(context, server) {
  const page = await context.newPage();
  page.setDefaultTimeout(20_000);
  pages.add(page);
  page.complaints = [];
  page.expected = [];
  page.expect = (status, target) => page.expected.push({ status, target, hasCome: false });
  page.on('pageerror', (error) => page.complaints.push(`error: ${error.message}`));
  page.on('console', (message) => {
    if (/Content Security Policy|Trusted/i.test(message.text())) page.complaints.push(message.text());
  });
  page.answered = new Set(); // numbers of all answers
  page.reading = [];
  page.on('domcontentloaded', () => (page.reading = []));
  page.on('response', (response) => {
    const [status, method, url] = [response.status(), response.request().method(), response.url()];
    // A page learns by a 401 that nobody has signed in, and by a 503 that a server is about to be back.
    const isQuestion = method === 'GET' && [`401 ${server.address}/session`, `503 ${server.address}/healthz`].includes(`${status} ${url}`);
    if (status >= 400 && !isQuestion) {
      const found = page.expected.filter((each) => each.status === status && url.includes(each.target));
      for (const each of found) each.hasCome = true;
      if (found.length === 0) page.complaints.push(`${method} ${url}: ${status}`);
    }
    if (!/\/v1\//.test(url) || !/json/.test(response.headers()['content-type'] ?? '')) return;
    page.reading.push(response.json().then((body) => numbersOf(body, page.answered), () => {}));
  });
  page.on('request', (request) => {
    const to = new URL(request.url());
    if (!['blob:', 'data:'].includes(to.protocol) && to.origin !== server.address) page.complaints.push(`request to ${to}`);
  });
  return page;
}

export async function signIn(page, token) {
  await page.getByLabel('Token').fill(token);
  await page.getByRole('button', { name: 'Sign in' }).click();
  await page.getByRole('dialog').waitFor({ state: 'detached' });
}

/** A campaign of candidates that differ in a parameter, words and a cost, at six conditions. */
export const campaignOf = (candidates, more = {}) => ({
  display_name: `${candidates} candidates`, lubricant: 'lubricants/paper-fluid-1',
  candidate_columns: [
    { path: 'lubricant.pressure_viscosity_coefficient_per_pascal', values: Array.from({ length: candidates }, (_, i) => 1.2e-8 + (1e-8 * i) / candidates) },
    { path: 'surface.asperity_friction_coefficient', values: Array.from({ length: candidates }, (_, i) => 0.08 + (0.04 * (i % 7)) / 7) },
  ],
  candidate_attributes: [
    { name: 'additive', texts: Array.from({ length: candidates }, (_, i) => `additive ${'ABC'[i % 3]}`) },
    { name: 'cost_euros_per_kilogram', values: Array.from({ length: candidates }, (_, i) => 2 + i) },
  ],
  conditions: [40, 90].flatMap((sump) => [30, 70, 110].map((speed) => ({ speed_kilometres_per_hour: speed, sump_temperature_celsius: sump }))),
  ...more,
});

/** All numbers of a JSON value, at any depth. */
function numbersOf(value, into) {
  if (typeof value === 'number') into.add(value);
  else if (value !== null && typeof value === 'object') Object.values(value).forEach((each) => numbersOf(each, into));
}

/** Numbers shown on the page that no answer of the service held, or whose text is not that number rounded. */
export async function foreignNumbers(page) {
  // An answer whose page was left is never read to its end.
  await Promise.race([Promise.all(page.reading), pause(2000)]);
  const shown = await page.locator('[data-value]').evaluateAll((all) => all.map((each) => ({ ...each.dataset, text: each.textContent })));
  if (shown.length === 0) return ['no number is shown'];
  return shown.flatMap(({ value, factor = '1', offset = '0', text }) => {
    const digits = text.replace('−', '-').replace('+', '').replace(/e−/, 'e-');
    const places = /e/.test(digits) ? undefined : (digits.split('.')[1] ?? '').length;
    const exact = Number(value) * Number(factor) + Number(offset);
    // Three figures at least, or the last place that is shown.
    const room = places === undefined ? 0.05 * Math.abs(exact) : Math.max(0.501 * 10 ** -places, 1e-12);
    const complaints = [];
    if (!page.answered.has(Number(value))) complaints.push(`no answer holds ${value} (shown as ${text})`);
    if (!(Math.abs(Number(digits) - exact) <= room)) complaints.push(`${text} is not ${exact}`);
    return complaints;
  });
}
