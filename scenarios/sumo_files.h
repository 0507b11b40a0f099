// A scenario's files for SUMO: the road and the vehicle types. They are plain SUMO files that its
// own tools open (`sumo-gui road.sumocfg`).
//
// The road is one straight edge `road` with lanes `road_0` (right) to `road_<n-1>`, on which runs
// the route `road`. Vehicle types are `ego`, `object`, and `<kind>_<alignment>` for each of
// kVehicleKinds and kAlignments: the kind fixes size and speed, the alignment where in its lane a
// driver keeps.
#pragma once

#include <array>
#include <chrono>
#include <filesystem>
#include <string>

#include "proto/settings/settings.h"

namespace corridor::scenarios {

inline constexpr std::array kVehicleKinds = {"car", "slow", "truck"};
inline constexpr std::array kAlignments = {"center", "arbitrary", "right", "left"};

// The contents of the files. Pure.
std::string nodes_xml(const RoadSettings& road);
std::string edges_xml(const RoadSettings& road);
std::string vehicle_types_xml(const TrafficSettings& traffic, const EgoSettings& ego);
std::string configuration_xml(const SimulationSettings& simulation);

// Writes road.nod.xml, road.edg.xml, traffic.rou.xml and road.sumocfg into `directory` (created
// when missing), and has `netconvert` make road.net.xml from the first two. netconvert is looked
// for in $SUMO_HOME/bin, then in PATH. Throws Failure when it is not there, refuses its input (with
// the first line of its complaint), or has not ended by the deadline (it is killed then).
void write_sumo_files(const RunConfig& config, const std::filesystem::path& directory,
                      std::chrono::milliseconds netconvert_deadline = std::chrono::seconds(60));

}  // namespace corridor::scenarios
