// SPDX-License-Identifier: Apache-2.0
// The car that ODE simulates, with Webots' published figures: Webots' physics engine is a fork of
// ODE, but this is not Webots. The only user of ODE.
//
// A rigid body on four wheels with springs and dampers, on a flat road. Front wheels are steered
// after Ackermann, their mean lagging the command as Webots' steering motor does, and held exactly
// (a motor would give way to the tyres: 0.0095 rad for 0.0100 at 13.9 m/s). Both front wheels are
// driven by the same torque, as behind a differential. Each tyre has one contact; a slip tyre's
// lateral and longitudinal forces grow with its slip, up to friction (a box, as all of ODE's).
//
// Bit-identical for equal calls: the full solver (dWorldStep), one thread.
#pragma once

#include <memory>

#include "actor/vehicle/vehicle.h"
#include "actor/vehicle/vehicle_model.h"

namespace corridor::vehicle {

// A step of 2 ms for slip tyres, of up to 10 ms for Webots'.
std::unique_ptr<Vehicle> make_ode_vehicle(const CarModel& car, const TyreModel& tyre,
                                          double time_step_s);

}  // namespace corridor::vehicle
