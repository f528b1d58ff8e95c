// SPDX-License-Identifier: Apache-2.0
#include "osteon/synth/objects.h"

#include <cassert>
#include <cmath>
#include <numbers>
#include <vector>

#include "osteon/base/random.h"
#include "osteon/mesh/shapes.h"
#include "osteon/synth/pieces.h"

namespace osteon::synth {
namespace {

constexpr float kTurn = 2.0f * std::numbers::pi_v<float>;

class Builder {
 public:
  explicit Builder(std::uint64_t seed) : random_(seed) {}

  TriangleMesh ball_like() { return stretched(shapes::icosphere(4, 0.5f)); }
  TriangleMesh crate() { return shapes::box(sizes(0.2f, 1.0f)); }

  // A hanging cloth: a sheet in waves.
  TriangleMesh cloth() {
    TriangleMesh mesh = shapes::sheet(30, 30);
    const float depth = some(0.0f, 0.1f), folds = some(1.0f, 4.0f), slant = some(-1.0f, 1.0f);
    for (Vec3f& p : mesh.positions) p.z() = depth * std::sin(kTurn * folds * (p.x() + slant * p.y()));
    return mesh;
  }

  TriangleMesh ring() {
    const float thick = some(0.06f, 0.2f);
    constexpr std::uint32_t around = 48, across = 16;
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < around; ++i)
      for (std::uint32_t k = 0; k < across; ++k) {
        const float a = kTurn * static_cast<float>(i) / around, b = kTurn * static_cast<float>(k) / across;
        const float r = 0.5f + thick * std::cos(b);
        mesh.positions.push_back({r * std::cos(a), thick * std::sin(b), r * std::sin(a)});
      }
    const auto at = [&](std::uint32_t i, std::uint32_t k) { return VertexId{i % around * across + k % across}; };
    for (std::uint32_t i = 0; i < around; ++i)
      for (std::uint32_t k = 0; k < across; ++k) {
        mesh.faces.push_back({at(i, k), at(i, k + 1), at(i + 1, k + 1)});
        mesh.faces.push_back({at(i, k), at(i + 1, k + 1), at(i + 1, k)});
      }
    return mesh;
  }

  // A ball with bumps of three sizes.
  TriangleMesh rock() {
    TriangleMesh mesh = stretched(shapes::icosphere(4, 0.5f));
    for (const float fineness : {3.0f, 7.0f, 15.0f}) {
      const Vec3f way = sizes(-1.5f, 1.5f);
      const float phase = some(0.0f, kTurn), height = 0.5f / fineness;
      for (Vec3f& p : mesh.positions) p *= 1.0f + height * std::sin(fineness * way.dot(p) + phase) * std::cos(fineness * p.y() - phase);
    }
    return mesh;
  }

  // Rods in any direction through one another.
  TriangleMesh rods() {
    const std::size_t count = 3 + random_.below(6);
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3f a = sizes(-0.5f, 0.5f), b = sizes(-0.5f, 0.5f);
      const float r = some(0.02f, 0.07f);
      const Vec3f side = (b - a).unitOrthogonal();
      add(tube({{a, r, r}, {b, r, r}}, 8, side));
    }
    return std::move(mesh_);
  }

  TriangleMesh table() {
    const Vec3f size = sizes({0.5f, 0.3f, 0.4f}, {1.0f, 0.8f, 0.8f});
    legs(size, size.y());
    add(block({0, size.y(), 0}, {size.x(), 0.05f, size.z()}));
    return std::move(mesh_);
  }

  TriangleMesh chair() {
    const Vec3f size = sizes(0.35f, 0.6f);
    legs(size, size.y());
    add(block({0, size.y(), 0}, {size.x(), 0.05f, size.z()}));
    const float back = some(0.3f, 0.6f);
    add(block({0, size.y() + 0.5f * back, -0.5f * size.z()}, {size.x(), back, 0.04f}));
    return std::move(mesh_);
  }

  TriangleMesh vase() {
    std::vector<Ring> rings;
    const float belly = some(0.1f, 0.35f), neck = some(0.05f, 0.2f), place = some(0.2f, 0.8f);
    for (int i = 0; i <= 20; ++i) {
      const float y = static_cast<float>(i) / 20.0f;
      const float r = neck + belly * std::exp(-20.0f * (y - place) * (y - place));
      rings.push_back({{0, y, 0}, r, r});
    }
    return tube(rings, 24, Vec3f::UnitX());
  }

