#include "paloc/tools/print_result.h"

#include <iostream>

#include "paloc/core/errors.h"

namespace paloc {

void printResult(const std::string& result) {
  std::cout << result << std::flush;
  if (!std::cout) throw IoError("the result could not be written to standard output");
}

}  // namespace paloc
