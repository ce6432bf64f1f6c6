#include "paloc/frontends/CObservationLidarScan.h"

#include <mrpt/core/initializer.h>
#include <mrpt/rtti/CObject.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/stl_serialization.h>

#include <ostream>
#include <stdexcept>

IMPLEMENTS_SERIALIZABLE(CObservationLidarScan, CObservation, paloc::obs)

namespace paloc::obs {

std::uint8_t CObservationLidarScan::serializeGetVersion() const { return 0; }

void CObservationLidarScan::serializeTo(mrpt::serialization::CArchive& out) const {
  out << timestamp << sensorLabel << sensorPoseOnRobot << x << y << z << dt_ns << intensity << ring
      << duration_ns << deskewed;
}

void CObservationLidarScan::serializeFrom(mrpt::serialization::CArchive& in, std::uint8_t version) {
  if (version != 0) MRPT_THROW_UNKNOWN_SERIALIZATION_VERSION(version);
  in >> timestamp >> sensorLabel >> sensorPoseOnRobot >> x >> y >> z >> dt_ns >> intensity >> ring >>
      duration_ns >> deskewed;
  const auto fits = [this](std::size_t n) { return n == 0 || n == x.size(); };
  if (y.size() != x.size() || z.size() != x.size() || !fits(dt_ns.size()) ||
      !fits(intensity.size()) || !fits(ring.size())) {
    throw std::runtime_error("CObservationLidarScan: its columns differ in length");
  }
}

void CObservationLidarScan::getDescriptionAsText(std::ostream& out) const {
  CObservation::getDescriptionAsText(out);
  out << "Sensor pose on the body: " << sensorPoseOnRobot << '\n'
      << "Points: " << size() << "\nDuration: " << duration_ns * 1e-6 << " ms\n"
      << "Time per point: " << (dt_ns.empty() ? "no" : "yes") << "\nDeskewed: "
      << (deskewed ? "yes" : "no") << "\nIntensity: " << (intensity.empty() ? "no" : "yes")
      << "\nRing: " << (ring.empty() ? "no" : "yes") << '\n';
}

}  // namespace paloc::obs

// Runs when the library is loaded, also by rawlog-edit -p.
MRPT_INITIALIZER(registerAllClasses_paloc) {
  mrpt::rtti::registerClass(CLASS_ID(paloc::obs::CObservationLidarScan));
}
