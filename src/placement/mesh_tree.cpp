// SPDX-License-Identifier: Apache-2.0
#include "placement/mesh_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/embree.hpp"
#include "core/parallel.hpp"
#include "scene/positions.hpp"
#include "scene/scene_tree.hpp"
#include "scene/winding.hpp"

namespace vantage {
namespace {

// Corners of triangles that Embree names, for queries.
struct Triangles {
  const SceneData& scene;
  const SceneTree* tree;
  std::uint32_t number(unsigned instance, unsigned primitive) const { return tree->number(instance, primitive); }
  std::array<glm::dvec3, 3> corners(std::uint32_t triangle) const { return corners_of(scene, triangle); }
};

// A search in a ball around a point, which finds triangles one after the other. Embree 3.13 does not scale the ball's
// radius when it enters a scaled instance. The boxes of shared meshes are therefore a geometry of their own, and their
// meshes are searched from here, each with a ball in its own frame.
struct Search {
  Triangles triangles;
  glm::dvec3 centre;
  double radius;                                  // what remains of it
  bool (*take)(Search&, std::uint32_t triangle);  // returns whether it made the radius smaller

  unsigned instance = RTC_INVALID_GEOMETRY_ID;  // the mesh that is being searched
  glm::dvec3 centre_in_mesh{};
  double mesh_per_local = 1;  // largest factor of lengths

  // Covers the rounding of centre and radius to float, and of the corners of shared meshes.
  double local_radius() const {
    const double reach = std::max({std::abs(centre.x), std::abs(centre.y), std::abs(centre.z)});
    return (radius + (triangles.scene.shares() ? 32 : 4) * reach * 0x1p-23) * (1 + 0x1p-20);
  }
  // Returns the ball in the current frame; empty once nothing nearer matters.
  RTCPointQuery ball() const {
    const bool own = instance == RTC_INVALID_GEOMETRY_ID;
    const glm::dvec3& at = own ? centre : centre_in_mesh;
    const double reach = std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)});
    RTCPointQuery ball{};
    ball.x = static_cast<float>(at.x);
    ball.y = static_cast<float>(at.y);
    ball.z = static_cast<float>(at.z);
    if (radius > 0)
      ball.radius = static_cast<float>(own ? local_radius()
                                           : (local_radius() * mesh_per_local + 4 * reach * 0x1p-23) * (1 + 0x1p-20));
    return ball;
  }

  void run(RTCScene scene);
  bool enter(unsigned number);
};

bool visit(RTCPointQueryFunctionArguments* arguments) {
  Search& search = *static_cast<Search*>(arguments->userPtr);
  const bool box = search.instance == RTC_INVALID_GEOMETRY_ID && search.triangles.tree->is_box(arguments->geomID);
  if (!(box ? search.enter(arguments->primID)
            : search.take(search, search.triangles.number(search.instance, arguments->primID))))
    return false;
  arguments->query->radius = search.ball().radius;
  return true;
}

void Search::run(RTCScene scene) {
  RTCPointQuery query = ball();
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene, &query, &context, visit, this);
}

// Searches the shared mesh of an instance; returns true if the radius shrank.
bool Search::enter(unsigned number) {
  const SceneData& scene = triangles.scene;
  const MeshPlace& place = scene.places[scene.instances[number].place];
  const glm::dmat3 local_from_mesh(to_glm(place.x), to_glm(place.y), to_glm(place.z));
  const glm::dmat3 inverse = glm::inverse(local_from_mesh);
  // Norm of the inverse, exact if the columns are at right angles; not finite if the place flattens space.
  const auto right = [&](int i, int j) {
    const glm::dvec3 &a = local_from_mesh[i], &b = local_from_mesh[j];
    return std::abs(dot(a, b)) <= 1e-9 * length(a) * length(b);
  };
  const double shortest =
      std::min({length(local_from_mesh[0]), length(local_from_mesh[1]), length(local_from_mesh[2])});
  const double norm =
      right(0, 1) && right(1, 2) && right(2, 0)
          ? 1 / shortest
          : std::sqrt(dot(inverse[0], inverse[0]) + dot(inverse[1], inverse[1]) + dot(inverse[2], inverse[2]));
  const double before = radius;
  instance = number;
  mesh_per_local = std::isfinite(norm) ? norm : std::numeric_limits<double>::infinity();
  centre_in_mesh = std::isfinite(norm) ? inverse * (centre + to_glm(scene.origin - place.origin)) : glm::dvec3(0);
  run(triangles.tree->mesh(number));
  instance = RTC_INVALID_GEOMETRY_ID;
  return radius < before;
}

