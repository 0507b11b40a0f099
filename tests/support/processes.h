// SPDX-License-Identifier: Apache-2.0
// Living processes, as /proc shows them.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace corridor::testing_support {

struct Process {
  pid_t pid = 0;
  std::string command_line;
};

// Those that have `text` in their command line, which no zombie has.
inline std::vector<Process> processes_with(const std::string& text) {
  std::vector<Process> found;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    std::ifstream in(entry.path() / "cmdline", std::ios::binary);
    // One that ends meanwhile cannot be read: a stream's operator says so by its state.
    std::ostringstream content;
    content << in.rdbuf();
    std::string line = content.str();
    for (char& c : line) {
      if (c == '\0') c = ' ';
    }
    if (line.find(text) != std::string::npos) found.push_back({std::stoi(name), line});
  }
  return found;
}

// Whether a signal has stopped it.
inline bool is_stopped(pid_t pid) {
  std::ifstream in("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(in, text);
  // "<pid> (<name>) <state> ..."
  const std::size_t state = text.rfind(") ");
  return state != std::string::npos && text.substr(state + 2, 1) == "T";
}

}  // namespace corridor::testing_support
