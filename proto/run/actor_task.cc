// SPDX-License-Identifier: Apache-2.0
#include "proto/run/actor_task.h"

#include <concepts>
#include <limits>
#include <tuple>
#include <type_traits>

#include "proto/base/failure.h"
#include "proto/base/text.h"
#include "proto/system/command_line.h"

namespace corridor {
namespace {

template <typename T>
struct IsOptional : std::false_type {};
template <typename T>
struct IsOptional<std::optional<T>> : std::true_type {};

std::string text_of(const std::string& value) { return value; }
std::string text_of(const std::filesystem::path& value) { return value.string(); }
template <std::integral T>
std::string text_of(T value) {
  return std::to_string(value);
}

template <typename Task>
void declare(CLI::App& app, std::filesystem::path& run, Task& task) {
  CLI::App* command = app.add_subcommand(Task::kCommand);
  command->add_option("RUN", run, "run directory")->required();
  Task::options(task, [&](const char* name, auto& value, const char* meaning) {
    CLI::Option* option = command->add_option(name, value, meaning);
    using Value = std::decay_t<decltype(value)>;
    if (!IsOptional<Value>()) option->required();
    if constexpr (std::integral<Value>) {
      option->check(whole_number(0, static_cast<std::uint64_t>(std::numeric_limits<Value>::max())));
    }
  });
}

// One of each alternative, for what is parsed.
template <typename Variant>
struct OneOfEach;
template <typename... Tasks>
struct OneOfEach<std::variant<Tasks...>> {
  using Type = std::tuple<Tasks...>;
};

}  // namespace

std::vector<std::string> argv_of(const ActorTask& task, const RunDirectory& run) {
  return std::visit(
      [&]<typename Task>(const Task& given) {
        std::vector<std::string> argv = {Task::kCommand, run.root().string()};
        Task::options(given, [&](const char* name, const auto& value, const char*) {
          if constexpr (IsOptional<std::decay_t<decltype(value)>>()) {
            if (value) argv.insert(argv.end(), {name, text_of(*value)});
          } else {
            argv.insert(argv.end(), {name, text_of(value)});
          }
        });
        return argv;
      },
      task);
}

std::variant<ActorCommand, int> parse_actor_command(int argc, const char* const* argv) {
  CLI::App app("One car in one SUMO: an actor of a training, or a task by itself", kActorProgram);
  app.require_subcommand(1);
  ActorCommand command;
  OneOfEach<ActorTask>::Type tasks;
  std::apply([&](auto&... task) { (declare(app, command.run, task), ...); }, tasks);
  if (const auto done = parse_command_line(app, kActorProgram, argc, argv)) return *done;
  const auto take = [&](const auto& task) {
    if (app.got_subcommand(task.kCommand)) command.task = task;
  };
  std::apply([&](const auto&... task) { (take(task), ...); }, tasks);
  return command;
}

std::string step_count(std::int64_t done, std::int64_t total) {
  return fmt::format("{}/{}", done, total);
}

std::optional<std::int64_t> parse_step_count(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  if (!parse_number<std::int64_t>(text.substr(slash + 1))) return std::nullopt;
  return parse_number<std::int64_t>(text.substr(0, slash));
}

}  // namespace corridor
