// SPDX-License-Identifier: Apache-2.0
// The names of JSON values, for headers. With proto/base/json.h the only user of nlohmann's JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace corridor {

using Json = nlohmann::json;                 // keys in alphabetical order
using OrderedJson = nlohmann::ordered_json;  // keys as they were set

}  // namespace corridor
