// SPDX-License-Identifier: Apache-2.0
#include "replay/limiter.h"

#include <algorithm>
#include <cmath>

namespace corridor::replay {

std::uint64_t counted_rows(const DqnSettings& settings, std::uint64_t inserted) {
  const auto minimum = static_cast<std::uint64_t>(
      std::max<std::int64_t>({settings.minimum_size, settings.batch_size, 1}));
  return inserted < minimum ? 0 : inserted - minimum + 1;
}

std::uint64_t granted_batches(const DqnSettings& settings, std::uint64_t inserted) {
  return static_cast<std::uint64_t>(
      std::floor(static_cast<double>(counted_rows(settings, inserted)) *
                 settings.samples_per_insert / settings.batch_size));
}

}  // namespace corridor::replay
