// SPDX-License-Identifier: Apache-2.0
// Random valid files of points, each with its truth: what is read is the truth, or a question.
// VANTAGE_SEEDS=first..last chooses them.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <random>

#include "e57_file.hpp"
#include "import/cloud/convert.hpp"
#include "las_file.hpp"

namespace vantage::test {
namespace {

using Eigen::Vector3d;

struct Truth {
  std::vector<Vector3d> points;  // in metres, or in the file's unit if that is not told
  bool metric = true;            // whether the file tells its unit
  bool may_ask = false;          // whether the file can be read in several ways
  double within = 1e-6;
  std::vector<Vector3d> heads = {};  // of scans with a place
};

class Maker {
 public:
  Maker(std::uint64_t seed, std::filesystem::path folder) : random_(seed), folder_(std::move(folder)) {
    const int place = whole(0, 2);  // local, of a plant, of a national grid
    if (place > 0) origin_ = {real(-500, 500), real(-500, 500), real(-5, 50)};
    if (place == 2) origin_ += Vector3d(whole(300, 800) * 1000.0, whole(4'700, 6'200) * 1000.0, 300);
    const int count = whole(40, 300);
    for (int k = 0; k < count; ++k) points_.push_back(origin_ + Vector3d(real(0, 12), real(0, 8), real(0, 3)));
  }

  std::filesystem::path make(const std::string& format, Truth& truth) {
    const auto file = folder_ / ("cloud." + format);
    std::string bytes;
    if (format == "las") bytes = las(truth);
    if (format == "ply") bytes = ply(truth);
    if (format == "pcd") bytes = pcd(truth);
    if (format == "xyz") bytes = whole(0, 3) == 0 ? ptx(truth) : text(truth);
    if (format == "e57")
      e57(file, truth);
    else
      std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }

 private:
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  bool chance(int of) { return whole(1, of) == 1; }
  template <class T>
  const T& one_of(const std::vector<T>& all) {
    return all[static_cast<std::size_t>(whole(0, static_cast<int>(all.size()) - 1))];
  }
  static std::string fixed(double value, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
  }
  Eigen::Quaterniond turn() {
    if (chance(2)) return Eigen::Quaterniond(Eigen::AngleAxisd(real(-3, 3), Vector3d::UnitZ()));
    return Eigen::Quaterniond(real(-1, 1), real(-1, 1), real(-1, 1), real(0.1, 1)).normalized();
  }

