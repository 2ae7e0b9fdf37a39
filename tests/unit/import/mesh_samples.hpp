// SPDX-License-Identifier: Apache-2.0
// A model of a few triangles in each format that the importer of meshes reads.
#pragma once

#include <string>

namespace vantage::test {

inline constexpr const char* kRoomObj = R"(mtllib colours.mtl
v 0 0 0
v 4 0 0
v 4 3 0
v 0 3 0
v 0 0 2
v 4 0 2
v 0 3 2
v 4 3 2
o bare
f 1 2 6
o wall
usemtl grey
f 1 2 3 4
o window
usemtl pane
f 5 6 8 7
)";

inline constexpr const char* kTriangleStl = R"(solid a
facet normal 0 1 0
outer loop
vertex 0 0 0
vertex 0 0 1
vertex 1 0 0
endloop
endfacet
endsolid a
)";

inline constexpr const char* kTrianglePly = R"(ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
element face 1
property list uchar int vertex_indices
end_header
0 0 0
0 0 1
1 0 0
3 0 1 2
)";

inline constexpr const char* kTriangleX3d = R"(<?xml version="1.0" encoding="UTF-8"?>
<X3D version="3.0" profile="Interchange"><Scene><Shape>
<IndexedFaceSet coordIndex="0 1 2 -1" solid="false"><Coordinate point="0 0 0 0 0 1 1 0 0"/></IndexedFaceSet>
</Shape></Scene></X3D>
)";

inline constexpr const char* kPostsDae = R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimeter" meter="0.01"/><up_axis>Z_UP</up_axis></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="t"><lambert>
<diffuse><color>0.5 0.5 0.5 1</color></diffuse></lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m" name="grey"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="9">0 0 0 100 0 0 0 0 300</float_array>
<technique_common><accessor source="#pa" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1" material="s"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s">
<node id="a" name="post 1"><instance_geometry url="#g"/></node>
<node id="b" name="post 2"><translate>500 0 0</translate><instance_geometry url="#g"><bind_material>
<technique_common><instance_material symbol="s" target="#m"/></technique_common></bind_material></instance_geometry>
</node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
)";

inline constexpr const char* kPostFbx = R"(; FBX 7.3.0 project file
FBXHeaderExtension:  {
	FBXHeaderVersion: 1003
	FBXVersion: 7300
}
GlobalSettings:  {
	Version: 1000
	Properties70:  {
		P: "UpAxis", "int", "Integer", "",2
		P: "UpAxisSign", "int", "Integer", "",1
		P: "FrontAxis", "int", "Integer", "",1
		P: "FrontAxisSign", "int", "Integer", "",-1
		P: "CoordAxis", "int", "Integer", "",0
		P: "CoordAxisSign", "int", "Integer", "",1
		P: "UnitScaleFactor", "double", "Number", "",2.54
	}
}
Objects:  {
	Geometry: 100, "Geometry::", "Mesh" {
		Vertices: *9 {
			a: 0,0,0,40,0,0,0,0,118
		}
		PolygonVertexIndex: *3 {
			a: 0,1,-3
		}
		GeometryVersion: 124
	}
	Model: 200, "Model::post", "Mesh" {
		Version: 232
	}
}
Connections:  {
	C: "OO",200,0
	C: "OO",100,200
}
)";

inline constexpr const char* kWallDxf = R"(  0
SECTION
  2
HEADER
  9
$INSUNITS
 70
     4
  0
ENDSEC
  0
SECTION
  2
ENTITIES
  0
3DFACE
  8
walls
 10
0.0
 20
0.0
 30
0.0
 11
4000.0
 21
0.0
 31
0.0
 12
4000.0
 22
0.0
 32
2500.0
 13
0.0
 23
0.0
 33
2500.0
  0
ENDSEC
  0
EOF
)";

// One triangle of 1 m, of nested chunks: a kind of two bytes and a length of four, its own included.
inline std::string triangle_3ds() {
  const auto number = [](std::uint32_t value, int bytes) {
    std::string out;
    for (int b = 0; b < bytes; ++b) out += static_cast<char>(value >> (8 * b) & 0xFF);
    return out;
  };
  const auto chunk = [&](std::uint32_t kind, const std::string& content) {
    return number(kind, 2) + number(static_cast<std::uint32_t>(content.size() + 6), 4) + content;
  };
  constexpr std::uint32_t kOne = 0x3F800000;  // 1.0F
  std::string points = number(3, 2);
  for (const std::uint32_t value : {0U, 0U, 0U, kOne, 0U, 0U, 0U, kOne, 0U}) points += number(value, 4);
  const std::string faces = number(1, 2) + number(0, 2) + number(1, 2) + number(2, 2) + number(0, 2);
  const std::string mesh = chunk(0x4100, chunk(0x4110, points) + chunk(0x4120, faces));
  return chunk(0x4D4D, chunk(0x3D3D, chunk(0x4000, std::string("plate\0", 6) + mesh)));
}

}  // namespace vantage::test