struct Query : Search {
  double best;                 // nearest so far
  double good_enough;          // a hit this near ends the search
  std::uint32_t triangle = 0;  // that of `best`
};

bool take_nearest(Search& search, std::uint32_t number) {
  Query& query = static_cast<Query&>(search);
  const auto [a, b, c] = query.triangles.corners(number);
  const double distance = distance_to_triangle(query.centre, a, b, c);
  if (!(distance < query.best)) return false;
  query.best = distance;
  query.triangle = number;
  query.radius = distance < query.good_enough ? 0 : distance;
  return true;
}

struct SegmentQuery : Search {
  glm::dvec3 a, b;
  double limit;
  bool found = false;
};

bool take_near_segment(Search& search, std::uint32_t number) {
  SegmentQuery& query = static_cast<SegmentQuery&>(search);
  const auto [a, b, c] = query.triangles.corners(number);
  if (query.found || !(distance_to_triangle(query.a, query.b, a, b, c) < query.limit)) return false;
  query.found = true;
  query.radius = 0;
  return true;
}

// Nearest triangle of a ray. Embree proposes hits; its own distance depends on the processor's maker, and its choice
// among equally distant triangles on the order of visits.
struct Nearest {
  embree::Context rtc;  // first member: Embree passes its address to the filter
  Triangles triangles;
  glm::dvec3 point, way;
  double distance = std::numeric_limits<double>::infinity();
  std::optional<std::uint32_t> triangle = std::nullopt;
};

void keep_nearest(const RTCFilterFunctionNArguments* arguments) {
  constexpr float kBeyond = 1 + 0x1p-8f;  // how far beyond the hit Embree continues
  Nearest& nearest = *reinterpret_cast<Nearest*>(arguments->context);
  const std::uint32_t proposed = nearest.triangles.number(RTCHitN_instID(arguments->hit, arguments->N, 0, 0),
                                                          RTCHitN_primID(arguments->hit, arguments->N, 0));
  const auto [a, b, c] = nearest.triangles.corners(proposed);
  const glm::dvec3 normal = cross(b - a, c - a);
  const double distance = dot(normal, a - nearest.point) / dot(normal, nearest.way);
  if (distance < nearest.distance ||
      (nearest.triangle && distance == nearest.distance && proposed < *nearest.triangle)) {
    nearest.distance = distance;
    nearest.triangle = proposed;
    RTCRayN_tfar(arguments->ray, arguments->N, 0) = static_cast<float>(distance) * kBeyond;
  } else {
    arguments->valid[0] = 0;
  }
}

RTCRay ray_of(const glm::dvec3& point, const glm::dvec3& way, double from, double to) {
  RTCRay ray{};
  ray.org_x = static_cast<float>(point.x);
  ray.org_y = static_cast<float>(point.y);
  ray.org_z = static_cast<float>(point.z);
  ray.dir_x = static_cast<float>(way.x);
  ray.dir_y = static_cast<float>(way.y);
  ray.dir_z = static_cast<float>(way.z);
  ray.tnear = static_cast<float>(from);
  ray.tfar = static_cast<float>(to);
  ray.mask = ~0u;
  return ray;
}

double squared(const glm::dvec3& v) { return dot(v, v); }

