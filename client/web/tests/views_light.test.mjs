// Every view in the light theme, and how much the first one takes of the network.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { newPage, signIn } from './harness.mjs';
import { browser, server, testViews } from './views.mjs';

testViews('light');

test('the first view takes less than 200 kB of the network', async () => {
  const page = await newPage(browser, server);
  let bytes = 0;
  const session = await page.context().newCDPSession(page);
  await session.send('Network.enable');
  session.on('Network.loadingFinished', (event) => (bytes += event.encodedDataLength));
  await page.goto(server.address + '/curves?r=1,2,3');
  await signIn(page, server.token);
  await page.locator('.multiple canvas').first().waitFor();
  assert.ok(bytes > 10_000 && bytes < 200_000, `${bytes} bytes`);
  console.log(`# the curves with their data: ${(bytes / 1000).toFixed(0)} kB`);
  await page.context().close();
});
