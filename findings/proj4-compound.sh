#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# proj4 (npm), with which pages and viewers place point clouds, reads the well-known text of a compound system, as LAS 1.4
# carries it where heights have a datum.
#
# Expected: it takes the system in plan out of COMPD_CS and leaves the heights alone, since it
# transforms no heights.
#
# Seen with proj4 2.11.0: it throws the text itself as an error. The same PROJCS alone is read, and is right.
# What vantage does: a cloud that it writes carries COMPD_CS only if the site's system has heights; docs/formats.md says to
# give the system in plan alone (--crs) for such programs.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
echo '{"private": true}' >package.json
npm install --silent --no-audit --no-fund proj4@2.11.0 >/dev/null
cat >try.cjs <<'END'
const proj4 = require("proj4");
const plan = 'PROJCS["ETRS89 / UTM zone 32N",GEOGCS["ETRS89",DATUM["European_Terrestrial_Reference_System_1989",' +
  'SPHEROID["GRS 1980",6378137,298.257222101]],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],' +
  'PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",9],' +
  'PARAMETER["scale_factor",0.9996],PARAMETER["false_easting",500000],PARAMETER["false_northing",0],UNIT["metre",1]]';
const both = `COMPD_CS["ETRS89 / UTM zone 32N + DHHN2016 height",${plan},VERT_CS["DHHN2016 height",` +
  'VERT_DATUM["Deutsches Haupthoehennetz 2016",2005],UNIT["metre",1],AXIS["Gravity-related height",UP]]]';
const place = (text) => {
  try {
    return proj4(text, "WGS84", [500000, 5400000]).map((v) => v.toFixed(4)).join(" ");
  } catch (error) {
    return `error: ${String(error.message ?? error).slice(0, 40)}`;
  }
};
console.log("version", require("proj4/package.json").version);
console.log("plan alone:", place(plan));
console.log("compound:  ", place(both));
process.exit(place(plan).startsWith("9.0000 48.7") && place(both).startsWith("error: COMPD_CS") ? 0 : 1);
END
node try.cjs && echo "a compound system is not read"
