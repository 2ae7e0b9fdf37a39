// SPDX-License-Identifier: Apache-2.0
// A browser without a screen, driven from outside: what it draws, says and asks for.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import { chromium } from 'playwright-core';

const names = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'];
const executablePath = process.env.VANTAGE_BROWSER ?? names.find((name) => fs.existsSync(name));
assert.ok(executablePath, `no browser: none of ${names.join(', ')} (Debian: chromium), and VANTAGE_BROWSER names none`);

// Without a GPU WebGL is drawn by software; root has no sandbox; one name leads here, as a stranger's may.
const args = ['--host-resolver-rules=MAP rebound.example 127.0.0.1', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', ...(process.getuid() === 0 ? ['--no-sandbox'] : [])];
export const launch = () => chromium.launch({ executablePath, args });

// A page whose errors and requests are kept: `troubles` and `requests`.
export async function watchedPage(browser, viewport, more = {}) {
  const page = await browser.newPage({ viewport, ...more });
  page.troubles = [];
  page.requests = [];
  page.on('console', (message) => { if (['error', 'warning'].includes(message.type())) page.troubles.push(message.text()); });
  page.on('pageerror', (error) => page.troubles.push(error.message));
  page.on('request', (request) => { if (!request.url().startsWith('data:') && !request.url().startsWith('blob:')) page.requests.push(request.url()); });
  return page;
}

// Colours of an element on the screen: their number, and the share of pixels for which `wanted(r, g, b)` holds.
export async function coloursOf(page, selector, wanted) {
  const png = (await page.locator(selector).screenshot()).toString('base64');
  const reader = await page.context().browser().newPage();  // where no policy of the page's own holds
  const colours = await reader.evaluate(async ([data, text]) => {
    const picture = new Image();
    picture.src = `data:image/png;base64,${data}`;
    await picture.decode();
    const canvas = Object.assign(document.createElement('canvas'), { width: picture.width, height: picture.height });
    const pen = canvas.getContext('2d');
    pen.drawImage(picture, 0, 0);
    const { data: bytes } = pen.getImageData(0, 0, canvas.width, canvas.height);
    const holds = new Function(`return ${text}`)(), seen = new Set();
    let share = 0;
    for (let k = 0; k < bytes.length; k += 4) {
      seen.add((bytes[k] << 16) | (bytes[k + 1] << 8) | bytes[k + 2]);
      if (holds(bytes[k], bytes[k + 1], bytes[k + 2])) share += 4 / bytes.length;
    }
    return { colours: seen.size, share };
  }, [png, wanted.toString()]);
  await reader.close();
  return colours;
}

// Texts whose contrast with what lies behind them is below 4.5 (WCAG 2.1, 1.4.3).
export const paleTexts = (page) => page.evaluate(() => {
  const channels = (text) => text.match(/[\d.]+/g).map(Number);
  const luminance = (c) => c.slice(0, 3).map((v) => v / 255).map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4))
    .reduce((sum, v, k) => sum + v * [0.2126, 0.7152, 0.0722][k], 0);
  const behind = (node) => {
    for (let at = node; at; at = at.parentElement) {
      const c = channels(getComputedStyle(at).backgroundColor);
      if (c.length < 4 || c[3] > 0) return c;
    }
    return [255, 255, 255];
  };
  const pale = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const node = walker.currentNode.parentElement;
    if (!walker.currentNode.data.trim() || ['SCRIPT', 'STYLE', 'NOSCRIPT'].includes(node.tagName) || !node.checkVisibility() || node.disabled) continue;
    const style = getComputedStyle(node), colour = node instanceof SVGElement ? style.fill : style.color;
    const [a, b] = [luminance(channels(colour)), luminance(behind(node))].sort((x, y) => y - x);
    if ((a + 0.05) / (b + 0.05) < 4.5) pale.push(`${walker.currentNode.data.trim()}: ${((a + 0.05) / (b + 0.05)).toFixed(2)}`);
  }
  return pale;
});
