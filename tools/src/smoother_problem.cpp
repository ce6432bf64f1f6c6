#include "paloc/tools/smoother_problem.h"

#include <charconv>
#include <cmath>
#include <fstream>
#include <string>
#include <string_view>

#include "paloc/core/errors.h"
#include "paloc/frontends/tum_file.h"

namespace paloc {
namespace {

// Printed quaternions are unit to their last decimal; more is another layout.
constexpr double kUnitTolerance = 1e-3;

/// Hands out the fields of one line after the other; what is wrong is told with file and line.
class FieldReader {
 public:
  FieldReader(const std::filesystem::path& file, std::size_t line, std::string_view text)
      : file_(file), line_(line), rest_(text) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw IoError(file_.string() + ":" + std::to_string(line_) + ": " + what);
  }
  bool atEnd() const { return rest_.find_first_not_of(kBlanks) == std::string_view::npos; }
  void expectEnd() const {
    if (!atEnd()) fail("more fields than this kind of line has");
  }
  std::string_view word(const char* name) {
    const std::size_t begin = rest_.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) fail(std::string("field ") + name + " is missing");
    const std::size_t end = std::min(rest_.find_first_of(kBlanks, begin), rest_.size());
    const std::string_view result = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    return result;
  }
  double number(const char* name) {
    const std::string_view text = word(name);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
      failAt(name, text, "a finite number");
    }
    return value;
  }
  double positive(const char* name) {
    const double value = number(name);
    if (!(value > 0)) fail(std::string("field ") + name + " must be positive");
    return value;
  }
  std::size_t index(const char* name) {
    const std::string_view text = word(name);
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) {
      failAt(name, text, "the number of a node");
    }
    return value;
  }
  TimeNs time() {
    const std::string_view text = word("t");
    TimeNs t_ns = 0;
    if (!parseSeconds(text, t_ns)) failAt("t", text, "a time in seconds");
    return t_ns;
  }
  Vec3 vector(const char* x, const char* y, const char* z) {
    const double a = number(x), b = number(y);  // the order of evaluation is that of the fields
    return {a, b, number(z)};
  }
  Pose pose() {
    Pose pose;
    pose.position = vector("x", "y", "z");
    const Vec3 v = vector("qx", "qy", "qz");
    const Quat q(number("qw"), v.x(), v.y(), v.z());
    if (std::abs(q.norm() - 1) > kUnitTolerance) {
      fail("the quaternion's length is " + std::to_string(q.norm()) + ", not 1");
    }
    pose.rotation = q.normalized().toRotationMatrix();
    return pose;
  }

 private:
  static constexpr std::string_view kBlanks = " \t\r\v\f";

  [[noreturn]] void failAt(const char* name, std::string_view text, const char* expected) const {
    fail(std::string("field ") + name + " is not " + expected + ": \"" + std::string(text) + "\"");
  }

  const std::filesystem::path& file_;
  std::size_t line_;
  std::string_view rest_;
};

// Variances [position, rotation] from the sigmas at the end of a line, rotation first.
Vec6 isotropicVariances(FieldReader& fields) {
  const double sigma_rotation = fields.positive("sigma_rot");
  const double sigma_position = fields.positive("sigma_pos");
  Vec6 variances;
  variances << Vec3::Constant(sigma_position * sigma_position),
      Vec3::Constant(sigma_rotation * sigma_rotation);
  return variances;
}

/// Takes the lines one after the other.
class ProblemBuilder {
 public:
  void add(const std::string_view kind, FieldReader& fields) {
    if (kind == "NOISE") {
      addNoise(fields);
    } else if (kind == "IMU") {
      addImu(fields);
    } else if (kind == "STATE") {
      addState(fields);
    } else if (kind == "ODOM") {
      addOdometry(fields);
    } else if (kind == "MAP" || kind == "MAPINFO") {
      addMap(fields, kind == "MAPINFO");
    } else {
      fields.fail("unknown kind of line \"" + std::string(kind) +
                  "\"; known are NOISE, IMU, STATE, ODOM, MAP and MAPINFO");
    }
    fields.expectEnd();
  }

