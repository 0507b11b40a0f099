// SPDX-License-Identifier: Apache-2.0
// x^y for many x in one loop that the compiler makes vector instructions of, which std::pow is not.
#pragma once

#include <span>

namespace corridor::replay {

// out[i] = bases[i]^exponent, at most 1e30. Bases are normal and > 0, |exponent| <= 8 (CHECK). The
// relative error is below 1e-5. The same bits on every processor: only additions, multiplications
// and divisions, in one order.
void power(std::span<const float> bases, float exponent, std::span<float> out);

}  // namespace corridor::replay
