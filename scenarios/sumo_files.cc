// SPDX-License-Identifier: Apache-2.0
#include "scenarios/sumo_files.h"

#include <cstdlib>
#include <sstream>
#include <vector>

#include "proto/base/failure.h"
#include "proto/settings/sumo_names.h"
#include "proto/system/files.h"
#include "proto/system/subprocess.h"

namespace corridor::scenarios {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHeader = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";

std::string vehicle_type_xml(const std::string& id, const std::string& attributes) {
  return fmt::format("  <vType id=\"{}\" {}/>\n", id, attributes);
}

fs::path find_netconvert() {
  std::vector<fs::path> folders;
  if (const char* home = std::getenv("SUMO_HOME")) folders.push_back(fs::path(home) / "bin");
  if (const auto program = find_program("netconvert", folders)) return *program;
  throw Failure(
      "netconvert (part of SUMO) is neither in $SUMO_HOME/bin nor in PATH: install SUMO "
      "(Debian: apt-get install sumo) or set SUMO_HOME");
}

// The first line that says "Error", else the first line.
std::string complaint(const std::string& output) {
  std::istringstream lines(output);
  std::string first;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("Error")) return line;
    if (first.empty()) first = line;
  }
  return first.empty() ? "it said nothing" : first;
}

void run_netconvert(const fs::path& directory, std::chrono::milliseconds patience) {
  const fs::path edges = directory / "road.edg.xml";
  const fs::path network = directory / kSumoNetworkFile;
  // By bare names: netconvert reads more than a name into some paths. Four decimals of a metre: two
  // would move lanes whose width is no multiple of a centimetre.
  const auto result = run_subprocess(
      find_netconvert(),
      {"--node-files", "road.nod.xml", "--edge-files", "road.edg.xml", "--output-file",
       kSumoNetworkFile, "--precision", "4", "--xml-validation", "never"},
      /*input=*/"", patience, directory);
  if (!result) {
    throw Failure("netconvert has not made {} within {} ms and was stopped", network.string(),
                  patience.count());
  }
  if (result->status != 0 || !fs::exists(network)) {
    throw Failure("netconvert refuses {} (exit status {}): {}", edges.string(), result->status,
                  complaint(result->errors + result->output));
  }
}

std::string nodes_xml(const RoadSettings& road) {
  return fmt::format(
      "<nodes>\n"
      "  <node id=\"west\" x=\"0\" y=\"0\"/>\n"
      "  <node id=\"east\" x=\"{}\" y=\"0\"/>\n"
      "</nodes>\n",
      road.length_m);
}

std::string edges_xml(const RoadSettings& road) {
  return fmt::format(
      "<edges>\n"
      "  <edge id=\"{}\" from=\"west\" to=\"east\" numLanes=\"{}\" width=\"{}\" speed=\"{}\"/>\n"
      "</edges>\n",
      kSumoRoad, road.lanes, road.lane_width_m, road.speed_limit_mps);
}

// So little of the ego that a vehicle in the intruded lane's other half is not in its way.
constexpr double kGhostWidth_m = 0.8;

std::string vehicle_types_xml(const TrafficSettings& traffic, const EgoSettings& ego) {
  const std::string keep_right = fmt::format("lcKeepRight=\"{}\"", traffic.keep_right);
  // Of the kinds in kVehicleKinds. The world draws each vehicle's speed factor itself, from the
  // same distribution, since where a vehicle fits depends on it; here it is for other tools.
  const std::string kinds[] = {
      fmt::format("speedFactor=\"normc({},{},{},{})\" length=\"5\" width=\"1.8\" color=\"yellow\"",
                  traffic.speed_factor_mean, traffic.speed_factor_deviation,
                  traffic.speed_factor_min, traffic.speed_factor_max),
      fmt::format("speedFactor=\"{}\" speedDev=\"0\" length=\"5\" width=\"1.8\" color=\"cyan\"",
                  traffic.slow_speed_factor),
      fmt::format("speedFactor=\"{}\" speedDev=\"0\" vClass=\"truck\" length=\"10\" width=\"2.4\" "
                  "color=\"gray\"",
                  traffic.truck_speed_factor)};
  static_assert(std::size(kinds) == kVehicleKinds.size());

  std::string xml = "<routes>\n";
  xml += vehicle_type_xml(
      kEgoType, fmt::format("speedFactor=\"1\" speedDev=\"0\" length=\"{}\" width=\"{}\" "
                            "accel=\"{}\" {} color=\"red\"",
                            ego.length_m, ego.width_m, ego.acceleration_max_mps2, keep_right));
  xml += vehicle_type_xml(kGhostType,
                          fmt::format("speedFactor=\"1\" speedDev=\"0\" length=\"{}\" width=\"{}\" "
                                      "accel=\"{}\" color=\"red\"",
                                      ego.length_m, kGhostWidth_m, ego.acceleration_max_mps2));
  for (std::size_t kind = 0; kind < kVehicleKinds.size(); ++kind) {
    for (const char* alignment : kAlignments) {
      xml += vehicle_type_xml(
          vehicle_type(static_cast<VehicleKind>(kind), alignment),
          fmt::format("{} {} latAlignment=\"{}\"", kinds[kind], keep_right, alignment));
    }
  }
  xml += vehicle_type_xml(
      kObjectType,
      fmt::format("length=\"{}\" width=\"{}\" minGap=\"0\" sigma=\"0\" color=\"white\"",
                  traffic.object_length_m, traffic.object_width_m));
  return xml + fmt::format("  <route id=\"{0}\" edges=\"{0}\"/>\n</routes>\n", kSumoRoad);
}

std::string configuration_xml(const SimulationSettings& simulation) {
  return fmt::format(
      "<configuration>\n"
      "  <input>\n"
      "    <net-file value=\"{}\"/>\n"
      "    <route-files value=\"{}\"/>\n"
      "  </input>\n"
      "  <time><step-length value=\"{}\"/></time>\n"
      "  <processing>\n"
      "    <lateral-resolution value=\"{}\"/>\n"
      "    <time-to-teleport value=\"-1\"/>\n"
      "    <collision.action value=\"none\"/>\n"
      "    <collision.mingap-factor value=\"0\"/>\n"
      "  </processing>\n"
      "</configuration>\n",
      kSumoNetworkFile, kSumoRoutesFile, simulation.substep_s(), simulation.lateral_resolution_m);
}

}  // namespace

void write_sumo_files(const RunConfig& config, const fs::path& directory,
                      std::chrono::milliseconds netconvert_deadline) {
  create_folders(directory);
  const std::pair<const char*, std::string> files[] = {
      {"road.nod.xml", nodes_xml(config.road)},
      {"road.edg.xml", edges_xml(config.road)},
      {kSumoRoutesFile, vehicle_types_xml(config.traffic, config.ego)},
      {"road.sumocfg", configuration_xml(config.simulation)}};
  for (const auto& [name, text] : files) write_file(directory / name, kHeader + text);
  run_netconvert(directory, netconvert_deadline);
  sync_file(directory / kSumoNetworkFile);
}

}  // namespace corridor::scenarios
