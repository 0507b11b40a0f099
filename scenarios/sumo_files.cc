#include "scenarios/sumo_files.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <system_error>
#include <vector>

#include "proto/failure.h"
#include "proto/run_directory.h"

extern char** environ;

namespace corridor::scenarios {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// netconvert's complaints are a few lines; a program that says more than this is not it.
constexpr std::size_t kOutputBytesMax = 64 * 1024;

constexpr const char* kHeader = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";

std::string vehicle_type_xml(const std::string& id, const std::string& attributes) {
  return fmt::format("  <vType id=\"{}\" {}/>\n", id, attributes);
}

fs::path find_netconvert() {
  std::vector<fs::path> folders;
  if (const char* home = std::getenv("SUMO_HOME")) folders.push_back(fs::path(home) / "bin");
  if (const char* path = std::getenv("PATH")) {
    std::istringstream parts(path);
    for (std::string part; std::getline(parts, part, ':');) folders.emplace_back(part);
  }
  for (const fs::path& folder : folders) {
    const fs::path program = folder / "netconvert";
    if (access(program.c_str(), X_OK) == 0) return program;
  }
  throw Failure(
      "netconvert (part of SUMO) is neither in $SUMO_HOME/bin nor in PATH: install SUMO "
      "(Debian: apt-get install sumo) or set SUMO_HOME");
}

// A child process whose standard output and error come back through one pipe. The destructor kills
// and reaps it if it still runs.
class Child {
 public:
  explicit Child(std::vector<std::string> arguments) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) fail(arguments[0], errno);
    output_ = ends[0];
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const int error = posix_spawn(&pid_, argv[0], &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    if (error != 0) {
      close(output_);
      fail(arguments[0], error);
    }
  }

  ~Child() {
    close(output_);
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
  }

  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // What it wrote until it closed its output. False when it has not done so by the deadline.
  bool read_all(Clock::time_point deadline, std::string& text) {
    for (;;) {
      const auto left =
          std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
      if (left <= 0) return false;
      pollfd ready{output_, POLLIN, 0};
      if (poll(&ready, 1, static_cast<int>(std::min<long>(left, 1000))) <= 0) continue;
      char buffer[4096];
      const ssize_t count = read(output_, buffer, sizeof buffer);
      if (count == 0) return true;
      if (count < 0 && errno != EINTR) return true;
      if (count > 0 && text.size() < kOutputBytesMax) text.append(buffer, count);
    }
  }

  // Its exit status (128 + signal when killed). Called after read_all, when it is about to end: a
  // program that closes its output and lives on is stopped.
  int wait() {
    constexpr int kPatience_ms = 1000;
    int status = 0;
    for (int waited_ms = 0; waitpid(pid_, &status, WNOHANG) == 0; ++waited_ms) {
      if (waited_ms == kPatience_ms) kill(pid_, SIGKILL);
      usleep(1000);
    }
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  [[noreturn]] static void fail(const std::string& program, int error) {
    throw Failure("cannot start {}: {}", program, std::strerror(error));
  }

  pid_t pid_ = -1;
  int output_ = -1;
};

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
  const auto deadline = Clock::now() + patience;
  const fs::path edges = directory / "road.edg.xml";
  const fs::path network = directory / "road.net.xml";
  // Four decimals of a metre: two would move lanes whose width is no multiple of a centimetre.
  Child child({find_netconvert(), "--node-files", directory / "road.nod.xml", "--edge-files", edges,
               "--output-file", network, "--precision", "4", "--xml-validation", "never"});
  std::string output;
  if (!child.read_all(deadline, output)) {
    throw Failure("netconvert has not made {} within {} ms and was stopped", network.string(),
                  patience.count());
  }
  const int status = child.wait();
  if (status != 0 || !fs::exists(network)) {
    throw Failure("netconvert refuses {} (exit status {}): {}", edges.string(), status,
                  complaint(output));
  }
}

}  // namespace

std::string nodes_xml(const RoadSettings& road) {
  return fmt::format(
      "{}<nodes>\n"
      "  <node id=\"west\" x=\"0\" y=\"0\"/>\n"
      "  <node id=\"east\" x=\"{}\" y=\"0\"/>\n"
      "</nodes>\n",
      kHeader, road.length_m);
}

std::string edges_xml(const RoadSettings& road) {
  return fmt::format(
      "{}<edges>\n"
      "  <edge id=\"road\" from=\"west\" to=\"east\" numLanes=\"{}\" width=\"{}\" speed=\"{}\"/>\n"
      "</edges>\n",
      kHeader, road.lanes, road.lane_width_m, road.speed_limit_mps);
}

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

  std::string xml = std::string(kHeader) + "<routes>\n";
  xml += vehicle_type_xml(
      "ego", fmt::format("speedFactor=\"1\" speedDev=\"0\" length=\"{}\" width=\"{}\" "
                         "accel=\"{}\" {} color=\"red\"",
                         ego.length_m, ego.width_m, ego.acceleration_max_mps2, keep_right));
  for (std::size_t kind = 0; kind < kVehicleKinds.size(); ++kind) {
    for (const char* alignment : kAlignments) {
      xml += vehicle_type_xml(
          fmt::format("{}_{}", kVehicleKinds[kind], alignment),
          fmt::format("{} {} latAlignment=\"{}\"", kinds[kind], keep_right, alignment));
    }
  }
  xml += vehicle_type_xml(
      "object", fmt::format("length=\"{}\" width=\"{}\" minGap=\"0\" sigma=\"0\" color=\"white\"",
                            traffic.object_length_m, traffic.object_width_m));
  return xml + "  <route id=\"road\" edges=\"road\"/>\n</routes>\n";
}

std::string configuration_xml(const SimulationSettings& simulation) {
  return fmt::format(
      "{}<configuration>\n"
      "  <input>\n"
      "    <net-file value=\"road.net.xml\"/>\n"
      "    <route-files value=\"traffic.rou.xml\"/>\n"
      "  </input>\n"
      "  <time><step-length value=\"{}\"/></time>\n"
      "  <processing>\n"
      "    <lateral-resolution value=\"{}\"/>\n"
      "    <time-to-teleport value=\"-1\"/>\n"
      "    <collision.action value=\"none\"/>\n"
      "    <collision.mingap-factor value=\"0\"/>\n"
      "  </processing>\n"
      "</configuration>\n",
      kHeader, simulation.step_s, simulation.lateral_resolution_m);
}

void write_sumo_files(const RunConfig& config, const fs::path& directory,
                      std::chrono::milliseconds netconvert_deadline) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) throw Failure("cannot create {}: {}", directory.string(), error.message());
  write_file(directory / "road.nod.xml", nodes_xml(config.road));
  write_file(directory / "road.edg.xml", edges_xml(config.road));
  write_file(directory / "traffic.rou.xml", vehicle_types_xml(config.traffic, config.ego));
  write_file(directory / "road.sumocfg", configuration_xml(config.simulation));
  run_netconvert(directory, netconvert_deadline);
}

}  // namespace corridor::scenarios
