// hashes_test.mjs BUSY_MATCH BRUME_SERVER: the simulation as WebAssembly, in node and in Chromium, prints what these
// native programs print: hashes of states, densities and lines of sight.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { readFile } from 'node:fs/promises';
import { after, before, test } from 'node:test';
import { promisify } from 'node:util';
import { BUILT, launch, serve } from './browser.mjs';

const run = promisify(execFile);
const [busyMatch, server] = process.argv.slice(2);
const folder = `${BUILT}wasm`;
const limits = { maxBuffer: 1 << 26 };
// Every mode of script/determinism. There are no threads: asked for eight, a call takes the one there is.
const MODES = [
  ['--threads', '1'],
  ['--threads', '8'],
  ['--calls', '20'],
  ['--calls', '240'],
  ['--mode', 'rollback'],
  ['--mode', 'late'],
  ['--mode', 'snapshot']
];
// 94 s are 6,016 ticks of the example's match through the C interface, with packets of which some are lost.
const SERVER = ['--seconds', '94'];

const natively = async (program, options) => (await run(program, options, limits)).stdout;
// Without fetch, which the code that loads a module would try with a path.
const inNode = async (module, options) =>
  (await run('node', ['--no-experimental-fetch', `${folder}/${module}`, ...options], limits)).stdout;

function same(found, expected, lines) {
  const a = found.split('\n'),
    b = expected.split('\n');
  for (let i = 0; i < b.length; ++i) assert.equal(a[i], b[i], `line ${i + 1}`);
  assert.equal(a.length, b.length);
  assert.ok(b.length > lines, `${b.length} lines, expected more than ${lines}`);
}

let browser, files;
before(async () => {
  files = await serve(folder, { '/': '<!doctype html><title>hashes</title>' });
  browser = await launch();
});
after(async () => {
  await browser?.close();
  files?.close();
});

async function inChromium(module, options) {
  const page = await browser.newPage();
  await page.goto(files.url);
  const lines = await page.evaluate(
    (source, options) =>
      new Promise((ended, failed) => {
        const lines = [];
        window.Module = {
          arguments: options,
          print: line => lines.push(line),
          printErr: line => failed(new Error(line)),
          quit: status => (status === 0 ? ended(lines) : failed(new Error(`ended with ${status}`))),
          postRun: () => ended(lines)
        };
        const script = document.createElement('script');
        script.src = source;
        script.onerror = () => failed(new Error(`no ${source}`));
        document.body.append(script);
      }),
    `/${module}`,
    options
  );
  await page.close();
  return lines.join('\n') + '\n';
}

for (const [name, runs] of [
  ['node', inNode],
  ['Chromium', inChromium]
]) {
  for (const mode of MODES)
    test(`the busy match in ${name}: ${mode.join(' ')}`, async () =>
      same(await runs('tests/determinism/busy_match.js', mode), await natively(busyMatch, mode), 600));
  test(`6,016 ticks of the example's match in C, in ${name}`, async () => {
    const expected = await natively(server, SERVER);
    assert.doesNotMatch(expected, /differs/);
    same(await runs('examples/web/brume_server.js', SERVER), expected, 94);
  });
}

test('the busy match in node has the hashes that are kept', async () => {
  const played = new Map(
    (await inNode('tests/determinism/busy_match.js', []))
      .trim()
      .split('\n')
      .map(line => line.match(/^(\d+ \w+) (\w+)$/).slice(1))
  );
  const kept = (await readFile(new URL('../determinism/expected.txt', import.meta.url), 'utf8')).trim().split('\n');
  for (const line of kept) {
    const [tick, kind, hash] = line.split(' ');
    assert.equal(played.get(`${tick} ${kind}`), hash, line);
  }
  assert.ok(kept.length > 100);
});
