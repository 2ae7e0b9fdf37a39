// SPDX-License-Identifier: Apache-2.0
// The editor in a real browser: a station is dragged, moved by keys, added, locked and saved, and the page says what the
// program on the command line says. What comes from elsewhere is refused.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import fs from 'node:fs';
import http from 'node:http';

import { coloursOf, launch, paleTexts, watchedPage } from './browser.mjs';
import { at, folder, program, read, vantage } from './vantage.mjs';

const coarse = ['--step', '1', '--user-size', '0.2', '--spacing', '0.05', '--engine', 'embree'];
vantage('generate', 'four-walls', '-o', 'walls.glb');

// The editor's process, and its address once it is said.
const start = (...args) => startAs({}, '--no-browser', ...args);
async function startAs(environment, ...args) {
  const editor = spawn(program, ['edit', 'walls.glb', ...coarse, '--sample', '2000', '-o', 'edited', ...args], { cwd: folder, env: { ...process.env, ...environment } });
  let log = '';
  editor.stderr.on('data', (text) => { log += text; });
  process.on('exit', () => editor.kill('SIGKILL'));
  const [line] = await Promise.race([once(editor.stdout, 'data'), once(editor, 'exit').then(() => assert.fail(log))]);
  const url = line.toString().trim();
  // What can be captured is looked at first.
  while (JSON.parse((await ask(`${url}state`)).text).busy) await new Promise((done) => { setTimeout(done, 100); });
  return { editor, url };
}
async function stop(editor) {
  const ended = once(editor, 'exit');
  editor.kill('SIGINT');
  const [code] = await ended;
  assert.equal(code, 0, 'Ctrl-C ends it in good order');
}

// One request as anybody on this machine could send it.
function ask(url, { method = 'GET', headers = {}, body } = {}) {
  return new Promise((resolve, reject) => {
    const request = http.request(url, { method, headers }, (response) => {
      let text = '';
      response.on('data', (part) => { text += part; });
      response.on('end', () => resolve({ status: response.statusCode, text, headers: response.headers }));
    });
    request.on('error', reject);
    request.end(body);
  });
}

// One of them is set up unlike the others, by a scanner of its own; what is told of it must hold through everything.
let { editor, url } = await start('--station', '8,0,1.5', '--station', 'x=8,y=6,z=1.5,heading=30,tilt=80,scanner=rtc360,step=0.7');
const { origin, host } = new URL(url);
const post = { method: 'POST', headers: { Origin: origin }, body: '{"do":"undo"}' };
assert.equal(new URL(url).hostname, '127.0.0.1');
assert.equal((await ask(url)).status, 200);
for (const [what, status, where, options] of [
  ['no token', 404, origin, {}], ['another token', 404, `${origin}/${'0'.repeat(32)}/`, {}], ['a file', 404, `${origin}/etc/passwd`, {}],
  ['a path out of the page', 404, `${url}../walls.glb`, {}], ['nothing of that name', 404, `${url}walls.glb`, {}],
  ['another host', 403, url, { headers: { Host: 'example.org' } }], ['a host by name', 403, url, { headers: { Host: host.replace('127.0.0.1', 'localhost') } }],
  ['another origin', 403, `${url}change`, { ...post, headers: { Origin: 'http://example.org' } }],
  ['no origin', 403, `${url}change`, { ...post, headers: {} }], ['a null origin', 403, `${url}change`, { ...post, headers: { Origin: 'null' } }],
  ['too much', 413, `${url}change`, { ...post, body: JSON.stringify({ do: 'x'.repeat(10000) }) }],
  ['no JSON', 400, `${url}change`, { ...post, body: '{' }],
]) assert.equal((await ask(where, options)).status, status, what);
assert.match(JSON.parse((await ask(`${url}change`, post)).text).refused, /nothing to undo/);
const policy = (await ask(url)).headers['content-security-policy'];
assert.match(policy, /default-src 'none'.*frame-ancestors 'none'/);
assert.doesNotMatch(policy, /unsafe|\*/);

