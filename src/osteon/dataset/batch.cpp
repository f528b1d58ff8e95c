// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/batch.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "osteon/base/parallel.h"
#include "osteon/dataset/fold.h"
#include "osteon/dataset/neuro.h"
#include "osteon/dataset/without_accessories.h"
#include "osteon/geometry/decimate.h"
#include "osteon/geometry/regions.h"
#include "osteon/geometry/symmetry.h"
#include "osteon/geometry/tree_features.h"

namespace osteon::dataset {
namespace {

static_assert(geometry::kTreeJointFeatures == nets::tree_joint_features && geometry::kTreePairFeatures == nets::tree_pair_features);
static_assert(geometry::kVoteFeatures == nets::vote_features);

constexpr std::size_t kLeastJoints = 4;  // no rig is folded to fewer

std::vector<float> plane_distances(const Skeleton& skeleton, const std::optional<Plane>& symmetry) {
  const Plane plane = symmetry.value_or(Plane{Vec3f::UnitX(), 0.0f});
  std::vector<float> distances;
  for (const Vec3f& p : skeleton.rest_positions) distances.push_back(std::abs(plane.signed_distance(p)));
  return distances;
}

// The nearest bones (V,8), one for each joint: -1 where there are no more.
geometry::IndexMatrix bind_choices(const PreparedCharacter& character) {
  geometry::IndexMatrix out = geometry::IndexMatrix::Constant(character.nearest_bones.rows(), geometry::kBindBones, -1);
  for (Eigen::Index v = 0; v < out.rows(); ++v)
    for (Eigen::Index k = 0; k < std::min(out.cols(), character.nearest_bones.cols()); ++k)
      if (std::isfinite(character.nearest_distances(v, k))) out(v, k) = character.nearest_bones(v, k);
  return out;
}

Example example_of(PreparedCharacter character, Parts parts, const std::optional<Plane>& symmetry) {
  Example example;
  example.symmetry = symmetry;
  example.plane_distance = plane_distances(character.skeleton, example.symmetry);
  if ((parts == Parts::skin || parts == Parts::bind) && character.nearest_bones.rows() == 0) derive_nearest_bones(character);
  if (parts == Parts::joints) example.vote_features = geometry::vote_features(character.mesh);
  if (parts == Parts::pairs) {
    example.pair_features = geometry::pair_features(character.skeleton.rest_positions.raw(), character.voxels);
    example.pair_labels = pair_labels(character.skeleton);
  }
  if (parts == Parts::tree) example.inside = geometry::inside_shares(character.skeleton.rest_positions.raw(), character.voxels);
  if (parts == Parts::skin) {
    const geometry::SkinInputs inputs = skin_inputs(character);
    example.skin_features = inputs.features;
    example.skin_targets = skin_targets(character, inputs.nearest);
  }
  if (parts == Parts::bind) {
    example.choices = bind_choices(character);
    example.skin_targets = skin_targets(character, example.choices);
  }
  if (parts == Parts::neuro || parts == Parts::neuro_2019) derive_neuro(example, character, parts);
  example.character = std::move(character);
  return example;
}

// Random bends and proportions, or proportions of one of the character's own poses.
Articulation some_articulation(const Example& example, const ArticulateOptions& options, Random& random) {
  const Skeleton& skeleton = example.character.skeleton;
  const std::vector<Articulation>& poses = example.character.poses;
  const bool from_motion = options.from_motion > 0.0f && !poses.empty() && random.uniform() < options.from_motion;
  if (!from_motion) return random_articulation(skeleton, example.symmetry, options, random);
  ArticulateOptions unbent = options;
  unbent.largest_bend = 0.0f;
  const Articulation& pose = poses[random.below(poses.size())];
  return with_sizes(pose, random_articulation(skeleton, example.symmetry, unbent, random), skeleton);
}

void append(std::vector<float>& to, const Vec3f& p) { to.insert(to.end(), {p.x(), p.y(), p.z()}); }

void add_mesh(nets::MeshArrays& mesh, const PreparedCharacter& character, const Placement& placement,
              const geometry::Neighbourhoods& near) {
  const std::int32_t first = mesh.batch.rows();
  for (const Vec3f& p : character.mesh.positions) append(mesh.positions, placement.apply(p));
  mesh.ring.add(character.one_ring.offsets, character.one_ring.members, first);
  mesh.geodesic.add(near.offsets, near.members, first);
  mesh.batch.add(character.vertices());
}

void add_joints(Batch& batch, const Example& example, const Placement& placement) {
  nets::JointArrays& joints = batch.inputs.joints;
  const std::int32_t first = joints.batch.rows();
  for (const Vec3f& p : example.character.skeleton.rest_positions) append(joints.positions, placement.apply(p));
  for (const float d : example.plane_distance) joints.plane_distance.push_back(d * placement.length_scale);
  joints.pairs.add_complete(static_cast<std::int32_t>(example.character.joints()), first);
  joints.batch.add(example.character.joints());
  batch.targets.root.push_back(first);  // joint 0 is the root
  const auto& attention = example.character.attention;
  batch.targets.attention.insert(batch.targets.attention.end(), attention.begin(), attention.end());
}

// Of the mesh that was added last. `joints`: how many the network is told that there are.
void add_votes(Batch& batch, const Example& example, const Placement& placement, const geometry::Regions& regions, float joints) {
  geometry::VoteFeatures placed = example.vote_features;
  const Eigen::Matrix3f of_normals = placement.linear.inverse().transpose();
  for (Vec3f& n : placed.normals) n = (of_normals * n).normalized();
  for (Vec3f& way : placed.to_middle) way = placement.linear * way;
  for (float& thickness : placed.thicknesses) thickness *= placement.length_scale;
  std::vector<Vec3f> positions;
  for (const Vec3f& p : example.character.mesh.positions) positions.push_back(placement.apply(p));
  const auto& starts = batch.inputs.mesh.batch.offsets;
  batch.inputs.votes.add(geometry::vote_rows(positions, placed, joints), regions.seeds, regions.region_of, starts[starts.size() - 2]);
}

// Of the joints that were added last. `astray` (J) is added to their positions.
void add_tree(Batch& batch, const Example& example, const Placement& placement, std::span<const Vec3f> astray) {
  const PreparedCharacter& character = example.character;
  const Plane plane = example.symmetry.value_or(Plane{Vec3f::UnitX(), 0.0f});
  std::vector<Vec3f> joints, images, vertices;
  for (JointId j : character.skeleton.names.ids()) {
    const Vec3f p = character.skeleton.rest_positions[j] + astray[static_cast<std::size_t>(j)];
    joints.push_back(placement.apply(p));
    images.push_back(placement.apply(plane.mirror(p)));
  }
  for (const Vec3f& p : character.mesh.positions) vertices.push_back(placement.apply(p));
  const geometry::TreeFeatures features = geometry::tree_features({joints, images, vertices, example.inside});
  batch.inputs.tree.add({features.joints.data(), static_cast<std::size_t>(features.joints.size())},
                        {features.pairs.data(), static_cast<std::size_t>(features.pairs.size())});
  for (const int parent : parent_indices(character.skeleton))
    batch.targets.parents.push_back(parent < 0 ? 0 : parent);  // joint 0 is the root
}

// How far each joint is from where it belongs.
std::vector<Vec3f> random_errors(std::size_t joints, const AugmentOptions& options, Random& random) {
  std::vector<Vec3f> errors(joints, Vec3f::Zero());
  if (random.uniform() >= options.misplaced) return errors;
  const float largest = options.misplacement * random.uniform();
  for (Vec3f& e : errors) e = largest * Vec3f(random.normal(), random.normal(), random.normal());
  return errors;
}

// A pair of joints of one example, by their rows there; `row` is that of its features.
struct Pair {
  std::int32_t first, second;
  Eigen::Index row;
};

std::vector<Pair> pairs_of(const Example& example) {
  std::vector<Pair> pairs;
  const auto count = static_cast<std::int32_t>(example.character.joints());
  for (std::int32_t i = 0; i < count; ++i)
    for (std::int32_t j = i + 1; j < count; ++j) pairs.push_back({i, j, static_cast<Eigen::Index>(pairs.size())});
  return pairs;
}

// Appends a pair of the mesh that was added last.
void add_pair(Batch& batch, const Example& example, const Pair& pair, const Placement& placement) {
  nets::PairArrays& pairs = batch.inputs.pairs;
  const auto& starts = batch.inputs.joints.batch.offsets;
  const auto& positions = example.character.skeleton.rest_positions.raw();
  const auto mesh = static_cast<std::int32_t>(starts.size()) - 2;
  const Vec3f a = placement.apply(positions[static_cast<std::size_t>(pair.first)]);
  const Vec3f b = placement.apply(positions[static_cast<std::size_t>(pair.second)]);
  pairs.first.push_back(starts[mesh] + pair.first);
  pairs.second.push_back(starts[mesh] + pair.second);
  pairs.mesh_of.push_back(mesh);
  append(pairs.features, a);
  append(pairs.features, b);
  pairs.features.push_back((a - b).norm());
  pairs.features.push_back(example.pair_features(pair.row, 7));  // the share inside is the same after an affine map
  batch.targets.connected.push_back(example.pair_labels[static_cast<std::size_t>(pair.row)]);
}

void add_skin_targets(Batch& batch, const geometry::SkinTargets& targets) {
  batch.targets.skin.insert(batch.targets.skin.end(), targets.weights.data(), targets.weights.data() + targets.weights.size());
  batch.targets.skin_share.insert(batch.targets.skin_share.end(), targets.covered.begin(), targets.covered.end());
}

// Positions and bone ends move with the placement, proximities with the distances.
void add_skin(Batch& batch, const Example& example, const Placement& placement) {
  std::vector<float>& out = batch.inputs.skin_features;
  const Matrix& features = example.skin_features;
  for (Eigen::Index v = 0; v < features.rows(); ++v) {
    append(out, placement.apply(features.row(v).head<3>().transpose()));
    for (Eigen::Index column = 3; column < features.cols(); column += geometry::kBoneFeatures) {
      append(out, placement.apply(features.row(v).segment<3>(column).transpose()));
      append(out, placement.apply(features.row(v).segment<3>(column + 3).transpose()));
      out.push_back(geometry::proximity(geometry::distance_of_proximity(features(v, column + 6)) * placement.length_scale));
      out.push_back(features(v, column + 7));
    }
  }
  add_skin_targets(batch, example.skin_targets);
}

// The features of the character as it is placed: of its bones, vertices and normals, and distances that grew with it.
void add_choices(Batch& batch, const Example& example, const Placement& placement) {
  const PreparedCharacter& character = example.character;
  std::vector<Vec3f> positions, normals = vertex_normals(character.mesh).raw();
  for (const Vec3f& p : character.mesh.positions) positions.push_back(placement.apply(p));
  const Eigen::Matrix3f of_normals = placement.linear.inverse().transpose();
  for (Vec3f& n : normals) n = (of_normals * n).normalized();
  geometry::BoneList bones = bone_list(character.skeleton);
  for (Segment& s : bones.segments) s = {placement.apply(s.a), placement.apply(s.b)};
  const geometry::BindInputs inputs =
      geometry::bind_inputs(positions, normals, bones, example.choices, placement.length_scale * character.nearest_distances);
  batch.inputs.choices.add(inputs.features, inputs.offsets, inputs.bones);
  add_skin_targets(batch, example.skin_targets);
}

// Noise, not zeros: normalisations blow up what does not vary, and its gradients drown all others.
void hide(std::vector<float>& positions) {
  Random random(positions.size());
  for (float& x : positions) x = random.uniform(0.0f, 1.0f);
}

void hide(Batch& batch, const BatchOptions& options) {
  if (options.hide_mesh) hide(batch.inputs.mesh.positions);
  if (options.hide_joints) hide(batch.inputs.joints.positions);
}

}  // namespace

std::vector<Example> examples_of(std::vector<PreparedCharacter> characters, Parts parts) {
  std::vector<Example> examples(characters.size());
  parallel_for(characters.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto symmetry = geometry::symmetry_plane(characters[i].mesh);
      examples[i] = example_of(std::move(characters[i]), parts, symmetry);
    }
  });
  return examples;
}

