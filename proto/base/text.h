// Numbers as people read them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace corridor {

// 1400000 -> "1,400,000".
std::string grouped(std::int64_t number);

// 67 -> "1 min 07 s"; 4000 -> "1 h 06 min". Rounded to whole seconds.
std::string duration_text(double seconds);

// "a, b, c".
std::string listed(const std::vector<std::string>& texts, std::string_view separator = ", ");

}  // namespace corridor
