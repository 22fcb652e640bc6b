// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Usage: node check_maps.mjs LANTHORN [SCREENSHOT-FOLDER]
// Bakes an environment and has three.js and Filament read the files in headless Chromium. Exit code 77 if the packages
// or the browser are missing: the test is skipped.
import {execFileSync} from 'node:child_process';
import {existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {createServer} from 'node:http';
import {tmpdir} from 'node:os';
import {dirname, extname, join, normalize} from 'node:path';
import {fileURLToPath} from 'node:url';

const here = dirname(fileURLToPath(import.meta.url)), [program, screenshots] = process.argv.slice(2);
const skip = (why) => {
  console.log(`SKIPPED: ${why}`);
  process.exit(77);
};
const browserPath = ['/usr/bin/chromium', '/usr/bin/chromium-browser'].find(existsSync);
if (!browserPath) skip('no chromium (scripts/install-packages browser)');
const playwright = await import('playwright-core').catch(() => skip('no playwright-core (npm ci in tests/browser)'));

// A colour for each axis, and a sun.
const colours = [[2, 0.2, 0.2], [0.2, 2, 2], [0.2, 2, 0.2], [2, 0.2, 2], [0.2, 0.2, 2], [2, 2, 0.2]];
function environment() {
  const width = 256, height = 128, pixels = new Float32Array(3 * width * height);
  for (let row = 0; row < height; row++)
    for (let x = 0; x < width; x++) {
      const polar = Math.PI * (row + 0.5) / height, azimuth = 2 * Math.PI * (x + 0.5) / width - Math.PI;
      const d = [Math.sin(polar) * Math.cos(azimuth), Math.cos(polar), Math.sin(polar) * Math.sin(azimuth)];
      const axis = [0, 1, 2].reduce((a, b) => Math.abs(d[b]) > Math.abs(d[a]) ? b : a);
      const at = 3 * ((height - 1 - row) * width + x);  // PFM has rows from the bottom
      pixels.set(colours[2 * axis + (d[axis] < 0 ? 1 : 0)], at);
      if (x === 90 && row === 40) pixels.set([1e5, 1e5, 1e5], at);
    }
  return Buffer.concat([Buffer.from(`PF\n${width} ${height}\n-1.0\n`), Buffer.from(pixels.buffer)]);
}

const folder = mkdtempSync(join(tmpdir(), 'lanthorn-maps-'));
writeFileSync(join(folder, 'sky.pfm'), environment());
execFileSync(program, ['ibl', 'sky.pfm', '-o', 'out', '-q', '--size', '64', '--smallest', '4', '--mapping', 'filament', '--formats', 'exr,ktx2'],
             {cwd: folder, stdio: ['ignore', 'ignore', 'ignore']});

const types = {'.html': 'text/html', '.js': 'text/javascript', '.wasm': 'application/wasm'};
const server = createServer((request, response) => {
  const path = normalize(new URL(request.url, 'http://localhost').pathname);
  const file = join(path.startsWith('/out/') ? folder : here, path);
  if (!existsSync(file)) return response.writeHead(404).end();
  response.writeHead(200, {'Content-Type': types[extname(file)] ?? 'application/octet-stream'}).end(readFileSync(file));
});
await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));

const browser = await playwright.chromium.launch({executablePath: browserPath, args: [
  '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader']});
let failures = 0;
const expect = (good, text) => {
  console.log(`${good ? 'ok' : 'FAILED'}: ${text}`);
  if (!good) failures++;
};

async function runPage(name) {
  const page = await browser.newPage();
  page.on('pageerror', (e) => expect(false, `${name}: ${e.message}`));
  page.on('console', (m) => m.type() === 'error' && console.log(`${name}: ${m.text()}`));
  await page.goto(`http://127.0.0.1:${server.address().port}/${name}.html`);
  await page.waitForFunction('window.ready');
  const result = await page.evaluate('window.run()');
  if (screenshots) await page.screenshot({path: join(screenshots, `${name}.png`)});
  await page.close();
  return result;
}

try {
  const three = await runPage('three');
  expect(three.error === 0, 'three.js: no WebGL error');
  expect(three.levels.length === 5, `three.js: ${three.levels.length} levels`);
  three.levels.forEach(({worst, largest}, i) =>
      expect(worst <= 1.001 && largest > 0.5, `three.js: level ${i} within ${worst.toFixed(3)} roundings of the EXR file (largest ${largest})`));
  expect(three.irradiance.worst <= 1.001, `three.js: irradiance within ${three.irradiance.worst.toFixed(3)} roundings`);
  const filament = await runPage('filament');
  filament.colours.forEach((seen, i) => {
    // Tone mapping keeps which channels are bright.
    const channels = (bright) => [0, 1, 2].filter((c) => colours[i][c] > 1 === bright).map((c) => seen[c]);
    const good = Math.min(...channels(true)) > Math.max(...channels(false)) + 30;
    expect(good, `Filament: sky along axis ${i} is ${seen.slice(0, 3)}`);
  });
} finally {
  await browser.close();
  server.close();
  rmSync(folder, {recursive: true});
}
process.exit(failures === 0 ? 0 : 1);
