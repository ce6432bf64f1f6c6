#pragma once

#include <string>

namespace paloc {

/// Prints to standard output; throws IoError where that fails.
void printResult(const std::string& result);

}  // namespace paloc
