// SPDX-License-Identifier: Apache-2.0
#include "formats/e57_xml.hpp"

#include <algorithm>
#include <cstdio>
#include <string_view>

#include "core/text.hpp"
#include "formats/xml_text.hpp"
#include "vantage/version.hpp"

namespace vantage {
namespace {

// Elements nest by the lifetime of these; each says its type, as the standard asks.
class Element {
 public:
  Element(std::string& xml, const char* name, const std::string& attributes) : xml_(xml), name_(name) {
    xml_.append("<").append(name).append(" ").append(attributes).append(">\n");
  }
  ~Element() { xml_.append("</").append(name_).append(">\n"); }
  Element(const Element&) = delete;
  Element& operator=(const Element&) = delete;

 private:
  std::string& xml_;
  const char* name_;
};

Element structure(std::string& xml, const char* name) { return {xml, name, "type=\"Structure\""}; }

void leaf(std::string& xml, const char* name, const char* type, const std::string& value) {
  xml.append("<").append(name).append(" type=\"").append(type).append("\">");
  xml.append(value).append("</").append(name).append(">\n");
}

void text(std::string& xml, const char* name, const std::string& value) { leaf(xml, name, "String", xml_text(value)); }

void integer(std::string& xml, const char* name, std::uint64_t value) { leaf(xml, name, "Integer", number(value)); }
void real(std::string& xml, const char* name, double value) { leaf(xml, name, "Float", number(value)); }

bool has(const E57Scan& scan, std::string_view field) {
  return std::any_of(scan.fields.begin(), scan.fields.end(), [&](const E57Field& f) { return f.name == field; });
}

void write_bounds(std::string& xml, const E57Scan& scan) {
  const E57Bounds& b = scan.bounds;
  if (scan.records > 0) {
    {
      const Element element = structure(xml, "indexBounds");
      integer(xml, "rowMinimum", b.row_low), integer(xml, "rowMaximum", b.row_high);
      integer(xml, "columnMinimum", b.column_low), integer(xml, "columnMaximum", b.column_high);
    }
    const Element element = structure(xml, "cartesianBounds");
    real(xml, "xMinimum", b.low[0]), real(xml, "xMaximum", b.high[0]);
    real(xml, "yMinimum", b.low[1]), real(xml, "yMaximum", b.high[1]);
    real(xml, "zMinimum", b.low[2]), real(xml, "zMaximum", b.high[2]);
  }
  if (has(scan, "intensity")) {
    const Element element = structure(xml, "intensityLimits");
    real(xml, "intensityMinimum", 0), real(xml, "intensityMaximum", 1);
  }
  if (has(scan, "colorRed")) {
    const Element element = structure(xml, "colorLimits");
    for (const char* name : {"colorRed", "colorGreen", "colorBlue"}) {
      integer(xml, (std::string(name) + "Minimum").c_str(), 0);
      integer(xml, (std::string(name) + "Maximum").c_str(), 255);
    }
  }
}

void write_pose(std::string& xml, const E57Scan& scan) {
  const Element pose = structure(xml, "pose");
  {
    const Element rotation = structure(xml, "rotation");
    constexpr const char* kOfQuaternion[] = {"w", "x", "y", "z"};
    for (std::size_t k = 0; k < 4; ++k) real(xml, kOfQuaternion[k], scan.rotation[k]);
  }
  const Element translation = structure(xml, "translation");
  real(xml, "x", scan.translation.x), real(xml, "y", scan.translation.y), real(xml, "z", scan.translation.z);
}

void write_points(std::string& xml, const E57Scan& scan) {
  const Element points(xml, "points",
                       "type=\"CompressedVector\" fileOffset=\"" + number(scan.section) + "\" recordCount=\"" +
                           number(scan.records) + "\"");
  {
    const Element prototype = structure(xml, "prototype");
    for (const E57Field& field : scan.fields) {
      xml += "<" + field.name;
      if (field.type == E57Field::Type::integer) {
        xml +=
            " type=\"Integer\" minimum=\"0\" maximum=\"" + number((std::uint64_t{1} << (8 * field.bytes)) - 1) + "\"";
      } else {
        xml += " type=\"Float\"";
        if (field.type == E57Field::Type::single_precision) xml += " precision=\"single\"";  // double is the default
        if (field.unit_range) xml += " minimum=\"0\" maximum=\"1\"";
      }
      xml += "/>\n";
    }
  }
  const Element codecs(xml, "codecs", "type=\"Vector\" allowHeterogeneousChildren=\"1\"");
}

void write_scan(std::string& xml, const E57Scan& scan) {
  const Element element = structure(xml, "vectorChild");
  text(xml, "guid", scan.guid);
  text(xml, "name", scan.name);
  text(xml, "description", "simulated terrestrial scan");
  text(xml, "sensorModel", scan.sensor_model);
  write_bounds(xml, scan);
  write_pose(xml, scan);
  write_points(xml, scan);
}

}  // namespace

std::string e57_xml(const std::string& guid, const std::string& crs, const std::vector<E57Scan>& scans) {
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  {
    // The second name space is the extension for normals, https://www.libe57.org/extensions.html.
    const Element root(xml, "e57Root",
                       "type=\"Structure\" xmlns=\"http://www.astm.org/COMMIT/E57/2010-e57-v1.0\" "
                       "xmlns:nor=\"http://www.libe57.org/E57_NOR_surface_normals.txt\"");
    text(xml, "formatName", "ASTM E57 3D Imaging Data File");
    text(xml, "guid", guid);
    integer(xml, "versionMajor", 1), integer(xml, "versionMinor", 0);
    text(xml, "e57LibraryVersion", "vantage " + std::string(version()));
    // No time of creation, so that equal runs give equal files.
    if (!crs.empty()) text(xml, "coordinateMetadata", crs);
    {
      const Element data(xml, "data3D", "type=\"Vector\" allowHeterogeneousChildren=\"1\"");
      for (const E57Scan& scan : scans) write_scan(xml, scan);
    }
    const Element images(xml, "images2D", "type=\"Vector\" allowHeterogeneousChildren=\"1\"");
  }
  return xml;
}

std::string e57_guid(std::uint64_t high, std::uint64_t low) {
  high = (high & ~0xF000ull) | 0x8000;         // version 8: by a rule of its own
  low = (low & ~(3ull << 62)) | (2ull << 62);  // the variant
  char guid[40];
  std::snprintf(guid, sizeof guid, "{%08X-%04X-%04X-%04X-%012llX}", static_cast<unsigned>(high >> 32),
                static_cast<unsigned>(high >> 16 & 0xFFFF), static_cast<unsigned>(high & 0xFFFF),
                static_cast<unsigned>(low >> 48), static_cast<unsigned long long>(low & 0xFFFF'FFFF'FFFF));
  return guid;
}

}  // namespace vantage