std::vector<double> sampling_weights(std::span<const Example> examples) {
  std::map<std::string, double> group_size, category_weight;
  for (const Example& e : examples) group_size[e.character.info.group] += 1.0;
  std::vector<double> weights;
  for (const Example& e : examples) {
    weights.push_back(1.0 / std::sqrt(group_size[e.character.info.group]));
    category_weight[e.character.info.category] += weights.back();
  }
  for (std::size_t i = 0; i < examples.size(); ++i) weights[i] /= std::sqrt(category_weight[examples[i].character.info.category]);
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& w : weights) w /= sum;
  return weights;
}

std::vector<std::size_t> draw(std::span<const double> weights, std::size_t count, Random& random) {
  std::vector<double> left(weights.begin(), weights.end());
  const auto possible = static_cast<std::size_t>(std::ranges::count_if(left, [](double weight) { return weight > 0.0; }));
  std::vector<std::size_t> drawn;
  while (drawn.size() < std::min(count, possible)) {
    double at = random.uniform() * std::accumulate(left.begin(), left.end(), 0.0);
    std::size_t i = 0;
    while (i + 1 < left.size() && (left[i] == 0.0 || at >= left[i])) at -= left[i++];
    if (left[i] == 0.0) continue;  // rounding led past the last one: draw again
    left[i] = 0.0;
    drawn.push_back(i);
  }
  return drawn;
}

