#include "proto/episode_trace.h"

#include "proto/failure.h"

namespace corridor {
namespace {

using nlohmann::json;

json to_json(const TracedVehicle& vehicle) {
  return {vehicle.id,        vehicle.s_m,      vehicle.d_m,
          vehicle.speed_mps, vehicle.length_m, vehicle.width_m};
}

TracedVehicle parse_vehicle(const json& list) {
  if (!list.is_array() || list.size() != 6) throw Failure("a vehicle has six numbers");
  return {whole_number<int>(list[0]), list[1].get<double>(), list[2].get<double>(),
          list[3].get<double>(),      list[4].get<double>(), list[5].get<double>()};
}

TracedStep parse_step(const json& object) {
  TracedStep step;
  step.ego = parse_vehicle(object.at("ego"));
  if (object.contains("command")) step.command = whole_number<int>(object.at("command"));
  for (const json& other : object.at("others")) step.others.push_back(parse_vehicle(other));
  return step;
}

}  // namespace

json to_json(const EpisodeTrace& trace) {
  json steps = json::array();
  for (const TracedStep& step : trace.steps) {
    json others = json::array();
    for (const TracedVehicle& other : step.others) others.push_back(to_json(other));
    json object = {{"ego", to_json(step.ego)}, {"others", std::move(others)}};
    if (step.command) object["command"] = *step.command;
    steps.push_back(std::move(object));
  }
  json object = {{"step_s", trace.step_s},
                 {"lanes", trace.lanes},
                 {"lane_width_m", trace.lane_width_m},
                 {"speed_limit_mps", trace.speed_limit_mps},
                 {"bp_reward", trace.bp_reward},
                 {"lane_changes", trace.lane_changes},
                 {"steps", std::move(steps)}};
  if (trace.collision) {
    object["collision"] = {{"kind", trace.collision->kind}, {"other", trace.collision->other}};
  }
  return object;
}

EpisodeTrace parse_episode_trace(const json& object, const std::string& name) {
  try {
    EpisodeTrace trace;
    trace.step_s = object.at("step_s").get<double>();
    trace.lanes = whole_number<int>(object.at("lanes"));
    trace.lane_width_m = object.at("lane_width_m").get<double>();
    trace.speed_limit_mps = object.at("speed_limit_mps").get<double>();
    trace.bp_reward = object.at("bp_reward").get<double>();
    trace.lane_changes = whole_number<int>(object.at("lane_changes"));
    for (const json& step : object.at("steps")) trace.steps.push_back(parse_step(step));
    if (trace.steps.empty()) throw Failure("no step");
    if (object.contains("collision")) {
      const json& collision = object.at("collision");
      trace.collision = {collision.at("kind").get<std::string>(),
                         whole_number<int>(collision.at("other"))};
    }
    return trace;
  } catch (const std::exception& error) {
    throw Failure("{} is no episode's trace: {}", name, error.what());
  }
}

}  // namespace corridor
