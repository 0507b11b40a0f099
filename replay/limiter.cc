#include "replay/limiter.h"

#include <algorithm>
#include <cmath>

namespace corridor::replay {

Limiter::Limiter(const DqnSettings& settings)
    : samples_per_insert_(settings.samples_per_insert),
      batch_size_(settings.batch_size),
      minimum_(static_cast<std::uint64_t>(
          std::max<std::int64_t>({settings.minimum_size, settings.batch_size, 1}))) {}

std::uint64_t Limiter::counted_rows(std::uint64_t inserted) const {
  return inserted < minimum_ ? 0 : inserted - minimum_ + 1;
}

std::uint64_t Limiter::batches(std::uint64_t inserted) const {
  return static_cast<std::uint64_t>(
      std::floor(static_cast<double>(counted_rows(inserted)) * samples_per_insert_ / batch_size_));
}

}  // namespace corridor::replay
