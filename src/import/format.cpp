// SPDX-License-Identifier: Apache-2.0
#include "import/format.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string_view>

#include "vantage/error.hpp"

namespace vantage::importers {
namespace {

using std::string_view_literals::operator""sv;

constexpr const char* kMesh = "vantage-import-mesh";
constexpr const char* kCloud = "vantage-import-cloud";
constexpr Format kGltf{"glTF", ".glb .gltf .b3dm ", nullptr};
constexpr Format kPacked{"compressed glTF", ".gltf .gz ", "vantage-import-gltf"};
constexpr Format kIfc{"IFC", ".ifc ", "vantage-import-ifc", "unit", true};
constexpr Format kObj{"OBJ", ".obj ", kMesh}, kStl{"STL", ".stl ", kMesh}, kPly{"PLY", ".ply ", kMesh},
    kFbx{"FBX", ".fbx ", kMesh}, kCollada{"COLLADA", ".dae ", kMesh}, k3ds{"3DS", ".3ds ", kMesh},
    kX3d{"X3D", ".x3d ", kMesh}, kDxf{"DXF", ".dxf ", kMesh};
// A PLY holds a mesh or points; its extension alone means a mesh.
constexpr const char* kOfClouds = "cell unit up";
constexpr Format kE57{"E57", ".e57 ", kCloud, kOfClouds, true}, kLas{"LAS", ".las .laz ", kCloud, kOfClouds, true},
    kPlyPoints{"PLY of points", ".ply ", kCloud, kOfClouds, true},
    kText{"XYZ", ".xyz .pts .ptx .asc ", kCloud, "cell unit up columns", true},
    kPcd{"PCD", ".pcd ", kCloud, kOfClouds, true};
constexpr Format kPlan{"a floor plan in DXF", ".dxf ", "vantage-import-plan", "unit wall-layer wall-height", true};
constexpr std::array kFormats{&kGltf, &kIfc, &kObj, &kStl, &kPly, &kFbx,  &kCollada,
                              &k3ds,  &kX3d, &kDxf, &kE57, &kLas, &kText, &kPcd};

// A file often mistaken for a model, with its first bytes and advice.
struct Mistaken {
  std::string_view begins;
  const char* is;
};
constexpr const char* kPicture = "a picture; give the model";
constexpr std::array kMistaken{
    Mistaken{"version https://git-lfs"sv, "a Git LFS pointer, not the model itself; fetch it with git lfs pull"},
    Mistaken{"PK\x03\x04"sv, "a zip archive; unpack it and give the model in it"},
    Mistaken{"7z\xBC\xAF"sv, "a 7z archive; unpack it and give the model in it"},
    Mistaken{"Rar!"sv, "a RAR archive; unpack it and give the model in it"},
    Mistaken{"%PDF"sv, "a PDF document; ask its author for the model"},
    Mistaken{"\x89PNG"sv, kPicture},
    Mistaken{"\xFF\xD8\xFF"sv, kPicture},
    Mistaken{"AutoCAD Binary DXF"sv, "a DXF in binary form; export it as DXF text"},
    Mistaken{"AC10"sv, "a DWG drawing; export IFC, FBX, or DXF with faces"},
    Mistaken{"\xD0\xCF\x11\xE0"sv, "a file of Revit, 3ds Max or an office program; export IFC or FBX"},
    Mistaken{"\xFF\xFE\xFF\x0E"sv, "a SketchUp file; export glTF or COLLADA"},
    Mistaken{"pnts"sv, "a 3D tile of points; export the cloud as E57 or LAS"},
    Mistaken{"i3dm"sv, "a 3D tile of instances; give their model"},
    Mistaken{"cmpt"sv, "a 3D tile of several tiles; give them one by one"},
    Mistaken{"BLENDER"sv, "a Blender file; export glTF"},
    Mistaken{"3D Geometry File Format"sv, "a Rhino file; export OBJ or FBX"},
    Mistaken{"PXR-USDC"sv, "a USD file; export glTF"},
    Mistaken{"#usda"sv, "a USD file; export glTF"},
    Mistaken{"OFF\n"sv, "an OFF model; export OBJ or PLY"},
    Mistaken{"#VRML"sv, "a VRML file; export X3D (as XML) or glTF"},
};

// Number of bytes of a file that may be read to recognise its format.
constexpr std::uint64_t kMostRecognised = std::uint64_t{1} << 30;

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v'; }

std::string_view without_blanks(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // UTF-8's byte order mark
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  return text;
}

std::uint32_t little_endian_32(std::string_view bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
  return value;
}

// Returns the non-empty lines of a text, without surrounding blanks.
std::vector<std::string_view> first_lines(std::string_view text, std::size_t most) {
  std::vector<std::string_view> lines;
  while (!text.empty() && lines.size() < most) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    std::string_view line = without_blanks(text.substr(0, end));
    while (!line.empty() && is_space(line.back())) line.remove_suffix(1);
    if (!line.empty()) lines.push_back(line);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::string_view first_word(std::string_view line) { return line.substr(0, line.find_first_of(" \t")); }

bool holds_obj(std::string_view text) {
  constexpr std::array kWords{"v"sv, "vn"sv, "vt"sv, "vp"sv,     "f"sv,      "fo"sv, "l"sv,
                              "p"sv, "g"sv,  "s"sv,  "mtllib"sv, "usemtl"sv, "o"sv,  "mg"sv};
  std::size_t known = 0, others = 0;
  bool vertices = false;  // a single letter at the start makes no model
  bool goes_on = false;   // true after a line that ends with a backslash
  for (const std::string_view line : first_lines(text, 2000)) {
    if (!goes_on && line.front() != '#')
      ++(std::ranges::find(kWords, first_word(line)) != kWords.end() ? known : others);
    vertices |= line.starts_with("v ") || line.starts_with("v\t");
    goes_on = line.ends_with('\\');
  }
  return vertices && known > 20 * others;
}

// Returns true if most of the first lines have at least three numbers and no more other words than numbers.
bool holds_numbers(std::string_view text) {
  constexpr std::size_t kLines = 40;
  const auto three_numbers = [](std::string_view line) {
    constexpr std::string_view kBetween = " \t,;\"";
    std::size_t numbers = 0, others = 0;
    for (std::size_t at = line.find_first_not_of(kBetween); at < line.size();) {
      const std::size_t end = std::min(line.find_first_of(kBetween, at), line.size());
      const std::string_view word = line.substr(at, end - at);
      const bool number = word.find_first_of("0123456789") < word.size() &&
                          word.find_first_not_of("0123456789+-.'eE") == std::string_view::npos;
      ++(number ? numbers : others);
      at = line.find_first_not_of(kBetween, end);
    }
    return numbers >= 3 && numbers >= others;
  };
  std::size_t points = 0, others = 0;
  for (const std::string_view line : first_lines(text, kLines))
    if (!line.starts_with('#') && !line.starts_with("//")) ++(three_numbers(line) ? points : others);
  return points >= 2 && points > others;
}

// Returns true if a PLY's header declares no faces.
bool ply_without_faces(std::string_view text) {
  for (const std::string_view line : first_lines(text, 1000)) {
    if (line.starts_with("end_header")) return true;
    if ((line.starts_with("element face") || line.starts_with("element tristrips")) && !line.ends_with(" 0"))
      return false;
  }
  return false;
}

// Returns the name of an XML document's root element, in lower case.
std::string root_element(std::string_view text) {
  for (std::size_t at = text.find('<'); at != std::string_view::npos; at = text.find('<', at + 1)) {
    const std::string_view rest = text.substr(at + 1);
    if (rest.starts_with("!--")) {
      at = text.find("-->", at);
      if (at == std::string_view::npos) return {};
    } else if (!rest.empty() && rest.front() != '?' && rest.front() != '!') {
      return lower(rest.substr(0, rest.find_first_of(" \t\r\n/>")));
    }
  }
  return {};
}

struct Head {
  std::string bytes;
  std::uintmax_t size = 0;  // of the whole file
};

std::optional<Head> read_head(const std::filesystem::path& file) {
  constexpr std::size_t kBytes = std::size_t{1} << 16;
  std::error_code failure;
  if (!std::filesystem::is_regular_file(file, failure)) return {};
  Head head;
  head.size = std::filesystem::file_size(file, failure);
  std::ifstream stream(file, std::ios::binary);
  if (failure || !stream) return {};
  head.bytes.resize(kBytes);
  stream.read(head.bytes.data(), kBytes);
  head.bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return head;
}

// Returns true for a text in UTF-16 that is no XML; readers of XML know UTF-16.
bool is_wide_text(std::string_view bytes) {
  const auto begins = [&](std::string_view mark, std::size_t letter) {
    return bytes.size() >= 4 && bytes.starts_with(mark) && bytes[letter] != '<' && bytes[5 - letter] == '\0';
  };
  return begins("\xFF\xFE", 2) || begins("\xFE\xFF", 3);
}

// Describes content that is no model of surfaces; empty if the content does not show it.
std::string mistaken_for_a_model(const Head& head) {
  if (head.bytes.empty()) return "empty; copy or export it again";
  const std::string_view text = without_blanks(head.bytes);
  for (const Mistaken& other : kMistaken)
    if (std::string_view(head.bytes).starts_with(other.begins) || text.starts_with(other.begins)) return other.is;
  if (is_wide_text(head.bytes)) return "a text in UTF-16; save or export it as UTF-8";
  if (text.starts_with("{") && text.find("ifcx") != std::string::npos && text.find("\"asset\"") == std::string::npos)
    return "IFC 5 (ifcx), a draft that no importer reads; export IFC 4.3 or IFC 4 as STEP text (.ifc)";
  if (text.starts_with("<")) {
    const std::string root = root_element(text);
    if (root == "html" || lower(text.substr(0, 14)) == "<!doctype html")
      return "an HTML page, perhaps the download page of the model; download the model itself";
    if (root.find("ifcxml") != std::string::npos || root.find("iso_10303_28") != std::string::npos)
      return "ifcXML; export IFC as STEP text (.ifc)";
    if (root.ends_with("citymodel")) return "CityGML; export glTF or OBJ";
  }
  if (text.starts_with("ISO-10303-21") && head.bytes.find("IFC") == std::string::npos)
    return "a STEP file of a CAD program; export glTF, OBJ or IFC";
  return {};
}

const Format* format_by_content(const Head& head) {
  const std::string_view bytes = head.bytes, text = without_blanks(bytes);
  if (bytes.starts_with("glTF") || bytes.starts_with("b3dm") || text.starts_with("{")) return &kGltf;
  if (text.starts_with("ISO-10303-21")) return &kIfc;
  if (bytes.starts_with("Kaydara FBX Binary") || bytes.find("FBXHeaderExtension") != std::string_view::npos)
    return &kFbx;
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return ply_without_faces(text) ? &kPlyPoints : &kPly;
  if (bytes.starts_with("ASTM-E57")) return &kE57;
  if (bytes.starts_with("LASF")) return &kLas;
  if (text.starts_with("# .PCD") || text.starts_with("VERSION .7") || text.starts_with("VERSION 0.7")) return &kPcd;
  if (bytes.size() >= 84 && head.size == 84 + std::uintmax_t{50} * little_endian_32(bytes.substr(80))) return &kStl;
  if (lower(text.substr(0, 5)) == "solid" && lower(text).find("facet") != std::string::npos) return &kStl;
  if (bytes.size() >= 6 && bytes.starts_with("MM") && head.size == little_endian_32(bytes.substr(2))) return &k3ds;
  if (text.starts_with("<")) {
    const std::string root = root_element(text);
    if (root == "collada") return &kCollada;
    if (root == "x3d") return &kX3d;
    return nullptr;
  }
  if (bytes.find('\0') != std::string_view::npos) return nullptr;
  auto lines = first_lines(text, 1000);
  std::span<const std::string_view> rest = lines;
  while (rest.size() >= 2 && rest[0] == "999") rest = rest.subspan(2);  // DXF's comments
  if (rest.size() >= 2 && rest[0] == "0" && rest[1] == "SECTION") return &kDxf;
  if (holds_obj(text)) return &kObj;
  return holds_numbers(text) ? &kText : nullptr;
}

bool is_named_as(const std::filesystem::path& file, const Format& format) {
  const std::string extension = lower(file.extension().string()) + " ";
  return extension.size() >= 2 && std::string_view(format.extensions).find(extension) != std::string_view::npos;
}

const Format* format_by_extension(const std::filesystem::path& file) {
  const auto found = std::ranges::find_if(kFormats, [&](const Format* format) { return is_named_as(file, *format); });
  return found == kFormats.end() ? nullptr : *found;
}

// Returns true if a text has one of these words within its first bytes.
bool mentions(std::istream& stream, std::uint64_t most, std::span<const std::string_view> words) {
  constexpr std::size_t kBlock = std::size_t{1} << 20, kOverlap = 64;  // no word is longer
  std::string block;
  while (stream && most > 0) {
    const std::size_t kept = std::min(block.size(), kOverlap), wanted = std::min<std::uint64_t>(kBlock, most);
    block.erase(0, block.size() - kept);
    block.resize(kept + wanted);
    stream.read(block.data() + kept, static_cast<std::streamsize>(wanted));
    block.resize(kept + static_cast<std::size_t>(stream.gcount()));
    most -= wanted;
    if (std::ranges::any_of(words, [&](std::string_view word) { return block.find(word) != std::string::npos; }))
      return true;
  }
  return false;
}

// Returns true if the JSON declares compressed meshes, or the file is gzipped.
bool is_packed(const std::filesystem::path& file, const Head& head) {
  constexpr std::array kWords{"\"KHR_draco_mesh_compression\""sv, "\"EXT_meshopt_compression\""sv,
                              "\"KHR_meshopt_compression\""sv};
  if (head.bytes.starts_with("\x1F\x8B")) return true;
  if (format_by_content(head) != &kGltf) return false;
  // A GLB's JSON comes first; the tables of a tile before it are short.
  const bool glb = head.bytes.starts_with("glTF") && head.bytes.size() >= 20;
  const std::uint64_t json =
      glb ? 20 + std::uint64_t{little_endian_32(std::string_view(head.bytes).substr(12))} : head.size;
  std::ifstream stream(file, std::ios::binary);
  return mentions(stream, std::min(json, kMostRecognised), kWords);
}

// Returns true if a DXF draws lines and no upright face, which makes it a floor plan and no model.
bool is_drawing(const std::filesystem::path& file) {
  constexpr std::array kLines{"LINE"sv,   "LWPOLYLINE"sv, "ARC"sv,   "CIRCLE"sv,  "HATCH"sv, "SOLID"sv,
                              "INSERT"sv, "POLYLINE"sv,   "MLINE"sv, "ELLIPSE"sv, "TRACE"sv, "SPLINE"sv};
  // Bits of group 70: a POLYLINE is a mesh of polygons or of faces; a VERTEX is a position, not a face.
  constexpr int kPolygons = 16, kFaces = 64, kPlace = 64;
  std::ifstream stream(file, std::ios::binary);
  auto left = static_cast<std::streamsize>(kMostRecognised);
  const auto next = [&](std::string& line) {
    std::array<char, 64> text{};  // a longer line is a text, cut off here
    stream.getline(text.data(), text.size());
    left -= stream.gcount();
    if (stream.fail() && !stream.eof() && stream.gcount() > 0) {
      stream.clear();
      stream.ignore(left, '\n');
      left -= stream.gcount();
    }
    line = without_blanks(text.data());
    while (!line.empty() && is_space(line.back())) line.pop_back();
    return !stream.fail();
  };
  bool lines = false;
  std::string code, value, entity;
  double lowest = 0, highest = 0, height = 0;
  int flags = 0, mesh = 0;  // the current entity's; those of the polyline that its vertices follow
  bool any = false;
  const auto reach = [&](double z) {
    lowest = any ? std::min(lowest, z) : z, highest = any ? std::max(highest, z) : z, any = true;
  };
  while (left > 0 && next(code) && next(value)) {
    if (code == "0") {
      if (entity == "POLYLINE") mesh = flags & (kPolygons | kFaces), any = false;
      if (entity == "VERTEX" && ((mesh & kPolygons) != 0 || (mesh != 0 && (flags & kPlace) != 0))) reach(height);
      if (any && highest - lowest > 1e-6) return false;
      if (value != "VERTEX") any = false;
      entity = value, flags = 0, height = 0;
      lines = lines || std::ranges::find(kLines, entity) != kLines.end();
    } else if (code == "70") {
      flags = std::atoi(value.c_str());
    } else if (entity == "3DFACE" && (code == "30" || code == "31" || code == "32" || code == "33")) {
      reach(std::atof(value.c_str()));
    } else if (entity == "MESH" && code == "30") {
      reach(std::atof(value.c_str()));
    } else if (entity == "VERTEX" && code == "30") {
      height = std::atof(value.c_str());
    }
  }
  return lines;
}

// Throws Error io if an entry of a folder has a model's extension and is no file.
void require_file(const std::filesystem::directory_entry& entry) {
  namespace fs = std::filesystem;
  std::error_code failure;
  const fs::file_status status = entry.status(failure);
  if (fs::is_regular_file(status)) return;
  std::string is = fs::is_directory(status)                                     ? "a folder"
                   : fs::is_character_file(status) || fs::is_block_file(status) ? "a device"
                   : fs::is_fifo(status)                                        ? "a pipe"
                   : fs::is_socket(status)                                      ? "a socket"
                                                                                : "nothing that can be read";
  if (entry.is_symlink(failure)) {
    const fs::path target = fs::read_symlink(entry.path(), failure);
    is = "a link to " + target.string() + ", " + (fs::exists(status) ? "which is " + is : "where there is nothing");
  }
  throw Error(Errc::io, entry.path().string() + ": this is " + is + "; take it out of the folder, or give a file");
}

}  // namespace

namespace {

std::vector<std::filesystem::path> files_at(const std::filesystem::path& file) {
  std::error_code failure;
  if (!std::filesystem::is_directory(file, failure)) return {file};
  constexpr std::array kSeveral{&kE57, &kLas, &kText, &kPcd, &kPlyPoints, &kPlan, &kIfc};
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(file, failure))
    if (std::ranges::any_of(kSeveral, [&](const Format* format) { return is_named_as(entry.path(), *format); })) {
      require_file(entry);
      files.push_back(entry.path());
    }
  if (failure) throw Error(Errc::io, file.string() + ": the folder cannot be read: " + failure.message());
  if (files.empty())
    throw Error(Errc::malformed_file,
                file.string() +
                    ": a folder is a site if it holds scans (E57, PTX, LAS, PLY, XYZ, PCD), IFC models, or floor plans "
                    "in DXF, a file for each storey; this one holds none of them");
  std::ranges::sort(files);
  return files;
}

}  // namespace

std::vector<std::filesystem::path> files_of(const std::filesystem::path& file, const std::vector<std::string>& beside) {
  std::vector<std::filesystem::path> files = files_at(file);
  for (const std::string& other : beside)
    for (std::filesystem::path& one : files_at(other)) files.push_back(std::move(one));
  return files;
}

Recognised recognise(const std::filesystem::path& file, const std::vector<std::string>& beside) {
  if (const auto files = files_of(file, beside); files.size() > 1 || files.front() != file) {
    const Recognised first = recognise(files.front());
    for (const std::filesystem::path& other : files) {
      const Format* const format = recognise(other).format;
      if (!format->several)
        throw Error(beside.empty() ? Errc::malformed_file : Errc::invalid_argument,
                    other.string() + ": this is " + format->name +
                        ", and several files are one site if they are IFC models, scans or "
                        "floor plans; give one file");
      if (format != first.format)
        throw Error(Errc::malformed_file, other.string() + ": this is " + format->name + ", and " +
                                              files.front().filename().string() + " is " + first.format->name +
                                              "; give files of one format");
    }
    return {first.format};
  }
  const auto head = read_head(file);
  if (!head) return {&kGltf};
  if (is_packed(file, *head)) return {&kPacked};
  const Format* by_extension = format_by_extension(file);
  if (const std::string other = mistaken_for_a_model(*head); !other.empty())
    throw Error(Errc::malformed_file, file.string() + ": this is " + other);
  if (const Format* format = format_by_content(*head); format && format->importer == nullptr) {
    if (!by_extension || by_extension == format) return {format};
    return {format, std::string("it is named as ") + by_extension->name + ", but holds glTF, and is read as that"};
  }
  const Format* format = format_by_content(*head);
  if (!format) format = by_extension;
  if (!format) {
    std::string names;
    for (const Format* known : kFormats) names += std::string(names.empty() ? "" : ", ") + known->name;
    throw Error(Errc::malformed_file,
                file.string() + ": this is no model that vantage knows; it reads " + names + ": export one of these");
  }
  const Format* read_as = format == &kDxf && is_drawing(file) ? &kPlan : format;
  if (!by_extension || is_named_as(file, *format)) return {read_as};
  return {read_as, std::string("it is named as ") + by_extension->name + ", but holds " + format->name +
                       ", and is read as that"};
}

}  // namespace vantage::importers