  // All formats and versions; a system as text or keys, before or behind the points, with a unit for each axis.
  std::string las(Truth& truth) {
    struct Length {
      double metres;
      const char *text, *plan_code, *height_code;
      std::uint16_t key;
    };
    constexpr double kSurveyFoot = 0.304800609601219;
    const std::vector<Length> lengths{{1, "UNIT[\"metre\",1]", "", "5703", 9001},
                                      {kSurveyFoot, "UNIT[\"US survey foot\",0.304800609601219]", "", "6360", 9003},
                                      {0.3048, "UNIT[\"foot\",0.3048]", "", "8228", 9002}};
    Las las{.minor = whole(2, 5)};
    las.format = las.minor >= 4 ? whole(0, 10) : whole(0, 3);
    las.spare = chance(3) ? static_cast<std::size_t>(whole(1, 9)) : 0;
    const Length plan = one_of(lengths), height = one_of(lengths);
    const int way = whole(0, 4);
    Vector3d metres(plan.metres, plan.metres, plan.metres);
    if (chance(3)) las.vlr(7, std::string(static_cast<std::size_t>(whole(0, 90)), 'v'));
    if (way == 0) {
      metres.setOnes();
      truth.metric = false;
    } else if (way <= 2) {
      const bool both = chance(2);
      if (both) metres.z() = height.metres;
      std::string text =
          "PROJCS[\"Own\",GEOGCS[\"NAD83\",DATUM[\"North_American_Datum_1983\",SPHEROID[\"GRS 1980\",6378137,"
          "298.257222101]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],"
          "PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\",0],"
          "PARAMETER[\"central_meridian\",-75],PARAMETER[\"scale_factor\",1],PARAMETER[\"false_easting\",5],"
          "PARAMETER[\"false_northing\",0]," +
          std::string(plan.text) + "]";
      if (both)
        text = "COMPD_CS[\"Both\"," + text + ",VERT_CS[\"Heights\",VERT_DATUM[\"Own\",2005]," + height.text + "]]";
      if (las.minor >= 4) las.flags = 16;
      if (las.minor >= 4 && chance(2))
        las.evlr(2112, text);
      else
        las.vlr(2112, text + std::string(static_cast<std::size_t>(whole(0, 3)), '\0'));
    } else {
      std::vector<std::pair<std::uint16_t, std::uint16_t>> keys{{1024, 1}};
      const bool by_code = chance(2);
      keys.emplace_back(3072, by_code ? (plan.metres == 1 ? 26918 : 2263) : 32767);
      if (by_code && plan.metres != 1) metres.setConstant(kSurveyFoot);
      if (!by_code || chance(2)) keys.emplace_back(3076, plan.key), metres.setConstant(plan.metres);
      if (chance(2)) keys.emplace_back(4099, height.key), metres.z() = height.metres;
      std::string body;
      for (const int word : {1, 1, 0, static_cast<int>(keys.size())}) put(body, static_cast<std::uint16_t>(word));
      for (const auto& [key, value] : keys)
        for (const int word : {int{key}, 0, 1, int{value}}) put(body, static_cast<std::uint16_t>(word));
      if (las.minor >= 4 && chance(3))
        las.evlr(34735, body);
      else
        las.vlr(34735, body);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      las.scale[axis] = one_of<double>({0.001, 0.0001, 0.00025});
      las.offset[axis] = std::round(origin_[static_cast<int>(axis)] / metres[static_cast<int>(axis)]);
    }
    for (const Vector3d& p : points_) {
      std::array<std::int32_t, 3> raw{};
      Vector3d read;
      for (int axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        raw[k] = static_cast<std::int32_t>(std::lround((p[axis] / metres[axis] - las.offset[k]) / las.scale[k]));
        read[axis] = (raw[k] * las.scale[k] + las.offset[k]) * metres[axis];
      }
      las.add(raw[0], raw[1], raw[2], chance(9) ? 6 : 2);
      truth.points.push_back(read);
      if (chance(8)) las.add(1, 1, 1, las.format >= 6 && chance(2) ? 18 : 7);
      if (chance(8)) las.add(1, 1, 1, 2, true);
    }
    return las.bytes();
  }

  // Properties in any order and type, text or binary in either order of bytes.
  std::string ply(Truth& truth) {
    truth.metric = false;
    struct Property {
      std::string name, type;
    };
    const bool wide = origin_.norm() > 1000 || chance(2), capitals = chance(6);
    const std::string type =
        wide ? one_of<std::string>({"double", "float64"}) : one_of<std::string>({"float", "float32"});
    std::vector<Property> properties;
    for (const char* name : {"x", "y", "z"})
      properties.push_back({capitals ? std::string(1, static_cast<char>(*name - 'a' + 'A')) : name, type});
    for (const auto& [name, of] :
         {std::pair{"red", "uchar"}, {"intensity", "float"}, {"label", "int16"}, {"t", "double"}})
      if (chance(3)) properties.push_back({name, of});
    std::shuffle(properties.begin(), properties.end(), random_);
    const std::string kind = one_of<std::string>({"ascii", "binary_little_endian", "binary_big_endian"});
    std::string out = "ply\nformat " + kind + " 1.0\ncomment made at random\n";
    if (chance(3)) out += "obj_info nothing\n";
    const bool before = chance(4);
    if (before) out += "element camera 2\nproperty float f\n";
    out += "element vertex " + std::to_string(points_.size()) + "\n";
    for (const Property& p : properties) out.append("property ").append(p.type).append(" ").append(p.name).append("\n");
    if (chance(4)) out += "element face 0\nproperty list uchar int vertex_indices\n";
    out += "end_header\n";
    const bool ascii = kind == "ascii", big = kind == "binary_big_endian";
    const auto number = [&](const std::string& of, double value) {
      if (ascii) {
        out += (of == "uchar" || of == "int16" ? std::to_string(static_cast<int>(value)) : fixed(value, 9)) + " ";
      } else if (of == "uchar") {
        put(out, static_cast<std::uint8_t>(value));
      } else if (of == "int16") {
        put(out, static_cast<std::int16_t>(value), big);
      } else if (of.starts_with("f") && of != "float64") {
        put(out, static_cast<float>(value), big);
      } else {
        put(out, value, big);
      }
    };
    for (int k = 0; before && k < 2; ++k) number("float", 1.5), out += ascii ? "\n" : "";
    for (const Vector3d& p : points_) {
      const Vector3d read = wide ? p : Vector3d(p.cast<float>().cast<double>());
      for (const Property& property : properties) {
        const char axis = static_cast<char>(property.name.front() | ' ');
        number(property.type, property.name.size() == 1 && axis != 't' ? p[axis - 'x'] : whole(0, 200));
      }
      if (ascii) out += chance(9) ? " \r\n" : "\n";
      truth.points.push_back(ascii ? p : read);
    }
    truth.within = 1e-6;
    return out;
  }

