#include "paloc/frontends/feature_registration.h"

#include "lio_update.h"

namespace paloc {
namespace {

/// The features of a scan on the planes and lines of a local map, as an IteratedUpdate asks for
/// them. `Place(features, x)` gives features where the state x puts them.
template <class Place>
class FeatureMatches {
 public:
  FeatureMatches(PlaneMatches& planes, LineMatches& lines, const ScanFeatures& features,
                 const KeyFrameMap& map, double ageing, Place place)
      : planes_(planes),
        lines_(lines),
        features_(features),
        map_(map),
        ageing_(ageing),
        place_(place) {}

  void associate(const LioState& x, double gate_m, double least_voxel_m) {
    planes_.associate(place_(features_.planes, x), map_.planes(), gate_m, least_voxel_m);
    lines_.associate(place_(features_.edges, x), map_.lines(), gate_m);
  }
  std::size_t size() const { return planes_.size() + lines_.size(); }
  void weigh(double widening_m) {
    planes_.weigh(widening_m);
    lines_.weigh(widening_m);
  }
  PointToPlaneSums<9> sums() const {
    PointToPlaneSums<9> sums = planes_.sums<9>(ageing_);
    lines_.addTo(sums, ageing_);
    return sums;
  }
  Mat9 normalNoise() const {
    Mat9 noise = planes_.normalNoise<9>(ageing_);
    lines_.addNoiseTo(noise, ageing_);
    return noise;
  }

 private:
  PlaneMatches& planes_;
  LineMatches& lines_;
  const ScanFeatures& features_;
  const KeyFrameMap& map_;
  double ageing_;
  Place place_;
};

}  // namespace

FeatureMeasurement FeatureRegistration::align(const ScanFeatures& features,
                                              const FreeFallScan& scan, const Vec3& sensor_body,
                                              const KeyFrameMap& map, const LioState& predicted,
                                              const LioMatrix& covariance, bool rigid) {
  const double ageing = rigid ? 0 : 1;
  const auto place = [&](const std::vector<MeasuredPoint>& points,
                         const LioState& x) -> const std::vector<PlacedPoint>& {
    placePoints(points, scan, sensor_body, x, ageing, placed_);
    return placed_;
  };
  FeatureMatches matches(planes_, lines_, features, map, ageing, place);
  LioUpdate update({limits_.max_iterations, limits_.max_gate_m});
  FeatureMeasurement result;
  result.found = predicted;
  result.points = features.planes.size() + features.edges.size();
  const bool known =
      update.run(predicted, covariance, rmsRange(features.planes), matches, lioToMeasured);
  result.matched = matches.size();
  if (!known) return result;
  result.found = update.state();
  result.information = update.information().topLeftCorner<9, 9>();
  result.gradient = update.gradient().head<9>();
  result.open = update.open().topRows<9>();
  return result;
}

}  // namespace paloc
