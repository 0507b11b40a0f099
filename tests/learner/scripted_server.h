// SPDX-License-Identifier: Apache-2.0
// A replay server by a script, for the small run's learner.
#pragma once

#include <utility>

#include "tests/learner/small_run.h"
#include "tests/support/scripted_server.h"

namespace corridor::learner {

class ScriptedServer : public testing_support::ScriptedServer<ReplayRequest> {
 public:
  explicit ScriptedServer(Script script)
      : testing_support::ScriptedServer<ReplayRequest>(fresh_address("scripted"), kRunId,
                                                       decode_replay_request, std::move(script)) {}
};

}  // namespace corridor::learner
