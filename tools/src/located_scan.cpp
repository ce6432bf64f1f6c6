#include "paloc/tools/located_scan.h"

#include <Eigen/LU>
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>

#include "paloc/core/text.h"
#include "paloc/tools/trajectory_csv.h"

namespace paloc {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegrees = 180 / std::numbers::pi;

template <typename... Values>
std::string formatted(const char* format, Values... values) {
  char buffer[256];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

// The map must hold every direction: else the information has no inverse.
bool hasCovariance(const MapMatch& match) {
  return match.accepted() &&
         std::none_of(match.directions.begin(), match.directions.end(),
                      [](const auto& d) { return d.cls == DirectionClass::kNone; });
}

Mat6 covarianceOf(const MapMatch& match) {
  const Eigen::Matrix<double, 6, 6> information = match.information;
  return information.inverse();
}

std::string evidenceText(const MapMatch& m) {
  std::string out = formatted(
      "  explained    %.0f %% of the points lie on the map\n"
      "  contradicted %.1f %% of the points lie where the map shows open space\n"
      "  blocked      %.1f %% of the rays pass through it\n",
      100 * m.explained, 100 * m.contradicted, 100 * m.blocked);
  if (m.searched) {
    out += formatted("  second best  %.0f %% (explained less the two)\n", 100 * m.runner_up);
  }
  return out;
}

std::string directionsText(const MapMatch& match) {
  std::string out = "  direction (body)                     class    sigma\n";
  for (std::size_t k = 0; k < match.directions.size(); ++k) {
    const MatchDirection& d = match.directions[k];
    const bool rotation = k >= 3;
    out += formatted("  %s (%6.3f, %6.3f, %6.3f)     %-8s", rotation ? "about" : "along",
                     d.axis_body.x(), d.axis_body.y(), d.axis_body.z(), toString(d.cls).c_str());
    out += d.cls == DirectionClass::kNone ? std::string("open\n")
           : rotation                     ? formatted("%.4f deg\n", d.sigma * kDegrees)
                                          : formatted("%.2f mm\n", d.sigma * 1000);
  }
  return out;
}

std::string poseText(const mrpt::poses::CPose3D& pose) {
  return formatted("%.4f,%.4f,%.4f,%.4f,%.4f,%.4f", pose.x(), pose.y(), pose.z(),
                   pose.yaw() * kDegrees, pose.pitch() * kDegrees, pose.roll() * kDegrees);
}

Json directionsJson(const MapMatch& match) {
  Json all = Json::array();
  for (std::size_t k = 0; k < match.directions.size(); ++k) {
    const MatchDirection& d = match.directions[k];
    all.push_back({{"kind", k >= 3 ? "rotation" : "translation"},
                   {"axis_body", {d.axis_body.x(), d.axis_body.y(), d.axis_body.z()}},
                   {"class", toString(d.cls)},
                   {"sigma", d.cls == DirectionClass::kNone ? Json(nullptr) : Json(d.sigma)}});
  }
  return all;
}

Json covarianceJson(const MapMatch& match) {
  if (!hasCovariance(match)) return nullptr;
  const Mat6 covariance = covarianceOf(match);
  Json rows = Json::array();
  for (int i = 0; i < 6; ++i) {
    Json row = Json::array();
    for (int k = 0; k < 6; ++k) row.push_back(covariance(i, k));
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

std::string tableOf(const LocatedScan& located) {
  const MapMatch& m = located.match;
  if (!m.accepted()) {
    std::string out =
        text(located.scan, ": not localized in ", located.map, ": ", toString(m.refusal), '\n');
    return m.explained > 0
               ? out + "  best place   " + poseText(m.T_map_body) + '\n' + evidenceText(m)
               : out;
  }
  std::string out = text(located.scan, ": found in ", located.map, '\n');
  out += "  pose         " + poseText(m.T_map_body) + "  (x,y,z,yaw,pitch,roll; m, degrees)\n";
  out += evidenceText(m);
  out += formatted("  residual     %.1f mm RMS, %d of %d points\n", 1000 * m.residual_rms_m,
                   m.inliers, m.points);
  if (hasCovariance(m)) {
    const Mat6 c = covarianceOf(m);
    out += formatted("  sigma        %.2f, %.2f, %.2f mm; %.4f, %.4f, %.4f deg\n",
                     1000 * std::sqrt(c(0, 0)), 1000 * std::sqrt(c(1, 1)),
                     1000 * std::sqrt(c(2, 2)), kDegrees * std::sqrt(c(3, 3)),
                     kDegrees * std::sqrt(c(4, 4)), kDegrees * std::sqrt(c(5, 5)));
  }
  return out + directionsText(m);
}

nlohmann::ordered_json jsonOf(const LocatedScan& located) {
  const MapMatch& m = located.match;
  const auto& pose = m.T_map_body;
  Json json = {{"scan", located.scan},
               {"map", located.map},
               {"found", m.accepted()},
               {"reason", m.accepted() ? Json(nullptr) : Json(toString(m.refusal))},
               {"searched", m.searched},
               {"pose", nullptr},
               {"covariance", covarianceJson(m)},
               {"directions", nullptr},
               {"explained", m.explained},
               {"contradicted", m.contradicted},
               {"blocked", m.blocked},
               {"runner_up", m.runner_up},
               {"points", m.points},
               {"inliers", m.inliers},
               {"residual_rms_m", m.residual_rms_m},
               {"load_s", located.load_s},
               {"locate_s", located.locate_s}};
  if (m.accepted()) {
    json["pose"] = {{"x_m", pose.x()},
                    {"y_m", pose.y()},
                    {"z_m", pose.z()},
                    {"yaw_deg", pose.yaw() * kDegrees},
                    {"pitch_deg", pose.pitch() * kDegrees},
                    {"roll_deg", pose.roll() * kDegrees}};
    json["directions"] = directionsJson(m);
  }
  return json;
}

}  // namespace paloc
