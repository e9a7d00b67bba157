// A page of another origin can neither read nor change anything, although the browser sends the
// cookie of the session to every port of the host.
import assert from 'node:assert/strict';
import { createServer } from 'node:http';
import { after, before, test } from 'node:test';
import { launch, Server, signIn } from './harness.mjs';

let browser;
let server;
let other;
let page;
before(async () => {
  browser = await launch();
  server = await new Server().start();
  other = createServer((_, response) => {
    response.setHeader('Content-Type', 'text/html');
    response.end('<!doctype html><title>another origin</title><body></body>');
  });
  await new Promise((done) => other.listen(0, '127.0.0.1', done));
  const context = await browser.newContext();
  const own = await context.newPage();
  await own.goto(server.address);
  await signIn(own, server.token);
  page = await context.newPage();
});
after(async () => {
  await browser?.close();
  other?.close();
  await server?.remove();
});

const origins = () => [`http://127.0.0.1:${other.address().port}`, `http://localhost:${other.address().port}`];

/** Everything that a page can try on the server without its consent; returns what it got to read. */
async function attack(server) {
  const got = [];
  const read = async (name, init, path = '/v1/lubricants') => {
    try {
      const response = await fetch(server + path, init);
      if (response.type !== 'opaque') got.push(`${name}: ${response.status} ${await response.text()}`);
    } catch {
      // The browser or the server refused it.
    }
  };
  await read('plain fetch', {});
  await read('fetch with cookies', { credentials: 'include' });
  await read('session', { credentials: 'include' }, '/session');
  await read('no-cors', { mode: 'no-cors', credentials: 'include' });
  for (const type of ['text/plain', 'application/json', 'application/x-www-form-urlencoded']) {
    for (const mode of ['cors', 'no-cors']) {
      await read(`POST of ${type}`, {
        method: 'POST', mode, credentials: 'include', headers: { 'Content-Type': type },
        body: JSON.stringify({ lubricant: 'lubricants/paper-fluid-1', operating_point: { cruise: { speed_kilometres_per_hour: 60 } } }),
      }, '/v1/simulations');
    }
  }
  await read('DELETE', { method: 'DELETE', credentials: 'include' }, '/v1/lubricants/paper-fluid-1');
  await read('end of the session', { method: 'DELETE', credentials: 'include' }, '/session');
  await new Promise((done) => {
    const events = new EventSource(`${server}/v1/simulations:watch?filter=labels.a:*`, { withCredentials: true });
    events.onopen = () => { got.push('events'); events.close(); done(); };
    events.onerror = () => { events.close(); done(); };
  });
  for (const [tag, property] of [['script', 'src'], ['img', 'src'], ['link', 'href']]) {
    await new Promise((done) => {
      const element = document.createElement(tag);
      if (tag === 'link') element.rel = 'stylesheet';
      element.onload = () => { got.push(`${tag} loads`); done(); };
      element.onerror = () => done();
      element[property] = `${server}/v1/lubricants`;
      document.body.append(element);
    }).catch(() => {}); // the policy of the page itself refuses it
  }
  const frame = document.createElement('iframe');
  frame.src = `${server}/`;
  await new Promise((done) => { frame.onload = done; document.body.append(frame); });
  try {
    if (frame.contentDocument?.body.textContent) got.push('frame');
  } catch {
    // Another origin: not readable.
  }
  const form = document.createElement('form');
  const target = document.createElement('iframe');
  target.name = 'target';
  document.body.append(form, target);
  Object.assign(form, { method: 'POST', action: `${server}/v1/simulations`, enctype: 'text/plain', target: 'target' });
  await new Promise((done) => { target.onload = done; form.submit(); setTimeout(done, 1000); });
  return got;
}

test('a page of another origin reads nothing and changes nothing', async () => {
  for (const origin of origins()) {
    await page.goto(origin);
    assert.deepEqual(await page.evaluate(attack, server.address), [], origin);
    assert.equal((await server.call('GET', '/v1/simulations')).total_size, 0, origin);
    assert.equal((await server.call('GET', '/v1/lubricants/paper-fluid-1')).delete_time, undefined, origin);
  }
});

test('the attack works from the page of the server itself, so that it is one', async () => {
  await page.goto(server.address);
  const got = await page.evaluate(attack, server.address);
  assert.ok(got.some((each) => each.startsWith('fetch with cookies: 200')), got.join('\n').slice(0, 500));
  assert.ok(got.some((each) => each.startsWith('session: 200')));
  // Even there a change needs the token of the session.
  assert.equal((await server.call('GET', '/v1/simulations')).total_size, 0);
});
