// What the cores do in a training, from the processes' metrics (proto/system/time_account.h). Pure.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "proto/run/metrics.h"

namespace corridor::cluster {

// By name of a part ("simulate", "update", ...); "io" is what ZeroMQ's threads do.
using CoreTime = std::map<std::string, double>;

// How many cores one process keeps busy, by part: its processor time over the line's wall time,
// shared out in proportion to the parts that do not wait. Empty when the line has no times.
CoreTime cores_by_part(const MetricsValues& values);

double sum(const CoreTime& parts);

// "simulate 52 %, update 25 %, world 8 %": the largest so many parts as shares of the sum.
std::string largest_parts(const CoreTime& parts, int count);

}  // namespace corridor::cluster
