#include "turn_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace paloc {
namespace {

constexpr std::size_t kFewestSteps = 20;
constexpr double kFurthest = 0.25;  // s: offsets that are looked at

// The readings' rotation between the means over two windows; between instants without a window.
Mat3 meanRotation(const GyroTrack& gyro, TimeNs end_ns, TimeNs window_ns) {
  if (window_ns == 0) return gyro.rotationAt(end_ns);
  const Mat3 R_mid = gyro.rotationAt(end_ns - window_ns / 2);
  constexpr int kNodes = 8;  // of the midpoint rule: the turn within a window is nearly parabolic
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < kNodes; ++i) {
    const TimeNs t_ns = end_ns - window_ns + (2 * i + 1) * window_ns / (2 * kNodes);
    sum += so3::log(R_mid.transpose() * gyro.rotationAt(t_ns));
  }
  return R_mid * so3::exp(sum / kNodes);
}

Mat3 readRotation(const GyroTrack& gyro, const TurnStep& step, double offset_s) {
  const TimeNs shift = nsFromSeconds(offset_s), window = step.moved_by_gyro ? 0 : step.window_ns;
  return meanRotation(gyro, step.from_ns + shift, window).transpose() *
         meanRotation(gyro, step.to_ns + shift, window);
}

bool covered(const GyroTrack& gyro, const TurnStep& step, double offset_s) {
  const TimeNs shift = nsFromSeconds(offset_s);
  return gyro.covers(step.from_ns - step.window_ns + shift, step.to_ns + shift);
}

struct Wahba {
  Mat3 R;
  double scale = 1, left = 1;  // share of the turns' square that is left
};

// turn = scale R reading, least squares. `hold` (small) ties what the turns do not tell to a given
// rotation.
Wahba solveWahba(const std::vector<Vec3>& turns, const std::vector<Vec3>& readings,
                 const Mat3& hold, bool left_handed) {
  Mat3 m = Mat3::Zero();
  double turned = 0, read = 0;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    m += turns[i] * readings[i].transpose();
    turned += turns[i].squaredNorm();
    read += readings[i].squaredNorm();
  }
  constexpr double kHold = 1e-3;
  if (!left_handed) m += kHold * m.norm() * hold;
  // Of dynamic size: with a fixed one GCC 12 warns of an uninitialized member.
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Mat3 plain = svd.matrixU() * svd.matrixV().transpose();
  const double wanted = left_handed ? -1 : 1;
  const Vec3 signs(1, 1, plain.determinant() * wanted > 0 ? 1 : -1);
  Wahba result;
  result.R = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  const double product = std::max(0.0, svd.singularValues().dot(signs));
  result.scale = product / std::max(read, 1e-300);
  result.left = 1 - product * product / std::max(turned * read, 1e-300);
  return result;
}

// Readings in a wrong unit may turn round several times in a step: they are first brought to about
// the size of the turns.
double roughScale(const std::vector<TurnStep>& steps, const GyroTrack& gyro) {
  double turned = 0, read = 0;
  for (const TurnStep& step : steps) {
    turned += step.turn.norm();
    read += gyro.path(step.from_ns, step.to_ns);
  }
  return turned / std::max(read, 1e-300);
}

TurnFit bestOnGrid(const std::vector<TurnStep>& steps, const GyroTrack& readings_track,
                   const Mat3& hold, bool left_handed) {
  const double rough = roughScale(steps, readings_track);
  const GyroTrack gyro = readings_track.transformed(rough * Mat3::Identity());
  constexpr int kEachWay = 12;
  constexpr double kSpacing = 0.98 * kFurthest / kEachWay;  // 20 ms: refining goes on from there
  TurnFit best;
  double least = INFINITY;
  for (int k = -kEachWay; k <= kEachWay; ++k) {
    const double offset_s = kSpacing * k;
    std::vector<Vec3> turns, readings;
    for (const TurnStep& step : steps) {
      // The same steps for all offsets: what is left would not be comparable otherwise.
      if (!covered(gyro, step, kFurthest) || !covered(gyro, step, -kFurthest)) continue;
      turns.push_back(step.turn);
      readings.push_back(so3::log(readRotation(gyro, step, offset_s)));
    }
    const Wahba wahba = solveWahba(turns, readings, hold, left_handed);
    if (!(wahba.left < least)) continue;
    least = wahba.left;
    best.R_sensor_imu = wahba.R;
    best.scale = rough * wahba.scale;
    best.offset_s = offset_s;
  }
  return best;
}

