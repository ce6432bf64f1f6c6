#include "paloc/frontends/odometry_frontend.h"

#include <map>
#include <mutex>

#include "icp_tracker.h"
#include "lio_sam_tracker.h"
#include "lio_tracker.h"
#include "paloc/core/errors.h"
#include "recorded_odometry.h"

namespace paloc {
namespace {

struct Registry {
  std::mutex mutex;
  std::map<std::string, OdometryFrontend::Factory> factories;

  Registry() {
    factories["recorded"] = [](const FrontendSettings& settings) {
      return std::make_unique<RecordedOdometry>(settings);
    };
    addTracked<LioTracker>("fast_lio");
    addTracked<IcpTracker>("icp");
    addTracked<LioSamTracker>("lio_sam");
  }

  template <class Tracker>
  void addTracked(const std::string& name) {
    factories[name] = [name](const FrontendSettings& settings) {
      return makeTrackedOdometry(name, std::make_unique<Tracker>(settings), settings);
    };
  }
};

// Made at its first use, so that a library may register while it is being loaded.
Registry& registry() {
  static Registry instance;
  return instance;
}

}  // namespace

void OdometryFrontend::registerFrontend(const std::string& name, Factory factory) {
  Registry& r = registry();
  const std::lock_guard<std::mutex> lock(r.mutex);
  if (!r.factories.emplace(name, std::move(factory)).second) {
    throw ConfigError("there is already a front-end '" + name + "'");
  }
}

std::vector<std::string> OdometryFrontend::names() {
  Registry& r = registry();
  const std::lock_guard<std::mutex> lock(r.mutex);
  std::vector<std::string> result;
  for (const auto& [name, factory] : r.factories) result.push_back(name);
  return result;
}

OdometryFrontend::Ptr OdometryFrontend::create(const std::string& name,
                                               const FrontendSettings& settings) {
  Factory factory;
  {
    Registry& r = registry();
    const std::lock_guard<std::mutex> lock(r.mutex);
    const auto found = r.factories.find(name);
    if (found != r.factories.end()) factory = found->second;
  }
  if (factory) return factory(settings);
  std::string known;
  for (const std::string& other : names()) known += (known.empty() ? "'" : ", '") + other + "'";
  throw ConfigError("there is no front-end '" + name + "'; there are: " + known);
}

}  // namespace paloc
