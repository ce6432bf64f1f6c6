// paloc embedded: consumer RECORDING.rawlog MAP.ply INITIAL.tum prints the last pose.
#include <exception>
#include <iostream>

#include "paloc/config/config.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/core/trajectory_generator.h"
#include "paloc/frontends/odometry_frontend.h"
#include "paloc/frontends/rawlog_stream.h"
#include "paloc/frontends/tum_file.h"
#include "paloc/map/prior_map.h"
#include "paloc/map/scan_matcher.h"

paloc::Result run(char** files) {
  const auto config = paloc::loadConfig(PALOC_SHARE_DIR "/sensors/vlp-16.yaml");
  const auto map = paloc::PriorMap::load(files[1], config.map);
  const auto odometry =
      paloc::OdometryFrontend::create("recorded", paloc::frontendSettingsOf(config));
  paloc::TrajectoryGenerator generator(config.estimator,
                                       paloc::ScanMatcher::onto(map, config.matcher));
  generator.setInitialPose(paloc::toMrpt(paloc::readTum(files[2]).front().pose));
  const auto drain = [&] {
    while (const auto event = odometry->next()) generator.add(*event);
  };
  paloc::RawlogStream log(files[0]);
  while (const auto observation = log.next()) {
    odometry->add(*observation);
    drain();
  }
  odometry->finish();
  drain();
  return generator.finish();
}

int main(int argc, char** argv) try {
  if (argc != 4) return 2;
  const paloc::Result result = run(argv + 1);
  if (result.trajectory.empty()) throw std::runtime_error(result.no_trajectory_reason);
  std::cout << result.trajectory.size()
            << " poses, the last: " << result.trajectory.back().T_map_body << '\n';
  return 0;
} catch (const std::exception& e) {
  std::cerr << e.what() << '\n';
  return 1;
}