  TriangleMesh house() {
    const Vec3f size = sizes(0.4f, 0.9f);
    add(block({0, 0.5f * size.y(), 0}, size));
    const float roof = some(0.2f, 0.5f);
    add(tube({{{0, size.y(), 0}, 0.55f * size.x(), 0.55f * size.z()}, {{0, size.y() + roof, 0}, 0.02f, 0.5f * size.z()}}, 4));
    add(block({0.25f * size.x(), size.y() + 0.5f * roof, 0}, {0.1f, roof, 0.1f}));
    return std::move(mesh_);
  }

  TriangleMesh stairs() {
    const std::size_t steps = 4 + random_.below(6);
    const float height = some(0.08f, 0.15f), depth = some(0.08f, 0.2f), width = some(0.3f, 0.8f);
    for (std::size_t i = 0; i < steps; ++i) {
      const float top = height * static_cast<float>(i + 1);
      add(block({0, 0.5f * top, depth * static_cast<float>(i)}, {width, top, depth}));
    }
    return std::move(mesh_);
  }

  TriangleMesh shelf() {
    const float width = some(0.4f, 0.9f), height = some(0.6f, 1.2f), depth = some(0.15f, 0.35f);
    for (const float side : {-0.5f, 0.5f}) add(block({side * width, 0.5f * height, 0}, {0.04f, height, depth}));
    const std::size_t boards = 3 + random_.below(4);
    for (std::size_t i = 0; i <= boards; ++i)
      add(block({0, height * static_cast<float>(i) / static_cast<float>(boards), 0}, {width, 0.03f, depth}));
    return std::move(mesh_);
  }

  TriangleMesh wheel() {
    mesh_ = ring();
    const std::size_t spokes = 3 + random_.below(8);
    for (std::size_t i = 0; i < spokes; ++i) {
      const float angle = kTurn * static_cast<float>(i) / static_cast<float>(spokes);
      add(tube({{Vec3f::Zero(), 0.03f, 0.03f}, {0.5f * Vec3f(std::cos(angle), 0, std::sin(angle)), 0.03f, 0.03f}}, 8, Vec3f::UnitY()));
    }
    const Eigen::AngleAxisf upright(0.25f * kTurn, Vec3f::UnitX());
    return shapes::transformed(std::move(mesh_), Transform(upright));
  }

  // Loose triangles anywhere.
  TriangleMesh scraps() {
    for (std::uint32_t i = 0; i < 400; ++i) {
      const Vec3f middle = sizes(-0.5f, 0.5f);
      for (int corner = 0; corner < 3; ++corner) mesh_.positions.push_back(middle + sizes(-0.06f, 0.06f));
      mesh_.faces.push_back({VertexId{3 * i}, VertexId{3 * i + 1}, VertexId{3 * i + 2}});
    }
    return std::move(mesh_);
  }

 private:
  float some(float low, float high) { return random_.uniform(low, high); }
  Vec3f sizes(const Vec3f& low, const Vec3f& high) {
    Vec3f out = low;
    for (int axis = 0; axis < 3; ++axis) out[axis] = some(low[axis], high[axis]);
    return out;
  }
  Vec3f sizes(float low, float high) { return sizes(Vec3f::Constant(low), Vec3f::Constant(high)); }
  TriangleMesh stretched(TriangleMesh mesh) {
    const Vec3f by = sizes(0.5f, 1.0f);
    for (Vec3f& p : mesh.positions) p = p.cwiseProduct(by);
    return mesh;
  }
  void add(const TriangleMesh& part) { mesh_ = shapes::merged(mesh_, part); }
  void legs(const Vec3f& size, float height) {
    const float thick = some(0.03f, 0.08f);
    for (const float x : {-0.45f, 0.45f})
      for (const float z : {-0.45f, 0.45f}) add(block({x * size.x(), 0.5f * height, z * size.z()}, {thick, height, thick}));
  }

  Random random_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh make_object(std::size_t kind, std::uint64_t seed) {
  using Make = TriangleMesh (Builder::*)();
  constexpr std::array<Make, kObjects.size()> make{&Builder::ball_like, &Builder::crate, &Builder::cloth, &Builder::ring,  &Builder::rock,
                                                   &Builder::rods,      &Builder::chair, &Builder::table, &Builder::vase,  &Builder::house,
                                                   &Builder::stairs,    &Builder::shelf, &Builder::wheel, &Builder::scraps};
  assert(kind < kObjects.size());
  Builder builder(seed);
  return (builder.*make[kind])();
}

}  // namespace osteon::synth
