// corridor-actor: one car in one SUMO. In a training it explores; by itself it evaluates, drives
// episodes again and for pictures, or looks back on an evaluation's collisions.
#include "actor/tasks.h"
#include "proto/run/actor_task.h"
#include "proto/system/program.h"

int main(int argc, char** argv) {
  using namespace corridor;
  return run_program(kActorProgram, [&] {
    const auto asked = parse_actor_command(argc, argv);
    const auto* command = std::get_if<ActorCommand>(&asked);
    return command != nullptr ? actor::perform(*command) : std::get<int>(asked);
  });
}
