// SPDX-License-Identifier: Apache-2.0
// A picture of a page, as in docs/images: node picture.mjs report.html picture.png
import path from 'node:path';
import { pathToFileURL } from 'node:url';

import { launch } from './browser.mjs';

const [page, picture] = process.argv.slice(2);
const browser = await launch();
const shown = await browser.newPage({ viewport: { width: 1240, height: 1080 } });
await shown.goto(pathToFileURL(path.resolve(page)).href);
await shown.waitForSelector('html[data-ready]');
await shown.screenshot({ path: picture });
await browser.close();
