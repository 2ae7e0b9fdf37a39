// SPDX-License-Identifier: Apache-2.0
// The report of a plan in a real browser, from disk: drawn, with no request and no error, in reach of the keyboard, with
// the numbers of front.json.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';

import { coloursOf, launch, paleTexts, watchedPage } from './browser.mjs';
import { at, read, vantage } from './vantage.mjs';

vantage('generate', 'four-walls', '-o', 'walls.glb');
vantage('plan', 'walls.glb', '--problem', 'coverage-overlap-fix', '--stations', '4', '--population', '12', '--iterations', '4',
        '--step', '0.5', '--user-size', '0.2', '--spacing', '0.05', '--engine', 'embree', '-o', 'plan');
const front = JSON.parse(read('plan/front.json'));
const answer = front.answer - 1;
assert.ok(front.front.length > 1, 'a front of one network shows no steps');
const pages = read('plan/report.pdf').toString('latin1').match(/\/Type \/Page\b/g);
assert.ok(pages && pages.length >= 4 && pages.length <= 8, 'report.pdf has a front, a map, stations, links and what is missed');

const browser = await launch();
const url = pathToFileURL(at('plan/report.html')).href;
const orange = (r, g, b) => r > 150 && r - b > 60, blue = (r, g, b) => b > 90 && b - r > 50;

async function checkNumbers(page, k) {
  const entry = front.front[k];
  const rows = await page.locator('#values tbody tr').allInnerTexts();
  const shown = Object.fromEntries(rows.map((row) => row.split('\t')).map((cells) => [cells[3].trim(), cells[1].trim()]));
  for (const [name, value] of Object.entries(entry.values)) {
    assert.notEqual(value.exact, null);
    assert.equal(shown[name], value.exact.toFixed(4), `${name} of network ${k + 1}`);
  }
  const stations = (await page.locator('#stations tbody tr').allInnerTexts()).map((row) => row.split('\t').map((cell) => cell.trim()));
  assert.equal(stations.length, entry.stations.length);
  // In the order of visiting, where there is a round.
  const round = entry.on_site ? entry.on_site.order.map((n) => n - 1) : entry.stations.map((s, i) => i);
  assert.equal(round.length, entry.stations.length);
  round.map((n) => entry.stations[n]).forEach((s, i) => {
    assert.deepEqual(stations[i].slice(0, 5), [s.name, ...s.position.map((v) => v.toFixed(3)), s.ground[2].toFixed(3)]);
    assert.equal(stations[i][5].replace(/\s/g, ''), String(s.points_on_surveyed));
  });
  const bridges = await page.locator('#links tbody tr:has(.bridge)').allInnerTexts();
  const named = bridges.map((row) => row.split('\t').slice(0, 2).map((name) => name.trim()).join()).sort();
  assert.deepEqual(named, entry.links.bridges.map((pair) => pair.map((i) => entry.stations[i - 1].name).join()).sort());
}

for (const [size, viewport] of Object.entries({ phone: { width: 390, height: 844 }, tablet: { width: 820, height: 1180 },
                                                desktop: { width: 1440, height: 900 } })) {
  const page = await watchedPage(browser, viewport);
  await page.goto(url);
  await page.waitForSelector('html[data-ready]');
  for (const [what, wanted] of [['coverage', blue], ['what is missing', orange]]) {
    const { colours, share } = await coloursOf(page, '#canvas', wanted);
    assert.ok(colours > 100, `${size}: the view is blank: ${colours} colours`);
    assert.ok(share > 0.005, `${size}: the view shows no ${what}: ${share}`);
  }
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.ok(wide <= 0, `${size}: the page is ${wide} pixels too wide`);
  assert.deepEqual(await paleTexts(page), [], `${size}: contrast`);
  assert.match(await page.locator('#facts').innerText(), /a ray every 0\.5°/, `${size}: the scanner is named`);
  assert.match(await page.locator('#round').innerText(), /^The round.*S\d → .*m on foot\.$/, `${size}: the round is told`);
  // Names in the view keep apart.
  const overlapping = await page.evaluate(() => {
    const boxes = [...document.querySelectorAll('.label:not(.crowded)')].filter((l) => !l.hidden).map((l) => l.getBoundingClientRect());
    return boxes.some((a, i) => boxes.some((b, j) => j > i && a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom));
  });
  assert.equal(overlapping, false, `${size}: names lie on each other`);
  await checkNumbers(page, answer);
  await page.screenshot({ path: path.join(process.env.VANTAGE_SCREENSHOTS ?? at('.'), `report-${size}.png`), fullPage: true });

  if (size === 'desktop') {
    // A station by keyboard alone: its name in the view is a button.
    const label = page.locator('.label', { hasText: front.front[answer].stations[1].name }).first();
    await label.focus();
    await page.keyboard.press('Enter');
    assert.equal(await label.getAttribute('aria-pressed'), 'true');
    assert.equal(await page.locator('#station h3').innerText(), front.front[answer].stations[1].name);
    const sight = await page.locator('#station img.sight').evaluate(async (img) => { await img.decode(); return [img.naturalWidth, img.naturalHeight]; });
    assert.deepEqual(sight, [512, 256]);
    const { colours: seen } = await coloursOf(page, '#station img.sight', () => true);
    assert.ok(seen > 200, `the station's picture is blank: ${seen} colours`);
    const yellow = (r, g, b) => r > 150 && g > 120 && b < 60;
    const alone = await coloursOf(page, '#canvas', yellow);
    assert.ok(alone.share > 0, 'nothing that the picked station alone sees is shown');
    // Every network of the front, by its dots.
    await page.locator('#chart [aria-checked="true"]').focus();
    const visited = new Set();
    for (let step = 0; step < front.front.length; ++step) {
      await page.keyboard.press('ArrowRight');
      const k = Number((await page.locator('#which').innerText()).match(/\d+/)[0]) - 1;
      visited.add(k);
      await checkNumbers(page, k);
    }
    assert.equal(visited.size, front.front.length);
    // The view turns and is drawn anew.
    const shot = () => page.locator('#canvas').screenshot();
    await page.locator('#canvas canvas').focus();
    const before = await shot();
    for (let k = 0; k < 3; ++k) await page.keyboard.press('ArrowLeft');
    await page.waitForTimeout(200);
    assert.ok(!before.equals(await shot()), 'arrow keys do not turn the view');
    // On paper the view is a picture, and all is on a few pages.
    const paper = await page.pdf();
    assert.ok(paper.subarray(0, 5).toString() === '%PDF-');
    assert.ok(paper.toString('latin1').match(/\/Type \/Page\b/g).length <= 8, 'printing takes too many pages');
    assert.ok(await page.evaluate(() => document.querySelector('#canvas img').naturalWidth > 100));
  }
  assert.deepEqual(page.troubles, [], `${size}: the console`);
  assert.deepEqual(page.requests, [url], `${size}: requests`);
  await page.close();
}
await browser.close();
console.log(`${front.front.length} networks at three sizes, ${(fs.statSync(at('plan/report.html')).size / 1e6).toFixed(2)} MB`);
