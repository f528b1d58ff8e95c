// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/mesh/triangle_mesh.h"

// Closed-form shapes, for tests and for the procedural characters. All are watertight and face outwards unless noted.
namespace osteon::shapes {

TriangleMesh box(const Vec3f& size);                            // centred at the origin, 8 vertices
TriangleMesh icosphere(int subdivisions, float radius = 1.0f);  // 10 * 4^n + 2 vertices, centred at the origin
// Side of a cylinder with hemispherical caps along +y from (0,0,0) to (0,length,0); length excludes the caps.
TriangleMesh capsule(float radius, float length, int segments = 16, int rings = 8);
TriangleMesh sheet(int columns, int rows);                          // unit square in the plane z = 0, open border
TriangleMesh merged(const TriangleMesh& a, const TriangleMesh& b);  // both, as separate components
TriangleMesh transformed(TriangleMesh mesh, const Transform& transform);
TriangleMesh shifted(TriangleMesh mesh, const Vec3f& by);

}  // namespace osteon::shapes
