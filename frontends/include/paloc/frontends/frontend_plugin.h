#pragma once

#include <string>

#include "paloc/core/export.h"

namespace paloc {

/// Raised with every change of what a library of front-ends is compiled against.
inline constexpr int kFrontendInterface = 1;

/// Loads a shared library of front-ends, which registers them; it stays loaded. A name without a
/// slash is looked for as the dynamic linker does. Throws IoError where it cannot be loaded,
/// ConfigError where it is no such library, is one for another interface, or brings a name that is
/// taken.
PALOC_EXPORT void loadFrontendPlugin(const std::string& file);

}  // namespace paloc

/// Makes a shared library one of front-ends: `registerThem` is a function that calls
/// OdometryFrontend::registerFrontend() for each. To be used once, outside of namespaces. A call
/// from the loader, not an object that registers as it is constructed: an error can be told.
#define PALOC_FRONTEND_PLUGIN(registerThem)                                                    \
  extern "C" PALOC_EXPORT int paloc_frontend_interface() { return paloc::kFrontendInterface; } \
  extern "C" PALOC_EXPORT void paloc_register_frontends() { registerThem(); }
