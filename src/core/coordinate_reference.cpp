// SPDX-License-Identifier: Apache-2.0
#include "core/coordinate_reference.hpp"

#include <proj.h>
#include <proj_experimental.h>

#include <cmath>
#include <memory>

namespace vantage {
namespace {

using Kind = CoordinateReference::Kind;
using Axis = CoordinateReference::Axis;

struct DestroyProj {
  void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
  void operator()(PJ* object) const { proj_destroy(object); }
};
using Context = std::unique_ptr<PJ_CONTEXT, DestroyProj>;
using Object = std::unique_ptr<PJ, DestroyProj>;

Context quiet_context() {
  Context context(proj_context_create());
  proj_context_set_enable_network(context.get(), 0);
  proj_log_level(context.get(), PJ_LOG_NONE);
  return context;
}

// Reads the parts of one system.
class Reference {
 public:
  Reference(PJ_CONTEXT* context, const PJ* whole) : context_(context) { split(whole); }

  std::optional<CoordinateReference> read() {
    CoordinateReference out;
    if (!plan_) {
      if (!height_) return {};
      out.name = name_of(height_.get());  // heights alone
      return out;
    }
    out.kind = kind_of(plan_.get());
    out.name = name_of(plan_.get());
    if (!read_axes(plan_.get(), out)) return {};
    // Version 1 of the text has no third axis of a projection.
    if (out.height && out.kind == Kind::projected) {
      PJ* flat = proj_crs_demote_to_2D(context_, nullptr, plan_.get());
      if (flat) plan_.reset(flat);
    }
    if (height_) {
      CoordinateReference upright;
      if (!read_axes(height_.get(), upright)) return {};
      out.height = upright.first;
    }
    take_registered_axes(out);
    out.text = text_of(joined(plan_.get(), height_.get()).get());
    if (out.has_lengths()) out.in_metres = in_metres(out);
    return out;
  }

 private:
  // Finds the systems of plan and height inside systems that wrap or join others.
  void split(const PJ* system) {
    const PJ_TYPE type = proj_get_type(system);
    if (type == PJ_TYPE_BOUND_CRS) {
      const Object source(proj_get_source_crs(context_, system));
      if (source) split(source.get());
    } else if (type == PJ_TYPE_COMPOUND_CRS) {
      for (int k = 0; k < 2; ++k)
        if (const Object part(proj_crs_get_sub_crs(context_, system, k)); part) split(part.get());
    } else if (type == PJ_TYPE_VERTICAL_CRS) {
      height_.reset(proj_clone(context_, system));
    } else {
      plan_.reset(proj_clone(context_, system));
    }
  }

  static Kind kind_of(const PJ* system) {
    switch (proj_get_type(system)) {
      case PJ_TYPE_PROJECTED_CRS: return Kind::projected;
      case PJ_TYPE_ENGINEERING_CRS: return Kind::local;
      case PJ_TYPE_GEOGRAPHIC_2D_CRS:
      case PJ_TYPE_GEOGRAPHIC_3D_CRS: return Kind::geographic;
      case PJ_TYPE_GEOCENTRIC_CRS: return Kind::geocentric;
      default: return Kind::other;
    }
  }
  static std::string name_of(const PJ* system) {
    const char* name = proj_get_name(system);
    return name ? name : "";
  }

  bool read_axes(const PJ* system, CoordinateReference& out) const {
    const Object axes(proj_crs_get_coordinate_system(context_, system));
    const int count = axes ? proj_cs_get_axis_count(context_, axes.get()) : 0;
    for (int k = 0; k < count && k < 3; ++k) {
      const char *direction = nullptr, *unit = nullptr;
      double factor = 1;
      if (!proj_cs_get_axis_info(context_, axes.get(), k, nullptr, nullptr, &direction, &factor, &unit, nullptr,
                                 nullptr))
        return false;
      const Axis axis{direction ? direction : "", unit ? unit : "", factor};
      if (k == 0) out.first = axis;
      if (k == 1) out.second = axis;
      if (k == 2) out.height = axis;
    }
    return count > 0;
  }

  // Takes axes from the registry, as text of version 1 has no words for some.
  void take_registered_axes(CoordinateReference& out) const {
    const char *authority = proj_get_id_auth_name(plan_.get(), 0), *code = proj_get_id_code(plan_.get(), 0);
    if (!authority || !code || out.kind != Kind::projected) return;
    const Object registered(proj_create_from_database(context_, authority, code, PJ_CATEGORY_CRS, 0, nullptr));
    CoordinateReference known;
    if (registered && proj_get_type(registered.get()) == PJ_TYPE_PROJECTED_CRS && read_axes(registered.get(), known))
      out.first.direction = known.first.direction, out.second.direction = known.second.direction;
  }

  Object joined(PJ* plan, PJ* height) const {
    if (!height) return Object(proj_clone(context_, plan));
    const std::string name = name_of(plan) + " + " + name_of(height);
    return Object(proj_create_compound_crs(context_, name.c_str(), plan, height));
  }

  std::string text_of(const PJ* system) const {
    constexpr const char* kOptions[] = {"MULTILINE=NO", nullptr};
    const char* text = system ? proj_as_wkt(context_, system, PJ_WKT1_GDAL, kOptions) : nullptr;
    return text ? text : "";
  }

  Object with_metres(const PJ* system, bool parameters) const {
    Object altered(proj_crs_alter_cs_linear_unit(context_, system, "metre", 1, "EPSG", "9001"));
    if (altered && parameters)
      altered.reset(proj_crs_alter_parameters_linear_unit(context_, altered.get(), "metre", 1, "EPSG", "9001", 1));
    if (altered) altered.reset(proj_alter_name(context_, altered.get(), (name_of(system) + " in metres").c_str()));
    return altered;
  }

  std::string in_metres(const CoordinateReference& system) const {
    const auto metric = [](const Axis& axis) { return axis.factor == 1; };
    Object plan(proj_clone(context_, plan_.get())), height;
    if (!metric(system.first) || !metric(system.second))
      plan = with_metres(plan_.get(), system.kind == Kind::projected);
    if (!plan) return {};
    if (height_ && system.height->direction == "up")
      height = metric(*system.height) ? Object(proj_clone(context_, height_.get())) : with_metres(height_.get(), false);
    return text_of(joined(plan.get(), height.get()).get());
  }

  PJ_CONTEXT* context_;
  Object plan_, height_;
};

}  // namespace

bool CoordinateReference::has_usual_axes() const {
  const std::string &a = first.direction, &b = second.direction;
  if (kind == Kind::local) return a != "south" && a != "west" && b != "south" && b != "west";
  return (a == "east" && b == "north") || (a == "north" && b == "east") || a == b;
}

std::optional<CoordinateReference> read_coordinate_reference(const std::string& definition) {
  const Context context = quiet_context();
  const Object system(proj_create(context.get(), definition.c_str()));
  if (!system || !proj_is_crs(system.get())) return {};
  return Reference(context.get(), system.get()).read();
}

std::optional<LengthUnit> epsg_length_unit(int code) {
  const Context context = quiet_context();
  const char *name = nullptr, *category = nullptr;
  double metres = 0;
  if (!proj_uom_get_info_from_database(context.get(), "EPSG", std::to_string(code).c_str(), &name, &metres, &category))
    return {};
  if (!name || std::string(category) != "linear" || !(metres > 0)) return {};
  return LengthUnit{name, metres};
}

}  // namespace vantage
