// SPDX-License-Identifier: Apache-2.0
// What tells runs, processes and machines apart. No clock has a part in it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace corridor {

// From the system. Throws Failure when it gives none.
std::uint64_t random_64_bits();

// "unknown" when it has none.
std::string host_name();

// Tells a folder from its copies, by whatever path it is reached. Throws Failure when there is
// none.
std::string folder_identity(const std::filesystem::path& folder);

// An incarnation tells a process from those of its name that ran before it, also when a message of
// one of them arrives late, even its first: it is greater than theirs. The upper half counts the
// starts of the one launcher that starts them, each when the last has ended. The lower is random:
// of two at a time, which only people start, one comes second.
std::uint64_t incarnation_of(std::uint32_t starts, std::uint64_t random);

// The starter's side: what the environment of the process says that is its `starts`-th, from 1.
std::string start_environment(std::uint32_t starts);

// The process's side, different at each call. Without a starter that counts, the count is 0.
std::uint64_t draw_incarnation();

}  // namespace corridor
