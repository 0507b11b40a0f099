// SPDX-License-Identifier: Apache-2.0
// manoeuvres: a lane change with a temporary cancellation, through the whole chain from targets to
// the car, as the paper's figure shows it; prints one line every 0.05 s for docs/draw_manoeuvres.
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "actor/vehicle/ode_vehicle.h"
#include "actor/world/dynamic_motion.h"
#include "proto/base/format.h"

namespace {

using namespace corridor;

constexpr double kSpeed_mps = 13.9;
constexpr double kLaneMiddle_m = 4.8;
constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;
// A corridor a second from the middle lane's middle (7) to the left; after the second the planner
// changes its mind, and after three more goes on.
const std::vector<int> kCorridors = {7, 7, 8, 9, 8, 7, 7, 8, 9, 10, 11, 12, 12, 12, 12, 12};

// Prints the car's state as it goes.
class Printed : public vehicle::Vehicle {
 public:
  explicit Printed(std::unique_ptr<Vehicle> car) : car_(std::move(car)) {}
  void place(const vehicle::VehicleState& start) override { car_->place(start); }
  void set_steering_angle(double angle_rad) override { car_->set_steering_angle(angle_rad); }
  void set_cruising_speed(double speed_mps) override { car_->set_cruising_speed(speed_mps); }
  void set_brake_intensity(double share) override { car_->set_brake_intensity(share); }
  double time_step_s() const override { return car_->time_step_s(); }
  vehicle::VehicleState state() const override { return car_->state(); }
  void step() override {
    car_->step();
    if (++steps_ % std::lround(kControlPeriod_s / time_step_s()) != 0) return;
    const vehicle::VehicleState now = car_->state();
    fmt::print("{:.2f} {:.4f} {:.4f} {:.4f} {:.4f}\n", static_cast<double>(steps_) * time_step_s(),
               now.y_m, kDegreesPerRadian * now.yaw_rad, kDegreesPerRadian * now.steering_rad,
               now.yaw_rate_radps * now.speed_mps);
  }

 private:
  std::unique_ptr<Vehicle> car_;
  long steps_ = 0;
};

void drive(const char* name, const vehicle::TyreModel& tyre, double step_s,
           double corridor_change_s = 1.0) {
  RunConfig config;
  config.road.speed_limit_mps = kSpeed_mps;
  config.planner.corridor_change_s = corridor_change_s;
  const vehicle::CarModel car = vehicle::bmw_x5();
  world::DynamicMotion motion(
      std::make_unique<Printed>(vehicle::make_ode_vehicle(car, tyre, step_s)), car, tyre,
      config.dynamics, config.road, config.ego);
  driving::Ego ego;
  ego.d_m = kLaneMiddle_m;
  ego.speed_mps = kSpeed_mps;
  fmt::print("\n\n# {}: s, m across the road, heading, steering (degrees), m/s2\n", name);
  motion.begin(ego, 1);
  for (const int corridor : kCorridors) {
    const driving::Trajectory trajectory(ego, {corridor, kSpeed_mps}, driving_settings(config));
    ego = motion.drive(trajectory, 0.0, config.simulation.step_s).reference;
  }
}

}  // namespace

int main() {
  drive("rigid", vehicle::kRigidTyre, 0.01);
  drive("slip 0.9", vehicle::slip_tyre(0.9), 0.002);
  drive("slip 0.3", vehicle::slip_tyre(0.3), 0.002);
  drive("rigid, two seconds a corridor", vehicle::kRigidTyre, 0.01, 2.0);
}