std::shared_ptr<const Example> varied(const Example& example, Parts parts, const AugmentOptions& options, Random& random) {
  const bool articulate = random.uniform() < options.articulate.probability && example.character.joints() > 1;
  const bool fold = random.uniform() < options.fold && example.character.joints() > kLeastJoints;
  const bool reduce = random.uniform() < options.reduce && parts == Parts::joints && example.character.vertices() > options.least_vertices;
  const bool drop = options.drop > 0.0f && random.uniform() < options.drop;
  const bool flip = options.flip > 0.0f && random.uniform() < options.flip;
  if (!articulate && !fold && !reduce && !drop && !flip) return {std::shared_ptr<const Example>(), &example};
  PreparedCharacter changed =
      articulate ? articulated(example.character, some_articulation(example, options.articulate, random)) : example.character;
  if (drop) {
    PreparedCharacter bare = without_accessories(changed, options.dropped, random);
    if (bare.joints() > 1) changed = std::move(bare);
  }
  if (fold) {
    const float share = std::exp(random.uniform(std::log(options.least_fold), 0.0f));
    changed = folded(changed, std::max(kLeastJoints, static_cast<std::size_t>(share * static_cast<float>(changed.joints()))),
                     example.symmetry, random);
  }
  if (reduce && changed.vertices() > options.least_vertices) {
    const std::size_t target = options.least_vertices + random.below(changed.vertices() - options.least_vertices);
    changed.mesh = geometry::decimate(changed.mesh, {.target_vertices = target}).mesh;
  }
  if (flip) changed.mesh = geometry::with_flipped_edges(std::move(changed.mesh), options.flips, random);
  derive_from_shape(changed, parts);
  const bool reads_plane = parts == Parts::pairs || parts == Parts::tree;
  const auto symmetry = reads_plane ? geometry::symmetry_plane(changed.mesh) : example.symmetry;
  auto made = std::make_shared<Example>(example_of(std::move(changed), parts, symmetry));
  made->character.voxels = {};  // most of what it weighs, and no batch reads them
  return made;
}