  // Fields in any order and type; a viewpoint that moves the points.
  std::string pcd(Truth& truth) {
    truth.metric = false;
    const bool wide = origin_.norm() > 1000 || chance(3), moved = chance(2);
    const Vector3d place(real(-5, 5), real(-5, 5), 1.5);
    const Eigen::Quaterniond turned = turn();
    std::vector<std::pair<std::string, int>> fields{{"x", wide ? 8 : 4}, {"y", wide ? 8 : 4}, {"z", wide ? 8 : 4}};
    if (chance(2)) fields.emplace_back("intensity", 4);
    if (chance(3)) fields.emplace_back("time", 8);
    std::shuffle(fields.begin(), fields.end(), random_);
    std::string names, sizes, types, counts;
    for (const auto& [name, bytes] : fields)
      names += " " + name, sizes += " " + std::to_string(bytes), types += " F", counts += " 1";
    const std::string kind = one_of<std::string>({"ascii", "binary", "binary_compressed"});
    std::string out = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS" + names + "\nSIZE" + sizes +
                      "\nTYPE" + types + "\n" + (chance(3) ? "" : "COUNT" + counts + "\n") + "WIDTH " +
                      std::to_string(points_.size()) + "\nHEIGHT 1\n";
    if (moved) {
      out += "VIEWPOINT";
      for (const double v : {place.x(), place.y(), place.z(), turned.w(), turned.x(), turned.y(), turned.z()})
        out += " " + fixed(v, 12);
      out += "\n";
      truth.heads = {place};
    } else if (chance(2)) {
      out += "VIEWPOINT 0 0 0 1 0 0 0\n";
    }
    out += "POINTS " + std::to_string(points_.size()) + "\nDATA " + kind + "\n";
    std::vector<std::string> columns(fields.size());
    std::string rows;
    for (const Vector3d& p : points_) {
      const Vector3d kept = wide || kind == "ascii" ? p : Vector3d(p.cast<float>().cast<double>());
      truth.points.push_back(moved ? Vector3d(turned * kept + place) : kept);
      for (std::size_t k = 0; k < fields.size(); ++k) {
        const double value = fields[k].first.size() == 1 ? p[fields[k].first.front() - 'x'] : real(0, 9);
        std::string bytes;
        if (fields[k].second == 8)
          put(bytes, value);
        else
          put(bytes, static_cast<float>(value));
        columns[k] += bytes;
        rows += kind == "ascii" ? fixed(value, 9) + " " : bytes;
      }
      if (kind == "ascii") rows += "\n";
    }
    truth.within = moved ? 1e-4 : 1e-6;
    if (kind != "binary_compressed") return out + rows;
    std::string all, packed;
    for (const std::string& column : columns) all += column;
    for (std::size_t at = 0; at < all.size(); at += 32) {
      const std::string run = all.substr(at, 32);
      packed += static_cast<char>(run.size() - 1) + run;
    }
    put(out, static_cast<std::uint32_t>(packed.size())), put(out, static_cast<std::uint32_t>(all.size()));
    return out + packed;
  }

