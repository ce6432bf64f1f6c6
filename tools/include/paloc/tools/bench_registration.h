#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "paloc/config/config.h"

namespace paloc {

/// What `paloc bench registration` is to measure. Without a map, it makes a building of rooms
/// (makeRooms), sampled to maps of some sizes, and OS1-128 scans from random places in it.
struct BenchRegistrationSettings {
  std::filesystem::path map, scans, poses;  ///< a map, a folder of scans, TUM poses: or none
  std::vector<std::size_t> map_points{8'000'000};
  std::vector<int> points{3000};  ///< of a scan, after the filter, at most
  std::vector<int> threads{1, 2};
  std::size_t places = 40;      ///< scans, each from another place; of a folder, as many at most
  int repeat = 1;               ///< times that all are registered; each scan's fastest counts
  double spacing_m = 0.1;       ///< between map points
  double map_noise_m = 0.003;   ///< 1 sigma across the surface
  double range_noise_m = 0.03;  ///< 1 sigma
  double off_m = 0.14, off_deg = 1;  ///< of the guess from the truth
  std::uint64_t seed = 1;
};

/// Quantiles over all scans.
struct ScanQuantiles {
  double p50 = 0, p95 = 0, p99 = 0;
};

/// One size of map and scan on one number of threads. Times of a scan in ms, by the wall clock.
struct RegistrationRun {
  std::size_t map_points = 0;  ///< after thinning
  std::size_t planar = 0;
  int points = 0, threads = 0;
  std::size_t scans = 0, accepted = 0;
  double points_in = 0, points_used = 0, iterations = 0, matched = 0;  ///< means
  ScanQuantiles match_ms;  ///< association, solve, information and spectrum together
  ScanQuantiles cpu_ms;    ///< filter and match on the processor, all threads together
  ScanQuantiles filter_ms, association_ms, solve_ms, information_ms, spectrum_ms;
  ScanQuantiles pose_ms;                         ///< association, solve and information together
  ScanQuantiles error_m, error_rad;              ///< of the accepted
  double load_s = 0;                             ///< from the file to the ready map, all included
  double sort_s = 0, index_s = 0, planes_s = 0;  ///< parts of it
  double bytes_a_point = 0;                      ///< of the map in memory
};

/// Runs them all. Throws IoError, UsageError.
std::vector<RegistrationRun> benchRegistration(const BenchRegistrationSettings& settings,
                                               const Config& config);

/// The result as a table for people.
std::string tableOf(const std::vector<RegistrationRun>& runs);

/// As JSON: the keys of the last run, and `runs`, all of them. m, rad, ms, s.
nlohmann::ordered_json jsonOf(const std::vector<RegistrationRun>& runs);

}  // namespace paloc
