#include "make_scan.h"

namespace paloc {

std::shared_ptr<const Scan> makeScan(const LidarFrame& frame, const ScanMotion* motion,
                                     RangeLimits limits, UnusedCounts& unused) {
  const auto count = [&](const char* reason, std::size_t number) {
    unused.add(frame.class_name, frame.label, reason, number);
  };
  if (frame.points_lidar.empty()) {
    count("scan without a point", 1);
    return nullptr;
  }
  DroppedPoints dropped;
  auto scan = std::make_shared<Scan>(motion ? deskew(frame, *motion, limits, dropped)
                                            : placeOnBody(frame, limits, dropped));
  count("points nearer than min_range_m", dropped.too_near);
  count("points beyond max_range_m", dropped.too_far);
  if (motion && motion->byImu() && !scan->ages_s.empty()) {
    scan->v_body_assumed = motion->vBodyEnd();
  }
  if (isSkewed(frame) && !(motion && motion->byImu())) {
    scan->skew = motion ? ScanSkew::kOfOdometry : ScanSkew::kWhole;
  }
  if (!scan->points_body.empty()) return scan;
  count("scan without a point within range", 1);
  return nullptr;
}

}  // namespace paloc
