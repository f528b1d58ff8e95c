// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "osteon/base/random.h"
#include "osteon/dataset/prepared.h"
#include "osteon/rig/motion.h"

namespace osteon::dataset {

// What is known of how characters move.
struct MotionLibrary {
  std::map<std::string, Motion> own;  // by a character's id; joints by the names of its skeleton, world as of its file
  std::vector<Motion> bipeds;         // for those without: joints as in kBipedJoints (retarget.h)
};

// A character's own pose, in the frame of the networks: its parts move as skinning with the clip moves them, posed * rest^-1 of each joint
// in the clip's own tree. Joints that the clip does not name follow the joint above. Pre: pose < motion.poses.size().
Articulation own_pose(const PreparedCharacter& character, const Motion& motion, std::size_t pose);

// Up to `count` poses that differ as much as can be: farthest points, the rest pose being the first, by how far each joint turns, counted
// by what it moves. Of its own motion where it has some, else of bipeds' where it is one, from a random choice of poses. Left out are those
// in which the body lies or stands on its head, and those that shrink a part to next to nothing or blow it up; turns about y are undone.
std::vector<Articulation> motion_poses(const PreparedCharacter& character, const MotionLibrary& library, std::size_t count, Random& random);

}  // namespace osteon::dataset
