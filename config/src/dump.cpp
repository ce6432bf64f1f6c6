#include <sstream>

#include "paloc/config/settings.h"

namespace paloc {

std::string dumpConfig(const Config& config) {
  std::ostringstream out;
  out << "# paloc's settings. Left out, a key keeps its default; units stand at the end of the "
         "names.\n";
  std::string section;
  for (const Setting& setting : allSettings()) {
    const auto dot = setting.key.find('.');
    if (setting.key.substr(0, dot) != section) {
      section = setting.key.substr(0, dot);
      out << '\n' << section << ":\n";
    }
    const std::string range = describeRange(setting);
    out << "  # " << setting.sentence << (range.empty() ? "" : " [" + range + "]") << '\n'
        << "  " << setting.key.substr(dot + 1) << ": " << formatValue(setting.get(config)) << '\n';
  }
  return out.str();
}

}  // namespace paloc