// Returns the squared distance of two closed segments (Ericson, Real-Time Collision Detection, 2005, section 5.1.9).
double squared_between_segments(const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 u = q - p, v = b - a, w = p - a;
  const double uu = squared(u), vv = squared(v), uv = dot(u, v), uw = dot(u, w), vw = dot(v, w);
  const double denominator = uu * vv - uv * uv;
  double s = denominator > 0 ? std::clamp((uv * vw - uw * vv) / denominator, 0.0, 1.0) : 0.0;
  double t = vv > 0 ? (uv * s + vw) / vv : 0.0;
  if (t < 0 || t > 1 || !(vv > 0)) {
    t = std::clamp(t, 0.0, 1.0);
    s = uu > 0 ? std::clamp((uv * t - uw) / uu, 0.0, 1.0) : 0.0;
  }
  return squared(w + u * s - v * t);
}

double squared_to_segment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 edge = b - a;
  const double length = squared(edge);
  const double x = length > 0 ? std::clamp(dot(p - a, edge) / length, 0.0, 1.0) : 0.0;
  return squared(p - (a + edge * x));
}

// Returns only the scene's triangles.
SceneData geometry_of(const SceneData& scene) {
  SceneData geometry;
  geometry.origin = scene.origin;
  geometry.positions = scene.positions;
  geometry.triangles = scene.triangles;
  geometry.places = scene.places;
  geometry.ranges = scene.ranges;
  geometry.set_instances(scene.instances);
  return geometry;
}

}  // namespace

double distance_to_triangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 normal = cross(b - a, c - a);
  const double area = squared(normal);
  // The plane is nearest over the triangle's inside; elsewhere the outline is.
  if (area > 0 && dot(cross(b - a, p - a), normal) >= 0 && dot(cross(c - b, p - b), normal) >= 0 &&
      dot(cross(a - c, p - c), normal) >= 0)
    return std::abs(dot(p - a, normal)) / std::sqrt(area);
  return std::sqrt(std::min({squared_to_segment(p, a, b), squared_to_segment(p, b, c), squared_to_segment(p, c, a)}));
}

double distance_to_triangle(const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& a, const glm::dvec3& b,
                            const glm::dvec3& c) {
  const glm::dvec3 normal = cross(b - a, c - a);
  const double from = dot(p - a, normal), to = dot(q - a, normal);
  if ((from <= 0) != (to <= 0)) {  // the segment crosses the plane; within the triangle?
    const glm::dvec3 x = p + (q - p) * (from / (from - to));
    if (dot(cross(b - a, x - a), normal) >= 0 && dot(cross(c - b, x - b), normal) >= 0 &&
        dot(cross(a - c, x - c), normal) >= 0)
      return 0;
  }
  const double outline = std::sqrt(std::min({squared_between_segments(p, q, a, b), squared_between_segments(p, q, b, c),
                                             squared_between_segments(p, q, c, a)}));
  return std::min({outline, distance_to_triangle(p, a, b, c), distance_to_triangle(q, a, b, c)});
}

namespace {

// Marks meshes whose winding tells nothing: all meshes, if so in the whole scene, as a few faces may agree by chance.
std::vector<std::uint8_t> wound_either_way_in(const SceneData& scene) {
  std::vector<Winding> windings(scene.ranges.size());
  parallel::for_all(std::size_t{0}, windings.size(), [&](std::size_t m) {
    const MeshRange& range = scene.ranges[m];
    windings[m] =
        winding_of(range.triangle_count, [&](std::uint32_t k) { return scene.corners(range.first_triangle + k); });
  });
  Winding all;
  for (const Winding& one : windings) all += one;
  std::vector<std::uint8_t> found(windings.size());
  for (std::size_t m = 0; m < found.size(); ++m) found[m] = all.either_way() || windings[m].either_way();
  return found;
}

}  // namespace

struct MeshTree::Impl {
  SceneData scene;
  std::vector<std::uint8_t> either_way;  // by mesh
  embree::Device device = embree::new_device();
  SceneTree tree;
  Triangles triangles{scene, &tree};

  Impl(const SceneData& whole, std::uint32_t used)
      : scene(geometry_of(whole)),
        either_way(wound_either_way_in(whole)),
        tree(device.get(), scene, 0, used, {.intersect = keep_nearest}, "for distances") {}