Batch training_batch(std::span<const Example* const> examples, const BatchOptions& options, const AugmentOptions& augment, Random& random) {
  Batch batch;
  for (const Example* one : examples) {
    const Example& example = *one;
    const PreparedCharacter& character = example.character;
    const Placement placement = random_placement(character.mesh.positions.raw(), augment, random);
    if (options.parts != Parts::tree)
      add_mesh(batch.inputs.mesh, character, placement, geometry::drawn(character.balls, options.neighbours, random));
    add_joints(batch, example, placement);
    if (options.parts == Parts::tree) add_tree(batch, example, placement, random_errors(character.joints(), augment, random));
    if (options.parts == Parts::joints) {
      const float joints = static_cast<float>(character.joints()) * std::exp(augment.joint_count_blur * random.normal());
      const auto first = static_cast<std::uint32_t>(random.below(character.vertices()));
      add_votes(batch, example, placement, geometry::regions(character.mesh, character.balls, nets::vote_regions, first), joints);
    }
    if (options.parts == Parts::skin) add_skin(batch, example, placement);
    if (options.parts == Parts::bind) add_choices(batch, example, placement);
    if (options.parts == Parts::neuro || options.parts == Parts::neuro_2019)
      add_neuro(batch, example, placement, options, random.uniform() >= augment.nameless);
    if (options.parts != Parts::pairs) continue;
    for (Pair pair : pairs_of(example)) {
      if (random.uniform() < 0.5f) std::swap(pair.first, pair.second);
      add_pair(batch, example, pair, placement);
    }
  }
  hide(batch, options);
  return batch;
}

Batch plain_batch(std::span<const Example* const> examples, const BatchOptions& options) {
  Batch batch;
  for (const Example* example : examples) {
    const PreparedCharacter& character = example->character;
    if (options.parts != Parts::tree) add_mesh(batch.inputs.mesh, character, {}, geometry::evenly(character.balls, options.neighbours));
    add_joints(batch, *example, {});
    if (options.parts == Parts::tree) add_tree(batch, *example, {}, std::vector<Vec3f>(character.joints(), Vec3f::Zero()));
    if (options.parts == Parts::joints) {
      const std::uint32_t first = geometry::outermost_vertex(character.mesh);
      add_votes(batch, *example, {}, geometry::regions(character.mesh, character.balls, nets::vote_regions, first),
                static_cast<float>(character.joints()));
    }
    if (options.parts == Parts::skin) add_skin(batch, *example, {});
    if (options.parts == Parts::bind) add_choices(batch, *example, {});
    if (options.parts == Parts::neuro || options.parts == Parts::neuro_2019) add_neuro(batch, *example, {}, options, true);
    if (options.parts != Parts::pairs) continue;
    const std::vector<Pair> pairs = pairs_of(*example);
    for (const Pair& pair : pairs) add_pair(batch, *example, pair, {});
    for (const Pair& pair : pairs) add_pair(batch, *example, {pair.second, pair.first, pair.row}, {});
  }
  hide(batch, options);
  return batch;
}

}  // namespace osteon::dataset
