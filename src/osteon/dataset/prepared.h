// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "osteon/dataset/articulation.h"
#include "osteon/geometry/bind_features.h"
#include "osteon/geometry/neighbourhoods.h"
#include "osteon/geometry/rignet_features.h"
#include "osteon/geometry/voxel_grid.h"
#include "osteon/geometry/working_mesh.h"
#include "osteon/rig/rig.h"

namespace osteon::dataset {

// Where a character comes from; `group` names characters of one base body, so that sampling can be balanced over groups.
struct CharacterInfo {
  std::string id, group, category;
};

struct PrepareOptions {
  geometry::WorkingMeshOptions working_mesh;
  int nearest_bones = 8;         // bones kept per vertex: the most that skin_inputs() below can be asked for
  float merge_distance = 1e-3f;  // joints nearer than this to their parent or a sibling become one joint; longest side = 1
};

// A rigged character as the RigNet trainer needs it, in the frame of the networks: longest side 1, centred on x and z, feet on y = 0.
// Made by the same geometry functions as the pipeline's inputs, so that training and use cannot drift apart.
struct PreparedCharacter {
  CharacterInfo info;
  std::vector<std::string> notes;  // what was changed or looks odd: merged joints, joints outside the shape, ...

  // Inputs. The last three follow from the mesh alone and are computed again at loading instead of stored.
  TriangleMesh mesh;  // working mesh, normalised; V vertices
  geometry::Normalization normalization;
  geometry::Neighbourhoods one_ring;  // of `mesh`
  geometry::GeodesicBalls balls;      // of `mesh`, radius 0.06
  geometry::VoxelGrid voxels;         // of `mesh`, 88^3

  // Targets.
  Skeleton skeleton;                    // J joints, normalised frame, joints at one place merged; joint 0 is the root
  SkinWeights weights;                  // (V) reference weights on `mesh`, in joints of `skeleton`
  std::vector<std::uint8_t> attention;  // (V) 1 where a ray from a joint, perpendicular to its bones, meets the surface (facts 5.2)
  PerJoint<float> tolerances;           // (J) mean length of these rays: half the local diameter; what counts as found in IoU

  // Poses from real motion, for augmentation alone (motion_poses.h); none where there is no motion for the character.
  std::vector<Articulation> poses;

  // For the skin and the binding network: per vertex the nearest bones of `bones(skeleton)` by volumetric geodesic distance, nearest first.
  // Costly, so loaded characters have none (0 rows) before derive_nearest_bones(); examples_of() calls it where the network reads them.
  geometry::IndexMatrix nearest_bones;  // (V,N) bone index; N = min(B, options.nearest_bones)
  Matrix nearest_distances;             // (V,N)

  std::size_t vertices() const { return mesh.positions.size(); }
  std::size_t joints() const { return skeleton.size(); }
};

// Throws Error when the rig is invalid or has no surface to work on.
PreparedCharacter prepare(const Rig& rig, CharacterInfo info, const PrepareOptions& options = {});

// Which parts of a character, beside its mesh and joints, a network learns from.
// joints: attention too; pairs, tree: of joints; skin, bind: bones and weights; neuro: these as NeuroSkinning reads them (ours, the
// paper's)
enum class Parts { joints, pairs, tree, skin, bind, neuro, neuro_2019 };

// Fills one_ring, balls and voxels from the mesh (prepare() and loading do so).
void derive_inputs(PreparedCharacter& character);

// Fills nearest_bones and nearest_distances from the mesh and the skeleton: the nearest `most` bones, or all where there are fewer.
void derive_nearest_bones(PreparedCharacter& character, int most = PrepareOptions().nearest_bones);

// After the mesh or the joints have changed: everything that follows from them and that `parts` reads. Joints: neighbourhoods and
// attention; pairs: neighbourhoods and voxels; tree: voxels; skin and bind: these and the nearest bones, as many as there were (not none).
void derive_from_shape(PreparedCharacter& character, Parts parts);

// How much each joint moves: the sum of its weights over the vertices.
PerJoint<float> moved_by(const PreparedCharacter& character);

// Brings the mesh and the joints into the frame of the networks again, after the mesh has changed.
void normalise_again(PreparedCharacter& character);

// Inputs of the skin network, (V, 3 + 8k); pre: k <= options.nearest_bones of its preparation.
geometry::SkinInputs skin_inputs(const PreparedCharacter& character, int k = 5);

// Targets of the skin network for bones of those inputs, or of the binding network for `nearest_bones` (facts 7.5).
geometry::SkinTargets skin_targets(const PreparedCharacter& character, const geometry::IndexMatrix& nearest);

// The bones of the skeleton, as the binding network's features read them.
geometry::BoneList bone_list(const Skeleton& skeleton);

// 1 where joints i < j are parent and child, in the order of geometry::pair_features: (0,1), (0,2), ..., (1,2), ... Length J(J-1)/2.
std::vector<std::uint8_t> pair_labels(const Skeleton& skeleton);

// The index of each joint's parent, -1 for the root: (J).
std::vector<int> parent_indices(const Skeleton& skeleton);

}  // namespace osteon::dataset
