// SPDX-License-Identifier: Apache-2.0
#include "cluster/launch/traced_episode.h"

#include "cluster/launch/plan.h"
#include "proto/base/failure.h"
#include "proto/base/text.h"
#include "proto/system/subprocess.h"

namespace corridor::cluster {

EpisodeTrace traced_by_actor(const RunDirectory& directory, const ActorTask& task,
                             std::chrono::minutes patience) {
  const std::vector<std::string> argv = argv_of(task, directory);
  const auto driven = run_subprocess(program_path(kActorProgram), argv, "", patience);
  const std::string command = fmt::format("{} {}", kActorProgram, listed(argv, " "));
  if (!driven) throw Failure("{} has not ended within {} min", command, patience.count());
  if (driven->status != 0) {
    throw Failure("{}", driven->errors.substr(0, driven->errors.find('\n')));
  }
  return parse_record<EpisodeTrace>(Json::parse(driven->output, nullptr, false), command,
                                    "episode's trace");
}

}  // namespace corridor::cluster
