#include "paloc/tools/simulated_observations.h"

#include <tbb/parallel_for.h>

#include <limits>

#include "paloc/frontends/mrpt_time.h"
#include "timeline_feed.h"

namespace paloc::synth {

void simulateObservations(const Timeline& timeline, const LidarSimulator& lidar,
                          const std::function<void(const mrpt::obs::CObservation&)>& give,
                          const std::function<void(double)>& progress) {
  constexpr std::size_t kScansAtOnce = 8;
  TimelineFeed motion(timeline);
  std::vector<obs::CObservationLidarScan::Ptr> scans(kScansAtOnce);
  for (std::size_t first = 0; first < timeline.scans; first += kScansAtOnce) {
    const std::size_t count = std::min(kScansAtOnce, timeline.scans - first);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      scans[i] = lidar.scan(first + i, timeline.scanStart(first + i));
    });
    for (std::size_t i = 0; i < count; ++i) {
      motion.until(fromMrptTime(scans[i]->timestamp), give);
      give(*scans[i]);
    }
    progress(static_cast<double>(first + count) / static_cast<double>(timeline.scans));
  }
  motion.until(std::numeric_limits<TimeNs>::max(), give);
}

}  // namespace paloc::synth