const browser = await launch();

// A page of somebody else in the same browser knows even the address: it neither changes a station nor reads one.
const stranger = http.createServer((request, response) => response.writeHead(200, { 'Content-Type': 'text/html' }).end('<!doctype html><title>stranger</title><body></body>'));
await once(stranger.listen(0, '127.0.0.1'), 'listening');
const untouched = (await ask(`${url}state`)).text;
const hostile = await browser.newPage();
await hostile.goto(`http://127.0.0.1:${stranger.address().port}/`);
const got = await hostile.evaluate(async (address) => {
  const change = '{"do":"add","to":[6,3,0]}', tried = {};
  const attempt = async (name, what) => { tried[name] = await Promise.race([what().catch(() => 'refused'), new Promise((done) => { setTimeout(done, 5000, 'nothing'); })]); };
  const text = async (response) => (response.type === 'opaque' ? 'refused' : response.text());
  await attempt('read', async () => text(await fetch(`${address}state`)));
  await attempt('read the page', async () => text(await fetch(address)));
  await attempt('change', async () => text(await fetch(`${address}change`, { method: 'POST', body: change, headers: { 'Content-Type': 'application/json' } })));
  await attempt('change unseen', async () => text(await fetch(`${address}change`, { method: 'POST', body: change, mode: 'no-cors' })));
  await attempt('beacon', async () => { navigator.sendBeacon(`${address}change`, change); return 'refused'; });
  const load = (node, key) => new Promise((done, failed) => { node.onload = () => done(node.contentDocument?.title ?? (node.tagName === 'IFRAME' ? 'refused' : 'loaded')); node.onerror = () => failed(); node[key] = address; document.body.append(node); });
  await attempt('script', () => load(document.createElement('script'), 'src'));
  await attempt('picture', () => load(new Image(), 'src'));
  await attempt('frame', () => load(document.createElement('iframe'), 'src'));
  return tried;
}, url);
for (const [what, outcome] of Object.entries(got)) assert.equal(outcome, 'refused', what);
await hostile.setContent(`<form method="post" enctype="text/plain" action="${url}change"><input name='{"do":"add","to":[6,3,0],"' value='":0}'></form>`);
const [answered] = await Promise.all([hostile.waitForResponse(`${url}change`), hostile.evaluate(() => document.forms[0].submit())]);
assert.equal(answered.status(), 403, 'a form');
await hostile.close();
const elsewhere = await browser.newPage();
const rebound = await elsewhere.goto(url.replace('127.0.0.1', 'rebound.example'));
assert.equal(rebound.status(), 403, 'a name that leads here');
await elsewhere.close();
stranger.close();
assert.equal((await ask(`${url}state`)).text, untouched, 'nothing came of it');

const page = await watchedPage(browser, { width: 1280, height: 900 });
await page.goto(url);
await page.waitForSelector('html[data-ready]');
const version = () => page.evaluate(() => Number(document.documentElement.dataset.version));
const changed = async (act) => {
  const before = await version();
  await act();
  await page.waitForFunction((v) => Number(document.documentElement.dataset.version) > v, before);
};
// Until nothing changes any more.
const settled = async (tab) => {
  let last = null;
  for (let quiet = 0; quiet < 15;) {
    const now = await tab.evaluate(() => document.documentElement.dataset.version);
    quiet = now === last ? quiet + 1 : 0;
    last = now;
    await tab.waitForTimeout(100);
  }
};
const rows = async () => (await page.locator('#stations tbody tr').allInnerTexts()).map((row) => row.split('\t').map((cell) => cell.trim()));
const coverageOf = async (tab) => (await tab.locator('#figures dd small').first().innerText()).match(/coverage ([\d.]+)/)[1];
const coverage = () => coverageOf(page);
const tile = async (name) => (await page.locator(`#figures div:has(dt:text-is("${name}")) dd`).innerText()).split('\n')[0];

