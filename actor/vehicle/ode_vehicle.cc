// SPDX-License-Identifier: Apache-2.0
#include "actor/vehicle/ode_vehicle.h"

#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "proto/base/failure.h"

namespace corridor::vehicle {
namespace {

constexpr double kContactErp = 0.6;  // highway.wbt
// Cruise control asks for so much of the speed's error a second.
constexpr double kCruiseGain_per_s = 5.0;
// Traction control: the share of the driven tyres' friction that cruise control uses at most.
constexpr double kTraction = 0.8;
// Below it a slip tyre's slip is reckoned at this speed: at a standstill it would be infinite.
constexpr double kSlipSpeedMin_mps = 0.5;
// A tyre's tangent is taken to rise at least by this share of its stiffness, and its load to be at
// least so much: both are divided by.
constexpr double kSlopeMin = 0.01;
constexpr double kLoadMin_n = 10.0;

constexpr int kWheels = 4;  // front left, front right, rear left, rear right
constexpr bool is_front(int wheel) { return wheel < 2; }
constexpr double side_of(int wheel) { return wheel % 2 == 0 ? 1.0 : -1.0; }  // > 0: left

// ODE counts its own users wrongly when it is initialised twice and closed once: one for all.
void initialise_ode() {
  static const int initialised = dInitODE2(0);
  CORRIDOR_CHECK(initialised != 0, "dInitODE2");
}

class OdeVehicle final : public Vehicle {
 public:
  OdeVehicle(const CarModel& car, const TyreModel& tyre, double time_step_s)
      : car_(car), tyre_(tyre), time_step_s_(time_step_s) {
    CORRIDOR_CHECK(time_step_s > 0.0, "{} s", time_step_s);
    initialise_ode();
    place({});
  }
  ~OdeVehicle() override { clear(); }
  OdeVehicle(const OdeVehicle&) = delete;
  OdeVehicle& operator=(const OdeVehicle&) = delete;

  // A new world each time: nothing of what was is left, not even the order of ODE's lists.
  void place(const VehicleState& start) override {
    clear();
    world_ = dWorldCreate();
    contacts_ = dJointGroupCreate(0);
    dWorldSetGravity(world_, 0.0, 0.0, -kGravity_mps2);
    steering_rad_ = steering_target_rad_ = brake_ = 0.0;
    cruising_speed_mps_ = start.speed_mps;

    dMatrix3 rotation;
    dRFromAxisAndAngle(rotation, 0.0, 0.0, 1.0, start.yaw_rad);
    const double cos = std::cos(start.yaw_rad), sin = std::sin(start.yaw_rad);
    const auto put = [&](dBodyID body, double ahead_m, double left_m, double up_m) {
      dBodySetPosition(body, start.x_m + cos * ahead_m - sin * left_m,
                       start.y_m + sin * ahead_m + cos * left_m, up_m);
      dBodySetRotation(body, rotation);
      dBodySetLinearVel(body, cos * start.speed_mps, sin * start.speed_mps, 0.0);
    };

    dMass mass;
    body_ = dBodyCreate(world_);
    dMassSetParameters(&mass, car_.body_mass_kg, 0.0, 0.0, 0.0, car_.inertia_x_kgm2,
                       car_.inertia_y_kgm2, car_.inertia_z_kgm2, 0.0, car_.inertia_xz_kgm2, 0.0);
    dBodySetMass(body_, &mass);
    put(body_, car_.centre_of_mass_x_m, 0.0, car_.tyre_radius_m + car_.centre_of_mass_z_m);

    for (int i = 0; i < kWheels; ++i) {
      dBodyID wheel = dBodyCreate(world_);
      constexpr int kAxisY = 2;
      dMassSetCylinderTotal(&mass, car_.wheel_mass_kg, kAxisY, car_.tyre_radius_m,
                            car_.tyre_width_m);
      dBodySetMass(wheel, &mass);
      // Explicit integration of a fast wheel's gyroscopic torque is unstable.
      dBodySetGyroscopicMode(wheel, 0);
      const double ahead_m = is_front(i) ? car_.wheelbase_m : 0.0;
      const double left_m = side_of(i) * car_.track_m / 2;
      put(wheel, ahead_m, left_m, car_.tyre_radius_m);
      const double spin_radps = start.speed_mps / car_.tyre_radius_m;
      dBodySetAngularVel(wheel, -sin * spin_radps, cos * spin_radps, 0.0);
      const double axle_share =
          is_front(i) ? car_.front_axle_share() : 1.0 - car_.front_axle_share();
      Wheel& placed = wheels_[static_cast<std::size_t>(i)];
      placed = {wheel, suspend(wheel), {}};
      placed.forces.f1[2] = car_.mass_kg() * kGravity_mps2 * axle_share / 2;
    }
  }

