// An actor process's work in a training run: round after round, weights in, transitions out.
#pragma once

#include "actor/world/world.h"
#include "proto/run/run_directory.h"
#include "proto/settings/settings.h"
#include "proto/system/time_account.h"

namespace corridor::actor {

// Drives every round that the replay server does not have yet, in lockstep with the learner, and
// returns after the last one, or when the process is asked to stop. Throws Failure when a peer is
// lost or refuses.
void train(const RunConfig& config, const RunDirectory& directory, int actor, world::World& world,
           TimeAccount& time);

}  // namespace corridor::actor
