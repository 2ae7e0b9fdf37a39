#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# dxf 5.3.1 (npm) and entities that were mirrored in CAD, with extrusion 0,0,-1. By the format a polyline lies in coordinates
# of its own, whose x points backwards; an ellipse lies in the drawing's, and only its sense of rotation turns.
# Guess before it was run: both are where CAD shows them.
# Seen: it is the other way round. A polyline from x = 1 to 2 stays there, which belongs to -1 to -2; half an ellipse that
# belongs below the x axis is above it. Arcs, circles and inserts are right.
# What vantage does: each kind of entity is placed by its own rule.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init -y >/dev/null
npm install --silent --no-audit --no-fund dxf@5.3.1 >/dev/null
cat >read.mjs <<'JS'
import { Helper } from "dxf";
const text = (groups) => groups.map(([code, value]) => `${code}\n${value}\n`).join("");
function ends(entity) {
  const mirrored = [[210, 0], [220, 0], [230, -1]];
  const file = text([[0, "SECTION"], [2, "ENTITIES"], ...entity, ...mirrored, [0, "ENDSEC"], [0, "EOF"]]);
  const { vertices } = new Helper(file).toPolylines().polylines[0];
  const middle = vertices[Math.floor(vertices.length / 2)];
  return [vertices[0], middle, vertices.at(-1)].map((vertex) => vertex.slice(0, 2).map((value) => Math.round(1000 * value) / 1000 + 0).join(",")).join(" ");
}
console.log = () => {};  // of the reader itself
const polyline = ends([[0, "LWPOLYLINE"], [8, "walls"], [90, 2], [70, 0], [10, 1], [20, 0], [10, 2], [20, 0]]);
const ellipse = ends([[0, "ELLIPSE"], [8, "walls"], [10, 0], [20, 0], [30, 0], [11, 2], [21, 0], [31, 0], [40, 0.5], [41, 0], [42, Math.PI]]);
const arc = ends([[0, "ARC"], [8, "walls"], [10, 5], [20, 0], [30, 0], [40, 1], [50, 0], [51, 90]]);
console.info(`polyline: first, middle, last ${polyline} (-1,0 and -2,0 by the format)`);
console.info(`ellipse: ${ellipse} (2,0 0,-1 -2,0 by the format)`);
console.info(`arc: ${arc} (-6,0 to -5,1 by the format)`);
process.exit(polyline === "1,0 2,0 2,0" && ellipse === "-2,0 0,1 2,0" && arc.startsWith("-6,0") && arc.endsWith("-5,1") ? 0 : 1);
JS
node read.mjs
