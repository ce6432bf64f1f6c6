#include "paloc/tools/map_info.h"

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "paloc/core/text.h"
#include "paloc/map/cloud_description.h"
#include "paloc/map/cloud_io.h"
#include "paloc/map/prior_map.h"
#include "paloc/tools/peak_memory.h"

namespace paloc {
namespace {

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string fixed(double value, int decimals) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*f", decimals, value);
  return buffer;
}

std::string triple(const Vec3& v, const char* between, int decimals) {
  return fixed(v.x(), decimals) + between + fixed(v.y(), decimals) + between +
         fixed(v.z(), decimals);
}

}  // namespace

MapInfo readMapInfo(const std::filesystem::path& file, const MapSettings& settings,
                    const MapInfoProgress& progress) {
  MapInfo info;
  info.file = file.string();
  const auto telling = [&progress](const char* what) {
    return [&progress, what](double share) {
      if (progress) progress(share, what);
    };
  };
  {  // first, so that the peak of memory is that of a replay
    const auto start = std::chrono::steady_clock::now();
    const auto map = PriorMap::load(file, settings, telling("reading it as a prior map"));
    info.load_s = secondsSince(start);
    info.map_points = map->size();
    info.planar_share =
        static_cast<double>(map->statistics().planar) / static_cast<double>(map->size());
    info.memory_mb = static_cast<double>(map->statistics().bytes) * 1e-6;
    info.peak_rss_mb = peakRssMb();
  }
  const PointCloud cloud = loadCloud(file, {.progress = telling("reading every point")});
  info.bytes = std::filesystem::file_size(file);
  info.format = cloud.format;
  info.points = cloud.size();
  info.nonfinite = cloud.nonfinite_dropped;
  info.origin = cloud.origin;
  info.intensity = !cloud.intensity.empty();
  const CloudDescription description = describeCloud(cloud);
  info.low = description.low;
  info.high = description.high;
  info.spacing_m = description.spacing_m;
  return info;
}

std::string tableOf(const MapInfo& info) {
  const auto number = [](std::size_t n) { return std::to_string(n); };
  std::string table =
      text(info.file, ": ", fixed(static_cast<double>(info.bytes) * 1e-6, 1), " MB, ", info.format);
  table += text("\n  points           ", number(info.points), " finite, ", number(info.nonfinite),
                " not finite, ", info.intensity ? "with" : "without", " intensity");
  table += text("\n  bounding box     ", triple(info.low, ", ", 3), " to ",
                triple(info.high, ", ", 3), " (m)");
  table += text("\n  extent           ", triple(info.high - info.low, " x ", 2), " m");
  table += text("\n  origin           ", triple(info.origin, ", ", 1), " (m)");
  table += text("\n  spacing          ", fixed(info.spacing_m, 4), " m (median to the next point)");
  table += text("\n  as a prior map   ", number(info.map_points), " points, ",
                fixed(100 * info.planar_share, 1), " % of them on a plane");
  table += text("\n  memory           ", fixed(info.memory_mb, 0), " MB, while loading ",
                fixed(info.peak_rss_mb, 0), " MB");
  table += text("\n  time to load     ", fixed(info.load_s, 2), " s\n");
  return table;
}

nlohmann::ordered_json jsonOf(const MapInfo& info) {
  const auto array = [](const Vec3& v) { return nlohmann::ordered_json{v.x(), v.y(), v.z()}; };
  return {{"file", info.file},
          {"format", info.format},
          {"bytes", info.bytes},
          {"points", info.points},
          {"nonfinite", info.nonfinite},
          {"low_m", array(info.low)},
          {"high_m", array(info.high)},
          {"origin_m", array(info.origin)},
          {"spacing_m", info.spacing_m},
          {"intensity", info.intensity},
          {"map_points", info.map_points},
          {"planar_share", info.planar_share},
          {"memory_mb", info.memory_mb},
          {"peak_rss_mb", info.peak_rss_mb},
          {"load_s", info.load_s}};
}

}  // namespace paloc