// The same stations give the same numbers on the command line.
async function checkNumbers(how) {
  fs.writeFileSync(at('now.csv'), ['x,y,z,u,v,heading,tilt,scanner,step', ...JSON.parse(read('edited/edit.json')).stations.map(
    (s) => [...s.position, ...s.uv, s.heading ?? '', s.tilt ?? '', s.scanner ?? '', s.step ?? ''].join())].join('\n'));
  const said = JSON.parse(vantage('evaluate', 'walls.glb', ...coarse, ...how, '--attainable', '--registration', '--stations', 'now.csv', '--json'));
  assert.equal(await coverage(), said.coverage.toFixed(4));
  // One scanner has noise, which is another where a station is traced alone.
  assert.ok(Math.abs(parseFloat(await tile('Captured')) - 100 * said.captured) < 0.3, `${await tile('Captured')} of ${said.captured}`);
  assert.match(await tile('Registered'), /^(less than 0\.1|\d+\.\d) mm$/);
  assert.equal(await tile('On site'), `${Math.round(said.minutes_on_site)} min`);
  assert.deepEqual([said.stations[1].scanner, said.stations[1].step, said.stations[1].tilt], ['Leica RTC360 @6mm', 0.7, 80]);
  (await rows()).forEach((row, k) => assert.deepEqual(row.slice(1, 4), said.stations[k].position.map((v) => v.toFixed(3))));
}

const { colours } = await coloursOf(page, '#canvas', () => true);
assert.ok(colours > 100, `the view is blank: ${colours} colours`);
assert.deepEqual(await paleTexts(page), []);

// Drag the first station by its name.
await page.locator('#above').click();
await page.waitForTimeout(200);
const [placed, number] = [await rows(), await coverage()];
const box = await page.locator('.label').first().boundingBox();
await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
await page.mouse.down();
await changed(async () => {
  for (let step = 1; step <= 5; ++step) await page.mouse.move(box.x + box.width / 2 + 8 * step, box.y + box.height / 2 + 10 * step);
});
await page.mouse.up();
await settled(page);
assert.notDeepEqual((await rows())[0], placed[0]);
assert.deepEqual((await rows())[1].slice(0, 5), placed[1].slice(0, 5));
assert.notEqual(await coverage(), number);
await checkNumbers(['--sample', '2000']);
await changed(() => page.locator('#undo').click());
assert.deepEqual(await rows(), placed);

// Keys: a step to the east, a lock that holds, a third station, one less.
const label = page.locator('.label').nth(1);
await label.focus();
await changed(() => page.keyboard.press('Shift+ArrowRight'));
assert.ok(Math.abs(Number((await rows())[1][1]) - Number(placed[1][1]) - 1) < 0.002);
await label.focus();
await changed(() => page.keyboard.press('l'));
await label.focus();
await page.keyboard.press('ArrowRight');
await page.waitForFunction(() => document.getElementById('status').textContent.includes('locked'));
await page.locator('#add').click();
const spots = await Promise.all([0, 1].map((k) => page.locator('.label').nth(k).boundingBox()));
await changed(() => page.mouse.click((spots[0].x + spots[1].x) / 2 + 20, (spots[0].y + spots[1].y) / 2 + 20));
assert.equal((await rows()).length, 3);
await checkNumbers(['--sample', '2000']);

// A station is renamed by F2, and undo takes that back, too.
const names = async () => (await rows()).map((row) => row[0]);
const numbered = await names();
await page.locator('.label').nth(2).focus();
await page.keyboard.press('F2');
await page.keyboard.type('By the gate');
await changed(() => page.keyboard.press('Enter'));
assert.deepEqual((await names()).filter((name) => !numbered.includes(name)), ['By the gate']);
assert.equal(JSON.parse(read('edited/edit.json')).stations[2].name, 'By the gate');
await changed(() => page.keyboard.press('Control+z'));
assert.deepEqual(await names(), numbered);

