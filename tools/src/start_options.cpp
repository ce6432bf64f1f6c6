#include "paloc/tools/start_options.h"

#include <CLI/CLI.hpp>

#include "paloc/core/mrpt_pose.h"
#include "paloc/frontends/tum_file.h"
#include "paloc/tools/parse_pose.h"

namespace paloc {

void StartOptions::registerOn(CLI::App& command, const std::string& at) {
  CLI::Option* pose =
      command.add_option("--init-pose", pose_,
                         "rough pose of the body " + at +
                             ": x,y,z,yaw,pitch,roll (m, degrees), within 3 m and 45 degrees");
  CLI::Option* position =
      command.add_option("--init-position", position_,
                         "position of the body " + at + ": x,y,z (m), within 1 m; any heading");
  command.add_option("--init", mode_, "auto: search the whole map")
      ->check(CLI::IsMember({"auto"}))
      ->excludes(pose)
      ->excludes(position);
  position->excludes(pose);
}

void StartOptions::registerTumOn(CLI::App& command) {
  CLI::Option* tum =
      command.add_option("--init-tum", tum_, "take --init-pose from the first pose of this file");
  for (const char* other : {"--init-pose", "--init-position", "--init"}) {
    tum->excludes(command.get_option(other));
  }
}

std::optional<StartGuess> StartOptions::guess() const {
  StartGuess guess;
  if (!pose_.empty()) guess.T_map_body = parsePose(pose_, "--init-pose");
  if (!tum_.empty()) guess.T_map_body = toMrpt(readTum(tum_).front().pose);
  if (!position_.empty()) guess.position_map = parsePosition(position_, "--init-position");
  if (!guess.T_map_body && !guess.position_map && mode_.empty()) return std::nullopt;
  return guess;
}

std::string StartOptions::words() const {
  if (!pose_.empty()) return " --init-pose=" + pose_;
  if (!tum_.empty()) return " --init-tum " + tum_;
  if (!position_.empty()) return " --init-position=" + position_;
  return mode_.empty() ? "" : " --init " + mode_;
}

}  // namespace paloc
