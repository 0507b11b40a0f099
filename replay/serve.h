// SPDX-License-Identifier: Apache-2.0
// The replay server's loop: a request from the socket, through the service, and its answer back.
#pragma once

#include <functional>

#include "proto/run/metrics.h"
#include "proto/settings/settings.h"
#include "proto/system/clock.h"
#include "proto/system/test_delay.h"
#include "proto/wire/endpoint.h"
#include "replay/replay_service.h"

namespace corridor::replay {

// What a server's loop asks and calls, beside its socket.
struct ServeHooks {
  std::function<bool()> stop;  // asked at least ten times a second
  TestDelay delay = [] {};     // before each chunk and block
  Clock clock = steady_now;
};

// Serves until it is to stop. Logs whom it waits for, when a block stays unopened for 5 s. Every 32
// blocks it writes the service's metrics, and where its time went (proto/system/time_account.h): it
// waits for actors where a block is wanted and chunks are missing, else for the learner. Requests
// that make no sense are refused. Throws Failure when the metrics cannot be written.
void serve(Server& server, ReplayService& service, MetricsWriter& metrics, const RunConfig& config,
           const ServeHooks& hooks);

}  // namespace corridor::replay