  Nearest first_hit(const glm::dvec3& point, const glm::dvec3& way) const;
  bool occluded(RTCRay ray) const;

  Query nearest(const glm::dvec3& point, double limit, double good_enough) const {
    Query query{{triangles, point, limit, take_nearest}, limit, good_enough};
    query.run(tree.for_points());
    return query;
  }
};

Nearest MeshTree::Impl::first_hit(const glm::dvec3& point, const glm::dvec3& way) const {
  RTCRayHit hit{};
  hit.ray = ray_of(point, way, 0, std::numeric_limits<double>::infinity());
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  Nearest nearest{.rtc = {}, .triangles = triangles, .point = point, .way = way};
  embree::intersect(tree.get(), nearest.rtc, hit);
  return nearest;
}

MeshTree::MeshTree(const SceneData& scene, std::uint32_t triangles) : impl_(std::make_unique<Impl>(scene, triangles)) {}
MeshTree::~MeshTree() = default;
MeshTree::MeshTree(MeshTree&&) noexcept = default;
MeshTree& MeshTree::operator=(MeshTree&&) noexcept = default;

double MeshTree::distance(const glm::dvec3& point, double limit) const { return impl_->nearest(point, limit, 0).best; }

std::optional<MeshTree::Hit> MeshTree::nearest(const glm::dvec3& point, double limit) const {
  const Query found = impl_->nearest(point, limit, 0);
  if (!(found.best < limit)) return std::nullopt;
  return Hit{found.best, found.triangle};
}

std::optional<MeshTree::Hit> MeshTree::first(const glm::dvec3& point, const glm::dvec3& way) const {
  const Nearest nearest = impl_->first_hit(point, way);
  if (!nearest.triangle) return std::nullopt;
  return Hit{nearest.distance, *nearest.triangle};
}

bool MeshTree::within(const glm::dvec3& point, double radius) const {
  return impl_->nearest(point, radius, radius).best < radius;
}

bool MeshTree::within_of_segment(const glm::dvec3& a, const glm::dvec3& b, double radius) const {
  SegmentQuery query{{impl_->triangles, (a + b) * 0.5, radius + 0.5 * length(b - a), take_near_segment}, a, b, radius};
  query.run(impl_->tree.for_points());
  return query.found;
}

std::optional<double> MeshTree::drop(const glm::dvec3& point) const {
  const Nearest nearest = impl_->first_hit(point, {0, 0, -1});
  if (!nearest.triangle) return std::nullopt;
  return nearest.distance;
}

bool MeshTree::Impl::occluded(RTCRay ray) const {
#if VANTAGE_EMBREE_MAJOR >= 4
  rtcOccluded1(tree.get(), &ray);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(tree.get(), &context, &ray);
#endif
  return ray.tfar < 0;
}

bool MeshTree::covered(const glm::dvec3& point, double from, double to) const {
  return impl_->occluded(ray_of(point, {0, 0, 1}, from, to));
}

bool MeshTree::between(const glm::dvec3& a, const glm::dvec3& b) const {
  return impl_->occluded(ray_of(a, b - a, 0, 1));
}

bool MeshTree::inside_solid(const glm::dvec3& point) const {
  int fronts = 0;
  for (const glm::dvec3& way :
       {glm::dvec3{0, 0, 1}, glm::dvec3{1, 0, 0}, glm::dvec3{-1, 0, 0}, glm::dvec3{0, 1, 0}, glm::dvec3{0, -1, 0}}) {
    const auto hit = impl_->first_hit(point, way).triangle;
    if (!hit) return false;
    const auto [a, b, c] = impl_->triangles.corners(*hit);
    const glm::dvec3 normal = cross(b - a, c - a);
    const bool back = dot(normal, way) > 0 && !wound_either_way(impl_->scene.mesh_of(*hit));
    if (!back && ++fronts > 1) return false;
  }
  return true;
}

bool MeshTree::wound_either_way(std::uint32_t mesh) const {
  return mesh < impl_->either_way.size() && impl_->either_way[mesh];
}

}  // namespace vantage