  void set_steering_angle(double angle_rad) override {
    steering_target_rad_ = std::clamp(angle_rad, -car_.steering_max_rad, car_.steering_max_rad);
  }
  void set_cruising_speed(double speed_mps) override { cruising_speed_mps_ = speed_mps; }
  void set_brake_intensity(double share) override { brake_ = std::clamp(share, 0.0, 1.0); }

  double time_step_s() const override { return time_step_s_; }

  void step() override {
    const double lag_radps =
        std::clamp(car_.steering_gain_per_s * (steering_target_rad_ - steering_rad_),
                   -car_.steering_rate_max_radps, car_.steering_rate_max_radps);
    steering_rad_ += lag_radps * time_step_s_;
    for (int i = 0; i < kWheels; ++i) {
      Wheel& wheel = wheels_[static_cast<std::size_t>(i)];
      if (is_front(i)) hold_steering(wheel, side_of(i));
      turn(wheel, is_front(i));
      touch_road(wheel);
    }
    dWorldStep(world_, time_step_s_);
    dJointGroupEmpty(contacts_);
  }

  VehicleState state() const override {
    const dReal* centre = dBodyGetPosition(body_);
    const dReal* velocity = dBodyGetLinearVel(body_);
    const dReal* rotation = dBodyGetRotation(body_);
    const double yaw_rad = std::atan2(rotation[4], rotation[0]);
    const double yaw_rate_radps = dBodyGetAngularVel(body_)[2];
    const double cos = std::cos(yaw_rad), sin = std::sin(yaw_rad);
    // From the centre of mass back to the rear axle.
    return {centre[0] - cos * car_.centre_of_mass_x_m,
            centre[1] - sin * car_.centre_of_mass_x_m,
            yaw_rad,
            cos * velocity[0] + sin * velocity[1],
            -sin * velocity[0] + cos * velocity[1] - yaw_rate_radps * car_.centre_of_mass_x_m,
            yaw_rate_radps,
            steering_rad_};
  }

 private:
  struct Wheel {
    dBodyID body = nullptr;
    dJointID suspension = nullptr;
    dJointFeedback forces{};  // of the road in the last step
  };

  void clear() {
    if (world_ == nullptr) return;
    dJointGroupDestroy(contacts_);
    dWorldDestroy(world_);  // with its bodies and joints
    world_ = nullptr;
  }

  dJointID suspend(dBodyID wheel) {
    const dReal* hub = dBodyGetPosition(wheel);
    const dReal* rotation = dBodyGetRotation(wheel);
    const dVector3 up = {0.0, 0.0, 1.0};
    const dVector3 axle = {rotation[1], rotation[5], rotation[9]};
    dJointID joint = dJointCreateHinge2(world_, nullptr);
    dJointAttach(joint, body_, wheel);
    dJointSetHinge2Anchor(joint, hub[0], hub[1], hub[2]);
    dJointSetHinge2Axes(joint, up, axle);
    // A spring and damper, integrated implicitly (ODE's manual, "how to use ERP and CFM").
    const double stiffness = time_step_s_ * car_.spring_npm;
    dJointSetHinge2Param(joint, dParamSuspensionERP, stiffness / (stiffness + car_.damping_nspm));
    dJointSetHinge2Param(joint, dParamSuspensionCFM, 1.0 / (stiffness + car_.damping_nspm));
    dJointSetHinge2Param(joint, dParamLoStop, 0.0);
    dJointSetHinge2Param(joint, dParamHiStop, 0.0);
    return joint;
  }

  void hold_steering(const Wheel& wheel, double side) {
    // Ackermann: both wheels turn about one point on the rear axle's line. ODE counts the angle of
    // the body against the wheel.
    double angle_rad = 0.0;
    if (steering_rad_ != 0.0) {
      const double radius_m = car_.wheelbase_m / std::tan(steering_rad_);
      angle_rad = -std::atan(car_.wheelbase_m / (radius_m - side * car_.track_m / 2));
    }
    // A low stop above the high one does not count: whichever way it moves, both hold at the end.
    dJointSetHinge2Param(wheel.suspension, dParamLoStop, angle_rad);
    dJointSetHinge2Param(wheel.suspension, dParamHiStop, angle_rad);
    dJointSetHinge2Param(wheel.suspension, dParamLoStop, angle_rad);
  }

