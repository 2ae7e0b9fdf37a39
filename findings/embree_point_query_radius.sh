#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Embree 3.13.5 (Debian 12), rtcPointQuery: does a ball of 0.5 m find triangles 0.3 m away in an instance whose transform
# scales by 0.1 or 0.001? Its callback is told a similarityScale, so similarities are foreseen.
# Guess before it was run: yes, for every similarity.
# Seen: with scale 1 and 10 it finds them. With 0.1 and 0.001 the callback is not called once, since the radius stays
# that of the outer scene while the point is moved into the instance. With 0.001 and a rotation rounding hides that the
# transform is a similarity, and it finds them again.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq libembree3-3=3.13.5+dfsg-2 libembree-dev=3.13.5+dfsg-2 libtbb12 >/dev/null
for package in *.deb; do dpkg-deb -x "$package" .; done
cat >query.cpp <<'CODE'
#include <embree3/rtcore.h>

#include <cmath>
#include <cstdio>
#include <initializer_list>

static int calls;
static bool count(RTCPointQueryFunctionArguments*) { return ++calls, false; }

// Calls for a ball around a point 0.3 below the first of 64 sheets, each of which is 1 cm above the other.
static int found(float scale, float angle) {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene mesh = rtcNewScene(device), top = rtcNewScene(device);
  RTCGeometry sheets = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* points = static_cast<float*>(
      rtcSetNewGeometryBuffer(sheets, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 3 * 64));
  auto* corners = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(sheets, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, 64));
  for (unsigned k = 0; k < 64; ++k) {
    const float z = static_cast<float>(k), sheet[9] = {0, 0, z, 1, 0, z, 0, 1, z};
    for (unsigned i = 0; i < 9; ++i) points[9 * k + i] = sheet[i] * 0.01f / scale;
    for (unsigned i = 0; i < 3; ++i) corners[3 * k + i] = 3 * k + i;
  }
  rtcCommitGeometry(sheets);
  rtcAttachGeometry(mesh, sheets);
  rtcCommitScene(mesh);
  RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(instance, mesh);
  const float c = std::cos(angle) * scale, s = std::sin(angle) * scale;
  const float transform[12] = {c, s, 0, -s, c, 0, 0, 0, scale, 0, 0, 0};
  rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, transform);
  rtcCommitGeometry(instance);
  rtcAttachGeometry(top, instance);
  rtcCommitScene(top);
  RTCPointQuery ball{};
  ball.z = -0.3f, ball.radius = 0.5f;
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  calls = 0;
  rtcPointQuery(top, &ball, &context, count, nullptr);
  return calls;
}

int main() {
  bool as_seen = true;
  for (const float scale : {1.f, 10.f, 0.1f, 0.001f}) {
    const int calls = found(scale, 0);
    std::printf("scale %g: %d calls, for 21 sheets within the ball\n", scale, calls);
    as_seen = as_seen && (scale < 1 ? calls == 0 : calls >= 20);
  }
  const int turned = found(0.001f, 0.3f);
  std::printf("scale 0.001, turned by 0.3: %d calls\n", turned);
  return as_seen && turned >= 20 ? 0 : 1;
}
CODE
library=$(dirname "$(find . -name 'libembree3.so.3' | head -1)")
g++ -std=c++17 -O1 -I usr/include query.cpp -o query -L "$library" -l:libembree3.so.3 -Wl,-rpath,"$PWD/$library"
echo "Embree 3.13.5+dfsg-2"
./query