constexpr int kOffset = 0, kAxes = 1, kBias = 4, kScale = 7, kUnknowns = 8;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Rows = Eigen::Matrix<double, 3, kUnknowns>;

struct Row {
  TimeNs from_ns = 0, to_ns = 0;
  Mat3 G;  // the turn as read, in the sensor's frame
  Vec3 residual;
  Rows jacobian;
};

// With readings in the sensor's frame, as a rotation G: turn = G, changed on the right by
// G^-1-differences of the rate (offset), of a turn of the axes, by bias and scale.
Row rowOf(const TurnStep& step, const GyroTrack& in_sensor, double offset_s) {
  const TimeNs shift = nsFromSeconds(offset_s);
  const Mat3 G = readRotation(in_sensor, step, offset_s);
  const TimeNs from = step.from_ns + shift, to = step.to_ns + shift;
  const Vec3 rate_from = in_sensor.meanRate(from - step.window_ns, from),
             rate_to = in_sensor.meanRate(to - step.window_ns, to);
  Row row;
  row.from_ns = step.from_ns;
  row.to_ns = step.to_ns;
  row.G = G;
  row.residual = so3::log(G.transpose() * so3::exp(step.turn));
  row.jacobian.col(kOffset) = rate_to - G.transpose() * rate_from;
  row.jacobian.middleCols<3>(kAxes) = G.transpose() - Mat3::Identity();
  row.jacobian.middleCols<3>(kBias) = -secondsBetween(step.from_ns, step.to_ns) * Mat3::Identity();
  row.jacobian.col(kScale) = so3::log(G);
  return row;
}

std::vector<Row> rowsOf(const std::vector<TurnStep>& steps, const GyroTrack& in_sensor,
                        double offset_s) {
  std::vector<Row> rows;
  for (const TurnStep& step : steps) {
    if (covered(in_sensor, step, offset_s)) rows.push_back(rowOf(step, in_sensor, offset_s));
  }
  return rows;
}

double medianNorm(const std::vector<Row>& rows, const Unknowns& x) {
  std::vector<double> norms;
  norms.reserve(rows.size());
  for (const Row& row : rows) norms.push_back((row.residual - row.jacobian * x).norm());
  const auto middle = norms.begin() + static_cast<std::ptrdiff_t>(norms.size() / 2);
  std::nth_element(norms.begin(), middle, norms.end());
  return *middle;
}

struct Solution {
  Unknowns x = Unknowns::Zero();
  Normal covariance = Normal::Zero();
  double sigma = 0;  // of one component of a residual, rad
};

// Iteratively reweighted least squares with Huber's weights.
Solution solveRows(const std::vector<Row>& rows) {
  constexpr double kMedianOfNorm = 1.538;  // of three unit normals
  constexpr double kHuber = 2.5, kSmallest = 1e-9;
  Solution solution;
  for (int round = 0; round < 6; ++round) {
    solution.sigma = std::max(kSmallest, medianNorm(rows, solution.x) / kMedianOfNorm);
    // Nothing is known beforehand; this only keeps the matrix regular.
    Normal normal = 1e-6 * Normal::Identity();
    Unknowns gradient = Unknowns::Zero();
    for (const Row& row : rows) {
      const double norm = (row.residual - row.jacobian * solution.x).norm() / solution.sigma;
      const double weight = norm > kHuber ? kHuber / norm : 1;
      normal += weight * row.jacobian.transpose() * row.jacobian;
      gradient += weight * row.jacobian.transpose() * row.residual;
    }
    const Eigen::LDLT<Normal> ldlt(normal);
    solution.x = ldlt.solve(gradient);
    solution.covariance = solution.sigma * solution.sigma * ldlt.solve(Normal::Identity());
  }
  return solution;
}