  // Cruise control, resistance and brakes.
  void turn(const Wheel& wheel, bool is_driven) {
    const double spin_radps = spin(wheel);
    double torque_nm = -car_.wheel_damping_nms * spin_radps;
    if (is_driven && brake_ == 0.0) {
      const double speed_mps = state().speed_mps;
      const double wanted_mps2 = kCruiseGain_per_s * (cruising_speed_mps_ - speed_mps);
      const double grip_mps2 = kTraction * tyre_.friction * kGravity_mps2 * car_.front_axle_share();
      const double most_mps2 = std::min(car_.drive_mps2, grip_mps2);
      const double mps2 = std::clamp(wanted_mps2, -most_mps2, most_mps2);
      torque_nm += car_.mass_kg() * mps2 * car_.tyre_radius_m / 2;
      torque_nm += 2 * car_.wheel_damping_nms * spin_radps;  // for the rear wheels', too
    }
    const dReal* rotation = dBodyGetRotation(wheel.body);
    dBodyAddTorque(wheel.body, rotation[1] * torque_nm, rotation[5] * torque_nm,
                   rotation[9] * torque_nm);
    dBodyAddTorque(body_, -rotation[1] * torque_nm, -rotation[5] * torque_nm,
                   -rotation[9] * torque_nm);
    dJointSetHinge2Param(wheel.suspension, dParamVel2, 0.0);
    dJointSetHinge2Param(wheel.suspension, dParamFMax2, brake_ * car_.brake_nm);
  }

  // About its axle.
  double spin(const Wheel& wheel) const {
    const dReal* rotation = dBodyGetRotation(wheel.body);
    const dReal* turning = dBodyGetAngularVel(wheel.body);
    return rotation[1] * turning[0] + rotation[5] * turning[1] + rotation[9] * turning[2];
  }

  void touch_road(Wheel& wheel) {
    const dReal* hub = dBodyGetPosition(wheel.body);
    const double depth_m = car_.tyre_radius_m - hub[2];
    if (depth_m < 0.0) return;
    dContact contact{};
    contact.geom.pos[0] = hub[0];
    contact.geom.pos[1] = hub[1];
    contact.geom.normal[2] = 1.0;
    contact.geom.depth = depth_m;
    // The wheel's heading, level with the road: across the axle.
    const dReal* rotation = dBodyGetRotation(wheel.body);
    const double length = std::hypot(rotation[1], rotation[5]);
    contact.fdir1[0] = rotation[5] / length;
    contact.fdir1[1] = -rotation[1] / length;
    contact.surface.mode =
        dContactApprox1 | dContactMu2 | dContactFDir1 | dContactSoftCFM | dContactSoftERP;
    contact.surface.mu = contact.surface.mu2 = tyre_.friction;
    contact.surface.soft_cfm = tyre_.softness_cfm;
    contact.surface.soft_erp = kContactErp;
    if (tyre_.stiffness > 0.0) slip(wheel, contact);
    dJointID joint = dJointCreateContact(world_, contacts_, &contact);
    dJointAttach(joint, wheel.body, nullptr);
    dJointSetFeedback(joint, &wheel.forces);
  }

  // ODE lets a contact slip by so many m/s a newton, from a speed at which it has no force: the
  // tangent to the tyre's law at the present slip, so that the law is integrated implicitly.
  void slip(const Wheel& wheel, dContact& contact) const {
    const dReal* velocity = dBodyGetLinearVel(wheel.body);
    const dReal* turning = dBodyGetAngularVel(wheel.body);
    const double ahead_x = contact.fdir1[0], ahead_y = contact.fdir1[1];
    const double hub_m = dBodyGetPosition(wheel.body)[2];  // above the contact
    const double rolling_mps =
        std::max(std::abs(ahead_x * velocity[0] + ahead_y * velocity[1]), kSlipSpeedMin_mps);
    // Of the contact point, to the left.
    const double sliding_mps = -ahead_y * (velocity[0] - hub_m * turning[1]) +
                               ahead_x * (velocity[1] + hub_m * turning[0]);
    const double load_n = std::max(wheel.forces.f1[2], kLoadMin_n);
    const LateralForce force = lateral_force(tyre_, sliding_mps / rolling_mps);
    const double slope = std::max(force.per_rad, kSlopeMin * tyre_.stiffness);
    contact.surface.mode |= dContactSlip1 | dContactSlip2 | dContactMotion2;
    contact.surface.slip1 = rolling_mps / (tyre_.stiffness * load_n);
    contact.surface.slip2 = rolling_mps / (slope * load_n);
    contact.surface.motion2 = sliding_mps - force.per_load / slope * rolling_mps;
  }

  const CarModel car_;
  const TyreModel tyre_;
  const double time_step_s_;
  dWorldID world_ = nullptr;
  dJointGroupID contacts_ = nullptr;
  dBodyID body_ = nullptr;
  std::array<Wheel, kWheels> wheels_;
  double steering_rad_ = 0.0;
  double steering_target_rad_ = 0.0;
  double cruising_speed_mps_ = 0.0;
  double brake_ = 0.0;
};

}  // namespace

std::unique_ptr<Vehicle> make_ode_vehicle(const CarModel& car, const TyreModel& tyre,
                                          double time_step_s) {
  return std::make_unique<OdeVehicle>(car, tyre, time_step_s);
}

}  // namespace corridor::vehicle
