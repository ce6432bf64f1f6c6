#pragma once

#include <string>

#include "paloc/core/export.h"
#include "paloc/core/time.h"

namespace paloc {

/// An instant as decimal seconds with nine decimals, exact.
PALOC_EXPORT std::string secondsText(TimeNs t_ns);

}  // namespace paloc
