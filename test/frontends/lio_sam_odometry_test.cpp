#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "recorded_lidar_imu.h"

namespace paloc {
namespace {

using namespace test::recorded;

/// A front-end that is asked for its map as it goes.
std::vector<std::size_t> mapBytesOf(const std::vector<CObservation::Ptr>& observations,
                                    const FrontendSettings& settings) {
  const auto frontend = OdometryFrontend::create("lio_sam", settings);
  std::vector<std::size_t> bytes;
  for (const auto& observation : observations) {
    frontend->add(*observation);
    while (frontend->next()) bytes.push_back(frontend->mapBytes());
  }
  return bytes;
}

TEST(LioSamOdometry, WithoutRingsItTakesPlanesAndSaysSo) {
  const test::Path path = test::sway();
  auto observations = recordingOf(path, 30);
  EXPECT_FALSE(run(observations, {}, "lio_sam").noted("do not tell the ring"));
  for (const auto& observation : observations) {
    if (auto scan = std::dynamic_pointer_cast<obs::CObservationLidarScan>(observation)) {
      scan->ring.clear();
    }
  }
  const Output output = run(observations, {}, "lio_sam");
  EXPECT_TRUE(output.noted("the scans do not tell the ring of their points"));
  ASSERT_EQ(output.frames.size(), 30U);
  EXPECT_LT(errorOf(path, output.frames[5], output.frames.back()).position.norm(), 0.02);
}

TEST(LioSamOdometry, ItsMapStopsGrowing) {
  FrontendSettings settings;
  settings.lio_sam.max_key_frames = 6;
  settings.lio_sam.key_frame_distance_m = 0.2;
  const auto bytes = mapBytesOf(recordingOf(test::sway(), 60), settings);
  ASSERT_GT(bytes.size(), 1000U);
  const std::size_t early = *std::max_element(bytes.begin(), bytes.begin() + 600);
  const std::size_t late = *std::max_element(bytes.begin() + 600, bytes.end());
  EXPECT_GT(early, 100'000U);
  EXPECT_LT(static_cast<double>(late), 1.5 * static_cast<double>(early));
}

/// Keeps of a scan what lies within `most_m` of the sensor along x.
void cutAlongX(obs::CObservationLidarScan& scan, float most_m) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < scan.x.size(); ++i) {
    if (std::abs(scan.x[i]) > most_m) continue;
    scan.x[kept] = scan.x[i];
    scan.y[kept] = scan.y[i];
    scan.z[kept] = scan.z[i];
    if (!scan.dt_ns.empty()) scan.dt_ns[kept] = scan.dt_ns[i];
    if (!scan.intensity.empty()) scan.intensity[kept] = scan.intensity[i];
    if (!scan.ring.empty()) scan.ring[kept] = scan.ring[i];
    ++kept;
  }
  for (auto* v : {&scan.x, &scan.y, &scan.z}) v->resize(kept);
  scan.dt_ns.resize(std::min(kept, scan.dt_ns.size()));
  scan.intensity.resize(std::min(kept, scan.intensity.size()));
  scan.ring.resize(std::min(kept, scan.ring.size()));
}

// Nothing else makes key frames here. Without the walls across x the scans leave that open.
TEST(LioSamOdometry, ScansThatLeaveADirectionOpenGoIntoItsMapUpToSomeAtAPlace) {
  FrontendSettings settings;
  settings.lio_sam.key_frame_distance_m = 100;
  settings.lio_sam.key_frame_turn_rad = 10;
  settings.lio_sam.key_frame_matched = 0;
  auto observations = recordingOf(test::sway(), 30);
  for (const bool open : {false, true}) {
    for (const auto& observation : observations) {
      auto scan = std::dynamic_pointer_cast<obs::CObservationLidarScan>(observation);
      if (scan && open) cutAlongX(*scan, 1.5F);
    }
    const auto bytes = mapBytesOf(observations, settings);
    const auto first =
        std::find_if(bytes.begin(), bytes.end(), [](std::size_t b) { return b > 10'000; });
    ASSERT_NE(first, bytes.end());
    EXPECT_EQ(2 * bytes.back() > 3 * *first, open);
    EXPECT_EQ(bytes.back(), bytes[2 * bytes.size() / 3]) << open;
  }
}

/// The room's walls, and the scans' edges in its corners; planes alone do as well here.
TEST(LioSamOdometry, EdgesCanBeLeftOut) {
  FrontendSettings settings;
  settings.lio_sam.edges_per_sector = 0;
  const test::Path path = test::sway();
  const auto observations = recordingOf(path, 30);
  const Output planes_only = run(observations, settings, "lio_sam");
  const Output both = run(observations, {}, "lio_sam");
  ASSERT_EQ(planes_only.frames.size(), 30U);
  EXPECT_LT(errorOf(path, planes_only.frames[5], planes_only.frames.back()).position.norm(), 0.02);
  EXPECT_NE(fromMrpt(planes_only.frames.back().T_odom_body).position,
            fromMrpt(both.frames.back().T_odom_body).position)
      << "edges count for something";
}

}  // namespace
}  // namespace paloc
