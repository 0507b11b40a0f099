// SPDX-License-Identifier: Apache-2.0
// A replay server's batch as a value, for tests that compare or make one.
#pragma once

#include <algorithm>

#include "proto/wire/codec.h"

namespace corridor::testing_support {

inline Body encoded(const Batch& batch) {
  const BatchToFill place = batch_to_fill(batch.observations, batch.keys.size());
  std::ranges::copy(batch.rows, place.rows.begin());
  std::ranges::copy(batch.keys, place.keys.begin());
  std::ranges::copy(batch.weights, place.weights.begin());
  return place.body;
}

// Throws when it is another reply.
inline Batch decoded_batch(const Body& body) {
  const ReceivedBatch batch = decode_batch(body).value();
  return {batch.observations,
          {batch.rows.begin(), batch.rows.end()},
          {batch.keys.begin(), batch.keys.end()},
          {batch.weights.begin(), batch.weights.end()}};
}

}  // namespace corridor::testing_support