  SmootherProblem finish(const std::filesystem::path& file) {
    if (problem_.nodes.empty()) throw IoError(file.string() + ": no STATE line");
    if (!has_noise_) throw IoError(file.string() + ": no NOISE line");
    return std::move(problem_);
  }

 private:
  void addNoise(FieldReader& fields) {
    ImuNoise& n = problem_.noise;
    n.accelerometer_noise_density_mps2_sqrthz = fields.positive("acc");
    n.gyroscope_noise_density_radps_sqrthz = fields.positive("gyr");
    n.accelerometer_bias_walk_mps3_sqrthz = fields.positive("acc_bias_walk");
    n.gyroscope_bias_walk_radps2_sqrthz = fields.positive("gyr_bias_walk");
    has_noise_ = true;
  }

  void addImu(FieldReader& fields) {
    ImuSample sample;
    sample.t_ns = fields.time();
    sample.acc_body = fields.vector("ax", "ay", "az");
    sample.omega_body = fields.vector("wx", "wy", "wz");
    if (!imu_.empty() && sample.t_ns < imu_.back().t_ns) fields.fail("time goes backwards");
    imu_.push_back(sample);
  }

  void addState(FieldReader& fields) {
    auto& nodes = problem_.nodes;
    if (fields.index("k") != nodes.size()) {
      fields.fail("STATE lines must count up from 0; expected " + std::to_string(nodes.size()));
    }
    SmootherProblem::Node node;
    node.t_ns = fields.time();
    if (!nodes.empty() && node.t_ns <= nodes.back().t_ns) fields.fail("time does not go forwards");
    node.T_map_body_true = fields.pose();
    node.v_map_true = fields.vector("vx", "vy", "vz");
    node.imu.swap(imu_);
    nodes.push_back(std::move(node));
  }

  void addOdometry(FieldReader& fields) {
    const std::size_t i = fields.index("i"), j = fields.index("j");
    if (j == 0 || i + 1 != j || j + 1 != problem_.nodes.size()) {
      fields.fail("ODOM must join the last STATE with the one before it");
    }
    SmootherProblem::OdometryMeasurement odometry;
    odometry.T_i_j = fields.pose();
    odometry.covariance = isotropicVariances(fields).asDiagonal();
    problem_.nodes.back().odometry.push_back(odometry);
  }

  void addMap(FieldReader& fields, bool with_information) {
    SmootherProblem::MapMeasurement map;
    map.node = fields.index("k");
    if (map.node >= problem_.nodes.size()) fields.fail("no STATE line of this number before it");
    map.T_map_body = fields.pose();
    map.information = with_information
                          ? informationInMap(fields, map.T_map_body.rotation)
                          : Mat6(isotropicVariances(fields).cwiseInverse().asDiagonal());
    problem_.nodes.back().map.push_back(map);
  }

  static Mat6 informationInMap(FieldReader& fields, const Mat3& R_map_body) {
    Mat6 information;
    for (int row = 0; row < 6; ++row) {
      for (int column = row; column < 6; ++column) {
        information(row, column) = information(column, row) = fields.number("information");
      }
    }
    Mat6 turn = Mat6::Identity();
    turn.topLeftCorner<3, 3>() = R_map_body;
    return turn * information * turn.transpose();
  }

  SmootherProblem problem_;
  std::vector<ImuSample> imu_;  // since the last STATE line
  bool has_noise_ = false;
};

}  // namespace

SmootherProblem readSmootherProblem(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file)) {
    throw IoError(file.string() + ": cannot be opened for reading");
  }
  ProblemBuilder builder;
  std::string text;
  for (std::size_t line = 1; std::getline(in, text); ++line) {
    FieldReader fields(file, line, std::string_view(text).substr(0, text.find('#')));
    if (fields.atEnd()) continue;
    const std::string_view kind = fields.word("kind");
    builder.add(kind, fields);
  }
  if (in.bad()) throw IoError(file.string() + ": reading failed");
  return builder.finish(file);
}

}  // namespace paloc
