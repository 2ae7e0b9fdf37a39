// SPDX-License-Identifier: Apache-2.0
#include "import/format.hpp"

#include <string>

#include "import_fixture.hpp"

namespace vantage::test {
namespace {

using namespace std::string_literals;

using FormatTest = ImportTest;

struct Sample {
  const char* file;
  std::string content;
  const char* format;
};

std::string binary_stl(std::uint32_t triangles) {
  std::string bytes(80, ' ');
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(triangles >> shift & 0xFF);
  return bytes + std::string(50 * triangles, '\0');
}

// A line, and two vertices of a polyface mesh that differ in height by so much, with a face of no height.
std::string polyface_dxf(double rise) {
  const auto vertex = [](int flags, double z) {
    return "0\nVERTEX\n8\n0\n70\n" + std::to_string(flags) + "\n30\n" + std::to_string(z) + "\n";
  };
  return "0\nSECTION\n2\nENTITIES\n0\nLINE\n8\n0\n0\nPOLYLINE\n70\n64\n" + vertex(192, 1) + vertex(192, 1 + rise) +
         vertex(128, 0) + "0\nSEQEND\n0\nENDSEC\n0\nEOF\n";
}

TEST_F(FormatTest, IsToldByContent) {
  const Sample samples[] = {
      {"a.glb", "glTF\2\0\0\0"s, "glTF"},
      {"a.gltf", "  {\"asset\": {}}", "glTF"},
      {"a.b3dm", "b3dm\1\0\0\0"s, "glTF"},
      {"packed.gltf", "{\"extensionsUsed\": [\"KHR_draco_mesh_compression\"]}", "compressed glTF"},
      {"a.glb.gz", "\x1F\x8B\x08rest", "compressed glTF"},
      {"a.ifc", "ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('IFC4'));", "IFC"},
      {"a.obj", "# by hand\nmtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "OBJ"},
      {"continued.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 \\\n2 \\\n3\nf 3 \\\n2 \\\n1\n", "OBJ"},
      {"points.obj", "v 1.0 2.0 3.0\nv 1.5 2.5 3.5\np 1 2\n", "OBJ"},
      {"a.stl", binary_stl(2), "STL"},
      {"solid.stl", "solid " + binary_stl(2).substr(6), "STL"},
      {"text.stl", "solid a\n facet normal 0 0 1\n", "STL"},
      {"capitals.stl", "SOLID a\n FACET NORMAL 0 0 1\n  VERTEX 1 2 3\n  VERTEX 1 2 4\n", "STL"},
      {"a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nelement face 1\nend_header\n", "PLY"},
      {"words.ply", "ply\nformat ascii 1.0\nobj_info no end_header yet\nelement face 1\nend_header\n", "PLY"},
      {"a.fbx", "Kaydara FBX Binary  \0\x1A\0"s, "FBX"},
      {"text.fbx", "; FBX 7.3.0 project file\nFBXHeaderExtension:  {\n", "FBX"},
      {"a.dae", "<?xml version=\"1.0\"?>\n<!-- made by hand -->\n<COLLADA xmlns=\"a\">", "COLLADA"},
      {"a.3ds", "MM\x0A\0\0\0\x02\0\x0A\0"s, "3DS"},
      {"a.x3d", "<?xml version=\"1.0\"?><!DOCTYPE X3D PUBLIC \"a\"><X3D>", "X3D"},
      {"a.e57", "ASTM-E57\1\0"s, "E57"},
      {"a.las", "LASF\0\0"s, "LAS"},
      {"a.pcd", "# .PCD v0.7\n", "PCD"},
      {"a.xyz", "1.0 2.0 3.0\n1.5 2.5 3.5\n", "XYZ"},
      {"a.pts", "2\n1.0 2.0 3.0 -5 1 2 3\n1.5 2.5 3.5 -5 1 2 3\n", "XYZ"},
      {"titles.xyz", "//X Y Z\nx;y;z\n1.0;2.0;3.0\n1.5;2.5;3.5\n", "XYZ"},
      {"quoted.xyz", "\"x\",\"y\",\"z\"\n\"1.0\",\"2.0\",\"3.0\"\n\"1.5\",\"2.5\",\"3.5\"\n", "XYZ"},
      {"a.ptx", "1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n1 2 3 0.5\n", "XYZ"},
      {"points.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nend_header\n", "PLY of points"},
      {"no_faces.ply", "ply\nformat ascii 1.0\nelement vertex 3\nelement face 0\nend_header\n", "PLY of points"},
      {"a.dxf", "999\nby hand\n  0\r\nSECTION\r\n  2\r\nHEADER\r\n", "DXF"},
      {"lines.dxf", "0\nSECTION\n2\nENTITIES\n0\nLINE\n8\n0\n0\nENDSEC\n0\nEOF\n", "a floor plan in DXF"},
      {"faces.dxf", "0\nSECTION\n2\nENTITIES\n0\nLINE\n8\n0\n0\n3DFACE\n30\n0\n31\n2.5\n0\nENDSEC\n0\nEOF\n", "DXF"},
      {"flat_faces.dxf", "0\nSECTION\n2\nENTITIES\n0\nLINE\n8\n0\n0\n3DFACE\n30\n0\n31\n0\n0\nENDSEC\n0\nEOF\n",
       "a floor plan in DXF"},
      {"polyface.dxf", polyface_dxf(2.5), "DXF"},
      {"mesh.dxf", "0\nSECTION\n2\nENTITIES\n0\nLINE\n8\n0\n0\nMESH\n30\n0\n30\n2.5\n0\nENDSEC\n0\nEOF\n", "DXF"},
      {"flat_polyface.dxf", polyface_dxf(0), "a floor plan in DXF"},
  };
  for (const Sample& sample : samples) {
    const auto recognised = importers::recognise(write(sample.file, sample.content));
    EXPECT_STREQ(recognised.format->name, sample.format) << sample.file;
    EXPECT_EQ(recognised.note, "") << sample.file;
    // A wrong extension is told, and one of its own is no reason to refuse.
    const auto renamed = importers::recognise(write("renamed.OBJ", sample.content));
    EXPECT_STREQ(renamed.format->name, sample.format) << sample.file;
    EXPECT_EQ(renamed.note.empty(), sample.format == "OBJ"s || sample.format == "compressed glTF"s)
        << sample.file << ": " << renamed.note;
    EXPECT_STREQ(importers::recognise(write("no_extension", sample.content)).format->name, sample.format);
  }
}

TEST_F(FormatTest, ExtensionDecidesWhatContentDoesNot) {
  EXPECT_STREQ(importers::recognise(write("cut.stl", binary_stl(2).substr(0, 120))).format->name, "STL");
  EXPECT_STREQ(importers::recognise(write("cut.fbx", "Kaydara")).format->name, "FBX");
  EXPECT_STREQ(importers::recognise(write("wide.x3d", "\xFF\xFE<\0X\0"s)).format->name, "X3D");
  EXPECT_STREQ(importers::recognise(write("cut.glb", "glT")).format->name, "glTF");
  EXPECT_STREQ(importers::recognise(folder_ / "not_there.obj").format->name, "glTF");  // whose loader says so
}

TEST_F(FormatTest, WhatIsNoModelIsRefusedByItsName) {
  const struct {
    const char* file;
    std::string content;
    const char* words;
  } others[] = {
      {"a.obj", "", "this is empty"},
      {"a.glb", "PK\x03\x04rest", "a zip archive"},
      {"a.pnts", "pnts\1\0\0\0"s, "a 3D tile of points"},
      {"a.off", "OFF\n8 6 12\n0 0 0\n1 0 0\n", "an OFF model"},
      {"a.ifc", "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n", "Git LFS pointer"},
      {"a.glb", "\n<!DOCTYPE html>\n<html><body>404</body></html>", "an HTML page"},
      {"a.obj", "<html><head></head></html>", "an HTML page"},
      {"a.pdf", "%PDF-1.7\n", "a PDF document"},
      {"a.jpg", "\xFF\xD8\xFF\xE0", "a picture"},
      {"a.dwg", "AC1032\0"s, "a DWG drawing"},
      {"a.dxf", "AutoCAD Binary DXF\r\n\x1A\0"s, "a DXF in binary form"},
      {"a.rvt", "\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1", "Revit"},
      {"a.step", "ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));", "a STEP file"},
      {"a.ifcxml", "<?xml version=\"1.0\"?><ifc:ifcXML xmlns=\"a\">", "ifcXML"},
      {"a.gml", "<?xml version=\"1.0\"?><core:CityModel>", "CityGML"},
      {"a.csv", "\xFF\xFEx\0,\0y\0"s, "a text in UTF-16"},
      {"a.dxf", "\xFE\xFF\0000\0\n"s, "a text in UTF-16"},
      {"a.txt", "What stands here is prose.\nNothing else.\n", "no model that vantage knows"},
  };
  for (const auto& other : others) {
    const auto file = write(other.file, other.content);
    const std::string message = expect_error(Errc::malformed_file, other.words, [&] { importers::recognise(file); });
    EXPECT_EQ(message.find(file.string()), 0u) << message;
  }
}

}  // namespace
}  // namespace vantage::test
