#include "plane_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "point_vector.h"

namespace paloc {
namespace {

constexpr double kMinIncidenceCosine =
    0.1;  // flatter rays say little and are biased by their footprint
constexpr double kNoiseCosine =
    0.2;  // below it the range noise counts no less: the beam has a width
// The radius of what a plane was fitted to: of a disc it is twice the standard deviation along
// either axis; and at least so much (m), for planes so thin that none can be told.
constexpr double kRadiusToWidth = 2, kLeastRadiusM = 0.05;
// Two map points are on one face when their planes are this parallel, and this near in thicknesses.
constexpr double kOneFaceCosine = 0.9, kOneFaceThicknesses = 3;

Vec3 normalOf(const MapPlane& plane) {
  return {static_cast<double>(plane.nx), static_cast<double>(plane.ny),
          static_cast<double>(plane.nz)};
}

}  // namespace

void PlaneSearch::setPoints(AveragedPoints averaged_body, const Vec3& sensor_position_body) {
  points_ = std::move(averaged_body);
  sensor_body_ = sensor_position_body;
  const std::size_t size = points_.points.size();
  reach_m_ = 0;
  rays_.resize(size);
  range_variance_.resize(size);
  const double variance = settings_.range_noise_m * settings_.range_noise_m;
  for (std::size_t i = 0; i < size; ++i) {
    const Vec3 ray = toVec(points_.points[i]) - sensor_body_;
    const double range = ray.norm();
    reach_m_ = std::max(reach_m_, range);
    rays_[i] = range > 0 ? Vec3(ray / range) : Vec3::Zero();
    range_variance_[i] = variance / points_.returns[i];
  }
  reach_m_ += sensor_body_.norm();
}

// The plane of the nearest map point that the sensor can see. Planes seen edge-on are none.
void PlaneSearch::take(Correspondence& match, const PriorMap::Nearest& nearest,
                       const Vec3& from_sensor) const {
  match.planar = false;
  match.near = nearest.found();
  match.map_index = nearest.index;
  if (!nearest.found()) return;
  match.distance = std::sqrt(static_cast<double>(nearest.distance_sq));
  const MapPlane plane = map_.plane(nearest.index);
  if (!plane.planar()) return;
  match.normal = normalOf(plane);
  const double across = match.normal.dot(from_sensor);
  if (across * across < kMinIncidenceCosine * kMinIncidenceCosine * from_sensor.squaredNorm())
    return;
  match.planar = true;
  match.map_point = toVec(map_.point(nearest.index));
  match.height = match.normal.dot(match.map_point) + static_cast<double>(plane.offset_m);
  // Towards the sensor: rows of one surface then have one sign, and so has the error they share.
  if (across > 0) {
    match.normal = -match.normal;
    match.height = -match.height;
  }
  const auto thickness = static_cast<double>(plane.thickness_m);
  // The point of the scan lies anywhere in the thickness of the surface, the fit has its own error.
  const double roughness = std::max(thickness, settings_.map_noise_m);
  match.fit_variance = roughness * roughness + thickness * thickness / plane.points;
  match.normal_sigma = static_cast<double>(plane.normal_sigma_rad);
  match.surface_sigma = thickness;
  const double width =
      match.normal_sigma > 0 ? thickness / (std::sqrt(plane.points) * match.normal_sigma) : 0;
  match.radius = std::max(kRadiusToWidth * width, kLeastRadiusM);
}

Vec3 PlaneSearch::point(std::size_t i) const { return toVec(points_.points[i]); }

void PlaneSearch::search(std::span<Correspondence* const> matches, const Pose& T_local_body,
                         double within_m) const {
  std::array<PriorMap::Query, kMost> queries;
  std::array<PriorMap::Nearest, kMost> answers;
  for (std::size_t k = 0; k < matches.size(); ++k) {
    queries[k] = {toPoint(matches[k]->searched_at), matches[k]->map_index};
  }
  const Vec3 sensor = T_local_body * sensor_body_;
  map_.nearestSeenFrom(toPoint(sensor), static_cast<float>(within_m),
                       std::span(queries).first(matches.size()), answers);
  for (std::size_t k = 0; k < matches.size(); ++k) {
    take(*matches[k], answers[k], matches[k]->searched_at - sensor);
    if (matches[k]->planar && !liesWhereHit(*matches[k], sensor)) matches[k]->planar = false;
  }
}

// Whether the map has the plane where the ray meets it, which no error of the range moves. A point
// beyond the edge of a face, on another that the map lacks, is near to the plane by chance.
bool PlaneSearch::liesWhereHit(const Correspondence& match, const Vec3& sensor) const {
  const Vec3 ray = match.searched_at - sensor;
  const double above = match.normal.dot(match.searched_at) - match.height;
  const Vec3 hit = match.searched_at - above / match.normal.dot(ray) * ray;
  const double radius = match.radius;
  if ((hit - match.map_point).squaredNorm() < radius * radius) return true;
  const PriorMap::Query query{toPoint(hit), match.map_index};
  PriorMap::Nearest there;
  map_.nearestSeenFrom(toPoint(sensor), static_cast<float>(radius), {&query, 1}, {&there, 1});
  if (!there.found()) return false;
  const MapPlane plane = map_.plane(there.index);
  if (!plane.planar()) return false;
  return std::abs(normalOf(plane).dot(match.normal)) > kOneFaceCosine &&
         std::abs(match.normal.dot(toVec(map_.point(there.index))) - match.height) <
             kOneFaceThicknesses * std::sqrt(match.fit_variance);
}

void PlaneSearch::measure(Correspondence& match, std::size_t point, const Vec3& position,
                          const Mat3& R_local_body) const {
  match.residual = match.normal.dot(position) - match.height;
  match.range_factor = match.normal.dot(R_local_body * rays_[point]);
  const double cosine = std::max(std::abs(match.range_factor), kNoiseCosine);
  const double lever_sq = (position - match.map_point).squaredNorm();
  match.sigma = std::sqrt(range_variance_[point] * cosine * cosine + match.fit_variance +
                          lever_sq * match.normal_sigma * match.normal_sigma);
}

}  // namespace paloc