// Coordinates below the pointer, and a distance between two points on the ground.
await page.locator('#above').click();
await page.waitForTimeout(300);
await page.locator('#measure').click();
const labels = await Promise.all([0, 1].map((k) => page.locator('.label').nth(k).boundingBox()));
const [mx, my] = ['x', 'y'].map((axis) => (labels[0][axis] + labels[1][axis]) / 2 + 45);  // beside the third station
const point = async (dx) => {
  await page.mouse.move(mx + dx, my);
  await page.waitForFunction(() => !document.getElementById('at').hidden && /^x -?\d+\.\d\d  y -?\d+\.\d\d  z -?\d+\.\d\d$/.test(document.getElementById('at').textContent));
  await page.waitForTimeout(1000);
  const place = (await page.locator('#at').textContent()).match(/-?\d+\.\d+/g).map(Number);
  await page.mouse.click(mx + dx, my);
  await page.waitForFunction(() => document.getElementById('status').textContent.match(/\d/));
  return place;
};
const [here, there] = [await point(0), await point(24)];
await page.waitForFunction(() => document.getElementById('status').textContent.includes('on the plan'));
const told = (await page.locator('#status').innerText()).match(/[\d.]+/g).map(Number);
assert.ok(Math.abs(told[0] - Math.hypot(...here.map((v, k) => v - there[k]))) < 0.03, `${told[0]} m from ${here} to ${there}`);
await page.keyboard.press('Escape');
assert.equal((await rows()).length, 3, 'measuring adds no station');

// A second tab shows what the first one does.
const second = await watchedPage(browser, { width: 390, height: 844 });
await second.goto(url);
await second.waitForSelector('html[data-ready]');
await page.locator('.label').nth(2).focus();
await changed(() => page.keyboard.press('Delete'));
await second.waitForFunction(() => document.querySelectorAll('#stations tbody tr').length === 2);
assert.deepEqual(second.troubles, []);
await second.close();

// Touch: a finger on a name moves the station and nothing else, one in the view turns it, two go further away.
const phone = await watchedPage(browser, { width: 390, height: 844 }, { hasTouch: true, isMobile: true });
await phone.goto(url);
await phone.waitForSelector('html[data-ready]');
await phone.locator('#above').tap();
await phone.locator('#canvas').scrollIntoViewIfNeeded();
const device = await phone.context().newCDPSession(phone);
const fingers = (type, ...points) => device.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
async function slide(froms, by, steps = 6) {
  await fingers('touchStart', ...froms);
  for (let k = 1; k <= steps; ++k) await fingers('touchMove', ...froms.map(([x, y], i) => [x + (by[i][0] * k) / steps, y + (by[i][1] * k) / steps]));
  await fingers('touchEnd');
}
const phoneRows = async () => (await phone.locator('#stations tbody tr').allInnerTexts()).map((row) => row.split('\t').map((cell) => cell.trim()));
const middles = () => phone.locator('.label').evaluateAll((labels) => labels.map((label) => { const b = label.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2, b.width, b.height]; }));
const stood = await phoneRows(), scrolled = await phone.evaluate(() => scrollY), marks = await middles();
assert.ok(marks.every(([, , w, h]) => w >= 24 && h >= 24), `too small for a finger: ${marks}`);
await slide([marks[0].slice(0, 2)], [[30, 24]]);
await phone.waitForFunction((was) => document.querySelector('#stations tbody tr').innerText.split('\t')[1].trim() !== was, stood[0][1]);
// A busy machine is behind the finger, but comes after it.
const arrived = ([x, y]) => Math.hypot(x - marks[0][0] - 30, y - marks[0][1] - 24) < 6;
let [to] = await middles();
for (let k = 0; k < 60 && !arrived(to); ++k) {
  await phone.waitForTimeout(500);
  [to] = await middles();
}
assert.ok(arrived(to), `the station is where the finger left it: ${to} from ${marks[0]}`);
await settled(phone);
const moved = await phoneRows();
assert.deepEqual(moved[1].slice(0, 5), stood[1].slice(0, 5), 'the other station stays');
assert.equal(await phone.evaluate(() => scrollY), scrolled, 'and the page did not scroll away');
const canvas = await phone.locator('#canvas canvas').boundingBox();
const [cx, cy] = [canvas.x + canvas.width / 2, canvas.y + canvas.height * 0.8];
const gap = async () => { const [a, b] = await middles(); return Math.hypot(a[0] - b[0], a[1] - b[1]); };
const before = await gap();
await slide([[cx - 80, cy], [cx + 80, cy]], [[30, 0], [-30, 0]]);
await phone.waitForTimeout(300);
const after = await gap();
assert.ok(after > 0.2 * before && after < 0.9 * before, `two fingers go further away: ${before} to ${after}`);
const far = await middles();
await slide([[cx, cy]], [[90, -40]]);
await phone.waitForTimeout(300);
assert.ok((await middles()).some(([x, y], k) => Math.hypot(x - far[k][0], y - far[k][1]) > 10), 'one finger turns the view');
assert.deepEqual(await phoneRows(), moved, 'neither moves a station');
if (process.env.VANTAGE_SCREENSHOTS) await phone.screenshot({ path: `${process.env.VANTAGE_SCREENSHOTS}/edit-touch.png`, fullPage: true });
assert.deepEqual(phone.troubles, []);
await phone.close();

