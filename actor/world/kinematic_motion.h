// The ego exactly where its trajectory says, but for its body staying on the road.
#pragma once

#include "actor/world/ego_motion.h"

namespace corridor::world {

class KinematicMotion : public EgoMotion {
 public:
  KinematicMotion(const DynamicsSettings& dynamics, const RoadSettings& road,
                  const EgoSettings& ego);
  void begin(const driving::Ego& start, std::uint64_t episode_seed) override;
  Motion drive(const driving::Trajectory& trajectory, double from_s, double to_s) override;

 private:
  DynamicsSettings dynamics_;
  RoadSettings road_;
  EgoSettings size_;
  std::uint64_t seed_ = 0;
  std::uint64_t instant_ = 0;
};

}  // namespace corridor::world
