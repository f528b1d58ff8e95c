// SPDX-License-Identifier: Apache-2.0
// three.js in Chromium: the file is one skinned mesh, stands in its bind pose, and moves when a joint is turned.
import {readFileSync, mkdtempSync, rmSync} from 'node:fs';
import {createServer} from 'node:http';
import {tmpdir} from 'node:os';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {chromium} from 'playwright-core';

const here = dirname(fileURLToPath(import.meta.url));
const types = {html: 'text/html', js: 'text/javascript', glb: 'model/gltf-binary'};
const flags = ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync'];

// The page, three.js and, by number, the files to be judged.
function serve(files) {
  const server = createServer((request, response) => {
    try {
      const path = new URL(request.url, 'http://localhost').pathname;
      const file = path.startsWith('/glb/') ? files[Number(path.slice(5, -4))] : join(here, path);
      const content = readFileSync(file);
      response.writeHead(200, {'content-type': types[path.split('.').pop()] ?? 'application/octet-stream'}).end(content);
    } catch {
      response.writeHead(404).end();
    }
  });
  return new Promise((resolve) => server.listen(0, '127.0.0.1', () => resolve(server)));
}

export async function judgeByThree(files, executablePath = process.env.CHROMIUM ?? '/usr/bin/chromium') {
  const server = await serve(files);
  const profile = mkdtempSync(join(tmpdir(), 'osteon-chromium-'));
  const context = await chromium.launchPersistentContext(profile, {executablePath, headless: true, args: flags});
  try {
    const page = await context.newPage();
    await page.goto(`http://127.0.0.1:${server.address().port}/three_page.html`);
    await page.waitForFunction('window.ready');
    const verdicts = [];
    for (const i of files.keys()) verdicts.push(await page.evaluate((url) => window.judge(url).catch((e) => `not readable: ${e}`), `/glb/${i}.glb`));
    return verdicts;
  } finally {
    await context.close();
    server.close();
    rmSync(profile, {recursive: true, force: true});
  }
}