await changed(() => page.locator('#exact').click());
await page.waitForFunction(() => document.querySelector('#figures dd small').textContent.includes('every ray'));
await checkNumbers(['--exact']);
await page.locator('#save').click();
await page.waitForFunction(() => document.getElementById('status').textContent.startsWith('Saved in /'), null, { timeout: 120000 });
assert.ok((await page.locator('#status').innerText()).includes(`${fs.realpathSync(at('edited'))}: stations.csv, report.html, report.pdf`));
for (const file of ['stations.csv', 'report.html', 'report.pdf']) assert.ok(fs.existsSync(at(`edited/${file}`)), file);
const heads = await rows(), exactly = await coverage();
const saved = JSON.parse(vantage('evaluate', 'walls.glb', ...coarse, '--exact', '--stations', 'edited/stations.csv', '--json'));
assert.equal(saved.coverage.toFixed(4), exactly, 'the table that was saved is the network');
assert.equal(saved.stations[1].step, 0.7);
assert.deepEqual(page.troubles, []);
assert.deepEqual(page.requests.filter((request) => !request.startsWith(url)), [], 'requests go nowhere else');

// Gone without a word, it is where it was.
editor.kill('SIGKILL');
await page.waitForFunction(() => document.getElementById('status').textContent.includes('does not answer'));
await page.close();
({ editor, url } = await start());
const again = await watchedPage(browser, { width: 820, height: 1180 });
await again.goto(url);
await again.waitForSelector('html[data-ready]');
const texts = await again.locator('#stations tbody tr').evaluateAll((rows) => rows.map((row) => [...row.cells].map((cell) => cell.textContent.trim())));
assert.deepEqual(texts.map((row) => row.slice(0, 5)), heads.map((row) => row.slice(0, 5)));
assert.equal(await again.locator('.label.locked').count(), 1);
await again.locator('#exact').click();
await again.waitForFunction(() => document.querySelector('#figures dd small').textContent.includes('every ray'));
assert.equal(await coverageOf(again), exactly, 'with the scanners it had');
if (process.env.VANTAGE_SCREENSHOTS) await again.screenshot({ path: `${process.env.VANTAGE_SCREENSHOTS}/edit.png` });
assert.deepEqual(again.troubles, []);