  // Lines with other columns before and behind, titles in any order, commas or points.
  std::string text(Truth& truth) {
    truth.metric = false;
    const bool comma = chance(3), titles = chance(2);
    const std::string between =
        comma ? one_of<std::string>({";", " ", "\t", "; "}) : one_of<std::string>({" ", ",", ";", "\t", ", ", "   "});
    std::vector<std::string> columns{"x", "y", "z"};
    if (titles) {
      if (chance(2)) columns.emplace_back("intensity");
      if (chance(2)) columns.emplace_back("Red");
      std::shuffle(columns.begin(), columns.end(), random_);
    } else {
      const int front = whole(0, 3);
      if (front == 1) columns.insert(columns.begin(), "no");
      if (front == 2) columns.insert(columns.begin(), "intensity");
      if (front == 3 && between != ",") columns.insert(columns.begin(), "name");
      if (chance(2)) columns.emplace_back("Red");
    }
    const std::vector<std::vector<std::string>> names{{"X", "Y", "Z"},
                                                      {"Easting", "Northing", "Elevation"},
                                                      {"Rechtswert", "Hochwert", "H\xC3\xB6he"},
                                                      {"east", "north", "h"}};
    const auto& named = one_of(names);
    const int digits = whole(2, 5);
    const std::string end = chance(3) ? "\r\n" : "\n";
    std::string out;
    const auto line = [&](auto&& word) {
      for (std::size_t k = 0; k < columns.size(); ++k) out += (k > 0 ? between : "") + word(columns[k]);
      out += end;
    };
    if (chance(4)) out += "# made at random" + end;
    if (chance(4)) out += std::to_string(points_.size()) + end;
    if (titles) {
      if (chance(3)) out += one_of<std::string>({"//", "# "});
      line([&](const std::string& c) { return c.size() == 1 ? named[static_cast<std::size_t>(c[0] - 'x')] : c; });
    }
    for (std::size_t k = 0; k < points_.size(); ++k) {
      Vector3d read;
      line([&](const std::string& c) -> std::string {
        if (c == "no") return std::to_string(k + 1);
        if (c == "name") return "P" + std::to_string(k);
        if (c.size() > 1) return std::to_string(whole(0, 255));
        std::string number = fixed(points_[k][c[0] - 'x'], digits);
        read[c[0] - 'x'] = std::strtod(number.c_str(), nullptr);
        if (comma) number[number.find('.')] = ',';
        return number;
      });
      truth.points.push_back(read);
    }
    // Groups of three behind commas might be thousands if nothing else tells.
    truth.may_ask = comma && digits == 3;
    return out;
  }

  // Scans with their poses in the matrix, or before it alone.
  std::string ptx(Truth& truth) {
    std::string out;
    const int scans = whole(1, 3);
    const bool before = chance(3);
    for (int s = 0; s < scans; ++s) {
      const Vector3d head = origin_ + Vector3d(real(0, 9), real(0, 9), 1.6);
      const Eigen::Matrix3d turned = turn().toRotationMatrix();
      const int columns = whole(6, 20), rows = whole(6, 20);
      out += std::to_string(columns) + "\n" + std::to_string(rows) + "\n";
      const auto row = [&](const Vector3d& v, const char* last = "") {
        out += fixed(v.x(), 12) + " " + fixed(v.y(), 12) + " " + fixed(v.z(), 12) + last + "\n";
      };
      row(head), row(turned.col(0)), row(turned.col(1)), row(turned.col(2));
      for (int k = 0; k < 3; ++k) row(before ? Vector3d(Vector3d::Unit(k)) : Vector3d(turned.col(k)), " 0");
      row(before ? Vector3d(Vector3d::Zero()) : head, " 1");
      const bool colours = chance(2);
      for (int c = 0; c < columns; ++c)
        for (int r = 0; r < rows; ++r) {
          const double a = 0.3 * c, e = 0.1 * r - 0.8, range = real(2, 6);
          const bool none = chance(9);
          const Vector3d p =
              none ? Vector3d(Vector3d::Zero())
                   : Vector3d(range * Vector3d(std::cos(a) * std::cos(e), std::sin(a) * std::cos(e), std::sin(e)));
          row(p, colours ? " 0.5 10 20 30" : " 0.5");
          if (!none) truth.points.push_back(turned * p + head);
        }
      truth.heads.push_back(head);
    }
    truth.within = 1e-5;
    return out;
  }

