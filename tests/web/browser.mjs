// A server of files on this machine alone, and a headless Chromium in front of it.
import { createServer } from 'node:http';
import { readFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';

/** The folder into which examples/web/build builds. */
export const BUILT = fileURLToPath(new URL('../../build/web/', import.meta.url));
const puppeteer = createRequire(`${BUILT}npm/package.json`)('puppeteer-core');

const TYPES = {
  '.html': 'text/html',
  '.js': 'text/javascript',
  '.mjs': 'text/javascript',
  '.css': 'text/css',
  '.wasm': 'application/wasm',
  '.svg': 'image/svg+xml'
};
// Chromium's own renderer, whose pixels repeat; nothing is cached, and nothing is fetched in the background.
const FLAGS = [
  '--no-sandbox',
  '--disable-dev-shm-usage',
  '--use-angle=swiftshader',
  '--enable-unsafe-swiftshader',
  '--disable-background-networking',
  '--hide-scrollbars',
  '--mute-audio'
];

/** Serves `folder`, and in place of the paths in `pages` their text: {url, close}. */
export async function serve(folder, pages = {}) {
  const server = createServer(async (request, response) => {
    const path = normalize(new URL(request.url, 'http://localhost').pathname);
    try {
      const body = pages[path] ?? (await readFile(join(folder, path === '/' ? 'index.html' : path)));
      response.writeHead(200, { 'content-type': TYPES[extname(path) || '.html'] ?? 'application/octet-stream' });
      response.end(body);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise(listening => server.listen(0, '127.0.0.1', listening));
  return { url: `http://127.0.0.1:${server.address().port}`, close: () => server.close() };
}

/** Starts Chromium with more `flags`. */
export function launch(flags = []) {
  return puppeteer.launch({
    executablePath: '/usr/bin/chromium',
    headless: true,
    args: [...FLAGS, ...flags],
    protocolTimeout: 600000
  });
}
