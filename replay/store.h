// SPDX-License-Identifier: Apache-2.0
// Transitions of one phase and their priorities: a ring of rows with proportional prioritized
// sampling (Schaul et al. 2016, section 3.3).
//
// A row's key is its insert index, counted on through both phases and never reused; its slot is key
// mod capacity. So a key says by itself whether its row has been replaced, and a late priority
// never reaches the slot's next tenant.
//
// Priorities come in as |TD error|; the exponent alpha is applied here and nowhere else:
// leaf = (|TD error| + offset)^alpha (power.h), > 0 since the offset is. Cost: one copy of a row
// in, one out, and the tree's. One thread.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "proto/base/random.h"
#include "proto/run/tensor_file.h"
#include "proto/settings/settings.h"
#include "proto/settings/transition.h"
#include "replay/sum_tree.h"

namespace corridor::replay {

bool are_finite(std::span<const float> values);
// Whether all are |TD errors|: finite and >= 0.
bool are_priorities(std::span<const float> values);

class Store {
 public:
  // Empty. Its draws are random_unit(seed, kReplaySampling, {phase, draw}) with draw = 0, 1, ...
  Store(const DqnSettings& settings, RowLayout layout, std::uint64_t seed, Phase phase,
        std::uint64_t first_key);

  std::uint64_t size() const { return next_key_ - oldest_key(); }
  std::uint64_t inserted() const { return next_key_ - first_key_; }
  std::uint64_t sampled() const { return sampled_; }
  std::uint64_t stale_priorities() const { return stale_priorities_; }
  std::uint64_t next_key() const { return next_key_; }
  RowLayout layout() const { return layout_; }

  // Appends whole rows, one priority a row (are_priorities); the oldest rows give way.
  void insert(std::span<const float> rows, std::span<const float> priorities);

  // Sets the priorities of rows drawn before, keys < next_key(), priorities are_priorities. Those
  // of replaced rows are dropped and counted; of a key named twice the last one stays.
  void update(std::span<const std::uint64_t> keys, std::span<const float> priorities);

  // What `sample` draws into, all of as many rows.
  struct Drawn {
    std::span<float> rows;  // [row, stride]
    std::span<std::uint64_t> keys;
    std::span<float> weights;
  };
  // Draws as many rows as there is room for, one from each of so many equal strata of the
  // priorities' sum, and weighs them by (size * probability)^-importance_exponent, divided by the
  // batch's largest weight. size() >= 1 unless there is no room; importance_exponent in [0, 1].
  void sample(double importance_exponent, const Drawn& into);

  // Keys of the rows held: [oldest_key(), next_key()).
  std::uint64_t oldest_key() const;
  // The rows from this key on, oldest first: [row, stride]. Keys from oldest_key() to next_key().
  std::vector<float> rows_from(std::uint64_t key) const;

  // Everything but the rows and what the constructor is given: "leaves" [size] from the oldest key
  // on, "first_key", "next_key", "sampled", "stale_priorities".
  void save(TensorFile& file) const;
  // Into an empty store: the same, and then the rows, in parts: those with the keys from
  // `first_key` on; of keys that are not held, nothing. Throw Failure naming the file when its
  // numbers do not fit together.
  void load(const TensorFile& file, const std::string& name);
  void load_rows(std::uint64_t first_key, const TensorFile& file, const std::string& name);

 private:
  struct Free {
    void operator()(float* memory) const { std::free(memory); }
  };
  static std::unique_ptr<float[], Free> uninitialised(std::size_t floats);

  float* row(std::uint64_t slot) const { return rows_.get() + slot * layout_.stride(); }
  void prefetch(std::uint64_t slot) const;
  void set_leaves(std::span<const float> priorities);

  std::size_t capacity_;
  float priority_exponent_;
  float priority_offset_;
  RowLayout layout_;
  RandomSequence draws_;

  std::uint64_t first_key_;
  std::uint64_t next_key_;
  std::uint64_t sampled_ = 0;
  std::uint64_t stale_priorities_ = 0;
  std::unique_ptr<float[], Free> rows_;  // [slot, stride]
  SumTree tree_;

  // Scratch of one call.
  std::vector<std::uint64_t> slots_;
  std::vector<float> fresh_;
  std::vector<float> leaves_;
  std::vector<double> units_;
};

}  // namespace corridor::replay