  // Cartesian, spherical, or both with a state each; floats, scaled integers and others between them.
  void e57(const std::filesystem::path& file, Truth& truth) {
    const int scans = whole(1, 3);
    std::vector<E57TestScan> all;
    for (int s = 0; s < scans; ++s) {
      const Vector3d head = origin_ + Vector3d(real(0, 9), real(0, 9), 1.6 + s);
      const Eigen::Quaterniond turned = turn();
      const auto element = [](const char* name, double value) {
        return "<" + std::string(name) + " type=\"Float\">" + fixed(value, 15) + "</" + name + ">";
      };
      E57TestScan scan{.head = "<pose type=\"Structure\"><rotation type=\"Structure\">" + element("w", turned.w()) +
                               element("x", turned.x()) + element("y", turned.y()) + element("z", turned.z()) +
                               "</rotation><translation type=\"Structure\">" + element("x", head.x()) +
                               element("y", head.y()) + element("z", head.z()) + "</translation></pose>",
                       .prototype = {}};
      const int kind = whole(0, 2);  // cartesian, spherical, both
      const int type = whole(0, 2);  // double, single, scaled integer
      const int count = whole(20, 200);
      struct Field {
        std::string name;
        std::vector<double> values = {};
        int type = 0;  // 3: an integer
      };
      std::vector<Field> fields;
      if (kind != 1)
        for (const char* name : {"cartesianX", "cartesianY", "cartesianZ"}) fields.push_back({name, {}, type});
      if (kind != 0)
        for (const char* name : {"sphericalRange", "sphericalAzimuth", "sphericalElevation"})
          fields.push_back({name, {}, type == 1 ? 1 : 0});
      if (kind == 2 || chance(2)) {
        if (kind != 1) fields.push_back({"cartesianInvalidState", {}, 3});
        if (kind != 0) fields.push_back({"sphericalInvalidState", {}, 3});
      }
      if (chance(2)) fields.push_back({"rowIndex", {}, 3}), fields.push_back({"columnIndex", {}, 3});
      if (chance(2)) fields.push_back({"intensity", {}, 1});
      std::shuffle(fields.begin(), fields.end(), random_);
      constexpr double kScale = 0.0005;
      for (int k = 0; k < count; ++k) {
        const double range = real(1, 9), a = real(-3, 3), e = real(-1, 1);
        Vector3d p = range * Vector3d(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
        if (type == 2 && kind == 0) p = (p / kScale).array().round() * kScale;
        const bool stated = std::ranges::any_of(fields, [](const Field& f) { return f.name.ends_with("State"); });
        // Which of them hold the point; neither: there was no return.
        const bool none = stated && chance(8), by_sphere = kind == 1 || (kind == 2 && chance(2));
        const bool zero = !stated && chance(12);
        for (Field& f : fields) {
          double value = 0;
          const bool cartesian = f.name.starts_with("cartesian"), state = f.name.ends_with("State");
          if (state)
            value = none || cartesian == by_sphere ? whole(1, 2) : 0;
          else if (f.name == "rowIndex")
            value = 5 + k % 7;
          else if (f.name == "columnIndex")
            value = 100 + k / 7;
          else if (cartesian)
            value = kind == 2 && by_sphere ? 7 : p[f.name.back() - 'X'];
          else if (f.name.starts_with("spherical"))
            value = kind == 2 && !by_sphere        ? 0.5
                    : f.name == "sphericalRange"   ? range
                    : f.name == "sphericalAzimuth" ? a
                                                   : e;
          if (zero && !state && f.type != 3) value = 0;
          f.values.push_back(value);
        }
        if (!none && !zero) truth.points.push_back(turned * p + head);
      }
      std::vector<std::string> streams;
      for (const Field& f : fields) {
        std::string bytes;
        if (f.type == 3) {
          const bool state = f.name.ends_with("State");
          const int low = state ? 0 : whole(0, 5), high = state ? 2 : 1000;
          std::vector<std::uint64_t> values;
          for (const double v : f.values) values.push_back(static_cast<std::uint64_t>(static_cast<int>(v) - low));
          bytes = packed_bits(values, static_cast<unsigned>(std::bit_width(static_cast<unsigned>(high - low))));
          scan.prototype += "<" + f.name + " type=\"Integer\" minimum=\"" + std::to_string(low) + "\" maximum=\"" +
                            std::to_string(high) + "\"/>";
        } else if (f.type == 2) {
          std::vector<std::uint64_t> values;
          constexpr int kMost = 30'000;
          for (const double v : f.values) values.push_back(static_cast<std::uint64_t>(std::lround(v / kScale) + kMost));
          bytes = packed_bits(values, static_cast<unsigned>(std::bit_width(2U * kMost)));
          scan.prototype +=
              "<" + f.name + " type=\"ScaledInteger\" minimum=\"-30000\" maximum=\"30000\" scale=\"0.0005\"/>";
        } else {
          for (const double v : f.values) {
            if (f.type == 1)
              put(bytes, static_cast<float>(v));
            else
              put(bytes, v);
          }
          scan.prototype += "<" + f.name + " type=\"Float\"" + (f.type == 1 ? " precision=\"single\"" : "") + "/>";
        }
        streams.push_back(bytes);
      }
      scan.count = static_cast<std::uint64_t>(count);
      scan.packets = {streams};
      all.push_back(scan);
      truth.heads.push_back(head);
      truth.within = std::max(truth.within, type == 1 ? 1e-5 : type == 2 ? 1e-3 : 1e-6);
    }
    write_e57(file, all);
  }

  std::mt19937_64 random_;
  std::filesystem::path folder_;
  Vector3d origin_ = Vector3d::Zero();
  std::vector<Vector3d> points_;
};

void expect_truth(std::uint64_t seed, const std::string& format, const std::filesystem::path& folder) {
  SCOPED_TRACE(format + " of seed " + std::to_string(seed));
  Truth truth;
  const auto file = Maker(seed, folder).make(format, truth);
  try {
    const auto source = importer::open_source({file}, format);
    EXPECT_EQ(source->metric(), truth.metric);
    const auto points = points_of(*source);
    ASSERT_EQ(points.size(), truth.points.size());
    double worst = 0;
    for (std::size_t k = 0; k < points.size(); ++k)
      worst = std::max(worst, (points[k].position - truth.points[k]).norm());
    EXPECT_LE(worst, truth.within);
    for (std::size_t k = 0; k < truth.heads.size(); ++k) {
      ASSERT_LT(k, source->scans().size());
      EXPECT_TRUE(source->scans()[k].posed);
      EXPECT_LE((source->scans()[k].position - truth.heads[k]).norm(), 1e-6);
    }
  } catch (const importer::Refused& why) {
    EXPECT_TRUE(truth.may_ask && std::string(why.what()).find("its first lines are") != std::string::npos)
        << why.what();
  }
}

TEST(RandomClouds, AreReadAsTheyWereMeant) {
  const TemporaryFolder folder;
  unsigned long long first = 1, last = 20;
  if (const char* seeds = std::getenv("VANTAGE_SEEDS")) {
    ASSERT_EQ(std::sscanf(seeds, "%llu..%llu", &first, &last), 2) << "VANTAGE_SEEDS must be first..last: " << seeds;
  }
  for (std::uint64_t seed = first; seed <= last; ++seed)
    for (const char* format : {"las", "ply", "pcd", "xyz", "e57"}) expect_truth(seed, format, folder.path());
}

}  // namespace
}  // namespace vantage::test
