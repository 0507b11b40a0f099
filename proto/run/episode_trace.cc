#include "proto/run/episode_trace.h"

#include "proto/base/failure.h"

namespace corridor {
namespace {

Json to_json(const TracedVehicle& vehicle) {
  return {vehicle.id,       vehicle.s_m,     vehicle.d_m,    vehicle.speed_mps,
          vehicle.length_m, vehicle.width_m, vehicle.yaw_rad};
}

Json to_json(const std::vector<TracedVehicle>& vehicles) {
  Json list = Json::array();
  for (const TracedVehicle& vehicle : vehicles) list.push_back(to_json(vehicle));
  return list;
}

Json to_json(const TracedDecision& decision) {
  return {{"corridor", decision.corridor},       {"set_point_mps", decision.set_point_mps},
          {"mop_action", decision.mop_action},   {"bp_values", decision.bp_values},
          {"mop_values", decision.mop_values},   {"window_first", decision.window_first},
          {"window_open", decision.window_open}, {"front_gaps_m", decision.front_gaps_m},
          {"back_gaps_m", decision.back_gaps_m}, {"path_s_m", decision.path_s_m},
          {"path_d_m", decision.path_d_m},       {"bp_reward", decision.bp_reward},
          {"mop_reward", decision.mop_reward}};
}

TracedVehicle parse_vehicle(const Json& list) {
  if (!list.is_array() || list.size() != 7) throw Failure("a vehicle has seven numbers");
  return {whole_number<int>(list[0]), list[1].get<double>(), list[2].get<double>(),
          list[3].get<double>(),      list[4].get<double>(), list[5].get<double>(),
          list[6].get<double>()};
}

std::vector<TracedVehicle> parse_vehicles(const Json& list) {
  std::vector<TracedVehicle> vehicles;
  for (const Json& vehicle : list) vehicles.push_back(parse_vehicle(vehicle));
  return vehicles;
}

TracedDecision parse_decision(const Json& object, std::size_t commands) {
  TracedDecision decision;
  decision.corridor = whole_number<int>(object.at("corridor"));
  object.at("set_point_mps").get_to(decision.set_point_mps);
  decision.mop_action = whole_number<int>(object.at("mop_action"));
  object.at("bp_values").get_to(decision.bp_values);
  object.at("mop_values").get_to(decision.mop_values);
  decision.window_first = whole_number<int>(object.at("window_first"));
  object.at("window_open").get_to(decision.window_open);
  object.at("front_gaps_m").get_to(decision.front_gaps_m);
  object.at("back_gaps_m").get_to(decision.back_gaps_m);
  object.at("path_s_m").get_to(decision.path_s_m);
  object.at("path_d_m").get_to(decision.path_d_m);
  object.at("bp_reward").get_to(decision.bp_reward);
  object.at("mop_reward").get_to(decision.mop_reward);
  if (decision.path_s_m.size() != decision.path_d_m.size()) throw Failure("half a path");
  const std::size_t values = decision.bp_values.size();
  if (values != 0 && values != commands) throw Failure("values of other commands");
  return decision;
}

TracedStep parse_step(const Json& object, std::size_t commands) {
  TracedStep step;
  step.ego = parse_vehicle(object.at("ego"));
  if (object.contains("command")) {
    step.command = whole_number<int>(object.at("command"));
    if (static_cast<std::size_t>(*step.command) >= commands) throw Failure("an unknown command");
  }
  step.others = parse_vehicles(object.at("others"));
  if (object.contains("decision")) step.decision = parse_decision(object.at("decision"), commands);
  for (const Json& scene : object.at("on_the_way")) {
    step.on_the_way.push_back({parse_vehicle(scene.at("ego")), parse_vehicles(scene.at("others"))});
  }
  return step;
}

}  // namespace

const std::string& EpisodeTrace::command_name(int command) const {
  const auto place = static_cast<std::size_t>(command);
  CORRIDOR_CHECK(place < commands.size(), "command {} of {}", command, commands.size());
  return commands[place];
}

Json to_json(const EpisodeTrace& trace) {
  Json steps = Json::array();
  for (const TracedStep& step : trace.steps) {
    Json on_the_way = Json::array();
    for (const TracedScene& scene : step.on_the_way) {
      on_the_way.push_back({{"ego", to_json(scene.ego)}, {"others", to_json(scene.others)}});
    }
    Json object = {{"ego", to_json(step.ego)},
                   {"others", to_json(step.others)},
                   {"on_the_way", std::move(on_the_way)}};
    if (step.command) object["command"] = *step.command;
    if (step.decision) object["decision"] = to_json(*step.decision);
    steps.push_back(std::move(object));
  }
  Json object = {{"commands", trace.commands},
                 {"step_s", trace.step_s},
                 {"lanes", trace.lanes},
                 {"lane_width_m", trace.lane_width_m},
                 {"speed_limit_mps", trace.speed_limit_mps},
                 {"bp_reward", trace.bp_reward},
                 {"lane_changes", trace.lane_changes},
                 {"steps", std::move(steps)}};
  if (trace.collision) {
    object["collision"] = {{"kind", name_of(trace.collision->kind)},
                           {"other", trace.collision->other}};
  }
  return object;
}

EpisodeTrace parse_episode_trace(const Json& object, const std::string& name) {
  try {
    EpisodeTrace trace;
    object.at("commands").get_to(trace.commands);
    trace.step_s = object.at("step_s").get<double>();
    trace.lanes = whole_number<int>(object.at("lanes"));
    trace.lane_width_m = object.at("lane_width_m").get<double>();
    trace.speed_limit_mps = object.at("speed_limit_mps").get<double>();
    trace.bp_reward = object.at("bp_reward").get<double>();
    trace.lane_changes = whole_number<int>(object.at("lane_changes"));
    for (const Json& step : object.at("steps")) {
      trace.steps.push_back(parse_step(step, trace.commands.size()));
    }
    if (trace.steps.empty()) throw Failure("no step");
    if (object.contains("collision")) {
      const Json& collision = object.at("collision");
      trace.collision = {parse_choice<CollisionKind>(collision.at("kind").get<std::string>()),
                         whole_number<int>(collision.at("other"))};
    }
    return trace;
  } catch (const std::exception& error) {
    throw Failure("{} is no episode's trace: {}", name, error.what());
  }
}

}  // namespace corridor