/// A scan that is turned wrongly makes one step too long and the next too short: residuals r_k =
/// e_k - theta e_(k-1), e white, with theta near 1 for scans and 0 for steps with errors of their
/// own. Estimates theta from the correlation of neighbours, -theta / (1 + theta^2).
double movingAverage(const std::vector<Row>& rows, const Solution& solution) {
  constexpr double kGreatest = 0.9;
  double product = 0, square = 0;
  const auto left = [&](const Row& row) {
    const Vec3 r = row.residual - row.jacobian * solution.x;
    return Vec3(r * std::min(1.0, 4 * solution.sigma / std::max(r.norm(), 1e-12)));
  };
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (rows[i].from_ns != rows[i - 1].to_ns) continue;
    const Vec3 r = left(rows[i]);
    product += r.dot(rows[i].G.transpose() * left(rows[i - 1]));
    square += r.squaredNorm();
  }
  if (!(product < 0)) return 0;
  const double correlation = product / square;
  if (correlation < -0.497) return kGreatest;
  return std::min(kGreatest,
                  (-1 + std::sqrt(1 - 4 * correlation * correlation)) / (2 * correlation));
}

/// Rows whose residuals are the white e_k above.
std::vector<Row> whitened(std::vector<Row> rows, double theta) {
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (rows[i].from_ns != rows[i - 1].to_ns) continue;
    const Mat3 carried = theta * rows[i].G.transpose();
    rows[i].residual += carried * rows[i - 1].residual;
    rows[i].jacobian += carried * rows[i - 1].jacobian;
  }
  return rows;
}

}  // namespace

double turnRms(const std::vector<TurnStep>& steps) {
  double sum = 0;
  for (const TurnStep& step : steps) sum += step.turn.squaredNorm();
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, steps.size())));
}

std::optional<TurnFit> findTurnFit(const std::vector<TurnStep>& steps, const GyroTrack& gyro,
                                   const Mat3& R_sensor_imu) {
  if (gyro.empty() || steps.size() < kFewestSteps) return std::nullopt;
  const auto usable = std::count_if(steps.begin(), steps.end(), [&](const TurnStep& step) {
    return covered(gyro, step, kFurthest) && covered(gyro, step, -kFurthest);
  });
  if (usable < static_cast<std::ptrdiff_t>(kFewestSteps)) return std::nullopt;
  const TurnFit right = refineTurnFit(steps, gyro, bestOnGrid(steps, gyro, R_sensor_imu, false));
  constexpr double kWell = 0.003;
  if (right.unexplained() < kWell) return right;
  const TurnFit left = refineTurnFit(steps, gyro, bestOnGrid(steps, gyro, R_sensor_imu, true));
  // Where a third axis hardly turns both fit alike, and the axes are taken to be right-handed.
  constexpr double kClearly = 0.5;
  return left.unexplained() < kClearly * right.unexplained() ? left : right;
}

TurnFit refineTurnFit(const std::vector<TurnStep>& steps, const GyroTrack& gyro, TurnFit fit,
                      int rounds) {
  fit.turn_rms_rad = turnRms(steps);
  for (int round = 0; round < rounds; ++round) {
    const GyroTrack in_sensor = gyro.transformed(fit.scale * fit.R_sensor_imu);
    const std::vector<Row> rows = rowsOf(steps, in_sensor, fit.offset_s);
    fit.steps = rows.size();
    if (rows.size() < kFewestSteps) return fit;
    const Solution plain = solveRows(rows);
    const Solution solution = solveRows(whitened(rows, movingAverage(rows, plain)));
    const Unknowns& x = solution.x;
    constexpr double kLongestStep = 0.02;  // s: the rate's differences hold about so far
    fit.offset_s += std::clamp(x[kOffset], -kLongestStep, kLongestStep);
    fit.R_sensor_imu = so3::exp(x.segment<3>(kAxes)) * fit.R_sensor_imu;
    fit.scale *= 1 + std::clamp(x[kScale], -0.5, 0.5);
    fit.offset_sigma_s = std::sqrt(solution.covariance(kOffset, kOffset));
    fit.scale_sigma = std::sqrt(solution.covariance(kScale, kScale));
    fit.rotation_covariance = solution.covariance.block<3, 3>(kAxes, kAxes);
    fit.residual_rms_rad = std::sqrt(3.0) * plain.sigma;
  }
  return fit;
}

Mat3 turnResidual(const std::vector<TurnStep>& steps, const GyroTrack& gyro, const TurnFit& fit) {
  const GyroTrack in_sensor = gyro.transformed(fit.scale * fit.R_sensor_imu);
  const std::vector<Row> rows = rowsOf(steps, in_sensor, fit.offset_s);
  Mat3 sum = Mat3::Zero();
  for (const Row& row : rows) sum += row.residual * row.residual.transpose();
  return sum / static_cast<double>(std::max<std::size_t>(1, rows.size()));
}

}  // namespace paloc
