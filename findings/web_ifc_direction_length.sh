#!/bin/sh
# web-ifc 0.0.78 and the length of an IfcDirection.
# Guess: only the ratios of a direction count (IfcDirection: "the magnitude is irrelevant"), so (0, 0, 2) extrudes by
# the depth.
# Seen: the depth is multiplied by the direction's length: 3 m become 6 m.
set -e
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init -y >/dev/null
npm install --silent --no-audit --no-fund web-ifc@0.0.78 >/dev/null
cat >model.ifc <<'IFC'
ISO-10303-21;
HEADER;
FILE_DESCRIPTION(('ViewDefinition [ReferenceView]'),'2;1');
FILE_NAME('model.ifc','2026-01-01T00:00:00',(''),(''),'','','');
FILE_SCHEMA(('IFC4'));
ENDSEC;
DATA;
#1=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);
#2=IFCSIUNIT(*,.PLANEANGLEUNIT.,$,.RADIAN.);
#3=IFCUNITASSIGNMENT((#1,#2));
#4=IFCCARTESIANPOINT((0.,0.,0.));
#5=IFCAXIS2PLACEMENT3D(#4,$,$);
#6=IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-05,#5,$);
#7=IFCPROJECT('0Finding00000000000001',$,'p',$,$,$,$,(#6),#3);
#8=IFCLOCALPLACEMENT($,#5);
#9=IFCDIRECTION((0.,0.,1.));
#10=IFCCARTESIANPOINT((0.,0.));
#11=IFCAXIS2PLACEMENT2D(#10,$);
#20=IFCRECTANGLEPROFILEDEF(.AREA.,$,#11,1.,1.);
#22=IFCDIRECTION((0.,0.,2.));
#21=IFCEXTRUDEDAREASOLID(#20,#5,#22,3.);
#49=IFCSHAPEREPRESENTATION(#6,'Body','SweptSolid',(#21));
#50=IFCPRODUCTDEFINITIONSHAPE($,$,(#49));
#51=IFCBUILDINGELEMENTPROXY('0Finding00000000000002',$,'thing',$,$,#8,#50,$,$);
ENDSEC;
END-ISO-10303-21;
IFC
cat >measure.cjs <<'JS'
// Volume, box and colours of each product, in metres with z up.
const ifc = require("web-ifc"), fs = require("fs");
(async () => {
  const api = new ifc.IfcAPI();
  await api.Init();
  api.SetLogLevel(ifc.LogLevel.LOG_LEVEL_OFF);
  const model = api.OpenModel(fs.readFileSync("model.ifc")), found = {};
  api.StreamAllMeshes(model, (mesh) => {
    const one = { volume: 0, min: [1e9, 1e9, 1e9], max: [-1e9, -1e9, -1e9], alphas: [], parts: [] };
    for (let g = 0; g < mesh.geometries.size(); ++g) {
      const placed = mesh.geometries.get(g), geometry = api.GetGeometry(model, placed.geometryExpressID), m = placed.flatTransformation;
      const v = api.GetVertexArray(geometry.GetVertexData(), geometry.GetVertexDataSize()), t = api.GetIndexArray(geometry.GetIndexData(), geometry.GetIndexDataSize());
      const corner = (i) => { const p = [0, 1, 2].map((r) => m[r] * v[6 * i] + m[4 + r] * v[6 * i + 1] + m[8 + r] * v[6 * i + 2] + m[12 + r]); return [p[0], -p[2], p[1]]; };
      let volume = 0;
      for (let k = 0; k < t.length; k += 3) {
        const [a, b, c] = [0, 1, 2].map((i) => corner(t[k + i]));
        volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6;
        for (const p of [a, b, c]) for (let i = 0; i < 3; ++i) one.min[i] = Math.min(one.min[i], p[i]), one.max[i] = Math.max(one.max[i], p[i]);
      }
      one.volume += volume, one.parts.push(volume), one.alphas.push(placed.color.w);
    }
    found[api.GetLine(model, mesh.expressID).Name.value] = one;
  });
  let same = true;
  const seen = (what, value, wanted) => {
    const is = value === wanted || Math.abs(value - wanted) < 1e-3;
    console.log(`${what}: ${typeof value === "number" ? Number(value.toFixed(4)) : value}${is ? "" : `, not ${wanted} as in 0.0.78`}`);
    same &&= is;
  };
  seen("height in m of a depth of 3", found.thing.max[2], 6);
  process.exit(same ? 0 : 1);
})();
JS
node measure.cjs
