# SPDX-License-Identifier: Apache-2.0
"""A trace of CommonRoad's multibody model, steered in a sine of 0.25 Hz: see README.md.

    python3 trace.py SPEED_MPS AMPLITUDE_RAD [no-camber-thrust] > FILE.csv
"""
import math
import sys

from vehiclemodels.init_mb import init_mb
from vehiclemodels.parameters_vehicle2 import parameters_vehicle2
from vehiclemodels.vehicle_dynamics_mb import vehicle_dynamics_mb

STEP_S = 0.0005
STEPS_A_ROW = 100
DURATION_S = 8.0
TURN_RADPS = 2 * math.pi * 0.25

speed_mps, amplitude_rad = float(sys.argv[1]), float(sys.argv[2])
car = parameters_vehicle2()  # BMW 320i
if "no-camber-thrust" in sys.argv:
    car.tire.p_hy1 = car.tire.p_hy3 = car.tire.p_vy1 = car.tire.p_vy3 = 0


def derivative(state, time_s):
    steering_rate_radps = amplitude_rad * TURN_RADPS * math.cos(TURN_RADPS * time_s)
    acceleration_mps2 = max(-3, min(3, 2 * (speed_mps - state[3])))
    return vehicle_dynamics_mb(state, [steering_rate_radps, acceleration_mps2], car)


def moved(state, by, times):
    return [value + times * rate for value, rate in zip(state, by)]


state = init_mb([0.0, 0.0, 0.0, speed_mps, 0.0, 0.0, 0.0], car)
print("time_s,steering_rad,x_m,y_m,yaw_rad,yaw_rate_radps,speed_mps")
for step in range(round(DURATION_S / STEP_S) + 1):
    time_s = step * STEP_S
    if step % STEPS_A_ROW == 0:
        print(f"{time_s:.2f},{state[2]:.8f},{state[0]:.5f},{state[1]:.5f},"
              f"{state[4]:.7f},{state[5]:.7f},{state[3]:.5f}")
    # Runge and Kutta's fourth order.
    k1 = derivative(state, time_s)
    k2 = derivative(moved(state, k1, STEP_S / 2), time_s + STEP_S / 2)
    k3 = derivative(moved(state, k2, STEP_S / 2), time_s + STEP_S / 2)
    k4 = derivative(moved(state, k3, STEP_S), time_s + STEP_S)
    state = [value + STEP_S / 6 * (a + 2 * b + 2 * c + d)
             for value, a, b, c, d in zip(state, k1, k2, k3, k4)]
