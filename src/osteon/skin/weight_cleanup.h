// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "osteon/geometry/cleanup.h"
#include "osteon/geometry/neighbourhoods.h"
#include "osteon/geometry/working_mesh.h"
#include "osteon/rig/skin_weights.h"

// From raw weights of a network or a distance to weights without holes. All matrices are (V,J): a row per vertex of the working mesh.
namespace osteon::skin {

// Each row becomes the mean of its neighbours' rows and its own. (RigNet's code leaves the own row out: parts of few vertices lose their
// weight, and lone vertices have none; facts, trap R8.)
Matrix smooth_rows(const Matrix& weights, const geometry::Neighbourhoods& one_ring);

// Sets what is below `share` of the row's largest entry to 0, and all but the `most` largest entries (ties: the smaller column stays); then
// scales rows with anything positive in them to the sum 1. Entries that are negative or not finite become 0.
void prune_rows(Matrix& weights, float share, std::size_t most);

// Gives each row without any positive entry the row of the nearest vertex that has one: along edges (fewest steps; ties: smaller vertex
// index) within its component, by straight distance for components without any. Returns the number of rows filled. Nothing changes when
// all rows are empty.
std::size_t fill_empty_rows(Matrix& weights, const PerVertex<Vec3f>& positions, const geometry::Neighbourhoods& one_ring);

// Weights of the original's vertices: rows blended at the points where they lie on the working mesh, at most `max_influences` kept.
// Column = JointId. Pre: no row of `weights` is empty.
SkinWeights weights_on_original(const Matrix& weights, const PerVertex<geometry::SurfacePoint>& places, std::size_t max_influences);

// The same weights without creases. On a mesh finer than the working mesh, cutting to the few largest leaves a step of one edge's width
// where one joint gives way to another. Eight rounds of diffusion along edges make it a ramp of about 0.008 (longest side 1), and cut again
// after each; edges longer than that carry nothing, so coarser meshes keep their weights to the bit. Weights below a hundredth of a
// vertex's largest go. `weights` are of the mesh that `clean` was made from. Pre: rows have 1 to max_influences influences,
// and vertices that became one in `clean` have the same row, as weights_on_original() gives them.
SkinWeights evened(const SkinWeights& weights, const geometry::CleanMesh& clean, std::size_t max_influences);

}  // namespace osteon::skin
