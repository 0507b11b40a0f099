// SPDX-License-Identifier: Apache-2.0
// An actor process's work in a training run: round after round, weights in, transitions out.
#pragma once

#include "actor/world/world.h"
#include "proto/run/run_directory.h"
#include "proto/settings/settings.h"
#include "proto/system/test_delay.h"
#include "proto/system/time_account.h"
#include "proto/wire/endpoint.h"

namespace corridor::actor {

// Drives every round that the replay server does not have yet, in lockstep with the learner, and
// returns after the last one, or when the process is asked to stop. `identity`: which actor this
// is, of which run. `delay` is called once a round. Throws Failure when a peer is lost or refuses.
void train(const RunConfig& config, const RunDirectory& directory, const ClientIdentity& identity,
           world::World& world, TimeAccount& time, const TestDelay& delay);

}  // namespace corridor::actor
