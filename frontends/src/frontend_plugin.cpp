#include "paloc/frontends/frontend_plugin.h"

#include <dlfcn.h>

#include "paloc/core/errors.h"

namespace paloc {
namespace {

template <class Function>
Function* functionOf(void* library, const char* name) {
  return reinterpret_cast<Function*>(dlsym(library, name));
}

}  // namespace

void loadFrontendPlugin(const std::string& file) {
  void* const library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) throw IoError("the plugin cannot be loaded: " + std::string(dlerror()));
  const auto interface = functionOf<int()>(library, "paloc_frontend_interface");
  const auto registerThem = functionOf<void()>(library, "paloc_register_frontends");
  if (!interface || !registerThem) {
    throw ConfigError(file + " is no plugin of paloc: it lacks PALOC_FRONTEND_PLUGIN");
  }
  if (const int version = interface(); version != kFrontendInterface) {
    throw ConfigError(file + " is built for interface " + std::to_string(version) +
                      " of paloc's front-ends, and this is " + std::to_string(kFrontendInterface) +
                      ": build it anew");
  }
  registerThem();
}

}  // namespace paloc
