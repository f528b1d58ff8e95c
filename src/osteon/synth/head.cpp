// SPDX-License-Identifier: Apache-2.0
#include "osteon/synth/head.h"

#include "osteon/synth/chain.h"
#include "osteon/synth/pieces.h"

namespace osteon::synth {
namespace {

class HeadMaker {
 public:
  HeadMaker(Body& body, JointId parent, const Vec3f& at, const HeadShape& shape, const Habits& habits)
      : body_(body),
        shape_(shape),
        habits_(habits),
        r_(shape.radius),
        head_(body.joint("Head", parent, at)),
        skull_(at + Vec3f(0, 0.85f - 0.75f * shape.forward, 0.1f + 0.5f * shape.forward) * r_) {}

  JointId make() {
    add_skull();
    if (shape_.snout > 0.0f) add_snout();
    if (shape_.eyes > 0.0f) add_eyes();
    if (shape_.ears > 0.0f) add_ears();
    if (shape_.horns > 0.0f) add_horns();
    if (shape_.headgear != Headgear::None)
      body_.attach(head_, headgear(shape_.headgear, skull_, Vec3f(shape_.width, 1, 1.04f) * r_), Copies::One);
    return head_;
  }

 private:
  Vec3f on_skull(float x, float y, float z) const { return skull_ + Vec3f(x * shape_.width, y, z) * r_; }

  void add_skull() {
    const Vec3f base = body_.at(head_) + Vec3f(0, 0, 0.05f * r_);
    body_.clothe(head_, {{base, skull_}, 0.5f * r_, 0.8f * r_}, 0.3f * r_);
    body_.clothe(head_, {{on_skull(0, 0.05f, -0.08f), on_skull(0, -0.02f, 0.08f)}, r_, 0.95f * r_, Vec3f::UnitX(), shape_.width},
                 0.2f * r_);
    if (habits_.ends) body_.joint("HeadEnd", head_, on_skull(0, 1.0f - shape_.forward, 0.9f * shape_.forward));
  }

  void add_snout() {
    const float width = shape_.snout_width, end = 0.75f + shape_.snout;
    add_chain(body_, head_, Rows::Single,
              {{"", on_skull(0, -0.2f, 0.5f), 1.1f * width * r_}, {"", on_skull(0, -0.3f, end), 0.7f * width * r_}}, 0.5f);
    add_chain(body_, head_, Rows::Single,
              {{joint_if(habits_.jaw, "Jaw"), on_skull(0, -0.55f, 0.15f), 0.75f * width * r_},
               {"", on_skull(0, -0.38f - 0.55f * width, 0.9f * end), 0.45f * width * r_}},
              0.5f);
  }

  void add_eyes() {
    const float r = shape_.eyes;
    const Vec3f at = on_skull(0.45f, 0.18f, 0.8f);
    const JointId joint = habits_.eyes ? body_.pair("Eye", head_, at) : head_;
    body_.attach(joint, ball(at, r * r_));
  }

  void add_ears() {
    const Vec3f base = on_skull(0.6f, 0.65f, -0.05f);
    const Vec3f way = Vec3f(0.25f + 1.2f * shape_.ear_spread, 1.0f - 0.7f * shape_.ear_spread, -0.1f).normalized() * shape_.ears * r_;
    add_chain(body_, head_, Rows::Paired,
              {{joint_if(habits_.ears, "Ear"), base, 0.3f * r_},
               {joint_if(habits_.ears && shape_.ears > 1.0f, "Ear1"), base + 0.5f * way, 0.32f * r_},
               {joint_if(habits_.ears && habits_.ends, "EarEnd"), base + way, 0.16f * r_}},
              0.5f, {{}, 0, 0, Vec3f::UnitZ(), 0.6f});
  }

  void add_horns() {
    const float length = shape_.horns * r_, curl = shape_.horn_curl;
    const Vec3f base = on_skull(0.45f, 0.75f, 0.15f), way = Vec3f(0.45f, 1.0f, 0.0f).normalized();
    const Vec3f middle = base + 0.55f * length * way, tip = middle + 0.5f * length * (way + curl * Vec3f(0.3f, 0, 1)).normalized();
    const auto ring = [&](const Vec3f& at, float radius) { return Ring{at, radius * r_, radius * r_}; };
    body_.attach(head_, tube({ring(base - 0.2f * r_ * way, 0.2f), ring(middle, 0.14f), ring(tip, 0.03f)}, 7, Vec3f::UnitZ()));
  }

  Body& body_;
  const HeadShape& shape_;
  const Habits& habits_;
  float r_;
  JointId head_;
  Vec3f skull_;  // its centre
};

}  // namespace

JointId add_head(Body& body, JointId parent, const Vec3f& at, const HeadShape& shape, const Habits& habits) {
  return HeadMaker(body, parent, at, shape, habits).make();
}

}  // namespace osteon::synth