// On a small phone the tools and the whole view are in the first screen, and nothing is wider than it.
const small = await watchedPage(browser, { width: 360, height: 640 }, { hasTouch: true, isMobile: true });
await small.goto(url);
await small.waitForSelector('html[data-ready]');
const shown = await small.locator('#canvas').boundingBox();
assert.ok(shown.y + shown.height <= 640 && shown.height >= 300, `the view is at ${shown.y}, ${shown.height} high`);
assert.ok((await small.locator('#add').boundingBox()).y < shown.y);
assert.equal(await small.evaluate(() => document.documentElement.scrollWidth), 360);
if (process.env.VANTAGE_SCREENSHOTS) await small.screenshot({ path: `${process.env.VANTAGE_SCREENSHOTS}/edit-phone.png` });
assert.deepEqual(small.troubles, []);
await small.close();
await stop(editor);  // with the tab still open

// The desktop's browser is given a page of this user's own, which leads to the editor: the token is in no program's arguments, where
// others see it. The page takes a link's place and goes with the editor.
fs.mkdirSync(at('bin'));
fs.writeFileSync(at('bin/xdg-open'), '#!/bin/sh\nprintf %s "$*" >opened.part && mv opened.part opened\n', { mode: 0o755 });
fs.writeFileSync(at('elsewhere'), 'untouched');
fs.symlinkSync(at('elsewhere'), at('edited/open-editor.html'));
({ editor, url } = await startAs({ DISPLAY: ':0', PATH: `${at('bin')}:${process.env.PATH}` }));
for (let k = 0; k < 100 && !fs.existsSync(at('opened')); ++k) await new Promise((done) => { setTimeout(done, 100); });
const opened = read('opened').toString(), status = fs.lstatSync(opened);
assert.equal(fs.realpathSync(opened), fs.realpathSync(at('edited/open-editor.html')));
assert.ok(status.isFile());
assert.equal(status.mode & 0o777, 0o600);
assert.equal(read('elsewhere').toString(), 'untouched');
const desktop = await watchedPage(browser, { width: 820, height: 1180 });
await desktop.goto(`file://${opened}`);
await desktop.waitForSelector('html[data-ready]');
assert.equal(desktop.url(), url);
assert.equal(await desktop.evaluate(() => document.referrer), '');
assert.deepEqual(desktop.troubles, []);
await stop(editor);
assert.ok(!fs.existsSync(opened), 'the page goes with the editor');

// Scans appear as they come into a folder: the planned station that one is of becomes a taken one, where it was really taken.
fs.mkdirSync(at('day'));
fs.writeFileSync(at('plan.csv'), 'name,x,y,z\nA,8,0,1.5\nB,0,8,1.5\n');
({ editor, url } = await start('--stations', 'plan.csv', '--scans', 'day'));
const site = await watchedPage(browser, { width: 1280, height: 900 });
await site.goto(url);
await site.waitForSelector('html[data-ready]');
assert.equal(await site.locator('.label.existing').count(), 0);
const planned = await coverageOf(site);
vantage('scan', 'walls.glb', ...coarse, '--station', '0.2,8.1,1.5', '-o', 'taken.e57');
fs.copyFileSync(at('taken.e57'), at('day/taken.e57'));
await site.waitForFunction(() => document.querySelectorAll('.label.existing').length === 1, null, { timeout: 60000 });
assert.equal(await site.locator('.label.existing').innerText(), 'B');
assert.match(await site.locator('#status').innerText(), /^B is taken, .* points; it was moved by /);
assert.match(await site.locator('#legend').innerText(), /planned station\s*taken/);
assert.notEqual(await coverageOf(site), planned, 'its real points count');
fs.writeFileSync(at('day/broken.e57'), 'no scan at all');
await site.waitForFunction(() => document.getElementById('status').textContent.includes('broken.e57'), null, { timeout: 60000 });
await site.locator('.label.existing').click();
assert.equal(await site.locator('#station button', { hasText: /^(Lock|Unlock|Remove)$/ }).count(), 0, 'it is renamed at most');
assert.equal(await site.locator('#rename').count(), 1);
if (process.env.VANTAGE_SCREENSHOTS) await site.screenshot({ path: `${process.env.VANTAGE_SCREENSHOTS}/edit-scans.png` });
assert.deepEqual(site.troubles, []);
await stop(editor);
await browser.close();
