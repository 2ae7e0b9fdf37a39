// SPDX-License-Identifier: Apache-2.0
// A triangle of the scene by its number, stored either in place or with a mesh that nodes share. Corners are in stored
// order, which a mirrored place reverses.
#ifndef VANTAGE_LIB_SCENE_TRIANGLE
#define VANTAGE_LIB_SCENE_TRIANGLE
#include "lib/exact.glsl"
#include "lib/parameters.glsl"

layout(constant_id = shared_constant) const bool with_shared = false;

struct StoredTriangle {
  uint number;   // number by which it is stored
  uint surface;  // index into arrays of diffuse coefficients and limits
  uint place;    // of its mesh, or no_place
};

StoredTriangle stored_of(uint triangle) {
  if (!with_shared) return StoredTriangle(triangle, triangle, no_place);
  uint k = parameters.run_at.at[triangle >> run_block_bits];
  while (parameters.runs.at[k + 1u].first_triangle <= triangle) ++k;
  const TriangleRun run = parameters.runs.at[k];
  return StoredTriangle(triangle + run.to_stored, k, run.place);
}

// Returns true if its corners are stored in another order than SceneData::corners() returns.
bool is_mirrored(uint triangle) {
  const uint place = stored_of(triangle).place;
  return place != no_place && parameters.places.at[place].mirrored != 0u;
}

// Returns the indices of its corners' positions and normals.
uvec3 vertices_of(StoredTriangle stored) {
  const uint first = 3u * stored.number;
  return uvec3(parameters.triangles.at[first], parameters.triangles.at[first + 1u],
               parameters.triangles.at[first + 2u]);
}

vec3 turned_from_mesh(vec3 x, vec3 y, vec3 z, vec3 v) {
  precise vec3 a = x * v.x;
  precise vec3 b = y * v.y;
  precise vec3 c = z * v.z;
  precise vec3 ab = a + b;
  precise vec3 abc = ab + c;
  return abc;
}

// Edges from the first corner to the others.
struct Edges {
  vec3 second, third;
};
Edges edges_of(StoredTriangle stored, uvec3 vertices) {
  const vec3 p = parameters.positions.at[vertices.x];
  precise vec3 e = parameters.positions.at[vertices.y] - p;
  precise vec3 f = parameters.positions.at[vertices.z] - p;
  if (!with_shared || stored.place == no_place) return Edges(e, f);
  const MeshTransform place = parameters.places.at[stored.place];
  return Edges(turned_from_mesh(place.x, place.y, place.z, e), turned_from_mesh(place.x, place.y, place.z, f));
}

// Corners relative to a station, and their error in metres for its rays.
struct Corners {
  vec3 a, b, c;
  float doubt;
};
Corners corners_of(uint triangle, vec3 origin) {
  const StoredTriangle stored = stored_of(triangle);
  const uvec3 vertices = vertices_of(stored);
  if (!with_shared || stored.place == no_place) {
    precise vec3 a = parameters.positions.at[vertices.x] - origin;
    precise vec3 b = parameters.positions.at[vertices.y] - origin;
    precise vec3 c = parameters.positions.at[vertices.z] - origin;
    return Corners(a, b, c, 0.0);
  }
  // Edges are placed separately, since a small triangle may be far from the origin of its mesh.
  const MeshTransform place = parameters.places.at[stored.place];
  const Edges edges = edges_of(stored, vertices);
  precise vec3 mesh = place.origin - origin;
  precise vec3 a = turned_from_mesh(place.x, place.y, place.z, parameters.positions.at[vertices.x]) + mesh;
  precise vec3 b = a + edges.second;
  precise vec3 c = a + edges.third;
  return Corners(a, b, c, place.doubt * (place.size + abs(mesh.x) + abs(mesh.y) + abs(mesh.z)));
}

// Returns the triangle across the edge from a corner to the next, or no_primitive.
uint neighbour_of(uint triangle, uint corner) {
  const StoredTriangle stored = stored_of(triangle);
  const uint other = parameters.neighbours.at[3u * stored.number + corner];
  // Within a shared mesh, neighbours have stored numbers.
  if (!with_shared || stored.place == no_place || other == no_primitive) return other;
  return other - stored.number + triangle;
}

#endif
