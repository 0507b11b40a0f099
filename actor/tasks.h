// What corridor-actor does when it is asked for a task.
#pragma once

#include "proto/run/actor_task.h"

namespace corridor::actor {

// Returns the exit status: 0, or 1 when an episode was driven again otherwise than recorded. What
// is asked for comes on standard output. Ends early when stop_requested(). Throws Failure when the
// task cannot be done.
int perform(const ActorCommand& command);

}  // namespace corridor::actor
