#include "cluster/launch/traced_episode.h"

#include "cluster/launch/local.h"
#include "proto/base/failure.h"
#include "proto/system/subprocess.h"

namespace corridor::cluster {

EpisodeTrace traced_by_actor(const RunDirectory& directory,
                             const std::vector<std::string>& arguments,
                             std::chrono::minutes patience) {
  std::vector<std::string> all = {directory.root().string()};
  all.insert(all.end(), arguments.begin(), arguments.end());
  const auto driven = run_subprocess(program_directory() / "corridor-actor", all, "", patience);
  if (!driven) throw Failure("{} was not driven within {} min", arguments.at(1), patience.count());
  if (driven->status != 0) {
    throw Failure("{}", driven->errors.substr(0, driven->errors.find('\n')));
  }
  return parse_episode_trace(Json::parse(driven->output, nullptr, false), arguments.at(1));
}

}  // namespace corridor::cluster
