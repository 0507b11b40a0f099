// SPDX-License-Identifier: Apache-2.0
// Text with values in it: fmt, as spdlog brings it. What formats includes this, and spdlog is named
// here and in proto/system/log only.
#pragma once

#include <spdlog/fmt/fmt.h>
